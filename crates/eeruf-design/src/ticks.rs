//! A problem and a schedule in the whole ticks of a certificate, of sensors that are alike or not.

use eeruf_core::search::PeriodProblem;
use eeruf_core::{Micros, Phase};
use eeruf_sim::AnySchedule;

use crate::engine::{Claim, Problem};

/// The problem in whole ticks: the separation of a sensor is the smallest number of ticks above twice its `t_delta`,
/// windows and gaps are the smallest that are as long.
pub(crate) fn in_ticks(problem: &PeriodProblem<'_>) -> Problem {
    let PeriodProblem { sensors, requirements, tick } = *problem;
    let tick_us = tick.as_micros().max(1);
    let ticks = |time: Micros| time.as_micros().div_ceil(tick_us);
    let separation = |sensor| {
        let twice = 2 * u64::from(requirements.t_delta_of(sensor).as_micros());
        u32::try_from(twice / u64::from(tick_us) + 1).unwrap_or(u32::MAX)
    };
    let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
    let refire = |x| ticks(requirements.window_of(x).max(requirements.refire_of(x))).max(1);
    let gap = |x, y| ticks(requirements.gap_after(sensors, x, y));
    let gaps = pairs.map(|(x, y)| (x, y, gap(x, y), gap(y, x)));
    let together = requirements.uneven.map_or(&[][..], |uneven| uneven.together);
    let members = |set: &u64| (0..sensors).filter(|sensor| set >> sensor & 1 == 1).collect();
    Problem {
        tick_us: (tick_us, 1),
        separation: (0..sensors).map(separation).collect(),
        // A certificate's window is how soon a sensor fires again; for how long it listens is in the gaps.
        window: (0..sensors).map(refire).collect(),
        stale_echo: requirements.stale_echo,
        over_reals: false,
        together: together.iter().map(members).collect(),
        gaps: gaps.filter(|&(.., after_x, after_y)| after_x > 0 || after_y > 0).collect(),
    }
}

/// The claim of a certificate about the schedule, in ticks.
pub(crate) fn claim(problem: &PeriodProblem<'_>, schedule: &AnySchedule, bound: Option<Micros>) -> Claim {
    let tick_us = problem.tick.as_micros().max(1);
    let ticks = |time: Micros| time.as_micros() / tick_us;
    let fire = [Phase::A, Phase::B].map(|phase| {
        (0..problem.sensors).map(|sensor| ticks(schedule.t_fire(phase, sensor).unwrap_or_default())).collect()
    });
    let period = ticks(schedule.period());
    // There is no bound below one tick.
    Claim { problem: in_ticks(problem), period, fire, bound: ticks(bound.unwrap_or_default()).max(1) }
}
