// Sensors 0 to 7: hc-sr04, pulse_width, trigger 10 us, rest 60000 us, held 38000 us without an echo
// Sensors 8 to 11: ping, one_pin, trigger 5 us, rest 19455 us, held 18500 us without an echo
use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 12 sensors, T_p = 64.5 ms; the given neighbours at least 9 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<12, 2, EachSensor<12>> = schedule! {
    period_us: 64_500,
    t_fire_a_us: [7_700, 22_500, 37_300, 2_700, 16_900, 31_100, 45_300, 58_900, 36_100, 36_100, 44_700, 44_700],
    t_fire_b_us: [8_000, 21_600, 35_200, 0, 13_600, 27_200, 40_800, 57_400, 43_800, 43_800, 35_200, 35_200],
    each_meets: Requirements {
        min_interval: Micros::new(9_000),
        layout: Layout::Graph(&[0xfc6, 0x58d, 0x1b, 0x36, 0x6c, 0xd8, 0xb1, 0xa63, 0x403, 0x881, 0x103, 0x281]),
        window: Micros::new(17_483),
        stale_echo: true,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(293),
                Micros::new(473),
                Micros::new(473),
                Micros::new(473),
                Micros::new(473),
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
            refire: &[
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(60_000),
                Micros::new(19_455),
                Micros::new(19_455),
                Micros::new(19_455),
                Micros::new(19_455),
            ],
            intervals: &[(8, 10, Micros::new(4_000)), (9, 11, Micros::new(4_000))],
            shared_lines: &[],
            together: &[0b1100000000, 0b110000000000],
        }),
        ..Requirements::new(Micros::new(473))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(115));

// No settings of one driver: sensors 8, 9, 10, 11 are of another kind than sensor 0.
