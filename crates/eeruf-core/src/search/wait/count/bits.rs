//! Sets of waits as bits of a word.

use super::super::Problem;

/// The longest wait for which a set of waits fits a word.
pub(super) const MASK_MAX: u32 = 63;

/// The waits a with `a - b = d` for which both waits are left to the sensor and `s = 2 a - d` is free.
#[inline]
pub(super) fn waits_with(d: i32, left: [u64; 2], s: [u64; 2], paper: bool) -> u64 {
    let waits = left[0] & shifted(left[1], d);
    if !paper {
        return waits;
    }
    let odd = d & 1;
    waits & shifted(s[odd as usize], (d + odd) / 2)
}

/// The distance within which a value excludes others: `D - 1`, but at most [`MASK_MAX`].
pub(super) fn reach(problem: &Problem<'_>) -> i32 {
    problem.separation.min(MASK_MAX + 1) as i32 - 1
}

/// Shifts bits up by `by`, or down if it is negative; `|by|` is at most 63.
#[inline]
const fn shifted(bits: u64, by: i32) -> u64 {
    if by >= 0 { bits << by } else { bits >> -by }
}

/// Bits `low ..= high`, clipped to the word; none if `low > high`.
#[inline]
pub(super) const fn span(low: i32, high: i32) -> u64 {
    below(high + 1) & !below(low)
}

/// The bits below bit `end`.
#[inline]
const fn below(end: i32) -> u64 {
    if end <= 0 {
        0
    } else if end >= 64 {
        u64::MAX
    } else {
        (1 << end) - 1
    }
}

/// The waits that remain to sensor `j`, in the same phase and in the other one, if sensor `i` has this wait.
pub(super) fn left_by(problem: &Problem<'_>, i: usize, j: usize, wait: i32) -> (u64, u64) {
    let (interval, period) = (problem.interval as i32, problem.period as i32);
    // When i fires, as a wait of j.
    let at = problem.lag[i] as i32 - problem.lag[j] as i32 + wait;
    (!span(at - interval + 1, at + interval - 1), span(at + interval - period, at + period - interval))
}
