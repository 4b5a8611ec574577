//! The Pareto front of interval and separation: tables that no other beats in one without losing in the other.

use super::{Budget, Objective, Search};
use crate::search::{Outcome, SearchError};

impl Search<'_> {
    /// The interval and separation of the first point of the front with at least this separation; its waits are in `a`
    /// and `b`.
    ///
    /// # Errors
    /// [`SearchError::Memory`] if the memory lent is too small.
    pub(crate) fn front_from(
        &self,
        separation: u32,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<Outcome<(u32, u32)>, SearchError> {
        let search = self.with(separation, self.problem().interval);
        let best = search.best(Objective::Interval, memory, budget, a, b)?;
        let (Outcome::Found(()), Some(interval)) = (best.outcome, best.value) else {
            return Ok(if best.outcome == Outcome::Exhausted { Outcome::Exhausted } else { Outcome::BudgetSpent });
        };
        let best = search.with(separation, interval).best(Objective::Separation, memory, budget, a, b)?;
        Ok(match (best.outcome, best.value) {
            (Outcome::Found(()), Some(separation)) => Outcome::Found((interval, separation)),
            _ => Outcome::BudgetSpent,
        })
    }
}
