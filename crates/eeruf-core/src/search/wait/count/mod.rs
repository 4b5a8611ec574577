//! Counts the tables, depth first over the sensors, and keeps earlier counts in memory.
//!
//! Only part of a partial table matters to the sensors not yet placed: which `|d|` (and `s`) are still free, and which
//! waits are left for each sensor that conflicts with a placed one. Two partial tables with the same remainder have the
//! same number of completions, so each remainder is counted once. The last sensor is not visited pair by pair: for each
//! free `|d|` its remaining waits are the common bits of three words.
//!
//! The memory lent holds only remainders, which are compared word by word, not only by hash. So any amount of memory
//! gives the exact count, even none; when it is full, older entries give way. Exchanging the phases changes neither
//! `|d|` nor `s`, so a remainder and its exchange share one entry.
//!
//! Waits above 63 ticks do not fit the words; such problems are counted one table at a time.

mod bits;
mod memo;
mod walk;

use super::{Budget, Search};
use crate::search::Outcome;
use bits::MASK_MAX;
use walk::Counting;

/// A sensible amount of memory for [`WaitSearch::count`](crate::search::WaitSearch::count) on a PC, in words (4 MiB),
/// chosen freely. With less memory the count is the same, but slower. On targets with 16-bit `usize` it is 1 KiB.
pub const COUNT_WORDS: usize = 1 << if usize::BITS > 16 { 20 } else { 8 };

impl Search<'_> {
    /// Counts the tables; stops early when there are `limit` or more. More `memory` makes it faster ([`COUNT_WORDS`]);
    /// it may be empty.
    ///
    /// Without a limit, a count beyond `u128` ends with [`Outcome::Found`] at its maximum.
    pub(crate) fn count(&self, limit: Option<u128>, memory: &mut [u32], budget: &mut Budget<'_>) -> (Outcome, u128) {
        let limit = limit.unwrap_or(u128::MAX);
        // Beyond capacity nothing needs setting up; what passes has D at most wait_max, or a single sensor.
        if self.problem.is_beyond_capacity() {
            (Outcome::Exhausted, 0)
        } else if self.problem.wait_max > MASK_MAX {
            count_one_by_one(self, limit, budget)
        } else {
            Counting::new(&self.problem, memory).run(limit, budget)
        }
    }
}

fn count_one_by_one(search: &Search<'_>, limit: u128, budget: &mut Budget<'_>) -> (Outcome, u128) {
    let mut tables = search.enumerate();
    let mut count = 0;
    while count < limit {
        match tables.advance(budget) {
            Outcome::Found(()) => count += 1,
            outcome => return (outcome, count),
        }
    }
    (Outcome::Found(()), count)
}
