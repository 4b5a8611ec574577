// Sensors 0 to 15: polaroid-6500, edge, trigger 0 us, rest 65000 us
use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 16 sensors, T_p = 67 ms; t_delta = 500 us, 4 adjacent sensors of a ring at least 12 ms apart, listening for 36 ms.
pub const RING: VerifiedSchedule<16> = schedule! {
    period_us: 67_000,
    t_fire_a_us: [3_000, 58_000, 19_000, 39_000, 0, 56_000, 26_000, 13_000, 40_000, 53_000, 27_000, 14_000, 1_000, 58_000, 45_000, 32_000],
    t_fire_b_us: [4_000, 35_000, 48_000, 22_000, 5_000, 35_000, 53_000, 22_000, 9_000, 38_000, 52_000, 25_000, 4_000, 39_000, 52_000, 19_000],
    meets: Requirements {
        min_interval: Micros::new(12_000),
        layout: Layout::Ring(4),
        window: Micros::new(36_000),
        stale_echo: true,
        ..Requirements::new(Micros::new(500))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(2380));
