//! The question: whether a problem has a schedule at a period, and for which values of one of its numbers.

use super::super::firing::Firing;
use super::super::problem::CheckedProblem;

/// The number that is varied while all others stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Objective {
    /// The shortest period.
    Period,
    /// The largest separation.
    Separation,
    /// The largest interval.
    Interval,
    /// The largest window.
    Window,
}

/// A problem at a period.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Query {
    pub(crate) problem: CheckedProblem,
    pub(crate) period: i32,
}

impl Query {
    /// The query with the number of the objective replaced. The larger the level, the easier the query: it is the
    /// period, or another number with the opposite sign.
    pub(crate) fn at(&self, objective: Objective, level: i32) -> Self {
        let mut query = *self;
        match objective {
            Objective::Period => query.period = level,
            Objective::Separation => {
                query.problem.separation = -level;
                if self.problem.least > 0 {
                    query.problem.least = (1 - level) / 2;
                }
            }
            Objective::Interval => query.problem.interval = -level,
            Objective::Window => query.problem.window = -level,
        }
        query
    }

    /// The smallest level at which the firing times serve.
    pub(crate) fn level_of(&self, objective: Objective, firing: &Firing) -> i32 {
        let problem = &self.problem;
        match objective {
            Objective::Period => firing.period(problem),
            // Twice `|d|` of a single sensor with the stale-echo option can exceed the period.
            Objective::Separation => -firing.separation(problem, 2 * self.period),
            Objective::Interval => -firing.interval(problem, self.period, self.period),
            Objective::Window => -firing.window(self.period),
        }
    }
}

/// A query with what may be spent on it. The outcome, and the nodes that it takes, depend on nothing else while the
/// budget of the bisection lasts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Probe {
    pub(crate) query: Query,
    pub(crate) budget: u64,
    /// Firing times of an easier query, whose orders are tried first.
    pub(crate) guide: Option<Firing>,
    /// True if the budget is for a proof rather than for finding a schedule.
    pub(crate) thorough: bool,
}

/// Between which two levels of a query's objective the infeasible ones end and the feasible ones start.
pub(crate) struct Bracket<'q> {
    pub(crate) query: &'q Query,
    pub(crate) objective: Objective,
    /// The largest level known to be infeasible.
    pub(crate) infeasible: i32,
    /// The smallest level known to be feasible.
    pub(crate) feasible: i32,
    /// Firing times at `feasible`.
    pub(crate) firing: Firing,
    /// True if these times came from a search, so that they are worth following.
    pub(crate) searched: bool,
}
