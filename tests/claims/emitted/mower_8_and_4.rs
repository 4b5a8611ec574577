use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 12 sensors, T_p = 37 ms; the given neighbours at least 9 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<12, 2, EachSensor<12>> = schedule! {
    period_us: 37_000,
    t_fire_a_us: [13_000, 22_000, 2_600, 31_000, 11_600, 2_600, 22_000, 31_000, 4_000, 4_000, 0, 0],
    t_fire_b_us: [12_000, 3_000, 21_000, 30_600, 3_000, 12_000, 30_000, 21_000, 30_000, 30_000, 34_000, 34_000],
    each_meets: Requirements {
        min_interval: Micros::new(9_000),
        layout: Layout::Graph(&[0xfc6, 0x58d, 0x1b, 0x36, 0x6c, 0xd8, 0xb1, 0xa63, 0x403, 0x881, 0x103, 0x281]),
        window: Micros::new(17_483),
        stale_echo: false,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(286),
                Micros::new(466),
                Micros::new(466),
                Micros::new(466),
                Micros::new(466),
            ],
            window: &[
                Micros::new(17_483),
                Micros::new(17_483),
                Micros::new(11_655),
                Micros::new(11_655),
                Micros::new(11_655),
                Micros::new(11_655),
                Micros::new(11_655),
                Micros::new(17_483),
                Micros::new(2_914),
                Micros::new(2_914),
                Micros::new(2_914),
                Micros::new(2_914),
            ],
            refire: &[],
            intervals: &[(8, 10, Micros::new(4_000)), (9, 11, Micros::new(4_000))],
            shared_lines: &[],
            together: &[0b1100000000, 0b110000000000],
        }),
        ..Requirements::new(Micros::new(466))
    },
};
