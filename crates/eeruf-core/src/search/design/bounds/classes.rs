//! The least slack of a period for sensors that all conflict, so that all their `|d|` find room.
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
//! values c are how far the places of a permutation move. **Disjoint cliques** share the room of the classes.
//!
//! **Line** (each n adjacent sensors conflict). Sensors i and i + n both conflict with the n - 1 between them, whose
//! firings leave `2 (n - 1)` gaps, in two periods end to end. A gap with u firings of sensor i and v of sensor i + n in
//! it is at least `(1 + max(u, v)) I` long; if `2 sigma < I`, together they are `2 T_p < (2 n + 1) I` long, so the sum
//! of `max(u, v)` is at most 2. As u and v sum to 2 each, `u = v` in each gap: sensor i + n takes the places of sensor
//! i. (Should i be last in both phases, i + n may instead be first in both: that moves all places of the sensors
//! between by one, in both phases alike.) So c of sensor x depends on `x mod n` alone: *one* permutation for all, and
//! each of its places needs room for `K / n` sensors or more.
//!
//! **Ring** with K a multiple of n, `K >= 2 n`. The same goes all round. Let x and y conflict, x before y in phase b
//! and behind it in a: `a_x - a_y >= (p_x - p_y) I` and `b_y - b_x >= (q_y - q_x) I`, so `e = d - c I` is no smaller
//! for x than for y. If `c_x > 0`, somebody in each clique is overtaken so; there is one on either side of x, n sensors
//! apart and so of one class, and their e differ by D. Hence `e_x >= -sigma + D`, and likewise `e_x <= sigma - D` if
//! `c_x < 0`: in terms of `|d|` every class but 0 loses D at the lower end.
//!
//! **Ring of `K = 2 n`.** Every sensor conflicts with all but the one opposite, and both fire in the same 2 n places of
//! two periods, of which each takes as long as its two firings are apart. The time from one firing to the next is
//! `T_p + d` or `T_p - d`; of two opposite sensors these times differ by D at least, so the two places that they share
//! take D together. (If they are next to each other, because the sensor that is last in one phase is first in the next,
//! then it is I from each firing to the next, and from the first of the four to the last `I + D`.) All n pairs of
//! places, with I behind each place: `2 T_p >= 2 n I + n D`.

use super::super::problem::CheckedProblem;
use super::super::symmetry;
use super::cliques::disjoint_cliques;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// The places tried before giving up on a permutation, which then says nothing.
const STEPS: u32 = 1 << 15;

/// Disjoint cliques of n sensors, and how they hang together.
#[derive(Clone, Copy)]
pub(crate) struct Classes {
    pub(crate) n: i32,
    pub(crate) cliques: i32,
    line: bool,
    /// As above, K a multiple of n.
    ring: bool,
}

impl Classes {
    /// `None` if no two sensors conflict or the window is shorter than the interval.
    pub(crate) fn new(problem: &CheckedProblem) -> Option<Self> {
        let (k, first) = (problem.sensors, problem.conflicts[0]);
        // Sensors 1 to n - 1 conflict with sensor 0, and more only round the end of a ring.
        let n = (first >> 1).trailing_ones() as usize + 1;
        let near = |x: usize, y: usize| x != y && x.abs_diff(y) < n;
        let row = |x: usize| (0..k).filter(|&y| near(x, y)).fold(0, |row, y| row | 1 << y);
        let line = (0..k).all(|x| problem.conflicts[x] == row(x));
        let around = k >= 2 * n && k % n == 0 && first.count_ones() as usize == 2 * (n - 1);
        let ring = around && symmetry::is_ring(problem);
        let (n, cliques) = if line || ring { (n as u32, (k / n) as u32) } else { disjoint_cliques(problem) };
        let counts = n >= 2 && problem.window >= problem.interval;
        counts.then_some(Self { n: n as i32, cliques: cliques as i32, line, ring })
    }

    /// A period below which there is no schedule; it may be smaller than other bounds.
    pub(crate) fn period(&self, problem: &CheckedProblem) -> u32 {
        // Where the largest interval is asked for, this can be longer than any period; other bounds say so then.
        let Some(mut yes) = problem.interval.checked_mul(self.n + 1) else {
            return 0;
        };
        let mut no = yes - problem.interval - 1;
        while no + 1 < yes {
            let middle = no + (yes - no) / 2;
            if self.excludes(problem, middle) { no = middle } else { yes = middle }
        }
        yes as u32
    }

    /// Returns true if too few `|d|` fit into the classes at this period, at least n I.
    fn excludes(&self, problem: &CheckedProblem, period: i32) -> bool {
        let (n, cliques, separation) = (self.n, self.cliques, problem.separation);
        let spare = period - n * problem.interval;
        let alike = cliques == 1 || (self.line || self.ring) && 2 * spare < problem.interval;
        let (mut sum, mut room) = (0, [0; MAX_SENSORS]);
        for (class, room) in (0..n).zip(&mut room) {
            let passed = if self.ring && alike && class > 0 { separation } else { 0 };
            let middle = class * problem.interval;
            let (low, high) = ((middle - spare + passed).max(problem.least), period - problem.window);
            let high = high.min(middle + spare);
            let values = if low <= high { (high - low) / separation + 1 } else { 0 };
            sum += values.min(n * cliques);
            *room = values / cliques;
        }
        let opposite = self.ring && alike && cliques == 2 && 2 * spare < n * separation;
        sum < n * cliques || opposite || alike && !permutes(n as usize, &mut room)
    }
}

/// Returns true if some permutation of n places moves no more of them by each distance than there is room for, or that
/// takes too long to find out. Places and distances are below n, which is at most `MAX_SENSORS`.
fn permutes(n: usize, room: &mut [i32; MAX_SENSORS]) -> bool {
    let all = u64::MAX >> (MAX_SENSORS - n);
    // Where each place goes, and where it may still be tried to go.
    let (mut to, mut open) = ([0; MAX_SENSORS], [all; MAX_SENSORS]);
    let (mut free, mut from) = (all, 0);
    for _ in 0..STEPS {
        if from == n {
            return true;
        }
        if let Some(p) = Members(open[from] & free).find(|p| room[p.abs_diff(from)] > 0) {
            room[p.abs_diff(from)] -= 1;
            free &= !(1 << p);
            open[from] &= u64::MAX << p << 1;
            (to[from], from) = (p, from + 1);
            continue;
        }
        open[from] = all;
        if from == 0 {
            return false;
        }
        from -= 1;
        room[to[from].abs_diff(from)] += 1;
        free |= 1 << to[from];
    }
    true
}
