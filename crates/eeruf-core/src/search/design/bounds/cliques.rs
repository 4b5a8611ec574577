//! Sets of sensors that all conflict with each other: how large they are, and how many cover a ring or any other
//! layout.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::super::problem::CheckedProblem;
use super::super::symmetry;
use crate::search::common::Members;

/// A large clique among the sensors `from`, with sensor `first`: greedily, upwards.
fn grow(problem: &CheckedProblem, first: usize, from: u64) -> u64 {
    let mut clique = 1u64 << first;
    let mut common = problem.conflicts[first] & from;
    while let Some(x) = Members(common).next() {
        clique |= 1 << x;
        common &= problem.conflicts[x];
    }
    clique
}

/// The size of a large clique, and a number of cliques that cover all sensors.
pub(crate) fn cliques(problem: &CheckedProblem) -> (u32, u32) {
    let size = |x: usize, from: u64| grow(problem, x, from).count_ones();
    let largest = (0..problem.sensors).map(|x| size(x, u64::MAX << x).max(size(x, u64::MAX))).max();
    let mut left = problem.all();
    let mut cover = 0;
    while let Some(x) = Members(left).next() {
        left &= !grow(problem, x, left);
        cover += 1;
    }
    (largest.unwrap_or(1), cover)
}

/// The size of a large clique, and a number of disjoint cliques of that size, at least 1.
pub(crate) fn disjoint_cliques(problem: &CheckedProblem) -> (u32, u32) {
    let (size, _) = cliques(problem);
    let mut left = problem.all();
    let mut count = 0;
    for x in 0..problem.sensors {
        let clique = if left >> x & 1 == 1 { grow(problem, x, left) } else { 0 };
        if clique.count_ones() == size {
            left &= !clique;
            count += 1;
        }
    }
    (size, count.max(1))
}

/// On a ring where a sensor conflicts with the next n - 1 on both sides: `K / n` rounded down, as independent sensors
/// are n apart all round.
pub(super) fn ring_at_once(problem: &CheckedProblem) -> Option<u32> {
    let k = problem.sensors as u32;
    // Sensor 0 itself and those that follow it without a gap, so at most k.
    let n = (problem.conflicts[0] >> 1).trailing_ones() + 1;
    (n > 1 && symmetry::is_ring(problem)).then(|| k / n)
}
