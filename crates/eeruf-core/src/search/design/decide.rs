//! True if there is a schedule with a given period.

use super::bisect::{Bisection, Query};
use super::bounds;
use super::firing::Firing;
use super::problem::{Problem, check_period};
use super::solver::check_memory;
use crate::search::common::{Control, Outcome, ProblemError};

/// The outcome of a search of one period, and what it cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decided {
    /// The outcome: found, exhausted (all were searched, or counting excludes them) or budget spent.
    pub outcome: Outcome<Firing>,
    /// Nodes visited.
    pub nodes: u64,
}

/// Returns true if there is a schedule with a period of `period` ticks, within `budget` nodes.
///
/// # Errors
/// If the problem is invalid, the period is 0 or too long, or the memory is smaller than
/// [`memory_words`](super::memory_words).
pub fn decide<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Decided, ProblemError> {
    let problem = problem.checked()?;
    let memory = check_memory(memory, problem.sensors)?;
    let period = check_period(period)?;
    if period < bounds::strongest(&problem).period() as i32 {
        return Ok(Decided { outcome: Outcome::Exhausted, nodes: 0 });
    }
    let mut bisection = Bisection::new(memory, control, budget);
    let outcome = bisection.decide(&Query { problem, period }, budget);
    Ok(Decided { outcome, nodes: bisection.meter.nodes })
}
