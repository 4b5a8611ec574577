use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 12 sensors, T_p = 65 ms; t_delta = 999 us, 4 adjacent sensors of a line at least 15 ms apart, listening for 30 ms.
pub const RING: VerifiedSchedule<12> = schedule! {
    period_us: 65_000,
    t_fire_a_us: [14_000, 47_000, 31_000, 62_000, 15_000, 47_000, 32_000, 64_000, 17_000, 49_000, 34_000, 64_000],
    t_fire_b_us: [34_000, 16_000, 49_000, 64_000, 31_000, 14_000, 46_000, 64_000, 29_000, 14_000, 44_000, 60_000],
    meets: Requirements {
        min_interval: Micros::new(15_000),
        layout: Layout::Line(4),
        window: Micros::new(30_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(999))
    },
};
