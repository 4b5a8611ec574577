use eeruf_core::{
    Criterion, Layout, Micros, Requirements,
    hopping::{HoppingListening, HoppingSchedule, HoppingSettings},
    hopping_schedule,
    judge::TrackerSettings,
};

// 8 sensors, 11 phases, T_p = 54 ms,
// t_delta = 150 us, 4 adjacent sensors of a line at least 12 ms apart, listening for 36 ms.
#[allow(long_running_const_eval, reason = "all pairs of neighbours are checked in all phases")]
pub const RING: HoppingSchedule<8> = hopping_schedule! {
    period_us: 54_000,
    step_us: 240,
    phases: 11,
    first_multiplier: 7,
    t_lag_us: [13_200, 27_120, 0, 40_560, 14_400, 26_400, 0, 39_840],
    meets: Requirements {
        criterion: Criterion::Margin(Micros::new(90)),
        min_interval: Micros::new(12_000),
        layout: Layout::Line(4),
        window: Micros::new(36_000),
        stale_echo: false,
        ..Requirements::new(Micros::new(150))
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
