// Sensors 0 to 7: polaroid-6500, edge, trigger 0 us, rest 65000 us
use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 8 sensors, T_p = 75.5 ms; t_delta = 662 us, 4 adjacent sensors of a line at least 14.569 ms apart, listening for 65 ms.
pub const RING: VerifiedSchedule<8> = schedule! {
    period_us: 75_500,
    t_fire_a_us: [18_400, 37_400, 56_400, 75_400, 18_400, 37_400, 56_400, 75_400],
    t_fire_b_us: [17_700, 33_900, 50_100, 66_300, 16_300, 32_500, 48_700, 64_900],
    meets: Requirements {
        min_interval: Micros::new(14_569),
        layout: Layout::Line(4),
        window: Micros::new(65_000),
        stale_echo: true,
        ..Requirements::new(Micros::new(662))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(2380));
