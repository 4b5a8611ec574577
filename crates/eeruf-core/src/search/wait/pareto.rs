//! The front of interval and separation: the tables that are better in one only where others are better in the other.

use super::{Budget, Objective, Search};
use crate::search::{Outcome, SearchError};

impl Search<'_> {
    /// The first point of the front with at least this separation, its interval and separation, with its waits in `a`
    /// and `b`: no table with at least one of both has more of the other.
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
