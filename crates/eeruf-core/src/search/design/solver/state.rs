//! Knowledge and preferences of the search at one node: the difference bounds, the ranks decided, and what to try
//! first.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::super::bounds;
use super::super::firing::Firing;
use super::super::problem::CheckedProblem;
use super::super::random::Random;
use super::difference_bounds::{Conflict, DifferenceBounds};
use super::ranks::Ranks;
use super::spacing::Intervals;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// State of the search of one period, and what it tries first.
pub(super) struct State<'p, 'm> {
    pub(super) problem: &'p CheckedProblem,
    /// The largest `|d|` allowed.
    pub(super) widest: i32,
    pub(super) differences: DifferenceBounds<'m>,
    pub(super) ranks: Ranks,
    /// Sensors in the order in which their firing orders are decided.
    pub(super) sequence: [u8; MAX_SENSORS],
    pub(super) random: Option<Random>,
    /// A schedule for an easier problem: its orders and signs come first.
    pub(super) guide: Option<Firing>,
    /// Orders are copied from the sensors so much further along.
    pub(super) shift: usize,
}

impl<'p, 'm> State<'p, 'm> {
    /// Nothing known yet. `bound` and `log` as for [`DifferenceBounds::new`].
    pub(super) fn new(problem: &'p CheckedProblem, period: i32, bound: &'m mut [i32], log: &'m mut [i32]) -> Self {
        Self {
            problem,
            widest: (period - problem.window).min(period - 1),
            differences: DifferenceBounds::new(2 * problem.sensors + 1, 1 << 28, bound, log),
            ranks: Ranks::NONE,
            sequence: [0; MAX_SENSORS],
            random: None,
            guide: None,
            shift: bounds::cliques(problem).0 as usize,
        }
    }

    /// Forgets all decisions; `root` holds the difference bounds without any.
    pub(super) fn reset(&mut self, root: &[i32]) {
        self.differences.reset(root);
        self.ranks = Ranks::NONE;
    }

    /// Sets what is tried first from now on: alternatives drawn from `random`, or those of a schedule for an easier
    /// problem, or the fixed order.
    pub(super) fn prefer(&mut self, random: Option<Random>, guide: Option<Firing>) {
        self.guide = guide;
        self.random = random;
    }

    /// The node of sensor `x` in phase a (0) or b (1).
    #[inline(always)]
    pub(super) fn node(&self, x: usize, phase: usize) -> usize {
        1 + x + phase * self.problem.sensors
    }

    /// Adds the bounds that hold for every schedule.
    pub(super) fn add_root_bounds(&mut self, period: i32) -> Result<(), Conflict> {
        let problem = self.problem;
        for x in 0..problem.sensors {
            let (a, b) = (self.node(x, 0), self.node(x, 1));
            for node in [a, b] {
                self.differences.add_bound(0, node, 0)?;
                self.differences.add_bound(node, 0, period - 1)?;
            }
            self.differences.add_bound(a, b, self.widest)?;
            self.differences.add_bound(b, a, self.widest)?;
        }
        for x in 0..problem.sensors {
            for y in Members(problem.conflicts[x]) {
                // From phase a to phase b and from b to the next a.
                let (a, b) = (self.node(x, 0), self.node(y, 1));
                self.differences.add_bound(a, b, period - problem.interval)?;
                self.differences.add_bound(b, a, period - problem.interval)?;
            }
        }
        self.propagate()
    }

    /// The interval of d of sensor `x`.
    #[inline(always)]
    pub(super) fn span(&self, x: usize) -> (i32, i32) {
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        (-self.differences.at_most(b, a), self.differences.at_most(a, b))
    }

    /// The intervals of all `|d|` by the difference bounds and the ranks.
    pub(super) fn intervals(&self) -> Intervals {
        let mut intervals = Intervals { low: [0; MAX_SENSORS], high: [0; MAX_SENSORS] };
        for x in 0..self.problem.sensors {
            let (low, high) = self.span(x);
            // Above 0, below 0, or on both sides of it.
            intervals.low[x] = low.max(-high).max(self.problem.least);
            intervals.high[x] = high.max(-low).min(self.widest);
        }
        let unranked = self.problem.all() & !self.ranks.ranked;
        if let Some(&last) = self.ranks.highs().last() {
            let ceiling = intervals.high[usize::from(last)] - self.problem.separation;
            for x in Members(unranked) {
                intervals.high[x] = intervals.high[x].min(ceiling);
            }
        }
        intervals
    }

    /// The earliest or the latest times that the matrix allows, if all orders are decided and the separation happens to
    /// hold.
    pub(super) fn reading(&self) -> Option<Firing> {
        let (k, interval) = (self.problem.sensors, self.problem.interval);
        let undecided = |u: usize, v: usize| {
            self.differences.at_most(u, v) > -interval && self.differences.at_most(v, u) > -interval
        };
        for x in 0..k {
            for y in Members(self.problem.conflicts[x] & ((1 << x) - 1)) {
                for phase in 0..2 {
                    if undecided(self.node(x, phase), self.node(y, phase)) && interval > 0 {
                        return None;
                    }
                }
            }
        }
        let earliest = |u: usize| -self.differences.at_most(0, u);
        let latest = |u: usize| self.differences.at_most(u, 0);
        self.times(earliest).or_else(|| self.times(latest))
    }

    /// These times, if all `|d|` are far enough from each other and from 0.
    fn times(&self, time: impl Fn(usize) -> i32) -> Option<Firing> {
        let k = self.problem.sensors;
        let mut times = Firing { a: [0; MAX_SENSORS], b: [0; MAX_SENSORS], sensors: k };
        let mut sizes = [0; MAX_SENSORS];
        for x in 0..k {
            let (a, b) = (time(self.node(x, 0)), time(self.node(x, 1)));
            // Times are in 0..period.
            (times.a[x], times.b[x]) = (a as u32, b as u32);
            sizes[x] = (a - b).abs();
            if sizes[x] < self.problem.least {
                return None;
            }
        }
        let sizes = &mut sizes[..k];
        sizes.sort_unstable();
        sizes.windows(2).all(|pair| pair[1] - pair[0] >= self.problem.separation).then_some(times)
    }
}
