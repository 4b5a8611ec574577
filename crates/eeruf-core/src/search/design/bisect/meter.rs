//! Counts nodes against the budget and polls the caller's control.

use super::super::firing::Firing;
use super::super::solver::Solver;
use crate::search::common::{Control, Outcome, Progress};

/// The nodes between two polls of the [`Control`]: few enough that the clock is looked at every few milliseconds. A
/// node costs about the cube of the number of sensors.
const fn nodes_between_polls(sensors: usize) -> u64 {
    const FOR_12: u64 = 256;
    let nodes = FOR_12 * 12 * 12 * 12 / (sensors * sensors * sensors) as u64;
    if nodes == 0 {
        1
    } else if nodes > FOR_12 {
        FOR_12
    } else {
        nodes
    }
}

/// The nodes spent, and how far the search has come.
pub(crate) struct Meter<'h, C> {
    pub(super) control: &'h mut C,
    pub(crate) nodes: u64,
    /// The search ends when `nodes` reaches this.
    pub(crate) limit: u64,
    /// Shown to the control; 0 if there is none.
    pub(crate) bound: u32,
    pub(crate) best: u32,
    /// The length of a tick of the queries, in the caller's ticks.
    pub(crate) ticks: u32,
    pub(crate) stopped: bool,
}

impl<C> Meter<'_, C> {
    /// The progress shown to the control.
    pub(super) fn progress(&self) -> Progress {
        let known = |value: u32| (value > 0).then_some(value);
        Progress { nodes: self.nodes, best: known(self.best), bound: known(self.bound) }
    }
}

impl<C: Control> Meter<'_, C> {
    /// Returns true if budget and control allow going on.
    pub(super) fn may_go_on(&self) -> bool {
        !self.stopped && self.nodes < self.limit
    }

    /// Runs the solver for `budget` nodes, polling.
    pub(super) fn run(&mut self, solver: &mut Solver<'_, '_>, budget: u64) -> Outcome<Firing> {
        let between = nodes_between_polls(solver.sensors());
        let end = solver.nodes() + budget;
        loop {
            let before = solver.nodes();
            let step = between.min(end - before).min(self.limit.saturating_sub(self.nodes));
            let outcome = solver.run(step);
            self.nodes += solver.nodes() - before;
            if outcome != Outcome::BudgetSpent || solver.nodes() >= end || solver.nodes() == before {
                return outcome;
            }
            self.stopped |= self.control.poll(&self.progress()).is_break();
            if !self.may_go_on() {
                return Outcome::BudgetSpent;
            }
        }
    }
}
