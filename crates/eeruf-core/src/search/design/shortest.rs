//! The shortest period, and why it is not shorter.

use super::bisect::{Bisection, Bracket, Objective, Query};
use super::bounds;
use super::construct::constructed;
use super::explanation::Explanation;
use super::firing::Firing;
use super::problem::{CheckedProblem, Problem};
use super::solver::check_memory;
use crate::search::common::{Control, ProblemError};

/// The shortest period found, with its proof or lower bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Shortest {
    /// Firing times that serve at `period`.
    pub firing: Firing,
    /// The shortest period found, in ticks.
    pub period: u32,
    /// No schedule has a shorter period than this, in ticks.
    pub bound: u32,
    /// Nodes visited.
    pub nodes: u64,
    /// Why it is not shorter.
    pub explanation: Explanation,
}

impl Shortest {
    /// Returns true if no shorter period exists.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.bound == self.period
    }
}

/// The shortest period, within `budget` nodes.
///
/// If the budget ends first, the shortest found so far comes back with the bound proven so far. There is always a
/// schedule: firing one by one. The answer depends on nothing but the problem and the budget.
///
/// # Errors
/// If the problem is invalid, or the memory is smaller than [`memory_words`](super::memory_words).
pub fn shortest<C: Control>(
    problem: &Problem<'_>,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Shortest, ProblemError> {
    let problem = problem.checked()?;
    let memory = check_memory(memory, problem.sensors)?;
    let mut bisection = Bisection::new(memory, control, budget);
    Ok(shortest_period(&problem, &mut bisection))
}

/// In fine ticks the same problem is solved in coarse ones first, if all times are multiples of one: a schedule in
/// coarse ticks is one in fine ticks as well, and hardly ever is there a better one. That is then all that remains to
/// be proven.
pub(crate) fn shortest_period<C: Control>(problem: &CheckedProblem, bisection: &mut Bisection<'_, C>) -> Shortest {
    let counted = bounds::strongest(problem);
    let firing = constructed(problem);
    let query = Query { problem: *problem, period: firing.period(problem) };
    let mut bracket = Bracket {
        query: &query,
        objective: Objective::Period,
        infeasible: counted.period() as i32 - 1,
        feasible: query.period,
        firing,
        searched: false,
    };
    match problem.in_coarse_ticks() {
        None => bisection.minimize(&mut bracket),
        Some((coarse, ticks)) => {
            // A bound between two coarse ticks may be met, and then coarse ticks cannot meet it.
            let least = bracket.infeasible + 1;
            let between = least % ticks > 0;
            if !(between && bisection.finds(least, 64 * problem.sensors as u64, &mut bracket)) {
                let budget = bisection.minimize_in_coarse_ticks(&coarse, ticks, &mut bracket);
                // As ticks were multiplied, the times may serve at a period that is shorter still.
                bracket.feasible = bracket.firing.period(problem);
                bisection.bisect(budget, &mut bracket);
            }
        }
    }
    let (period, bound) = (bracket.feasible as u32, bracket.infeasible as u32 + 1);
    let explanation =
        if bound < period { Explanation::BudgetSpent { bound } } else { Explanation::by(counted, period) };
    Shortest { firing: bracket.firing, period, bound, nodes: bisection.meter.nodes, explanation }
}
