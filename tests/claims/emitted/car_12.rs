use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 12 sensors, T_p = 34.1 ms; 3 adjacent sensors of a ring at least 6.993 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<12, 2, EachSensor<12>> = schedule! {
    period_us: 34_100,
    t_fire_a_us: [17_000, 0, 25_500, 8_500, 17_000, 0, 25_500, 8_500, 17_000, 0, 25_500, 8_500],
    t_fire_b_us: [13_700, 2_000, 24_800, 13_100, 0, 22_400, 13_900, 2_100, 25_200, 13_400, 4_900, 23_700],
    each_meets: Requirements {
        min_interval: Micros::new(6_993),
        layout: Layout::Ring(3),
        window: Micros::new(32_051),
        stale_echo: true,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(644),
                Micros::new(644),
                Micros::new(644),
                Micros::new(644),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
                Micros::new(894),
            ],
            window: &[
                Micros::new(26_224),
                Micros::new(32_051),
                Micros::new(32_051),
                Micros::new(26_224),
                Micros::new(11_655),
                Micros::new(11_655),
                Micros::new(14_569),
                Micros::new(17_483),
                Micros::new(17_483),
                Micros::new(14_569),
                Micros::new(11_655),
                Micros::new(11_655),
            ],
            refire: &[],
            intervals: &[(4, 5, Micros::new(12_000)), (10, 11, Micros::new(12_000))],
            shared_lines: &[],
            together: &[],
        }),
        ..Requirements::new(Micros::new(894))
    },
};
