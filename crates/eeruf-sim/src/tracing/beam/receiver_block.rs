//! All receivers as one block of numbers, to drop beams of the last order that meet none of them.

use crate::geometry::{Point, SAME_DIRECTION, TOUCH_M, Vector, cross};

/// Number of receivers that are tested as one block before a beam of the last order is followed.
const BLOCK: usize = 32;

/// Positions of the receivers.
#[derive(Debug)]
pub(super) struct ReceiverBlock {
    x: [f64; BLOCK],
    y: [f64; BLOCK],
    len: usize,
    all: bool,
    /// A disc around all receivers, which speeds up tests if they are close together.
    middle: Point,
    radius: f64,
}

impl Default for ReceiverBlock {
    fn default() -> Self {
        Self { x: [0.0; BLOCK], y: [0.0; BLOCK], len: 0, all: false, middle: Point::origin(), radius: 0.0 }
    }
}

impl ReceiverBlock {
    pub(super) fn fill(&mut self, receivers: &[Point]) {
        self.all = receivers.len() > BLOCK;
        self.enclose(receivers);
        // Repetitions fill the block up to groups of four, which the compiler turns into vector instructions.
        self.len = if self.all { 0 } else { receivers.len().next_multiple_of(4) };
        for k in 0..self.len {
            let receiver = receivers[k.min(receivers.len() - 1)];
            self.x[k] = receiver.x;
            self.y[k] = receiver.y;
        }
    }

    fn enclose(&mut self, receivers: &[Point]) {
        let count = receivers.len().max(1) as f64;
        let sum = receivers.iter().fold(Vector::zeros(), |sum, at| sum + at.coords);
        self.middle = Point::from(sum / count);
        let far = receivers.iter().map(|at| (at - self.middle).norm());
        self.radius = far.fold(0.0, f64::max) * (1.0 + 1e-9) + TOUCH_M;
    }

    /// Returns true if all receivers are certainly farther from a point than a length.
    #[inline]
    pub(super) fn is_beyond(&self, from: Point, length_m: f64) -> bool {
        let least_m = length_m + self.radius;
        (self.middle - from).norm_squared() > least_m * least_m
    }

    /// Returns true if any receiver may be in the cone; if false, certainly none is.
    #[inline]
    pub(super) fn may_see(&self, image: Point, left: Vector, right: Vector) -> bool {
        let ahead = self.middle - image;
        // The sum of the absolute coordinates of a vector is no less than its length.
        let reach = |limit: Vector| -self.radius * (limit.x.abs() + limit.y.abs());
        if cross(ahead, left) < reach(left) || cross(right, ahead) < reach(right) {
            return false;
        }
        if self.all {
            return true;
        }
        let size = |v: Vector| v.x.abs() + v.y.abs();
        let (slack_l, slack_r) = (2.0 * SAME_DIRECTION * size(left), 2.0 * SAME_DIRECTION * size(right));
        let groups = self.x[..self.len].chunks_exact(4).zip(self.y[..self.len].chunks_exact(4));
        for (xs, ys) in groups {
            let mut any = false;
            for k in 0..4 {
                let (x, y) = (xs[k] - image.x, ys[k] - image.y);
                let size = x.abs() + y.abs();
                let l = x * left.y - y * left.x;
                let r = right.x * y - right.y * x;
                any |= (l >= -slack_l * size) & (r >= -slack_r * size);
            }
            if any {
                return true;
            }
        }
        false
    }
}
