//! Renamings of the sensors that leave the conflicts as they are, and what may be demanded of a schedule because of
//! them.
//!
//! Of all schedules that are the same but for a renaming, the search needs only one. It picks the sensor with the
//! largest `|d|` from [`representatives`], and among the renamings that leave that sensor alone it sorts the
//! interchangeable ones by their time in phase a ([`Sorting`]). Exchanging the phases or reversing time negates every
//! d, so that the largest may be taken as positive.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`; renamings map them to such.

use super::problem::CheckedProblem;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// Returns true if sensor i may be renamed to `to(i)` for all i at once.
fn keeps_conflicts(problem: &CheckedProblem, to: impl Fn(usize) -> usize) -> bool {
    (0..problem.sensors).all(|x| {
        let renamed = Members(problem.conflicts[x]).fold(0, |set, y| set | 1 << to(y));
        problem.conflicts[to(x)] == renamed
    })
}

/// Returns true if the sensors stand on a closed ring: each sees the same as the next.
pub(crate) fn is_ring(problem: &CheckedProblem) -> bool {
    keeps_conflicts(problem, |i| (i + 1) % problem.sensors)
}

fn mirrored(problem: &CheckedProblem) -> bool {
    keeps_conflicts(problem, |i| problem.sensors - 1 - i)
}

/// Sensors that conflict with each other and with the same others are interchangeable: the lowest such sensor for `x`.
fn twin(problem: &CheckedProblem, x: usize) -> usize {
    let seen = |i: usize| problem.conflicts[i] | 1 << i;
    (0..x).find(|&y| seen(y) == seen(x)).unwrap_or(x)
}

/// If all sensors form disjoint blocks of one size, each sensor conflicting with its whole block: that size.
fn block_size(problem: &CheckedProblem) -> Option<u32> {
    let size = problem.conflicts[0].count_ones() + 1;
    let alike = |x: usize| {
        let block = problem.conflicts[x] | 1 << x;
        block.count_ones() == size && Members(block).all(|y| problem.conflicts[y] | 1 << y == block)
    };
    (0..problem.sensors).all(alike).then_some(size)
}

/// Sensors of which one may be assumed to have the largest `|d|`.
pub(crate) fn representatives(problem: &CheckedProblem) -> u64 {
    if is_ring(problem) || block_size(problem).is_some() {
        return 1;
    }
    let mut set = 0;
    for x in 0..problem.sensors {
        let mut lowest = twin(problem, x);
        if mirrored(problem) {
            lowest = lowest.min(twin(problem, problem.sensors - 1 - x));
        }
        set |= 1 << lowest;
    }
    set
}

/// Pairs (x, y) of which x may be assumed to fire before y, or together with it, in phase a, when `top` has the largest
/// `|d|`.
#[derive(Clone, Copy)]
pub(crate) struct Sorting {
    /// For each sensor y, x + 1, or 0 if nothing is assumed.
    after: [u8; MAX_SENSORS],
}

impl Sorting {
    pub(crate) fn new(problem: &CheckedProblem, top: usize) -> Self {
        let mut after = [0; MAX_SENSORS];
        let k = problem.sensors;
        let mut twins = false;
        for y in 0..k {
            // The next lower twin other than `top`.
            let lower = (0..y).rev().find(|&x| x != top && y != top && twin(problem, x) == twin(problem, y));
            twins |= twin(problem, y) != y;
            if let Some(x) = lower {
                after[y] = x as u8 + 1;
            }
        }
        // Blocks as wholes, by the first sensor of each, which is the first to fire once twins are sorted.
        if block_size(problem).is_some() {
            let mut before = None;
            for y in 0..k {
                if twin(problem, y) != y || problem.conflict(y, top) || y == top {
                    continue;
                }
                if let Some(x) = before {
                    after[y] = x as u8 + 1;
                }
                before = Some(y);
            }
        } else if !twins && k > 2 {
            // The mirror image with `top` in place.
            let (left, right) = ((top + k - 1) % k, (top + 1) % k);
            if left != right && keeps_conflicts(problem, |i| (2 * top + k - i) % k) {
                after[left] = right as u8 + 1;
            }
        }
        Self { after }
    }

    /// The pairs.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.after.iter().enumerate().filter(|&(_, &x)| x > 0).map(|(y, &x)| (usize::from(x) - 1, y))
    }
}
