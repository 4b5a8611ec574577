use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 8 sensors, T_p = 67 ms; t_delta = 416 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
pub const RING: VerifiedSchedule<8> = schedule! {
    period_us: 67_000,
    t_fire_a_us: [0, 17_000, 34_000, 51_000, 1_000, 18_000, 35_000, 52_000],
    t_fire_b_us: [0, 15_000, 30_000, 45_000, 0, 15_000, 30_000, 45_000],
    meets: Requirements {
        min_interval: Micros::new(14_569),
        layout: Layout::Ring(4),
        window: Micros::new(60_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(416))
    },
};
