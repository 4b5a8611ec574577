use eeruf_core::{
    Layout, Micros,
    hopping::{HoppingListening, HoppingSchedule, HoppingSettings},
    hopping_schedule,
    judge::TrackerSettings,
    phases::{Audible, PhaseCriterion, PhaseRequirements},
};

// 8 sensors, 11 phases, T_p = 54.48 ms,
// t_delta = 150 us, 4 adjacent sensors of a line at least 12 ms apart, listening for 36 ms.
#[allow(long_running_const_eval, reason = "all pairs of neighbours are checked in all phases")]
pub const RING: HoppingSchedule<8> = hopping_schedule! {
    period_us: 54_480,
    step_us: 240,
    phases: 11,
    first_multiplier: 7,
    t_lag_us: [0, 13_920, 27_600, 40_800, 720, 12_720, 25_920, 39_600],
    meets: PhaseRequirements {
        t_delta: Micros::new(150),
        criterion: PhaseCriterion::Margin(Micros::new(90)),
        audible: Audible {
            window: Micros::new(36_000),
            blanking: Micros::new(0),
            reach: Micros::new(36_000),
        },
        min_interval: Micros::new(12_000),
        layout: Layout::Line(4),
        stale_echo: false,
    },
};

// For `HoppingRing::hopping`; QUICK, DRIVING and MAPS are other sets of settings.
pub const SETTINGS: HoppingSettings = HoppingSettings::BALANCED
    .with_tracker(
        TrackerSettings::BALANCED
            .with_t_delta(Micros::new(150))
            .with_near(Micros::new(400))
            .with_tentative_within(Micros::new(60)),
    )
    .with_neighbours(4);

pub const LISTENING: HoppingListening = HoppingListening::new(Micros::new(36_000));
