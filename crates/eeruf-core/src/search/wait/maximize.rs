//! The best table: the one whose smallest interval is largest, or the one with the largest separation.
//!
//! Both are monotone: a table for one value serves for each smaller one. So a bisection over [`decide`] is exact, and
//! its last infeasible value is the proof. Slow values wait until the quick ones are decided.

use super::feasibility::decide;
use super::{Budget, Problem, Search};
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Outcome, SearchError};

/// The value to maximise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Objective {
    /// The smallest interval between conflicting sensors, at the separation of the problem.
    Interval,
    /// The separation `D`, at the smallest interval of the problem.
    Separation,
}

/// The outcome of a search for the best table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Best {
    /// `Found`: the value is proven best. `Exhausted`: no table exists. `BudgetSpent`: value and bound are the best
    /// known.
    pub(crate) outcome: Outcome,
    /// The best value found, in ticks; the table was written where the caller asked.
    pub(crate) value: Option<u32>,
    /// No table has a greater value, in ticks.
    pub(crate) bound: u32,
    /// Nodes visited.
    pub(crate) nodes: u64,
}

impl Best {
    /// Returns true if the value is proven to be the best, or that no table exists.
    pub(crate) fn proven(&self) -> bool {
        self.outcome != Outcome::BudgetSpent
    }
}

impl Search<'_> {
    /// Finds the table with the greatest value and proves that none is better. `a` and `b` hold the best table found,
    /// even if the budget ends first.
    ///
    /// With nothing in conflict the interval is the period; a single sensor has the separation `wait_max`.
    ///
    /// # Errors
    /// [`SearchError::Memory`] if `memory` is too small ([`memory_words`](super::memory_words)).
    pub(crate) fn best(
        &self,
        objective: Objective,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<Best, SearchError> {
        self.check(memory)?;
        let before = budget.nodes();
        let pairs = self.sensors() as u32 - 1;
        let mut bound = match objective {
            // Of two conflicting sensors one fires before and after the other on the circle of 2 T_p; without conflicts
            // there is no interval to measure.
            Objective::Interval if self.problem().conflicts.iter().any(|&row| row != 0) => self.problem().period,
            Objective::Interval => self.problem().period.max(self.problem().interval),
            // Capacity: K values |d| in 0 ..= wait_max.
            Objective::Separation => match self.problem().wait_max.checked_div(pairs) {
                Some(most) => most,
                None => self.problem().wait_max.max(self.problem().separation),
            },
        };
        if self.problem().criterion == Criterion::Paper {
            // The weaker criterion is decided much faster, and whatever it excludes is excluded here too.
            let exact = Self::new(Problem { criterion: Criterion::Exact, ..*self.problem() });
            let exact = budget.slice(BOUND_SLICE, |budget| exact.best(objective, memory, budget, a, b))?;
            if exact.outcome == Outcome::Exhausted {
                return Ok(exact);
            }
            bound = bound.min(exact.bound);
        }
        let mut wait = [0; 2 * MAX_SENSORS];
        let mut value: Option<u32> = None;
        let mut slice = FIRST_SLICE;
        // Each round decides what takes at most `slice` nodes a value; the next round allows more.
        'rounds: loop {
            let mut top = bound;
            loop {
                let target = match value {
                    None => self.least_of(objective),
                    Some(value) if value < top => value + (top - value).div_ceil(2),
                    Some(_) => break,
                };
                if value.is_none() && target > bound {
                    bound = target;
                    break 'rounds;
                }
                let search = self.at(objective, target);
                (budget.best, budget.bound) = (value, Some(bound));
                let limit = if value.is_none() { u64::MAX } else { slice };
                match budget.slice(limit, |budget| decide(search.problem(), memory, budget, &mut wait)) {
                    Outcome::Found(()) => {
                        self.hand_out(&wait, a, b);
                        value = Some(self.value_of(objective, a, b).clamp(target, bound));
                    }
                    Outcome::Exhausted if value.is_none() => break 'rounds,
                    Outcome::Exhausted => {
                        bound = target - 1;
                        top = bound;
                    }
                    Outcome::BudgetSpent if budget.spent() => break 'rounds,
                    Outcome::BudgetSpent => top = target - 1,
                }
            }
            if value == Some(bound) {
                break;
            }
            slice = slice.saturating_mul(4);
        }
        let outcome = match value {
            Some(value) if value == bound => Outcome::Found(()),
            None if !budget.spent() => Outcome::Exhausted,
            _ => Outcome::BudgetSpent,
        };
        Ok(Best { outcome, value, bound, nodes: budget.nodes() - before })
    }

    fn least_of(&self, objective: Objective) -> u32 {
        match objective {
            Objective::Interval => self.problem().interval,
            Objective::Separation => self.problem().separation,
        }
    }

    fn at(&self, objective: Objective, value: u32) -> Self {
        match objective {
            Objective::Interval => self.with(self.problem().separation, value),
            Objective::Separation => self.with(value, self.problem().interval),
        }
    }

    fn value_of(&self, objective: Objective, a: &[u32], b: &[u32]) -> u32 {
        match objective {
            Objective::Interval => self.smallest_interval(a, b),
            Objective::Separation => self.separation_of(a, b),
        }
    }
}

/// Number of nodes for a value in the first round of a bisection.
const FIRST_SLICE: u64 = 1000;
/// Number of nodes for a bound by the weaker criterion.
const BOUND_SLICE: u64 = 20_000;
