use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 24 sensors, T_p = 76 ms; t_delta = 999 us, 4 adjacent sensors of a ring at least 15 ms apart, listening for 30 ms.
pub const RING: VerifiedSchedule<24> = schedule! {
    period_us: 76_000,
    t_fire_a_us: [60_000, 30_000, 45_000, 15_000, 0, 66_000, 47_000, 27_000, 12_000, 73_000, 58_000, 40_000, 11_000, 73_000, 56_000, 26_000, 11_000, 41_000, 72_000, 26_000, 56_000, 41_000, 9_000, 75_000],
    t_fire_b_us: [14_000, 44_000, 29_000, 59_000, 12_000, 44_000, 29_000, 61_000, 12_000, 45_000, 28_000, 72_000, 13_000, 47_000, 32_000, 62_000, 15_000, 47_000, 32_000, 64_000, 14_000, 49_000, 29_000, 65_000],
    meets: Requirements {
        min_interval: Micros::new(15_000),
        layout: Layout::Ring(4),
        window: Micros::new(30_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(999))
    },
};
