//! Of all schedules with the shortest period, the one with most to spare.

use super::bisect::{Bisection, Objective, Query};
use super::firing::Firing;
use super::maximize::improve;
use super::problem::{Problem, check_period};
use super::shortest::Shortest;
use super::solver::check_memory;
use crate::search::common::{Control, ProblemError};

/// The quality of a second optimum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Optimum {
    /// The value attained, in ticks.
    pub value: u32,
    /// No schedule has more, in ticks.
    pub bound: u32,
}

impl Optimum {
    /// Returns true if the value is proven the best; otherwise it is the best found.
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
    pub separation: Optimum,
    /// At this separation, the smallest interval between conflicting sensors as large as possible.
    pub interval: Optimum,
    /// At these, refire times as even as possible: the shortest time between two firings of one sensor as long as
    /// possible.
    pub window: Optimum,
    /// Nodes visited.
    pub nodes: u64,
}

/// Of all schedules with the period found, the one to prefer: larger separation, then larger interval, then evener
/// refire times.
///
/// Each comes first on its own: no gain in a later one makes up for a loss in an earlier one. `budget` nodes are spent
/// at most, a third on each. A value that was not proven best is the best found.
///
/// # Errors
/// As for [`decide`](super::decide()).
pub fn prefer<C: Control>(
    problem: &Problem<'_>,
    shortest: &Shortest,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Preferred, ProblemError> {
    let problem = problem.checked()?;
    let memory = check_memory(memory, problem.sensors)?;
    let mut query = Query { problem, period: check_period(shortest.period)? };
    let mut bisection = Bisection::new(memory, control, 0);
    (bisection.meter.bound, bisection.meter.best) = (shortest.bound, shortest.period);
    let mut firing = shortest.firing;
    let mut optima = [Optimum { value: 0, bound: 0 }; 3];
    for (optimum, objective) in optima.iter_mut().zip([Objective::Separation, Objective::Interval, Objective::Window]) {
        bisection.meter.limit = bisection.meter.nodes + budget / 3;
        let bracket = improve(&mut bisection, &query, objective, firing);
        firing = bracket.firing;
        let (level, infeasible) = (bracket.feasible, bracket.infeasible);
        query = query.at(objective, level);
        *optimum = Optimum { value: -level as u32, bound: (-infeasible - 1) as u32 };
    }
    let [separation, interval, window] = optima;
    Ok(Preferred { firing, separation, interval, window, nodes: bisection.meter.nodes })
}
