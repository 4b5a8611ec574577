// Sensors 0 to 2: hc-sr04, pulse_width, trigger 10 us, rest 60000 us, held 38000 us without an echo
use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 3 sensors, T_p = 62.5 ms; t_delta = 479 us, 3 adjacent sensors of a line at least 14.977 ms apart, listening for 60 ms.
pub const RING: VerifiedSchedule<3> = schedule! {
    period_us: 62_500,
    t_fire_a_us: [20_000, 41_000, 62_000],
    t_fire_b_us: [19_500, 39_500, 59_500],
    meets: Requirements {
        min_interval: Micros::new(14_977),
        layout: Layout::Line(3),
        window: Micros::new(60_000),
        stale_echo: true,
        ..Requirements::new(Micros::new(479))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(117));
