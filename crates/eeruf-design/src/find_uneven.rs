//! The shortest period of sensors that are not all alike, by the search of `eeruf-check`.

use eeruf_check::MAX_NUMBER;
use eeruf_check::shortest::{Shortest, shortest};
use eeruf_core::search::{Control, Found, GridError, PeriodProblem, ProblemError, Progress, SearchError};
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_sim::AnySchedule;

use crate::ticks::in_ticks;

/// The shortest period within `budget` nodes, and why it is not shorter, in words.
///
/// # Errors
/// As for core's search.
pub(crate) fn shortest_uneven(
    problem: &PeriodProblem<'_>,
    budget: u64,
    control: &mut impl Control,
) -> Result<(Found<MAX_SENSORS>, String), SearchError> {
    if problem.tick == Micros::ZERO {
        return Err(GridError::NoTick.into());
    }
    problem.requirements.layout.check(problem.sensors)?;
    let ticks = in_ticks(problem);
    let mut go_on = |so_far: &eeruf_check::shortest::SoFar| {
        control.poll(&Progress::new(so_far.nodes, Some(so_far.best), Some(so_far.bound))).is_continue()
    };
    let too_long = || {
        let longest = |times: &[u32]| times.iter().map(|&time| u64::from(time)).max().unwrap_or(0);
        let gap = ticks.gaps.iter().map(|&(.., x, y)| u64::from(x.max(y))).max().unwrap_or(0);
        let each = gap + longest(&ticks.separation);
        let period = longest(&ticks.window) + problem.sensors as u64 * each;
        SearchError::Problem(ProblemError::TooLong { period, most: MAX_NUMBER })
    };
    let found = shortest(&ticks, budget, &mut go_on).ok_or_else(too_long)?;
    let time = |ticks: u32| Micros::new(ticks.saturating_mul(problem.tick.as_micros()));
    let times = |times: &[u32]| times.iter().map(|&ticks| time(ticks)).collect::<Vec<_>>();
    let lags = vec![Micros::ZERO; problem.sensors];
    let [a, b] = found.fire.each_ref().map(|times_in_ticks| times(times_in_ticks));
    let schedule = AnySchedule::from_slices(time(found.period), &lags, [&a, &b]).map_err(SearchError::Schedule)?;
    let answer = Found {
        schedule: Some(schedule),
        value: Some(time(found.period)),
        bound: Some(time(found.bound)),
        proven: found.bound == found.period,
        nodes: found.nodes,
    };
    Ok((answer, reason(&found, &time)))
}

/// Why the period is not shorter.
fn reason(found: &Shortest, time: &dyn Fn(u32) -> Micros) -> String {
    if found.bound < found.period {
        format!(
            "the search, which ended early: periods from {} on are neither found nor excluded, and a larger budget may \
             settle that",
            time(found.bound)
        )
    } else if found.without_cases {
        format!(
            "what the sensors need: {} leave too little time for it, before any order of firing is chosen",
            time(found.period - 1)
        )
    } else {
        format!(
            "what the sensors need together: no firing order meets it within {} (every order was searched)",
            time(found.period - 1)
        )
    }
}
