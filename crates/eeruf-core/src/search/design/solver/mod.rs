//! Decides one period: depth first, with times kept as intervals, so that the tick does not matter.
//!
//! A *simple temporal network* holds what is certain: bounds on the differences between any two firing times, kept
//! closed in a *difference-bound matrix* ([`difference_bounds`]). Orders and ranks are *disjunctive*, so the search
//! branches on them, in this order (`docs/explanation/theory.md`, section 6.3): the sensor with the largest `|d|`; the
//! firing orders of conflicting sensors, sensor by sensor; the ranks of the other `|d|` with their signs, downwards;
//! and, where ranks leave room and the matrix read as times is no schedule yet, values ([`branching`]). After each
//! decision [`propagate`] draws conclusions, among them from *Hall intervals* ([`spacing`]).
//!
//! There is no recursion: a stack of [`Decision`]s in lent memory, and difference bounds that can be undone. What is on
//! the stack is read and written with `get`.

mod alternatives;
mod branching;
mod decision;
mod difference_bounds;
mod propagate;
mod ranks;
mod spacing;
mod state;

use super::firing::Firing;
use super::problem::CheckedProblem;
use super::random::Random;
use crate::search::common::{Outcome, ProblemError};
use decision::{DECISION_WORDS, Decision};
use state::State;

/// Decisions that can be on the stack at once: every order, every rank, and some values.
pub(crate) const fn max_decisions(sensors: usize) -> usize {
    sensors * sensors.saturating_sub(1) + 8 * sensors + 32
}

/// The rows of the undo log: for 12 sensors what fits into 64 KiB with everything else, for more sensors enough
/// that backing up hardly ever has to recompute.
const fn log_rows(sensors: usize) -> usize {
    let per_node = if sensors <= 12 { 16 } else { 64 };
    per_node * (2 * sensors + 1)
}

/// The words of memory that a search over `sensors` sensors needs.
pub(crate) const fn memory_words(sensors: usize) -> usize {
    let nodes = 2 * sensors + 1;
    2 * nodes * nodes + max_decisions(sensors) * DECISION_WORDS + log_rows(sensors) * (nodes + 1)
}

/// The search of one period.
pub(crate) struct Solver<'p, 'm> {
    state: State<'p, 'm>,
    root: &'m mut [i32],
    stack: &'m mut [i32],
    depth: usize,
    /// Decisions below this one can no longer be undone, only recomputed.
    base: usize,
    nodes: u64,
    /// Not even without a decision can the bounds hold.
    root_infeasible: bool,
}

impl<'p, 'm> Solver<'p, 'm> {
    /// Sets up the search of `period`. `memory` holds at least [`memory_words`].
    pub(crate) fn new(problem: &'p CheckedProblem, period: i32, memory: &'m mut [i32]) -> Self {
        let k = problem.sensors;
        let nodes = 2 * k + 1;
        let (bound, memory) = memory.split_at_mut(nodes * nodes);
        let (root, memory) = memory.split_at_mut(nodes * nodes);
        let (stack, log) = memory.split_at_mut(max_decisions(k) * DECISION_WORDS);
        let state = State::new(problem, period, bound, log);
        let mut solver = Self { state, root, stack, depth: 0, base: 0, nodes: 0, root_infeasible: false };
        solver.root_infeasible = solver.state.add_root_bounds(period).is_err();
        solver.state.differences.copy_to(solver.root);
        solver
    }

    /// Number of sensors the problem has.
    pub(crate) fn sensors(&self) -> usize {
        self.state.problem.sensors
    }

    /// The nodes visited so far.
    pub(crate) fn nodes(&self) -> u64 {
        self.nodes
    }

    /// Starts over at the root, trying alternatives in an order drawn from `random`, or first those of a schedule for
    /// an easier problem, or in the fixed order.
    pub(crate) fn restart(&mut self, random: Option<Random>, guide: Option<Firing>) {
        self.state.reset(self.root);
        self.state.prefer(random, guide);
        self.depth = 0;
        self.base = 0;
    }

    /// Goes on for at most `budget` nodes; `BudgetSpent` can be continued by calling again.
    pub(crate) fn run(&mut self, budget: u64) -> Outcome<Firing> {
        if self.root_infeasible {
            return Outcome::Exhausted;
        }
        let end = self.nodes.saturating_add(budget);
        let mut descend = self.depth == 0;
        loop {
            if descend {
                if let Some(times) = self.state.reading() {
                    return Outcome::Found(times);
                }
                self.push_decision();
            }
            if self.depth == 0 {
                return Outcome::Exhausted;
            }
            // More values than fit have been seen on no problem yet; giving up is the honest answer.
            if self.nodes >= end || self.depth > max_decisions(self.state.problem.sensors) {
                return Outcome::BudgetSpent;
            }
            descend = self.next_alternative();
        }
    }

    fn decision(&self, i: usize) -> Decision {
        Decision::unpack(self.stack.get(i * DECISION_WORDS..(i + 1) * DECISION_WORDS).unwrap_or(&[]))
    }

    fn store(&mut self, i: usize, decision: &Decision) {
        if let Some(words) = self.stack.get_mut(i * DECISION_WORDS..(i + 1) * DECISION_WORDS) {
            words.copy_from_slice(&decision.pack());
        }
    }

    /// Takes back the top decision's alternative and tries its next one; drops the decision if there is none. True if
    /// that one may hold.
    fn next_alternative(&mut self) -> bool {
        let top = self.depth - 1;
        let mut decision = self.decision(top);
        if decision.tried > 0 {
            self.state.retract(&decision);
            if top >= self.base {
                self.state.differences.undo(decision.mark as usize);
            } else {
                self.recompute(top);
            }
        }
        if !self.state.advance(&mut decision) {
            self.depth = top;
            return false;
        }
        self.nodes += 1;
        decision.mark = self.state.differences.mark() as u32;
        self.store(top, &decision);
        let holds = self.state.apply(&decision).and_then(|()| self.state.propagate()).is_ok();
        if self.state.differences.take_overrun() {
            self.base = self.depth;
        }
        holds
    }

    /// Restores the state before decision `to` from the root.
    fn recompute(&mut self, to: usize) {
        self.state.reset(self.root);
        self.base = 0;
        for i in 0..to {
            let mut decision = self.decision(i);
            decision.mark = self.state.differences.mark() as u32;
            self.store(i, &decision);
            // It held before, and conclusions depend on nothing but the decisions.
            let _ = self.state.apply(&decision).and_then(|()| self.state.propagate());
            if self.state.differences.take_overrun() {
                self.base = i + 1;
            }
        }
    }

    /// Pushes the next decision.
    fn push_decision(&mut self) {
        let decision = self.state.next_decision();
        self.store(self.depth, &decision);
        self.depth += 1;
    }
}

/// The memory, if it is large enough.
pub(super) fn check_memory(memory: &mut [i32], sensors: usize) -> Result<&mut [i32], ProblemError> {
    let (words, needed) = (memory.len(), memory_words(sensors));
    if words < needed { Err(ProblemError::Memory { words, needed }) } else { Ok(memory) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schedule::MAX_SENSORS;

    #[test]
    fn every_order_in_both_phases_and_every_rank_fit_on_the_stack() {
        for sensors in 1..=MAX_SENSORS {
            let pairs = sensors * (sensors - 1) / 2;
            assert!(max_decisions(sensors) >= 2 * pairs + sensors, "{sensors}");
        }
    }
}
