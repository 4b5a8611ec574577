use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 12 sensors, T_p = 34.1 ms; 3 adjacent sensors of a ring at least 6.993 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<12, 2, EachSensor<12>> = schedule! {
    period_us: 34_100,
    t_fire_a_us: [17_000, 0, 8_500, 25_500, 17_000, 34_000, 8_500, 25_500, 17_000, 34_000, 8_500, 25_500],
    t_fire_b_us: [21_600, 700, 10_500, 22_200, 34_000, 13_400, 21_900, 31_900, 8_400, 22_400, 30_900, 10_300],
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
