use eeruf_core::{Criterion, Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 8 sensors, T_p = 67 ms; t_delta = 416 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
pub const RING: VerifiedSchedule<8> = schedule! {
    period_us: 67_000,
    t_fire_a_us: [58_000, 19_000, 0, 41_000, 56_000, 20_000, 3_000, 36_000],
    t_fire_b_us: [51_000, 21_000, 6_000, 36_000, 52_000, 21_000, 6_000, 36_000],
    meets: Requirements {
        t_delta: Micros::new(416),
        criterion: Criterion::Exact,
        min_interval: Micros::new(14_569),
        layout: Layout::Ring(4),
        window: Micros::new(60_000),
        stale_echo: false,
        uneven: None,
    },
};
