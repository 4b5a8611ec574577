// Sensors 0 to 4: hc-sr04, pulse_width, trigger 10 us, rest 60000 us, held 38000 us without an echo
use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 5 sensors, T_p = 67 ms; t_delta = 532 us, 4 adjacent sensors of a line at least 14.569 ms apart, listening for 60 ms.
pub const RING: VerifiedSchedule<5> = schedule! {
    period_us: 67_000,
    t_fire_a_us: [1_000, 19_000, 35_500, 52_000, 2_500],
    t_fire_b_us: [0, 15_000, 30_000, 45_000, 0],
    meets: Requirements {
        min_interval: Micros::new(14_569),
        layout: Layout::Line(4),
        window: Micros::new(60_000),
        stale_echo: true,
        ..Requirements::new(Micros::new(532))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(117));
