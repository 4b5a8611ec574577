//! The positions of one clique: whether a sensor fires first, second, .. in phase a and in phase b.
//!
//! In a line or ring any n adjacent sensors conflict. The search first fixes the positions of the n sensors around the
//! one with the largest `|d|`: a sensor at position q of phase b and p of phase a has d within `(p - q) I +- sigma`
//! (`docs/theory.md`, sections 5.3 and 6.5). This decides all their orders, and says how large each `|d|` is before the
//! orders do. As `2 sigma < I` is required, d of each n-th sensor is confined in the same way.

use super::super::bounds::{Classes, Orders};
use super::super::problem::CheckedProblem;
use super::decision::Decision;

/// A decision has one bit for each pair of positions.
pub(super) const MAX_POSITIONS: usize = 8;

/// The positions fixed so far.
///
/// Indices: the number of sensors to fix is at most `MAX_POSITIONS`, and so are positions; [`CliquePositions::new`]
/// sees to it.
pub(super) struct CliquePositions {
    /// n, or 0 if nothing is to be fixed.
    pub(super) count: usize,
    /// The period without n intervals.
    pub(super) spare: i32,
    pub(super) ring: bool,
    pub(super) sensors: [u8; MAX_POSITIONS],
    /// Which of them are fixed, in the order in which they were, with (q, p) of each.
    pub(super) fixed: usize,
    pub(super) at: [(u8, u8, u8); MAX_POSITIONS],
    /// How many `|d|` fit into each class.
    pub(super) room: [i32; MAX_POSITIONS],
}

impl CliquePositions {
    /// No positions to fix.
    pub(super) const NONE: Self = Self {
        count: 0,
        spare: 0,
        ring: false,
        sensors: [0; MAX_POSITIONS],
        fixed: 0,
        at: [(0, 0, 0); MAX_POSITIONS],
        room: [0; MAX_POSITIONS],
    };

    pub(super) fn new(problem: &CheckedProblem, period: i32) -> Self {
        let mut positions = Self::NONE;
        let Some(classes) = Classes::new(problem).filter(Classes::adjacent) else {
            return positions;
        };
        let n = classes.clique() as usize;
        let spare = period - n as i32 * problem.interval;
        if n > MAX_POSITIONS || spare < 0 {
            return positions;
        }
        // Beyond, the order of the sensors changes now and then, and deciding it pair by pair is as good.
        if 2 * spare >= problem.interval || (classes.ring() && problem.sensors % n > 0) {
            return positions;
        }
        (positions.count, positions.spare, positions.ring) = (n, spare, classes.ring());
        for class in 0..n {
            positions.room[class] = classes.values(problem, period, class as i32, classes.passed(problem));
        }
        positions
    }

    /// Begins anew with the adjacent sensors that include `top`.
    pub(super) fn begin(&mut self, problem: &CheckedProblem, top: usize) {
        self.fixed = 0;
        let first = if self.ring { top } else { top.min(problem.sensors - self.count) };
        for i in 0..self.count {
            // `top` first, then the others from `first` on.
            let x = if i == 0 {
                top
            } else {
                let x = first + i - 1;
                if x >= top { x + 1 } else { x }
            };
            // Sensors are below 64.
            self.sensors[i] = (x % problem.sensors) as u8;
        }
    }

    pub(super) fn clear(&mut self) {
        self.fixed = 0;
    }

    pub(super) fn pop(&mut self) {
        self.fixed -= 1;
    }

    /// The sensors that share the class of `x`.
    pub(super) fn alike(&self, problem: &CheckedProblem, x: usize) -> u64 {
        (x % self.count..problem.sensors).step_by(self.count).fold(0, |set, y| set | 1 << y)
    }

    /// The pair of positions in `orders`, if it is among the decision's.
    pub(super) fn of_orders(&self, orders: &Orders, decision: &Decision) -> Option<u8> {
        let x = usize::from(decision.x);
        let before = |order: &[u8]| {
            let window = self.sensors[..self.count].iter();
            window.filter(|&&y| order[usize::from(y)] < order[x]).count()
        };
        let pair = MAX_POSITIONS * before(&orders.b) + before(&orders.a);
        (decision.positive >> pair & 1 == 1).then_some(pair as u8)
    }
}
