//! Searches for schedules of one period: a depth-first search, whose tree a certificate records, and short descents
//! with *Luby restarts* (Luby, Sinclair and Zuckerman 1993).

use core::cell::OnceCell;

use crate::engine::branching::choose;
use crate::engine::construct::Times;
use crate::engine::descent::{Case, Choice};
use crate::engine::problem::{Merged, Problem};
use crate::engine::repair::{PAIRS, Repair};
use crate::engine::rules::propagate;
use crate::engine::state::{Mark, State, event};
use crate::engine::symmetry::Assumptions;

/// Firing times in phases a and b, in ticks, sensor by sensor.
pub type FiringTimes = [Vec<u32>; 2];

/// The outcome of a search for a schedule with a period.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decided {
    /// Firing times with this period.
    Found(FiringTimes),
    /// No firing times have this period.
    Refuted,
    /// The budget is spent, and the question is open.
    Open,
    /// The caller stopped the search.
    Stopped,
}

/// A search for schedules of one problem, which can be run again and again.
#[derive(Clone, Debug)]
pub struct Search {
    problem: Problem,
    merged: Merged,
    /// Assumptions at the root of a full search; computed on demand, since that takes as long as many nodes.
    assumptions: OnceCell<Assumptions>,
    /// Number of nodes between two calls of `go_on`.
    between: u64,
    /// Nodes visited so far.
    nodes: u64,
}

/// The `i`-th of Luby's numbers, from 1: 1 1 2 1 1 2 4 1 1 2 1 1 2 4 8 ..
fn luby(i: u64) -> u64 {
    let power = 64 - i.leading_zeros();
    if i == (1 << power) - 1 { 1 << (power - 1) } else { luby(i - ((1 << (power - 1)) - 1)) }
}

/// The number of nodes between two calls of `go_on`: few enough to call it every few milliseconds, as a node costs
/// about the cube of the number of sensors.
pub(crate) fn nodes_between(sensors: usize) -> usize {
    (64 * 8 * 8 * 8 / sensors.max(1).pow(3)).clamp(1, 64)
}

impl Search {
    /// A search in whole ticks for this problem.
    #[must_use]
    pub fn new(problem: &Problem) -> Self {
        Self {
            problem: problem.clone(),
            merged: problem.with_separations_that_count().merged(),
            assumptions: OnceCell::new(),
            between: nodes_between(problem.sensors()) as u64,
            nodes: 0,
        }
    }

    /// The nodes visited so far.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        self.nodes
    }

    pub(crate) fn problem(&self) -> &Problem {
        &self.problem
    }

    pub(crate) fn merged(&self) -> &Merged {
        &self.merged
    }

    /// Returns true if the rules alone refute this period.
    pub(crate) fn is_refuted(&self, period: u32) -> bool {
        self.root(period).is_none()
    }

    /// The number of branchings that decide every order, sign and rank, and so the most nodes of a descent.
    #[must_use]
    pub fn depth(&self) -> u64 {
        let count = self.merged.count();
        (2 * self.merged.pairs.len() + count * (count + 1) / 2) as u64
    }

    /// Decides whether some firing times have this period, by at most `budget` nodes of a full search.
    pub fn decide(&mut self, period: u32, budget: u64, go_on: &mut dyn FnMut(u64) -> bool) -> Decided {
        let assumptions = self.assumptions.get_or_init(|| Assumptions::of(&self.problem.with_separations_that_count()));
        let Ok(mut state) = assumptions.root(&self.merged, period + 1) else { return Decided::Refuted };
        state.goes_further = true;
        self.walk(period, &mut state, budget, None, go_on)
    }

    /// Decides by branchings in the order of time.
    pub fn decide_in_time(&mut self, period: u32, budget: u64, go_on: &mut dyn FnMut(u64) -> bool) -> Decided {
        let assumptions = self.assumptions.get_or_init(|| Assumptions::of(&self.problem.with_separations_that_count()));
        let Ok(mut state) = assumptions.root_in_time(&self.merged, period + 1) else { return Decided::Refuted };
        state.goes_further = true;
        self.walk(period, &mut state, budget, None, go_on)
    }

    /// Looks for firing times of this period by at most `budget` nodes: first by a search along the guide, the times
    /// of a schedule with another period, then by short descents with restarts.
    pub fn find(
        &mut self,
        period: u32,
        budget: u64,
        seed: u64,
        guide: Option<&FiringTimes>,
        go_on: &mut dyn FnMut(u64) -> bool,
    ) -> Decided {
        let Some(mut state) = self.root(period) else { return Decided::Refuted };
        let root = state.mark();
        let unit = self.unit();
        let end = self.nodes.saturating_add(budget);
        let firsts = self.merged.firsts();
        let guide: Option<Times> = guide.map(|[a, b]| firsts.iter().map(|&x| [a[x] as i32, b[x] as i32]).collect());
        let mut choice = Choice::new(&self.merged, period, guide.clone());
        let mut least = unit.max(budget / 8).min(budget);
        for descent in 1.. {
            let decided = self.walk(period, &mut state, least, Some(&mut choice), go_on);
            if decided != Decided::Open {
                return decided;
            }
            if self.nodes >= end || descent > budget {
                break;
            }
            state.undo(root);
            let along = guide.clone().filter(|_| descent % 2 == 0);
            choice.restart(seed.wrapping_add(descent), along, self.merged.count());
            least = (unit * luby(descent)).min(end - self.nodes);
        }
        Decided::Open
    }

    /// Looks for firing times by repairing given ones, at the cost of at most `budget` nodes: not at all if ticks are
    /// so fine that a move costs more.
    pub(crate) fn repair(&mut self, repair: &mut Repair, budget: u64, go_on: &mut dyn FnMut(u64) -> bool) -> Decided {
        let end = self.nodes.saturating_add(budget);
        let (period, pairs) = (repair.period as u32, (repair.period as u64).pow(2));
        let (nodes, moves) = (pairs.div_ceil(PAIRS), PAIRS.div_ceil(pairs.max(1)));
        while self.nodes.saturating_add(nodes) <= end {
            for _ in 0..moves {
                if repair.step(&self.merged) {
                    let kept = Some(repair.fire(&self.merged)).filter(|fire| self.problem.is_kept_by(period, fire));
                    return kept.map_or(Decided::Open, Decided::Found);
                }
            }
            self.nodes += nodes;
            if (self.nodes / nodes).is_multiple_of(self.between) && !go_on(self.nodes) {
                return Decided::Stopped;
            }
        }
        Decided::Open
    }

    /// The number of nodes of a short descent.
    pub(crate) fn unit(&self) -> u64 {
        32 + 6 * self.merged.count() as u64
    }

    /// Bounds that every schedule of this period keeps, unless they refute it: without assumptions about symmetry, so
    /// that a descent can end in any schedule.
    fn root(&self, period: u32) -> Option<State> {
        let mut state = State::new(&self.merged, period as i32 + 1).ok()?;
        state.goes_further = true;
        propagate(&mut state, &self.merged).ok().map(|()| state)
    }

    fn walk(
        &mut self,
        period: u32,
        state: &mut State,
        budget: u64,
        mut choice: Option<&mut Choice>,
        go_on: &mut dyn FnMut(u64) -> bool,
    ) -> Decided {
        let end = self.nodes.saturating_add(budget);
        // The states with cases left, and these cases.
        let mut open: Vec<(Mark, Vec<Case>)> = Vec::new();
        let along: Vec<usize> = (0..self.merged.count()).collect();
        let mut holds = true;
        loop {
            if holds {
                if let Some(times) = self.reading(period, state) {
                    return Decided::Found(times);
                }
                let cases = match &mut choice {
                    Some(choice) => choice.cases(state, &self.merged),
                    None => choose(state, &self.merged, &along).map(|branching| {
                        (0..branching.cases(state)).rev().map(|case| Case::Of(branching, case)).collect()
                    }),
                };
                // With nothing left to branch on, the times above are a schedule, if ticks are whole.
                let Some(cases) = cases else { return Decided::Open };
                open.push((state.mark(), cases));
            }
            let Some((mark, cases)) = open.last_mut() else { return Decided::Refuted };
            if !holds {
                state.undo(*mark);
            }
            let Some(case) = cases.pop() else {
                state.drop_mark(*mark);
                open.pop();
                holds = false;
                continue;
            };
            self.nodes += 1;
            holds = case.assume(state, &self.merged).is_ok();
            if self.nodes >= end {
                return Decided::Open;
            }
            if self.nodes.is_multiple_of(self.between) && !go_on(self.nodes) {
                return Decided::Stopped;
            }
        }
    }

    /// The earliest or the latest times within the bounds, if they keep all needs.
    fn reading(&self, period: u32, state: &State) -> Option<FiringTimes> {
        let earliest = |one: usize, phase: usize| -state.bounds.at(event(one, phase), 0);
        let latest = |one: usize, phase: usize| state.bounds.at(0, event(one, phase));
        let times = |time: &dyn Fn(usize, usize) -> i32| -> FiringTimes {
            [0, 1].map(|phase| self.merged.of_sensor.iter().map(|&one| time(one, phase).max(0) as u32).collect())
        };
        let serve = |times: &FiringTimes| self.problem.is_kept_by(period, times);
        Some(times(&earliest)).filter(serve).or_else(|| Some(times(&latest)).filter(serve))
    }
}

#[cfg(test)]
mod tests {
    use super::luby;

    #[test]
    fn lubys_numbers_are_his() {
        let first: Vec<u64> = (1..16).map(luby).collect();
        assert_eq!(first, [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]);
    }
}
