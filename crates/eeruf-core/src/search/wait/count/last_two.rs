//! The last two sensors at once: pairs of waits as bits of a few words.
//!
//! With waits up to 15 ticks a sensor has at most 256 pairs `(a, b)`; pair number `a (wait_max + 1) + b` is one bit.
//! What one sensor leaves to the next is then an AND of words, and the tables below a pair of the last sensor but one
//! are a count of bits.

use super::super::Problem;
use super::bits::{left_by, reach, span};
use crate::conditions::Criterion;
use crate::search::common::Members;

/// The most pairs of waits that a set of them may need.
const PAIRS: usize = 256;
/// The most waits.
const WAITS: usize = 16;

/// A set of pairs of waits.
pub(super) type Set<const N: usize> = [u64; N];

/// What a pair of one sensor leaves to any other, and of the last but one to the last.
pub(super) struct LastTwo<const N: usize> {
    /// Waits a sensor has: `wait_max + 1`.
    waits: usize,
    /// By pair: the pairs separated from it.
    separate: [Set<N>; PAIRS],
    /// By wait a of the last sensor but one: the pairs of the last that fire far enough from it; and by wait b.
    in_time: [[Set<N>; WAITS]; 2],
}

/// Words that the pairs of waits up to `wait_max` take; `None` if there are too many.
pub(super) const fn words(wait_max: u32) -> Option<usize> {
    let waits = wait_max as usize + 1;
    if wait_max as usize >= WAITS { None } else { Some((waits * waits).div_ceil(64)) }
}

// Indices: waits are below `waits <= WAITS`, pairs below its square, words below N, which `words` gave.
impl<const N: usize> LastTwo<N> {
    pub(super) fn new(problem: &Problem<'_>) -> Self {
        let waits = problem.wait_max as usize + 1;
        Self { waits, separate: Self::separate(problem, waits), in_time: [[[0; N]; WAITS]; 2] }
    }

    fn separate(problem: &Problem<'_>, waits: usize) -> [Set<N>; PAIRS] {
        let mut separate = [[0; N]; PAIRS];
        if N == 0 {
            // Too many pairs: there are no sets.
            return separate;
        }
        let reach = reach(problem);
        let row = span(0, waits as i32 - 1);
        for a in 0..waits as i32 {
            for b in 0..waits as i32 {
                let (d, s) = ((a - b).abs(), a + b);
                for c in 0..waits as i32 {
                    // Pairs (c, e): too close where |c - e| is within reach of d, or c + e of s.
                    let mut close = span(c - d - reach, c - d + reach) | span(c + d - reach, c + d + reach);
                    if problem.criterion == Criterion::Paper {
                        close |= span(s - c - reach, s - c + reach);
                    }
                    put(&mut separate[a as usize * waits + b as usize], c as usize * waits, row & !close);
                }
            }
        }
        separate
    }

    /// Stores what the firings of sensor `i` leave to sensor `j`, which conflict.
    pub(super) fn set_pair(&mut self, problem: &Problem<'_>, near: Option<(usize, usize)>) {
        let all = self.rectangle([u64::MAX; 2]);
        for wait in 0..self.waits {
            for phase in 0..2 {
                self.in_time[phase][wait] = match near {
                    None => all,
                    Some((i, j)) => {
                        let (same, across) = left_by(problem, i, j, wait as i32);
                        self.rectangle(if phase == 0 { [same, across] } else { [across, same] })
                    }
                };
            }
        }
    }

    pub(super) const fn waits(&self) -> usize {
        self.waits
    }

    /// The pairs with waits a and b in these sets.
    pub(super) fn rectangle(&self, left: [u64; 2]) -> Set<N> {
        let mut set = [0; N];
        let all = span(0, self.waits as i32 - 1);
        for a in Members(left[0] & all) {
            put(&mut set, a * self.waits, left[1] & all);
        }
        set
    }

    /// The pairs that stay separated from a pair placed.
    pub(super) fn without(&self, free: &Set<N>, pair: usize) -> Set<N> {
        both(free, &self.separate[pair])
    }

    /// The tables with the last sensor but one at a pair of `own` and the last at a pair of `last`, both separated from
    /// what is placed.
    pub(super) fn count(&self, own: &Set<N>, last: &Set<N>) -> u32 {
        let mut tables = 0;
        let waits = self.waits as u32;
        for (k, &word) in own.iter().enumerate() {
            for bit in Members(word) {
                let pair = 64 * k + bit;
                let (a, b) = ((pair as u32 / waits) as usize, (pair as u32 % waits) as usize);
                let (separate, by_a, by_b) = (&self.separate[pair], &self.in_time[0][a], &self.in_time[1][b]);
                for n in 0..N {
                    tables += (last[n] & separate[n] & by_a[n] & by_b[n]).count_ones();
                }
            }
        }
        tables
    }
}

fn both<const N: usize>(x: &Set<N>, y: &Set<N>) -> Set<N> {
    let mut set = *x;
    for n in 0..N {
        set[n] &= y[n];
    }
    set
}

/// Puts the bits of a row, at most 16, into a set, from bit `at` on.
fn put<const N: usize>(set: &mut Set<N>, at: usize, row: u64) {
    let (word, bit) = (at / 64, at % 64);
    if let Some(low) = set.get_mut(word) {
        *low |= row << bit;
    }
    if let (Some(high), true) = (set.get_mut(word + 1), bit > 0) {
        *high |= row >> (64 - bit);
    }
}
