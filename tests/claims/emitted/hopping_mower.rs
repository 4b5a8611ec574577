use eeruf_core::{
    EachSensor, Layout, Micros, Requirements, Uneven,
    hopping::{HoppingListening, HoppingSchedule, HoppingSettings},
    hopping_schedule,
    judge::TrackerSettings,
};

// 12 sensors, 16 phases, T_p = 68.848 ms,
// the given neighbours at least 9 ms apart, and what each sensor and pair needs.
#[allow(long_running_const_eval, reason = "all pairs of neighbours are checked in all phases")]
pub const RING: (HoppingSchedule<12>, EachSensor<12>) = hopping_schedule! {
    period_us: 68_848,
    step_us: 601,
    phases: 16,
    first_multiplier: 1,
    t_lag_us: [59_439, 20_611, 43_228, 0, 13_808, 27_616, 43_227, 6_803, 34_419, 34_419, 45_631, 45_631],
    each_meets: Requirements {
        min_interval: Micros::new(9_000),
        layout: Layout::Graph(&[0xfc6, 0x58d, 0x1b, 0x36, 0x6c, 0xd8, 0xb1, 0xa63, 0x403, 0x881, 0x103, 0x281]),
        window: Micros::new(17_483),
        stale_echo: false,
        uneven: Some(Uneven {
            t_delta: &[
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(120),
                Micros::new(300),
                Micros::new(300),
                Micros::new(300),
                Micros::new(300),
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
        ..Requirements::new(Micros::new(300))
    },
};

// For `HoppingRing::with_limits`; QUICK, DRIVING and MAPS are other sets of settings.
pub const SETTINGS: HoppingSettings = HoppingSettings::BALANCED
    .with_tracker(
        TrackerSettings::BALANCED
            .with_t_delta(Micros::new(300))
            .with_near(Micros::new(400))
            .with_tentative_within(Micros::new(60)),
    )
    .with_neighbours(0);

pub const LISTENING: HoppingListening = HoppingListening::new(Micros::new(17_483));
