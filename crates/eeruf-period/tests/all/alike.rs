//! Rings of identical sensors, with a slow, obvious judge of firing times and nested loops over them. It shares nothing
//! with the search.

#![allow(dead_code)]

use eeruf_period::engine::Problem;
use eeruf_period::engine::search::FiringTimes;
use eeruf_period::engine::shortest::{self, Shortest};

/// The needs of a ring, in ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alike<'a> {
    /// Row x has bit y if x and y need the interval.
    pub(crate) conflicts: &'a [u64],
    pub(crate) separation: u32,
    pub(crate) interval: u32,
    pub(crate) window: u32,
    pub(crate) stale_echo: bool,
}

impl Alike<'_> {
    pub(crate) fn sensors(&self) -> usize {
        self.conflicts.len()
    }

    /// Returns the problem in the search's form, in which a conflict needs an interval and a window is at least a tick.
    pub(crate) fn problem(&self) -> Problem {
        let none = vec![0; self.sensors()];
        let conflicts = if self.interval > 0 { self.conflicts } else { &none };
        let problem = Problem::alike(conflicts, self.separation, self.interval, self.window.max(1));
        Problem { stale_echo: self.stale_echo, ..problem }
    }

    pub(crate) fn shortest(&self, budget: u64) -> Shortest {
        shortest::shortest(&self.problem(), budget, &mut |_| true).expect("there is a schedule")
    }
}

#[derive(Clone, Copy)]
pub(crate) enum Layout {
    Line,
    Ring,
    Blocks,
}

/// The rows of conflicts of a layout.
pub(crate) fn conflicts(layout: Layout, sensors: usize, neighbours: usize) -> Vec<u64> {
    conflicts_where(sensors, |x, y| match layout {
        Layout::Line => x - y < neighbours,
        Layout::Ring => (x - y).min(sensors - (x - y)) < neighbours,
        Layout::Blocks => x / neighbours == y / neighbours,
    })
}

/// The rows of conflicts of any graph: `close` is asked for each pair `x > y`.
pub(crate) fn conflicts_where(sensors: usize, close: impl Fn(usize, usize) -> bool) -> Vec<u64> {
    let conflict = |x: usize, y: usize| x != y && close(x.max(y), x.min(y));
    (0..sensors).map(|x| (0..sensors).filter(|&y| conflict(x, y)).map(|y| 1 << y).sum()).collect()
}

/// Violations of a schedule: each need is checked as defined, pair by pair.
pub(crate) fn check(problem: &Alike<'_>, period: u32, a: &[u32], b: &[u32]) -> Result<(), String> {
    let k = problem.sensors();
    if a.len() != k || b.len() != k {
        return Err(format!("{} and {} times for {k} sensors", a.len(), b.len()));
    }
    let t = i64::from(period);
    let (a, b): (Vec<i64>, Vec<i64>) = (a.iter().map(|&t| t.into()).collect(), b.iter().map(|&t| t.into()).collect());
    for x in 0..k {
        let d = (a[x] - b[x]).abs();
        if a[x] >= t
            || b[x] >= t
            || t - d < problem.window.into()
            || (problem.stale_echo && 2 * d < problem.separation.into())
        {
            return Err(format!("sensor {x}: {} {}", a[x], b[x]));
        }
        for y in 0..x {
            let other = (a[y] - b[y]).abs();
            if (d - other).abs() < problem.separation.into() {
                return Err(format!("sensors {x} and {y} are separated by {}", (d - other).abs()));
            }
            if problem.conflicts[x] >> y & 1 == 1 {
                // All firings of both sensors on the circle of two periods.
                for u in [a[x], t + b[x]] {
                    for v in [a[y], t + b[y]] {
                        let gap = (u - v).rem_euclid(2 * t).min((v - u).rem_euclid(2 * t));
                        if gap < problem.interval.into() {
                            return Err(format!("sensors {x} and {y} fire {gap} apart"));
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

pub(crate) fn assert_serves(problem: &Alike<'_>, period: u32, [a, b]: &FiringTimes) {
    assert_eq!(check(problem, period, a, b), Ok(()), "{problem:?} at {period}");
}

/// Returns true if any schedule exists, by trying all times of one sensor after the other.
pub(crate) fn nested_loops(problem: &Alike<'_>, period: u32) -> bool {
    fn assign(problem: &Alike<'_>, period: u32, a: &mut Vec<u32>, b: &mut Vec<u32>) -> bool {
        let k = a.len();
        if k > 0 {
            let rows: Vec<u64> = problem.conflicts[..k].iter().map(|row| row & ((1 << k) - 1)).collect();
            let part = Alike { conflicts: &rows, ..*problem };
            if check(&part, period, a, b).is_err() {
                return false;
            }
        }
        if k == problem.sensors() {
            return true;
        }
        for ta in 0..period {
            for tb in 0..period {
                a.push(ta);
                b.push(tb);
                let done = assign(problem, period, a, b);
                a.pop();
                b.pop();
                if done {
                    return true;
                }
            }
        }
        false
    }
    assign(problem, period, &mut Vec::new(), &mut Vec::new())
}

/// The paper's half ring of 12: 2 ms separation, 15 ms interval, 30 ms window, in ticks of `1 ms / scale`.
pub(crate) fn paper_12(conflicts: &[u64], scale: u32) -> Alike<'_> {
    Alike { conflicts, separation: 2 * scale, interval: 15 * scale, window: 30 * scale, stale_echo: false }
}
