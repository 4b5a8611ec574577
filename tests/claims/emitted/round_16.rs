// Sensors 0 to 15: polaroid-6500, edge, trigger 0 us, rest 65000 us
use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 16 sensors, T_p = 67 ms; t_delta = 500 us, 4 adjacent sensors of a ring at least 12 ms apart, listening for 36 ms.
pub const RING: VerifiedSchedule<16> = schedule! {
    period_us: 67_000,
    t_fire_a_us: [31_000, 18_000, 5_000, 54_000, 31_000, 18_000, 5_000, 45_000, 62_000, 18_000, 5_000, 40_000, 57_000, 18_000, 5_000, 44_000],
    t_fire_b_us: [0, 15_000, 32_000, 45_000, 2_000, 17_000, 30_000, 56_000, 43_000, 11_000, 26_000, 57_000, 44_000, 13_000, 28_000, 59_000],
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
