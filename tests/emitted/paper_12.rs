use eeruf_core::{Criterion, Layout, Micros, Requirements, Schedule, schedule};

/// 12 sensors, T_p = 65 ms; t_delta = 999 us, 4 adjacent sensors of a line at least 15 ms apart, listening for 30 ms.
pub const RING: Schedule<12> = schedule! {
    period_us: 65_000,
    t_fire_a_us: [35_000, 50_000, 3_000, 18_000, 33_000, 48_000, 63_000, 14_000, 29_000, 44_000, 59_000, 14_000],
    t_fire_b_us: [45_000, 15_000, 0, 30_000, 49_000, 15_000, 64_000, 32_000, 49_000, 13_000, 64_000, 28_000],
    meets: Requirements {
        t_delta: Micros::new(999),
        criterion: Criterion::Exact,
        min_interval: Micros::new(15_000),
        layout: Layout::Line(4),
        window: Micros::new(30_000),
        stale_echo: false,
    },
};
