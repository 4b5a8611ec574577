//! When one sensor n places further along may fire between other neighbours than its like: a bound just beyond
//! `2 sigma = I`.
//!
//! [`classes`](super::classes) lets sensor i + n take the places of sensor i as long as `2 sigma < I`. Now let
//! `2 sigma = I + epsilon` with `epsilon >= 0` and `sigma < I`. Again u firings of sensor i and v of sensor i + n share
//! a gap between firings of the n - 1 sensors that both conflict with, and the 2 (n - 1) gaps are `(1 + max(u, v)) I`
//! long or longer, `2 T_p = (2 n + 1) I + epsilon` together. So the sum of `max(u, v)` is 2, and the places are the
//! same, or it is 3: call that a **change** at i. Then only `epsilon` is left for all gaps together, and whatever has
//! no room in its gap is **rigid**: the time from one of its firings to the next is a multiple of I, and at most
//! `epsilon` more. As `T_p = (n + 1/2) I + epsilon / 2`, its `|d|` is in one of the *half classes*
//!
//! ```text
//! (j + 1/2) I - epsilon / 2 ..= (j + 1/2) I + epsilon / 2,  j = 0, 1, ..,  as far as T_p - R reaches,
//! ```
//!
//! each with room for `m = epsilon / D + 1` (rounded down) values. The n - 1 sensors between are rigid. So are i and
//! i + n if neither fires twice in one gap. If sensor i does, it is last in one phase and first in the next, the gap is
//! `2 I + R` long, which `R - I <= epsilon` allows, and only sensor i + n, once in the same gap, may have room. Hence
//! at least n + 1 sensors are rigid, or n if `R - I <= epsilon`: where the half classes hold fewer, **nothing
//! changes**.
//!
//! **The one change.** What remains for m = 1 is `R - I <= epsilon` and n half classes, for exactly n rigid sensors: i,
//! which fires twice in one gap, and the n - 1 between (or these and i + n, the mirror image). Two changes would need
//! the same n sensors, at either end of them, but then both ends would need the one topmost half class. So there is one
//! change at most. In a ring whose K is a multiple of n there is none: going round, sensor i + n would have the places
//! of sensor i after all.
//!
//! **A ring**, K a multiple of n, with `R - I > epsilon`. If the half classes have just room for the n + 1 rigid
//! sensors of one change, there is one at most. Going round, it must leave all c as they were; so each sensor that i
//! passes between firing in b and in a, sensor i + n passes too, though it may fire at the other end of a phase, and
//! all that is said of rings in [`classes`](super::classes) holds. If there is room for one rigid sensor more, there
//! may be two changes, at i and i + 1: two further apart have more rigid sensors together. Only the n sensors from i +
//! 1 on can have odd places then; all other cliques, going round, agree, and as each sensor is in one of these, c still
//! depends on x mod n. But who passes whom near the changes is not known. The n + 2 rigid sensors fill all half
//! classes, and each class has to hold those at its ends besides its own.
//!
//! In a line, let sensor i be last in b and first in a. If `r_b` and `r_a` count the sensors between in each phase,
//! from 0, such a sensor has moved by `c = r_a + 1 - r_b` places against those of sensor i and before. Sensor i + n
//! stays last in b and is at place p >= 1 in a (or, reversing time, stays first in a): against it and those behind,
//! `c = r_a - r_b`, and 1 more from `r_a = p` on; sensor i + n itself has moved by `p - (n - 1)`. From firing in b to
//! firing in a such a sensor takes that of `n + 1 + r_a - r_b` times I, and once more from `r_a = p` on. That must fill
//! all half classes but the topmost, one each. So class 0 has one value less for all others, and each other class two.
//! Whether that is possible is found by trying all orders, positions p and places of the change in the line.

use super::super::problem::CheckedProblem;
use super::classes::Classes;
use crate::schedule::MAX_SENSORS;

/// The largest n for which all orders are tried.
const MAX_CLIQUE: usize = 5;

/// How the places change along a line or ring.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Changes {
    /// Each n-th sensor has the same places, or passes the same others.
    None,
    /// In a line: as `None`, or there is the one change.
    One,
    /// In a ring: as `None`, or there are two changes side by side, which leave no room in the half classes.
    Two {
        /// So many rigid sensors are in each half class.
        rigid: i32,
    },
    /// Nothing is known.
    Any,
}

/// The half classes.
struct Halves {
    /// How many there are.
    count: i32,
    /// m.
    values: i32,
    /// How many sensors are rigid where one change is.
    rigid: i32,
}

impl Halves {
    /// The half classes of this period, with n sensors in a clique; `None` if there is too much room to speak of them.
    fn new(problem: &CheckedProblem, period: i32, n: i32) -> Option<Self> {
        let CheckedProblem { interval, window, separation, .. } = *problem;
        let spare = period - n * interval;
        let excess = 2 * spare - interval;
        if spare >= interval || window < interval {
            return None;
        }
        let reach = 2 * (period - window) + excess - interval;
        Some(Self {
            count: if reach < 0 { 0 } else { reach / (2 * interval) + 1 },
            values: excess / separation + 1,
            rigid: if window - interval <= excess { n } else { n + 1 },
        })
    }

    /// So many more sensors fit than are rigid with one change.
    fn left(&self) -> i32 {
        // No more than what fits into a period, below 2^26.
        self.count * self.values - self.rigid
    }
}

/// How the places change in a line at this period.
pub(crate) fn in_line(problem: &CheckedProblem, period: i32, n: i32) -> Changes {
    if 2 * (period - n * problem.interval) < problem.interval {
        return Changes::None;
    }
    match Halves::new(problem, period, n) {
        Some(halves) if halves.left() < 0 => Changes::None,
        Some(halves) if halves.values == 1 => Changes::One,
        _ => Changes::Any,
    }
}

/// How the places change in a ring at this period.
pub(crate) fn in_ring(problem: &CheckedProblem, period: i32, n: i32) -> Changes {
    if 2 * (period - n * problem.interval) < problem.interval {
        return Changes::None;
    }
    let round = problem.sensors as i32 % n == 0;
    match Halves::new(problem, period, n) {
        Some(halves) if halves.left() < 0 => Changes::None,
        Some(halves) if halves.left() == 0 && round => Changes::None,
        Some(halves) if halves.left() == 1 && halves.rigid > n && round => Changes::Two { rigid: halves.values },
        _ => Changes::Any,
    }
}

/// Whether a ring with [`Changes::Two`] has room for them.
pub(crate) fn two_fit(problem: &CheckedProblem, classes: &Classes, period: i32, rigid: i32) -> bool {
    let n = classes.clique() as i32;
    let count = Halves::new(problem, period, n).map_or(0, |halves| halves.count);
    let like = problem.sensors as i32 / n;
    let mut places = [0; MAX_SENSORS];
    for (class, places) in (0..n).zip(&mut places) {
        let values = classes.values(problem, period, class, 0);
        // In the half classes at its ends; of the n + 2 sensors in a row, two pairs are alike.
        let rigid = (i32::from(class > 0 && class <= count) + i32::from(class < count)) * rigid;
        let fits = |places: i32| like * places - (places + places.min(2)).min(rigid) + rigid <= values;
        *places = (1..=n).rev().find(|&places| fits(places)).unwrap_or(0);
    }
    classes.permutes(&places)
}

/// Whether a line with [`Changes::One`] has room for the change somewhere; `values` tells how many `|d|` fit into a
/// class. If n is large it is taken for granted.
pub(crate) fn one_fits(problem: &CheckedProblem, classes: &Classes, period: i32) -> bool {
    let (k, n) = (problem.sensors, classes.clique() as usize);
    if n > MAX_CLIQUE {
        return true;
    }
    let mut room = [0; MAX_CLIQUE];
    for (class, room) in room.iter_mut().enumerate().take(n) {
        let rigid = if class == 0 { 1 } else { 2 };
        *room = classes.values(problem, period, class as i32, 0) - rigid;
    }
    let mut order_a = Order::first(n - 1);
    loop {
        for p in 1..n as i32 {
            // Numbered by their places in b.
            let later = |b: usize| i32::from(i32::from(order_a.at[b]) >= p);
            let moved = |b: usize| i32::from(order_a.at[b]) - b as i32;
            let mut halves = 0u32;
            for b in 0..n - 1 {
                // |moved + 1/2| rounded down; the topmost is taken.
                let twice = 2 * (moved(b) + later(b)) + 1;
                halves |= 1 << (twice.unsigned_abs() / 2);
            }
            if halves != (1 << (n - 1)) - 1 {
                continue;
            }
            let mut sensors = Order::first(n - 1);
            loop {
                for i in 0..k.saturating_sub(n) {
                    let mut taken = [0; MAX_CLIQUE];
                    let mut take = |moved: i32, sensors: usize| taken[moved.unsigned_abs() as usize] += sensors as i32;
                    // Sensor i itself is rigid.
                    take(n as i32 - 1, i / n);
                    take(n as i32 - 1 - p, (k - 1 - i) / n);
                    for b in 0..n - 1 {
                        let s = 1 + usize::from(sensors.at[b]);
                        take(moved(b) + 1, (i + s) / n);
                        take(moved(b) + later(b), (k - 1 - i - s) / n);
                    }
                    if taken[..n].iter().zip(&room[..n]).all(|(taken, room)| taken <= room) {
                        return true;
                    }
                }
                if !sensors.advance() {
                    break;
                }
            }
        }
        if !order_a.advance() {
            return false;
        }
    }
}

/// An order of few things, stepping through all in lexical order.
struct Order {
    at: [u8; MAX_CLIQUE],
    len: usize,
}

impl Order {
    fn first(len: usize) -> Self {
        let mut at = [0; MAX_CLIQUE];
        for (i, at) in at.iter_mut().enumerate() {
            // Below MAX_CLIQUE.
            *at = i as u8;
        }
        Self { at, len }
    }

    /// The next order, if there is one.
    fn advance(&mut self) -> bool {
        let at = &mut self.at[..self.len];
        let Some(i) = (1..at.len()).rev().find(|&i| at[i - 1] < at[i]) else {
            return false;
        };
        let Some(j) = (i..at.len()).rev().find(|&j| at[j] > at[i - 1]) else {
            return false;
        };
        at.swap(i - 1, j);
        at[i..].reverse();
        true
    }
}
