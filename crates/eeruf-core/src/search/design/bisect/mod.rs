//! Probes queries over the same memory, and bisects between the infeasible and the feasible values of one number.
//!
//! It uses the solver and the bounds by counting; what is sought, and how the answer is worded, is for its callers.

mod meter;
mod minimize;
mod query;

use meter::Meter;
pub(super) use query::{Bracket, Objective, Probe, Query};

use super::firing::Firing;
use super::random::Random;
use super::solver::Solver;
use crate::search::common::{Control, Outcome};

/// Lent memory, and the meter.
pub(crate) struct Bisection<'h, C> {
    memory: &'h mut [i32],
    pub(crate) meter: Meter<'h, C>,
}

impl<'h, C: Control> Bisection<'h, C> {
    pub(crate) fn new(memory: &'h mut [i32], control: &'h mut C, limit: u64) -> Self {
        Self { memory, meter: Meter { control, nodes: 0, limit, bound: 0, best: 0, ticks: 1, stopped: false } }
    }

    /// Decides a query with about the budget of the probe.
    ///
    /// A schedule is found soon by a descent that happens to start well, or not for long: a small part of the budget
    /// goes to an ordinary search, led by the guide, and the rest to short descents that start in different ways
    /// (*restarts*). For a proof all goes to the ordinary search.
    pub(crate) fn probe(&mut self, probe: &Probe) -> Outcome<Firing> {
        let Probe { query, budget, guide, thorough } = *probe;
        let mut solver = Solver::new(&query.problem, query.period, self.memory);
        let unit = 32 + 6 * query.problem.sensors as u64;
        let full = if thorough { budget } else { unit.max(budget / 8).min(budget) };
        solver.restart(None, guide);
        let outcome = self.meter.run(&mut solver, full);
        if outcome != Outcome::BudgetSpent {
            return outcome;
        }
        // Another budget, other descents: none is repeated while a budget grows.
        let seed = budget.wrapping_shl(20);
        let mut descents = 0;
        while solver.nodes() < budget && self.meter.may_go_on() {
            descents += 1;
            solver.restart(Some(Random::new(seed.wrapping_add(descents))), None);
            let run = (unit * luby(descents)).min(budget - solver.nodes());
            let outcome = self.meter.run(&mut solver, run);
            if outcome != Outcome::BudgetSpent {
                return outcome;
            }
        }
        Outcome::BudgetSpent
    }

    /// Decides a query with `budget` nodes, in turns for a schedule and for a proof, with more nodes each time.
    pub(crate) fn decide(&mut self, query: &Query, budget: u64) -> Outcome<Firing> {
        let end = self.meter.nodes.saturating_add(budget).min(self.meter.limit);
        let mut part = 64 * query.problem.sensors as u64;
        loop {
            for (thorough, part) in [(false, part), (true, part.saturating_mul(4))] {
                let budget = part.min(end.saturating_sub(self.meter.nodes));
                let outcome = self.probe(&Probe { query: *query, budget, guide: None, thorough });
                if outcome != Outcome::BudgetSpent || self.meter.nodes >= end || !self.meter.may_go_on() {
                    return outcome;
                }
            }
            part = part.saturating_mul(4);
        }
    }
}

/// The sequence 1 1 2 1 1 2 4 .. of Luby, Sinclair and Zuckerman (1993), within a logarithmic factor of the best
/// lengths of restarts; `i` counts from 1.
fn luby(i: u64) -> u64 {
    let mut i = i;
    loop {
        let size = (i + 1).next_power_of_two();
        if size == i + 1 {
            return size / 2;
        }
        i -= size / 2 - 1;
    }
}
