//! A system of *difference constraints* on the waits, and its least solution, found by raising waits that are too low
//! (Bellman and Ford).
//!
//! Node `2 i` is `a_i` and node `2 i + 1` is `b_i`. Every constraint says that one node is at least another plus a
//! weight, and weights follow from a few words per sensor, so none is stored. If raising never ends or passes
//! `wait_max` there is no solution; else the result is the least solution, whole ticks because all weights are.

use super::Problem;
use crate::schedule::MAX_SENSORS;
use crate::search::Members;

/// Order of two conflicting sensors within one phase.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Order {
    pub(super) phase: usize,
    pub(super) first: usize,
    pub(super) second: usize,
}

/// The constraints and the least waits that meet them.
pub(super) struct Constraints<'p> {
    problem: &'p Problem<'p>,
    sensors: usize,
    /// The least waits so far, by node.
    pub(super) wait: [i32; 2 * MAX_SENSORS],
    /// For each phase and sensor, the conflicting sensors that fire after it.
    after: [[u64; MAX_SENSORS]; 2],
    /// For each sensor, the conflicting sensors that could come too close across the border of a period.
    across: [u64; MAX_SENSORS],
    /// For each sensor whose `d` is fixed, the sensors whose `s` lies at least `D` above its own.
    above: [u64; MAX_SENSORS],
    /// For each sensor, least and greatest `d = a - b`.
    pub(super) d: [[i32; 2]; MAX_SENSORS],
}

// Indices: sensors are below `sensors <= MAX_SENSORS`, as bits of rows are (`Search::new` checked the rows), and nodes
// below twice that.
impl<'p> Constraints<'p> {
    /// Constraints without chosen orders and with `d` free.
    pub(super) fn new(problem: &'p Problem<'p>) -> Self {
        let free = problem.wait_max as i32;
        let mut constraints = Self {
            problem,
            sensors: problem.lag.len(),
            wait: [0; 2 * MAX_SENSORS],
            after: [[0; MAX_SENSORS]; 2],
            across: [0; MAX_SENSORS],
            above: [0; MAX_SENSORS],
            d: [[-free, free]; MAX_SENSORS],
        };
        for (i, &row) in problem.conflicts.iter().enumerate() {
            for j in Members(row) {
                if constraints.across_weight(i, j) > -free {
                    constraints.across[i] |= 1 << j;
                }
            }
        }
        constraints
    }

    /// Weight of `f_j >= f_i + I` in one phase, as `wait_j >= wait_i + weight`.
    fn after_weight(&self, i: usize, j: usize) -> i32 {
        self.problem.interval as i32 + self.problem.lag[i] as i32 - self.problem.lag[j] as i32
    }

    /// Weight of `T_p + f_j >= f_i + I` from one phase to the next, as `wait_j >= wait_i + weight`.
    fn across_weight(&self, i: usize, j: usize) -> i32 {
        self.after_weight(i, j) - self.problem.period as i32
    }

    /// Returns true if `j` can fire `I` after `i` within a phase.
    pub(super) fn can_follow(&self, i: usize, j: usize) -> bool {
        self.after_weight(i, j) <= self.problem.wait_max as i32
    }

    pub(super) fn order(&mut self, order: Order) {
        self.after[order.phase][order.first] |= 1 << order.second;
    }

    pub(super) fn forget_order(&mut self, order: Order) {
        self.after[order.phase][order.first] &= !(1 << order.second);
    }

    pub(super) fn same_orders(&self) -> bool {
        self.after[0][..self.sensors] == self.after[1][..self.sensors]
    }

    pub(super) fn put_above(&mut self, low: usize, high: usize) {
        self.above[low] |= 1 << high;
    }

    pub(super) fn forget_above(&mut self, low: usize, high: usize) {
        self.above[low] &= !(1 << high);
    }

    /// `s` of a sensor in the least solution.
    pub(super) fn s(&self, sensor: usize) -> i32 {
        self.wait[2 * sensor] + self.wait[2 * sensor + 1]
    }

    /// Raises the waits until all constraints hold; `false` if they cannot.
    pub(super) fn raise(&mut self) -> bool {
        let nodes = 2 * self.sensors;
        let mut dirty = if nodes == 128 { u128::MAX } else { (1 << nodes) - 1 };
        // Without a cycle of positive weight every wait is final after as many passes as there are nodes.
        for _ in 0..=nodes {
            let mut now = dirty;
            dirty = 0;
            while now != 0 {
                let node = now.trailing_zeros() as usize;
                now &= now - 1;
                if !self.raise_from(node, &mut dirty) {
                    return false;
                }
            }
            if dirty == 0 {
                return true;
            }
        }
        false
    }

    /// Raises the waits again from zero, after constraints were withdrawn.
    pub(super) fn raise_anew(&mut self) -> bool {
        self.wait = [0; 2 * MAX_SENSORS];
        self.raise()
    }

    /// Raises the nodes that depend on `node`; `false` if one exceeds `wait_max`.
    fn raise_from(&mut self, node: usize, dirty: &mut u128) -> bool {
        let (i, phase) = (node / 2, node % 2);
        let from = self.wait[node];
        let [low, high] = self.d[i];
        let own = if phase == 0 { from - high } else { from + low };
        let mut fits = self.lift(2 * i + 1 - phase, own, dirty);
        for j in Members(self.after[phase][i]) {
            fits &= self.lift(2 * j + phase, from + self.after_weight(i, j), dirty);
        }
        for j in Members(self.across[i]) {
            fits &= self.lift(2 * j + 1 - phase, from + self.across_weight(i, j), dirty);
        }
        if phase == 0 && self.above[i] != 0 {
            // s = 2 a - d, so s_j >= s_i + D reads 2 a_j >= 2 a_i + D + d_j - d_i: both d are fixed here. Half a tick
            // rounds up.
            for j in Members(self.above[i]) {
                let twice = self.problem.separation as i32 + self.d[j][0] - low;
                fits &= self.lift(2 * j, from + (twice + 1).div_euclid(2), dirty);
            }
        }
        fits
    }

    #[inline]
    fn lift(&mut self, node: usize, to: i32, dirty: &mut u128) -> bool {
        if self.wait[node] < to {
            self.wait[node] = to;
            *dirty |= 1 << node;
            return to <= self.problem.wait_max as i32;
        }
        true
    }
}
