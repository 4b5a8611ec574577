//! Sets of sensors of which few can fire close together, and the resulting bounds on their firing times.

use crate::engine::counting::{Even, members};
use crate::engine::problem::Merged;

/// Cliques, and the least number of them that contain a sensor: windows of neighbours round a ring or along a line,
/// including those that its ends cut off; else a partition. The number of cliques divided by that number limits how
/// many sensors have their interval open at once.
pub(crate) fn cover(merged: &Merged) -> (Vec<u64>, usize) {
    let count = merged.count();
    let Some(even) = Even::of(merged) else { return ((0..count).map(|x| 1 << x).collect(), 1) };
    let n = (even.rows[0] >> 1).trailing_ones() as usize + 1;
    let row = |x: usize| (0..count).filter(|&y| x != y && x.abs_diff(y) < n).fold(0, |row, y| row | 1 << y);
    if (0..count).all(|x| even.rows[x] == row(x)) {
        let window =
            |end: usize| (0..count).filter(|x| (x + 1..x + 1 + n).contains(&end)).fold(0, |set, x| set | 1 << x);
        return ((1..count + n).map(window).collect(), n);
    }
    if let Some(n) = even.ring() {
        let window = |first: usize| (first..first + n).fold(0, |set, x| set | 1 << (x % count));
        return ((0..count).map(window).collect(), n);
    }
    let (mut left, mut cliques) = (even.all(), Vec::new());
    while let Some(x) = members(left).next() {
        let clique = even.grow(x, left);
        cliques.push(clique);
        left &= !clique;
    }
    (cliques, 1)
}

/// The least gap of any two sensors of a clique.
pub(crate) fn interval_of(merged: &Merged, clique: u64) -> Option<i32> {
    let of = |x: usize| members(clique).filter(move |&y| y != x).map(move |y| merged.gap[x][y]);
    members(clique).flat_map(of).min()
}

/// The firings of two periods, of which at most `at_once` in a row lie within an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    sensors: i32,
    at_once: i32,
    interval: i32,
    period: i32,
}

impl Pace {
    pub(crate) fn new(sensors: usize, at_once: i32, interval: i32, period: i32) -> Self {
        Self { sensors: sensors as i32, at_once, interval, period }
    }

    /// The least time from a firing to the one that comes this many steps later: `at_once` steps take an interval, also
    /// across several times two periods.
    pub(crate) fn least(&self, steps: i32) -> i32 {
        let round =
            |turns: i32| self.interval * ((steps + 2 * self.sensors * turns) / self.at_once) - 2 * self.period * turns;
        (0..self.at_once).map(round).max().unwrap_or(0)
    }

    /// Returns true if these times leave room for fewer separated |d| than there are sensors.
    ///
    /// A sensor at place p in phase a and q in phase b has `K + q - p` steps from its firing in a to that in b, and as
    /// many fewer than `2 K` from there to the next in a; with `e = |p - q|`, `|d|` lies between `least(K + e) - T` and
    /// `T - least(K - e)`.
    pub(crate) fn excludes(&self, separation: i32, window: i32, least: i32) -> bool {
        let Self { sensors, period, .. } = *self;
        let places = (0..sensors).map(|e| (self.least(sensors + e) - period, period - self.least(sensors - e)));
        let mut places: Vec<(i32, i32)> =
            places.map(|(low, high)| (high.min(period - window), low.max(least))).collect();
        places.retain(|(high, low)| low <= high);
        // From the lowest up, each as low as it may.
        let (mut count, mut next) = (0, least);
        while let Some(low) = places.iter().filter(|(high, _)| *high >= next).map(|&(_, low)| low.max(next)).min() {
            (count, next) = (count + 1, low + separation);
        }
        count < sensors
    }
}
