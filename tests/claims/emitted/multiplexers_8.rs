// Sensors 0 to 7: hc-sr04, pulse_width, trigger 10 us, rest 40000 us, held 38000 us without an echo
use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};

// 8 sensors, T_p = 61.5 ms; 3 adjacent sensors of a ring at least 8.741 ms apart, and what each sensor and pair needs.
pub const RING: VerifiedSchedule<8, 2, EachSensor<8>> = schedule! {
    period_us: 61_500,
    t_fire_a_us: [61_000, 45_500, 30_000, 61_000, 15_000, 30_500, 46_000, 15_000],
    t_fire_b_us: [44_500, 29_500, 14_500, 60_000, 29_500, 44_500, 59_500, 14_500],
    each_meets: Requirements {
        min_interval: Micros::new(8_741),
        layout: Layout::Ring(3),
        window: Micros::new(14_569),
        stale_echo: true,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
                Micros::new(100),
            ],
            window: &[
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
                Micros::new(14_569),
            ],
            refire: &[
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
                Micros::new(40_000),
            ],
            intervals: &[],
            shared_lines: &[0b1010101, 0b10101010],
            together: &[],
        }),
        ..Requirements::new(Micros::new(100))
    },
};

// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.
pub const CONFIG: eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new(117));
