//! The largest separation or interval at a given period.

use super::bisect::{Bisection, Bracket, Objective, Query};
use super::firing::Firing;
use super::problem::{CheckedProblem, Problem, check_period};
use super::solver::check_memory;
use crate::search::common::{Control, Outcome, ProblemError};

/// The largest value of one need at a given period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Maximum {
    /// The largest value found, in ticks, with firing times that attain it; `None` if not even the smallest was found.
    pub found: Option<(u32, Firing)>,
    /// No schedule has more than this, in ticks; `None` if none exists at all.
    pub bound: Option<u32>,
    /// Nodes visited.
    pub nodes: u64,
}

impl Maximum {
    /// Returns true if the value is proven the largest, or it is proven that there is none.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.found.map(|(value, _)| value) == self.bound
    }
}

/// The largest separation D at a period of `period` ticks; `problem.separation` is not looked at.
///
/// `t_delta` follows as `(D tick - 1 us) / 2`. A single sensor without the stale-echo option has no need of separation:
/// then the answer is the period.
///
/// # Errors
/// As for [`decide`](super::decide()).
pub fn maximize_separation<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Maximum, ProblemError> {
    let problem = Problem { separation: 1, ..*problem }.checked()?;
    maximize(problem, Objective::Separation, period, budget, memory, control)
}

/// The largest interval I between conflicting sensors at a period of `period` ticks; `problem.interval` is not looked
/// at.
///
/// Without any conflict the answer is the period.
///
/// # Errors
/// As for [`decide`](super::decide()).
pub fn maximize_interval<C: Control>(
    problem: &Problem<'_>,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Maximum, ProblemError> {
    let problem = Problem { interval: 0, ..*problem }.checked()?;
    maximize(problem, Objective::Interval, period, budget, memory, control)
}

fn maximize<C: Control>(
    problem: CheckedProblem,
    objective: Objective,
    period: u32,
    budget: u64,
    memory: &mut [i32],
    control: &mut C,
) -> Result<Maximum, ProblemError> {
    let memory = check_memory(memory, problem.sensors)?;
    let query = Query { problem, period: check_period(period)? };
    let mut bisection = Bisection::new(memory, control, budget);
    (bisection.meter.bound, bisection.meter.best) = (period, period);
    let most = most(&query, objective);
    let firing = match bisection.decide(&query, budget) {
        Outcome::Found(firing) => firing,
        Outcome::Exhausted => {
            return Ok(Maximum { found: None, bound: None, nodes: bisection.meter.nodes });
        }
        Outcome::BudgetSpent => {
            return Ok(Maximum { found: None, bound: Some(most as u32), nodes: bisection.meter.nodes });
        }
    };
    let bracket = improve(&mut bisection, &query, objective, firing);
    Ok(Maximum {
        found: Some((-bracket.feasible as u32, bracket.firing)),
        bound: Some((-bracket.infeasible - 1) as u32),
        nodes: bisection.meter.nodes,
    })
}

/// Moves from `firing`, which answers the query, as far along the objective as the budget allows.
pub(super) fn improve<'q, C: Control>(
    bisection: &mut Bisection<'_, C>,
    query: &'q Query,
    objective: Objective,
    firing: Firing,
) -> Bracket<'q> {
    let infeasible = -most(query, objective) - 1;
    let feasible = query.level_of(objective, &firing).max(infeasible + 1);
    let mut bracket = Bracket { query, objective, infeasible, feasible, firing, searched: true };
    bisection.minimize(&mut bracket);
    bracket
}

/// No schedule has more than this on `objective`: the capacity and clique bounds solved for it.
fn most(query: &Query, objective: Objective) -> i32 {
    let Query { problem, period } = *query;
    let others = problem.sensors as i32 - 1;
    match objective {
        Objective::Separation => {
            let width = (period - problem.window).min(period - 1);
            // With the stale-echo option twice the smallest |d| is at least D as well: D / 2 + (K - 1) D <= width.
            let most = if problem.least > 0 {
                2 * width / (2 * others + 1)
            } else if others > 0 {
                width / others
            } else {
                period
            };
            most.max(0)
        }
        // The clique bound at two conflicting sensors; the search finds the rest at once.
        Objective::Interval => period,
        Objective::Window => period - problem.least - problem.separation * others,
        Objective::Period => 0,
    }
}
