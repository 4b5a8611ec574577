// Sensors 0 to 11: jsn-sr04t, pulse_width, trigger 10 us, rest 70000 us, held 60000 us without an echo
use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 12 sensors, T_p = 106.2 ms; 3 adjacent sensors of a ring at least 6.993 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<12, 2, EachSensor<12>> = schedule! {
    period_us: 106_200,
    t_fire_a_us: [16_400, 53_600, 98_000, 13_600, 72_000, 40_500, 0, 75_300, 38_800, 4_500, 66_800, 97_800],
    t_fire_b_us: [17_800, 43_800, 91_000, 17_800, 45_700, 76_700, 19_700, 45_700, 71_700, 17_600, 43_800, 81_400],
    each_meets: Requirements {
        min_interval: Micros::new(6_993),
        layout: Layout::Ring(3),
        window: Micros::new(32_051),
        stale_echo: true,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(1_395),
                Micros::new(1_395),
                Micros::new(1_395),
                Micros::new(1_395),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
                Micros::new(1_645),
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
            refire: &[
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
                Micros::new(70_000),
            ],
            intervals: &[(4, 5, Micros::new(12_000)), (10, 11, Micros::new(12_000))],
            shared_lines: &[],
            together: &[],
        }),
        ..Requirements::new(Micros::new(1_645))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(1166));
