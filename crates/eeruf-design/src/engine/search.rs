//! Searches for schedules of one period: a depth-first search, whose tree a certificate writes down, and short descents
//! with *Luby restarts* (Luby, Sinclair and Zuckerman 1993).

use crate::engine::branching::{Branching, choose};
use crate::engine::problem::{Merged, Problem};
use crate::engine::schedule;
use crate::engine::state::{State, event};
use crate::engine::symmetry::Assumptions;

/// Firing times in phases a and b, in ticks, sensor by sensor.
pub type FiringTimes = [Vec<u32>; 2];

/// The outcome of a search for a schedule with a period.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Decided {
    /// Firing times that serve.
    Found(FiringTimes),
    /// None serve.
    Refuted,
    /// The budget is spent: neither.
    Open,
    /// The caller wanted no more.
    Stopped,
}

/// A problem, ready to be searched again and again.
#[derive(Clone, Debug)]
pub struct Search<'p> {
    problem: &'p Problem,
    merged: Merged,
    assumptions: Assumptions,
    /// The number of nodes between two questions whether to go on.
    between: u64,
    /// Nodes visited so far.
    nodes: u64,
}

/// A generator of pseudo-random numbers, the same on every machine (xorshift64*).
struct Random(u64);

impl Random {
    /// A number below `end`.
    fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % u64::from(end.max(1))) as u32
    }
}

/// The `i`-th of Luby's numbers, from 1: 1 1 2 1 1 2 4 1 1 2 1 1 2 4 8 ..
fn luby(i: u64) -> u64 {
    let power = 64 - i.leading_zeros();
    if i == (1 << power) - 1 { 1 << (power - 1) } else { luby(i - ((1 << (power - 1)) - 1)) }
}

/// The number of nodes between two questions whether to go on: few enough to ask every few milliseconds, as a node
/// costs about the cube of the number of sensors.
pub(crate) fn nodes_between(sensors: usize) -> usize {
    (64 * 8 * 8 * 8 / sensors.max(1).pow(3)).clamp(1, 64)
}

impl<'p> Search<'p> {
    /// The search of whole ticks for this problem.
    #[must_use]
    pub fn new(problem: &'p Problem) -> Self {
        Self {
            problem,
            merged: problem.merged(),
            assumptions: Assumptions::of(problem),
            between: nodes_between(problem.sensors()) as u64,
            nodes: 0,
        }
    }

    /// The nodes visited so far.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        self.nodes
    }

    /// The number of branchings that decide every order, sign and rank: as many nodes as a descent may take.
    #[must_use]
    pub fn depth(&self) -> u64 {
        let count = self.merged.count();
        (2 * self.merged.pairs.len() + count * (count + 1) / 2) as u64
    }

    /// Decides whether some firing times have this period, by at most `budget` nodes of a full search.
    pub fn decide(&mut self, period: u32, budget: u64, go_on: &mut dyn FnMut(u64) -> bool) -> Decided {
        let root = self.root(period);
        self.walk(period, root, budget, &mut Choice { random: None, guide: None }, go_on)
    }

    /// Looks for firing times of this period by at most `budget` nodes of short descents, along those of a longer one.
    pub fn find(
        &mut self,
        period: u32,
        budget: u64,
        seed: u64,
        guide: &FiringTimes,
        go_on: &mut dyn FnMut(u64) -> bool,
    ) -> Decided {
        let Some(root) = self.root(period) else { return Decided::Refuted };
        let unit = self.depth();
        let mut random = Random(seed.wrapping_mul(2) | 1);
        let (mut spent, mut descent) = (0, 0);
        while spent < budget {
            descent += 1;
            let seed = 1 + u64::from(random.below(u32::MAX));
            // The first along the guide, then every other one.
            let firsts = self.merged.firsts();
            let guide = (descent % 2 == 1).then(|| firsts.iter().map(|&x| [guide[0][x], guide[1][x]]).collect());
            let mut choice = Choice { random: Some(Random(seed)), guide };
            let before = self.nodes;
            let least = (unit * luby(descent)).min(budget - spent);
            let decided = self.walk(period, Some(root.clone()), least, &mut choice, go_on);
            if decided != Decided::Open {
                return decided;
            }
            spent += (self.nodes - before).max(1);
        }
        Decided::Open
    }

    fn root(&self, period: u32) -> Option<State> {
        self.assumptions.root(&self.merged, period + 1).ok()
    }

    fn walk(
        &mut self,
        period: u32,
        root: Option<State>,
        budget: u64,
        choice: &mut Choice,
        go_on: &mut dyn FnMut(u64) -> bool,
    ) -> Decided {
        let end = self.nodes.saturating_add(budget);
        // The open nodes: state, branching, the case that is left.
        let mut open: Vec<(State, Branching, usize)> = Vec::new();
        let mut reached = root;
        loop {
            if let Some(state) = reached {
                if let Some(times) = self.reading(period, &state) {
                    return Decided::Found(times);
                }
                // Nothing left to branch on is a schedule too, in whole ticks.
                let Some(branching) = choose(&state, &self.merged) else { return Decided::Open };
                let first = choice.first_case(&state, &self.merged, branching);
                open.push((state.clone(), branching, 1 - first));
                reached = self.assume(state, branching, first);
            } else {
                let Some((state, branching, case)) = open.pop() else { return Decided::Refuted };
                reached = self.assume(state, branching, case);
            }
            if self.nodes >= end {
                return Decided::Open;
            }
            if self.nodes.is_multiple_of(self.between) && !go_on(self.nodes) {
                return Decided::Stopped;
            }
        }
    }

    fn assume(&mut self, mut state: State, branching: Branching, case: usize) -> Option<State> {
        self.nodes += 1;
        branching.assume(case, &mut state, &self.merged).ok().map(|()| state)
    }

    /// The earliest or the latest times that the bounds allow, if they happen to keep everything.
    fn reading(&self, period: u32, state: &State) -> Option<FiringTimes> {
        let earliest = |one: usize, phase: usize| -state.bounds.at(event(one, phase), 0) / 2;
        let latest = |one: usize, phase: usize| state.bounds.at(0, event(one, phase)) / 2;
        let times = |time: &dyn Fn(usize, usize) -> i32| -> FiringTimes {
            [0, 1].map(|phase| self.merged.of_sensor.iter().map(|&one| time(one, phase).max(0) as u32).collect())
        };
        let serve = |times: &FiringTimes| schedule::keeps(self.problem, period, times);
        Some(times(&earliest)).filter(serve).or_else(|| Some(times(&latest)).filter(serve))
    }
}

/// The case to take first. It matters only for how soon a schedule is found.
struct Choice {
    random: Option<Random>,
    /// The times of a schedule with a longer period, for each sensor of the merged problem.
    guide: Option<Vec<[u32; 2]>>,
}

impl Choice {
    fn first_case(&mut self, state: &State, merged: &Merged, branching: Branching) -> usize {
        let Some(random) = &mut self.random else { return 0 };
        if let Some(guide) = self.guide.as_ref().filter(|_| random.below(8) > 0) {
            let d = |x: usize| i64::from(guide[x][0]) - i64::from(guide[x][1]);
            return usize::from(match branching {
                Branching::Order(phase, x, y) => guide[x][phase] > guide[y][phase],
                Branching::Sign(x) => d(x) < 0,
                Branching::Rank(x, y) => d(x).abs() > d(y).abs(),
                Branching::Split(x, at) => d(x).abs() > i64::from(at),
            });
        }
        // As much room as each case leaves.
        let (first, second) = match branching {
            Branching::Order(phase, x, y) => {
                let after = |x, y| state.bounds.at(event(x, phase), event(y, phase)) - 2 * merged.gap[x][y];
                (after(x, y), after(y, x))
            }
            Branching::Sign(x) => (state.most(x, false), state.most(x, true)),
            Branching::Rank(x, y) => (state.high(y) - state.low[x], state.high(x) - state.low[y]),
            Branching::Split(..) => (1, 1),
        };
        let (first, second) = (first.max(0) as u32 + 1, second.max(0) as u32 + 1);
        usize::from(random.below(first + second) >= first)
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
