//! The shortest period of sensors that are not all alike, and the schedule to prefer of those that have it, by the
//! engine.

use eeruf_core::search::{Control, Found, GridError, Outcome, PeriodProblem, ProblemError, Progress, SearchError};
use eeruf_core::{MAX_SENSORS, Micros};
use eeruf_sim::AnySchedule;

use crate::engine::MAX_NUMBER;
use crate::engine::search::{Decided, FiringTimes, Search};
use crate::engine::shortest::{Shortest, SoFar, shortest};
use crate::engine::spare::most_to_spare;
use crate::ticks::{claim, in_ticks};

/// Slack of a schedule for an uneven ring beyond its needs, the same for all sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ToSpare {
    /// Growth that every `t_delta` may have; then
    pub t_delta: Micros,
    /// by how much every time between two firings, be it an interval or for a shared line; then
    pub interval: Micros,
    /// how much later every sensor is triggered again than it asks for.
    pub refire: Micros,
    /// True if no schedule of this period has more, of each.
    pub proven: [bool; 3],
    /// Nodes visited for the choice.
    pub nodes: u64,
}

impl ToSpare {
    /// The three in microseconds, as JSON and Python have them.
    #[must_use]
    pub fn in_us(&self) -> [u32; 3] {
        [self.t_delta, self.interval, self.refire].map(Micros::as_micros)
    }
}

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
    let mut go_on = |so_far: &SoFar| {
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
    let answer = Found {
        schedule: Some(schedule_of(problem, found.period, &found.fire)?),
        value: Some(time(found.period)),
        bound: Some(time(found.bound)),
        proven: found.bound == found.period,
        nodes: found.nodes,
    };
    Ok((answer, reason(&found, &time)))
}

/// Decides whether some schedule has this period in ticks, within `budget` nodes, and counts the nodes visited. Short
/// descents go along `guide`, a schedule with another period.
///
/// # Errors
/// As for core's search.
pub(crate) fn decide_uneven(
    problem: &PeriodProblem<'_>,
    period: u32,
    guide: Option<&AnySchedule>,
    budget: u64,
    control: &mut impl Control,
) -> Result<(Outcome<AnySchedule>, u64), SearchError> {
    let ticks = in_ticks(problem);
    let guide = guide.map(|schedule| claim(problem, schedule, None).fire);
    let mut search = Search::new(&ticks);
    let mut go_on = |nodes| control.poll(&Progress::new(nodes, None, Some(period))).is_continue();
    let mut effort = 8 * search.depth();
    let outcome = loop {
        let left = budget.saturating_sub(search.nodes());
        let mut decided = search.decide(period, effort.min(left), &mut go_on);
        if decided == Decided::Open {
            let left = budget.saturating_sub(search.nodes());
            decided = search.find(period, (effort / 2).min(left), effort, guide.as_ref(), &mut go_on);
        }
        match decided {
            Decided::Found(fire) => break Outcome::Found(schedule_of(problem, period, &fire)?),
            Decided::Refuted => break Outcome::Exhausted,
            Decided::Stopped => break Outcome::BudgetSpent,
            Decided::Open if search.nodes() >= budget => break Outcome::BudgetSpent,
            Decided::Open => effort *= 2,
        }
    };
    Ok((outcome, search.nodes()))
}

/// A schedule from firing times in ticks.
fn schedule_of(problem: &PeriodProblem<'_>, period: u32, fire: &FiringTimes) -> Result<AnySchedule, SearchError> {
    let time = |ticks: u32| Micros::new(ticks.saturating_mul(problem.tick.as_micros()));
    let [a, b] = fire.each_ref().map(|times| times.iter().map(|&ticks| time(ticks)).collect::<Vec<_>>());
    let lags = vec![Micros::ZERO; problem.sensors];
    AnySchedule::from_slices(time(period), &lags, [&a, &b]).map_err(SearchError::Schedule)
}

/// Of the schedules with the period of this one, the one with most to spare, within `budget` nodes.
///
/// # Errors
/// As for core's search.
pub(crate) fn prefer_uneven(
    problem: &PeriodProblem<'_>,
    schedule: &AnySchedule,
    budget: u64,
    control: &mut impl Control,
) -> Result<(AnySchedule, ToSpare), SearchError> {
    let claim = claim(problem, schedule, Some(schedule.period()));
    let mut go_on = |nodes| control.poll(&Progress::new(nodes, Some(claim.period), Some(claim.period))).is_continue();
    let spare = most_to_spare(&claim.problem, claim.period, claim.fire.clone(), budget, &mut go_on);
    let time = |ticks: u32| Micros::new(ticks.saturating_mul(problem.tick.as_micros()));
    let [separation, gap, window] = spare.more.map(time);
    // The separation covers twice the t_delta.
    let t_delta = Micros::new(separation.as_micros() / 2);
    let to_spare = ToSpare { t_delta, interval: gap, refire: window, proven: spare.proven, nodes: spare.nodes };
    Ok((schedule_of(problem, claim.period, &spare.fire)?, to_spare))
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
