use eeruf_core::{Layout, Micros, Requirements, VerifiedSchedule, schedule};

// 24 sensors, T_p = 76 ms; t_delta = 999 us, 4 adjacent sensors of a ring at least 15 ms apart, listening for 30 ms.
pub const RING: VerifiedSchedule<24> = schedule! {
    period_us: 76_000,
    t_fire_a_us: [30_000, 61_000, 13_000, 46_000, 29_000, 66_000, 5_000, 50_000, 27_000, 68_000, 5_000, 53_000, 30_000, 69_000, 14_000, 47_000, 30_000, 62_000, 15_000, 45_000, 30_000, 0, 15_000, 45_000],
    t_fire_b_us: [36_000, 73_000, 51_000, 20_000, 5_000, 66_000, 51_000, 22_000, 7_000, 66_000, 39_000, 23_000, 8_000, 61_000, 46_000, 31_000, 16_000, 72_000, 55_000, 1_000, 34_000, 18_000, 51_000, 3_000],
    meets: Requirements {
        min_interval: Micros::new(15_000),
        layout: Layout::Ring(4),
        window: Micros::new(30_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(999))
    },
};
