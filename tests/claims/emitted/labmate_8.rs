use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 8 sensors, T_p = 48.3 ms; t_delta = 487 us, 4 adjacent sensors of a line at least 11.655 ms apart, listening for 23.31 ms.
pub const RING: VerifiedSchedule<8> = schedule! {
    period_us: 48_300,
    t_fire_a_us: [36_600, 500, 24_900, 13_200, 36_600, 1_500, 24_900, 13_200],
    t_fire_b_us: [12_700, 0, 37_100, 24_400, 11_700, 0, 38_100, 23_400],
    meets: Requirements {
        min_interval: Micros::new(11_655),
        layout: Layout::Line(4),
        window: Micros::new(23_310),
        stale_echo: false,
        ..Requirements::new(Micros::new(487))
    },
};
