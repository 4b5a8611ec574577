//! How much a period leaves to spare decides how many sensors can share a size of `|d|`: a bound for cliques, lines and
//! rings.
//!
//! Take n sensors that all conflict, in a period `T_p = n I + sigma`, with `R >= I`. Any two firings that follow each
//! other are I apart, also those of one sensor. If a sensor is the p-th of them in phase a and the q-th in phase b,
//! `n + p - q` such steps lie between its firing in b and the next in a, and `n - p + q` between a and the next b, so
//! with `c = p - q`
//!
//! ```text
//! T_p + d >= (n + c) I,  T_p - d >= (n - c) I,  that is  c I - sigma <= d <= c I + sigma.
//! ```
//!
//! Its **class** is `|c|`. As long as `sigma < I` each class has room for as many `|d|` as fit D apart into
//! `|c| I - sigma ..= |c| I + sigma`, cut off at `least` below and at the `T_p - R` that the window leaves above. The n
//! values c are how far the places of a permutation move. That bounds one clique; a set of **disjoint cliques** shares
//! the room of the classes.
//!
//! **Line** (each n adjacent sensors conflict). Sensors i and i + n both conflict with the n - 1 between them, whose
//! firings leave `2 (n - 1)` gaps, in two periods end to end. A gap with u firings of sensor i and v of sensor i + n in
//! it is at least `(1 + max(u, v)) I` long; if `2 sigma < I`, together they are `2 T_p < (2 n + 1) I` long, so the sum
//! of `max(u, v)` is at most 2. As u and v sum to 2 each, `u = v` in each gap: sensor i + n takes the places of sensor
//! i. (Should i be last in both phases, i + n may instead be first in both: that moves all places of the sensors
//! between by one, in both phases alike.) So c of sensor x depends on `x mod n` alone, and *one* permutation places
//! `floor(K / n)` sensors or one more for each of its places. For n that divides K and n = 4, that is `n I + D (L - 1)`
//! with `L = K / n` at `R = I`.
//!
//! **Ring.** The same goes all round, so c depends on x mod the largest common divisor of n and K, and of each class
//! there are K / n times as many sensors as places. Let x and y conflict, x before y in phase b and behind it in a:
//! `a_x - a_y >= (p_x - p_y) I` and `b_y - b_x >= (q_y - q_x) I`, so `e = d - c I` is no smaller for x than for y. If
//! `c_x > 0`, somebody in each clique is overtaken so; with `K >= 2 n` there is one on either side of x, n sensors
//! apart and so of one class, and their e differ by D. Hence `e_x >= -sigma + D`, and likewise `e_x <= sigma - D` if
//! `c_x < 0`: in terms of `|d|` every class but 0 loses D at the lower end. A sensor that keeps its place, `c = 0`,
//! while others pass it from both sides, has both: its class loses D above, on the one side that `|d|` has. Sensors
//! that nobody passes lose nothing.
//!
//! **Ring of `K = 2 n`.** Every sensor conflicts with all but the one opposite, and both fire in the same 2 n places of
//! two periods, of which each takes as long as its two firings are apart. The time from one firing to the next is
//! `T_p + d` or `T_p - d`; of two opposite sensors these times differ by D at least, so the two places that they share
//! take D together. (If they are next to each other, because the sensor that is last in one phase is first in the next,
//! then it is I from each firing to the next, and from the first of the four to the last `I + D`.) All n pairs of
//! places, with I behind each place: `2 T_p >= 2 n I + n D`.
//!
//! Whether some permutation fits is found by trying them, place by place; there are few unless n is large, and then
//! giving up says nothing. Where `2 sigma >= I`, lines and rings take up [`changes`](super::changes); where
//! `sigma >= I`, nothing is said.

use super::super::problem::CheckedProblem;
use super::super::symmetry;
use super::cliques::disjoint_cliques;
use super::permutation::Room;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Outcome;

/// What is known of the conflicts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shape {
    Line,
    /// With at least twice as many sensors as conflict at once.
    Ring,
    /// So many disjoint cliques.
    Cliques(u32),
}

/// Cliques of n sensors, and how they hang together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Classes {
    pub(super) shape: Shape,
    /// n.
    pub(super) clique: u32,
}

impl Classes {
    /// What the conflicts allow to count, or `None` if no two sensors conflict or the window is shorter than the
    /// interval.
    pub(crate) fn new(problem: &CheckedProblem) -> Option<Self> {
        if problem.window < problem.interval {
            return None;
        }
        let first = problem.conflicts[0];
        // Sensors 1 to n - 1 conflict with sensor 0, and more only round the end of a ring.
        let n = (first >> 1).trailing_ones() as usize + 1;
        let near = |x: usize, y: usize| x != y && x.abs_diff(y) < n;
        let row = |x: usize| (0..problem.sensors).filter(|&y| near(x, y)).fold(0, |row, y| row | 1 << y);
        if n >= 2 && (0..problem.sensors).all(|x| problem.conflicts[x] == row(x)) {
            return Some(Self { shape: Shape::Line, clique: n as u32 });
        }
        if n >= 2
            && problem.sensors >= 2 * n
            && first.count_ones() as usize == 2 * (n - 1)
            && symmetry::is_ring(problem)
        {
            return Some(Self { shape: Shape::Ring, clique: n as u32 });
        }
        let (clique, cliques) = disjoint_cliques(problem);
        (clique >= 2).then_some(Self { shape: Shape::Cliques(cliques), clique })
    }

    /// The number of sensors in each clique.
    pub(crate) fn clique(&self) -> u32 {
        self.clique
    }

    /// Whether any n adjacent sensors conflict.
    pub(crate) fn adjacent(&self) -> bool {
        !matches!(self.shape, Shape::Cliques(_))
    }

    /// Whether also round the end.
    pub(crate) fn ring(&self) -> bool {
        self.shape == Shape::Ring
    }

    /// Whether some permutation has no more places in each class than these.
    pub(super) fn permutes(&self, places: &[i32; MAX_SENSORS]) -> bool {
        let n = self.clique as usize;
        let room = Room { places: *places, crossed: i32::MAX, values: [0; MAX_SENSORS] };
        // A clique has at most MAX_SENSORS sensors.
        !matches!(room.permutation(&[1; MAX_SENSORS][..n], &[0; MAX_SENSORS], |_| true), Outcome::Exhausted)
    }

    /// What a sensor of a ring needs at the lower end of its class, as others pass it on both sides.
    pub(crate) fn passed(&self, problem: &CheckedProblem) -> i32 {
        if self.ring() { problem.separation } else { 0 }
    }

    /// How many `|d|` fit into a class, if in all but class 0 the first `passed` ticks are lost.
    pub(crate) fn values(&self, problem: &CheckedProblem, period: i32, class: i32, passed: i32) -> i32 {
        self.values_within(problem, period, class, if class > 0 { passed } else { 0 }, 0)
    }

    /// How many `|d|` fit into a class of which `below` and `above` are lost.
    pub(super) fn values_within(
        &self,
        problem: &CheckedProblem,
        period: i32,
        class: i32,
        below: i32,
        above: i32,
    ) -> i32 {
        // Where the largest interval is asked for, these can be longer than 32 bits hold.
        let spare = period.saturating_sub((self.clique as i32).saturating_mul(problem.interval));
        let middle = class.saturating_mul(problem.interval);
        let low = middle.saturating_sub(spare).saturating_add(below).max(problem.least);
        let high = middle.saturating_add(spare).saturating_sub(above).min(period - problem.window);
        if low <= high { (high - low) / problem.separation + 1 } else { 0 }
    }
}
