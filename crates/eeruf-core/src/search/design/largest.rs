//! The questions the other way round: how much separation or interval fits into a given period, and the best of all shortest schedules.

use super::check_memory;
use super::control::Control;
use super::hunt::{Axis, Border, Hunt, Question};
use super::problem::{Needs, Problem, ProblemError};
use super::schedule::Firing;
use super::shortest::{Shortest, check_period};
use super::tree::Outcome;

/// The largest value of one need at a given period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Largest {
    /// The largest value found, in ticks, with firing times that attain it; `None` if not even the smallest was found.
    pub found: Option<(u32, Firing)>,
    /// No schedule has more than this, in ticks; `None` if none exists at all.
    pub bound: Option<u32>,
    /// Nodes visited.
    pub nodes: u64,
}

impl Largest {
    /// Whether the value is proven the largest, or it is proven that there is none.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.found.map(|(value, _)| value) == self.bound
    }
}

/// The largest separation D at a period of `period` ticks; `problem.separation` is not looked at.
///
/// `t_delta` follows as `(D tick - 1 us) / 2`. A single sensor without the stale-echo option has no need of separation: then the answer is
/// the period.
///
/// # Errors
/// As for [`decide`](super::decide).
pub fn largest_separation<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Largest, ProblemError> {
    let needs = Problem { separation: 1, ..*problem }.needs()?;
    largest(needs, Axis::Separation, period, budget, memory, control)
}

/// The largest interval I between conflicting sensors at a period of `period` ticks; `problem.interval` is not looked at.
///
/// Without any conflict the answer is the period.
///
/// # Errors
/// As for [`decide`](super::decide).
pub fn largest_interval<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Largest, ProblemError> {
    let needs = Problem { interval: 0, ..*problem }.needs()?;
    largest(needs, Axis::Interval, period, budget, memory, control)
}

fn largest<C: Control>(
    needs: Needs,
    axis: Axis,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Largest, ProblemError> {
    let memory = check_memory(memory, needs.sensors)?;
    let question = Question { needs, period: check_period(period)? };
    let mut hunt = Hunt::new(memory, control, budget);
    (hunt.meter.bound, hunt.meter.best) = (period, period);
    let most = most(&question, axis);
    let firing = match hunt.settle(&question, budget) {
        Outcome::Found(firing) => firing,
        Outcome::Exhausted => {
            return Ok(Largest { found: None, bound: None, nodes: hunt.meter.nodes });
        }
        Outcome::Spent => {
            return Ok(Largest { found: None, bound: Some(most as u32), nodes: hunt.meter.nodes });
        }
    };
    let border = improve(&mut hunt, &question, axis, firing);
    Ok(Largest {
        found: Some((-border.yes as u32, border.firing)),
        bound: Some((-border.no - 1) as u32),
        nodes: hunt.meter.nodes,
    })
}

/// Moves from `firing`, which answers `question`, as far along `axis` as the budget allows.
fn improve<C: Control>(hunt: &mut Hunt<'_, C>, question: &Question, axis: Axis, firing: Firing) -> Border {
    let no = -most(question, axis) - 1;
    let yes = question.ease_of(axis, &firing).max(no + 1);
    let mut border = Border { no, yes, firing, guide: true };
    hunt.narrow(question, axis, &mut border);
    border
}

/// No schedule has more than this on `axis`: the capacity and clique bounds solved for it.
fn most(question: &Question, axis: Axis) -> i32 {
    let Question { needs, period } = *question;
    let others = needs.sensors as i32 - 1;
    match axis {
        Axis::Separation => {
            let width = (period - needs.window).min(period - 1);
            // With the stale-echo option twice the smallest |d| is at least D as well: D / 2 + (K - 1) D <= width.
            let most = if needs.least > 0 {
                2 * width / (2 * others + 1)
            } else if others > 0 {
                width / others
            } else {
                period
            };
            most.max(0)
        }
        // The clique bound at two conflicting sensors; the search finds the rest at once.
        Axis::Interval => period,
        Axis::Window => period - needs.least - needs.separation * others,
        Axis::Period => 0,
    }
}

/// How good a second choice is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Choice {
    /// The value attained, in ticks.
    pub value: u32,
    /// No schedule has more, in ticks.
    pub bound: u32,
}

impl Choice {
    /// Whether the value is proven the best; otherwise it is the best found.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.value == self.bound
    }
}

/// The best of the schedules with the period of a [`Shortest`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Preferred {
    /// The firing times.
    pub firing: Firing,
    /// First, the separation as large as possible.
    pub separation: Choice,
    /// At this separation, the smallest interval between conflicting sensors as large as possible.
    pub interval: Choice,
    /// At these, refire times as even as possible: the shortest time between two firings of one sensor as long as possible.
    pub window: Choice,
    /// Nodes visited.
    pub nodes: u64,
}

/// Of all schedules with the period found, the one to prefer: larger separation, then larger interval, then evener refire times.
///
/// Each comes first on its own: no gain in a later one makes up for a loss in an earlier one. `budget` nodes are spent at most, a third on
/// each. A value that was not proven best is the best found.
///
/// # Errors
/// As for [`decide`](super::decide).
pub fn prefer<C: Control>(
    problem: &Problem<'_>,
    shortest: &Shortest,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Preferred, ProblemError> {
    let needs = problem.needs()?;
    let memory = check_memory(memory, needs.sensors)?;
    let mut question = Question { needs, period: check_period(shortest.period)? };
    let mut hunt = Hunt::new(memory, control, 0);
    (hunt.meter.bound, hunt.meter.best) = (shortest.bound, shortest.period);
    let mut firing = shortest.firing;
    let mut choices = [Choice { value: 0, bound: 0 }; 3];
    for (choice, axis) in choices.iter_mut().zip([Axis::Separation, Axis::Interval, Axis::Window]) {
        hunt.meter.limit = hunt.meter.nodes + budget / 3;
        let border = improve(&mut hunt, &question, axis, firing);
        firing = border.firing;
        question = question.at(axis, border.yes);
        *choice = Choice { value: -border.yes as u32, bound: (-border.no - 1) as u32 };
    }
    let [separation, interval, window] = choices;
    Ok(Preferred { firing, separation, interval, window, nodes: hunt.meter.nodes })
}
