//! The front of interval and separation: the tables that are better in one only where others are better in the other.

use super::{Budget, Objective, Search};
use crate::search::{Outcome, SearchError};

impl<'p> Search<'p> {
    /// The tables of which no other is better in one of interval and separation without being worse in the other, from
    /// the greatest interval to the greatest separation; both at least those of the problem.
    pub(crate) fn pareto<'m>(&self, memory: &'m mut [u32]) -> Pareto<'p, 'm> {
        Pareto { search: *self, separation: Some(self.problem().separation), memory }
    }
}

/// One point of the front, in ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ParetoPoint {
    /// The smallest interval; no table with at least this separation has a greater one.
    pub(crate) interval: u32,
    /// The separation; no table with at least this interval has a greater one.
    pub(crate) separation: u32,
}

/// Walks the front of interval and separation; each step hands out a table.
#[derive(Debug)]
pub(crate) struct Pareto<'p, 'm> {
    search: Search<'p>,
    /// The separation from which the next point is sought.
    separation: Option<u32>,
    memory: &'m mut [u32],
}

impl Pareto<'_, '_> {
    /// The next point, with its waits in `a` and `b`; `Exhausted` after the last, `BudgetSpent` if the budget ended
    /// before the point was proven. A step that ran out of budget may be repeated with a new one.
    ///
    /// # Errors
    /// [`SearchError::Memory`] if the memory lent is too small.
    pub(crate) fn next_into(
        &mut self,
        budget: &mut Budget<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<(Outcome, Option<ParetoPoint>), SearchError> {
        let Some(from) = self.separation else {
            return Ok((Outcome::Exhausted, None));
        };
        let search = self.search.with(from, self.search.problem().interval);
        let interval = search.best(Objective::Interval, self.memory, budget, a, b)?;
        let (Outcome::Found(()), Some(interval)) = (interval.outcome, interval.value) else {
            if interval.outcome == Outcome::Exhausted {
                self.separation = None;
            }
            return Ok((interval.outcome, None));
        };
        let separation = search.with(from, interval).best(Objective::TDelta, self.memory, budget, a, b)?;
        let (Outcome::Found(()), Some(separation)) = (separation.outcome, separation.value) else {
            return Ok((Outcome::BudgetSpent, None));
        };
        // A single sensor is at no distance from another: its one point is the whole front.
        self.separation = if search.sensors() == 1 { None } else { separation.checked_add(1) };
        Ok((Outcome::Found(()), Some(ParetoPoint { interval, separation })))
    }
}
