use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 12 sensors, T_p = 65 ms; t_delta = 999 us, 4 adjacent sensors of a line at least 15 ms apart, listening for 30 ms.
pub const RING: VerifiedSchedule<12> = schedule! {
    period_us: 65_000,
    t_fire_a_us: [5_000, 50_000, 35_000, 20_000, 5_000, 50_000, 35_000, 20_000, 5_000, 52_000, 37_000, 22_000],
    t_fire_b_us: [15_000, 49_000, 0, 34_000, 17_000, 55_000, 2_000, 40_000, 23_000, 55_000, 6_000, 38_000],
    meets: Requirements {
        min_interval: Micros::new(15_000),
        layout: Layout::Line(4),
        window: Micros::new(30_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(999))
    },
};
