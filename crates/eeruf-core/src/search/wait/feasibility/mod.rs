//! Decides if a table exists: by orders first, then by ranks of `|d|`, then by values if ranks leave them open.
//!
//! Sensors get their ranks from the greatest `|d|` down. The sensor of rank `r` has `|d| >= D r`, and as those above it
//! take their share, `|d| <= wait_max - D (K - 1 - r)`. Each branch is tested with the least waits that its difference
//! constraints allow ([`difference_constraints`](super::difference_constraints)), so times stay intervals and a finer
//! tick costs no more.
//!
//! **Where ranks suffice.** If conflicting sensors fire in the same order in both phases and the criterion is
//! [`Criterion::Exact`], then a table exists only if one exists with `|d| = D r` exactly: `docs/explanation/theory.md`,
//! section 7.1, has the proof. In particular `n I + D (K - 1) <= T_p` for n mutual neighbours (section 5.2) needs no
//! test of its own: the greatest rank finds no sensor.

mod branch;
mod walk;

use super::{Budget, Problem, Search};
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Outcome, SearchError};
use walk::{Feasibility, Style};

/// Words of memory that suffice for every search but counting with this many sensors: 808 bytes for 8, 1,784 for 12.
#[must_use]
pub const fn memory_words(sensors: usize) -> usize {
    // Two orders per pair, one order of s per pair, a rank and a value per sensor; two words per branch.
    let pairs = sensors * sensors.saturating_sub(1) / 2;
    2 * (3 * pairs + 2 * sensors) + 2
}

/// Decides whether a table exists, and leaves it in `wait` (`a` and `b` alternating).
pub(super) fn decide(
    problem: &Problem<'_>,
    memory: &mut [u32],
    budget: &mut Budget<'_>,
    wait: &mut [i32; 2 * MAX_SENSORS],
) -> Outcome {
    let conflict = problem.conflicts.iter().any(|&row| row != 0);
    // Sums below stay small after this.
    if problem.is_beyond_capacity() {
        return Outcome::Exhausted;
    }
    let interval = if conflict { problem.interval } else { 0 };
    let exact = Problem { criterion: Criterion::Exact, interval, ..*problem };
    let outcome = walk(&exact, memory, Style::default(), budget, wait);
    if problem.criterion == Criterion::Exact || outcome != Outcome::Found(()) {
        // Without a table under the weaker criterion there is none under the stronger.
        return outcome;
    }
    let paper = Problem { criterion: Criterion::Paper, ..exact };
    let mut slice = FIRST_SLICE;
    let mut tight = true;
    loop {
        // Under this criterion |d| = D r is only a good guess: its failure proves nothing. Which style is quick
        // depends on how tight the problem is, so each gets its turn, and more with every round.
        for style in STYLES {
            if style.tight && !tight {
                continue;
            }
            let outcome = budget.slice(slice, |budget| walk(&paper, memory, style, budget, wait));
            match outcome {
                Outcome::Exhausted if style.tight => tight = false,
                Outcome::BudgetSpent if !budget.spent() => {}
                outcome => return outcome,
            }
        }
        slice = slice.saturating_mul(4);
    }
}

/// Walks once. Not inlined, so that only one walk is on the stack.
#[inline(never)]
fn walk(
    problem: &Problem<'_>,
    memory: &mut [u32],
    style: Style,
    budget: &mut Budget<'_>,
    wait: &mut [i32; 2 * MAX_SENSORS],
) -> Outcome {
    Feasibility::new(problem, memory, style).run(budget, wait)
}

/// Number of nodes for each style in the first round.
const FIRST_SLICE: u64 = 200;

const STYLES: [Style; 5] = [
    Style { tight: true, early_sums: false, backwards: false },
    Style { tight: true, early_sums: true, backwards: false },
    Style { tight: true, early_sums: false, backwards: true },
    Style { tight: true, early_sums: true, backwards: true },
    Style { tight: false, early_sums: false, backwards: false },
];

impl Search<'_> {
    /// Finds one table, or proves that there is none. `memory` of [`memory_words`] words; `a` and `b` receive the waits
    /// in ticks.
    ///
    /// # Errors
    /// [`SearchError::Memory`] if `memory` is too small.
    pub(crate) fn first(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<Outcome, SearchError> {
        self.check(memory)?;
        let mut wait = [0; 2 * MAX_SENSORS];
        let outcome = decide(self.problem(), memory, budget, &mut wait);
        if outcome == Outcome::Found(()) {
            self.hand_out(&wait, a, b);
        }
        Ok(outcome)
    }

    /// Checks the memory that the caller lends.
    pub(super) fn check(&self, memory: &[u32]) -> Result<(), SearchError> {
        let (words, needed) = (memory.len(), memory_words(self.sensors()));
        if words < needed { Err(SearchError::Memory { words, needed }) } else { Ok(()) }
    }

    /// Copies the waits, `a` and `b` alternating, to the caller's slices.
    pub(super) fn hand_out(&self, wait: &[i32; 2 * MAX_SENSORS], a: &mut [u32], b: &mut [u32]) {
        for (node, &wait) in wait.iter().enumerate().take(2 * self.sensors()) {
            let phase = if node % 2 == 0 { &mut *a } else { &mut *b };
            if let Some(slot) = phase.get_mut(node / 2) {
                *slot = wait as u32;
            }
        }
    }
}
