//! A slow, obvious judge of wait tables: (13a) and (13b) pair by pair as printed, firings compared one by one on the
//! circle, and plain nested loops. It shares nothing with the search.

use eeruf_core::Criterion;
use serde::Deserialize;

/// The wait-time problem, all times in ticks.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    pub period: u32,
    pub lag: &'a [u32],
    pub wait_max: u32,
    /// `D`, 1 or more.
    pub separation: u32,
    pub interval: u32,
    pub conflicts: &'a [u64],
    pub criterion: Criterion,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    Line,
    Ring,
    Blocks,
}

/// The rows of conflicts of a layout.
pub fn conflicts(layout: Layout, sensors: usize, neighbours: usize) -> Vec<u64> {
    conflicts_where(sensors, |x, y| match layout {
        Layout::Line => x - y < neighbours,
        Layout::Ring => (x - y).min(sensors - (x - y)) < neighbours,
        Layout::Blocks => x / neighbours == y / neighbours,
    })
}

/// The rows of conflicts of any graph; `close` decides each pair `x > y`.
pub fn conflicts_where(sensors: usize, close: impl Fn(usize, usize) -> bool) -> Vec<u64> {
    let conflict = |x: usize, y: usize| x != y && close(x.max(y), x.min(y));
    (0..sensors).map(|x| (0..sensors).filter(|&y| conflict(x, y)).map(|y| 1 << y).sum()).collect()
}

/// Returns true if sensors x and y may stand in one table.
pub fn pair_holds(problem: &Problem<'_>, x: usize, y: usize, a: &[u32], b: &[u32]) -> bool {
    let (xa, xb, ya, yb) = (a[x] as i64, b[x] as i64, a[y] as i64, b[y] as i64);
    let d = i64::from(problem.separation);
    let separate = match problem.criterion {
        // (13a) and (13b) with an outer absolute value; "> 2 t_delta" is ">= D".
        Criterion::Paper => {
            ((xa - ya).abs() - (xb - yb).abs()).abs() >= d && ((xa - yb).abs() - (xb - ya).abs()).abs() >= d
        }
        // (10a) and (10b).
        Criterion::Exact | Criterion::Margin(_) => {
            ((xa - xb) - (ya - yb)).abs() >= d && ((xa - xb) + (ya - yb)).abs() >= d
        }
    };
    separate && (problem.conflicts[x] >> y & 1 == 0 || interval(problem, x, y, a, b) >= i64::from(problem.interval))
}

/// The least distance between a firing of x and one of y.
fn interval(problem: &Problem<'_>, x: usize, y: usize, a: &[u32], b: &[u32]) -> i64 {
    let period = i64::from(problem.period);
    let firings = |k: usize| {
        let lag = i64::from(problem.lag[k]);
        [lag + i64::from(a[k]), period + lag + i64::from(b[k])]
    };
    let mut least = i64::MAX;
    for p in firings(x) {
        for q in firings(y) {
            for turn in [-2, 0, 2] {
                least = least.min((p - q + turn * period).abs());
            }
        }
    }
    least
}

pub fn holds(problem: &Problem<'_>, a: &[u32], b: &[u32]) -> bool {
    let sensors = problem.lag.len();
    (0..sensors).all(|x| {
        a[x] <= problem.wait_max && b[x] <= problem.wait_max && (0..x).all(|y| pair_holds(problem, x, y, a, b))
    })
}

/// Calls `see` for every table: one loop for each wait of each sensor, the innermost bodies entered only if the sensors
/// so far fit.
pub fn for_each(problem: &Problem<'_>, see: &mut dyn FnMut(&[u32], &[u32])) {
    fn loops(problem: &Problem<'_>, k: usize, a: &mut Vec<u32>, b: &mut Vec<u32>, see: &mut dyn FnMut(&[u32], &[u32])) {
        if k == problem.lag.len() {
            see(a, b);
            return;
        }
        for wait_a in 0..=problem.wait_max {
            for wait_b in 0..=problem.wait_max {
                a.push(wait_a);
                b.push(wait_b);
                if (0..k).all(|y| pair_holds(problem, k, y, a, b)) {
                    loops(problem, k + 1, a, b, see);
                }
                a.pop();
                b.pop();
            }
        }
    }
    loops(problem, 0, &mut Vec::new(), &mut Vec::new(), see);
}

pub fn count(problem: &Problem<'_>) -> u128 {
    let mut count = 0;
    for_each(problem, &mut |_, _| count += 1);
    count
}

/// The greatest value, interval or separation, for which a table exists, by trying each.
pub fn best(problem: &Problem<'_>, with: impl Fn(Problem<'_>, u32) -> Problem<'_>, most: u32) -> Option<u32> {
    (0..=most).rev().find(|&value| count(&with(*problem, value)) > 0)
}
