use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 8 sensors, T_p = 48.3 ms; t_delta = 487 us, 4 adjacent sensors of a line at least 11.655 ms apart, listening for 23.31 ms.
pub const RING: VerifiedSchedule<8> = schedule! {
    period_us: 48_300,
    t_fire_a_us: [1_000, 13_700, 26_400, 38_100, 0, 11_700, 24_400, 36_100],
    t_fire_b_us: [1_500, 24_900, 36_600, 13_200, 1_500, 24_900, 36_600, 13_200],
    meets: Requirements {
        min_interval: Micros::new(11_655),
        layout: Layout::Line(4),
        window: Micros::new(23_310),
        stale_echo: false,
        ..Requirements::new(Micros::new(487))
    },
};
