//! The sensors whose rank of `|d|` is decided so far, from the smallest up and from the largest down.
//!
//! Indices: each sensor is ranked at most once, at one end, so that `lows` and `highs` stay at most at `MAX_SENSORS`.

use super::decision::Branch;
use crate::schedule::MAX_SENSORS;

/// The sensors whose rank of `|d|` is decided, from both ends.
pub(super) struct Ranks {
    low: [u8; MAX_SENSORS],
    high: [u8; MAX_SENSORS],
    lows: usize,
    highs: usize,
    pub(super) ranked: u64,
    pub(super) negative: u64,
}

impl Ranks {
    pub(super) const NONE: Self =
        Self { low: [0; MAX_SENSORS], high: [0; MAX_SENSORS], lows: 0, highs: 0, ranked: 0, negative: 0 };

    pub(super) fn clear(&mut self) {
        *self = Self::NONE;
    }

    /// The ranked sensors with the smallest `|d|`, ascending.
    pub(super) fn lows(&self) -> &[u8] {
        &self.low[..self.lows]
    }

    /// The ranked sensors with the largest `|d|`, descending.
    pub(super) fn highs(&self) -> &[u8] {
        &self.high[..self.highs]
    }

    pub(super) fn push(&mut self, branch: Branch, sensor: u8, negative: bool) {
        if branch == Branch::Low {
            self.low[self.lows] = sensor;
            self.lows += 1;
        } else {
            self.high[self.highs] = sensor;
            self.highs += 1;
        }
        self.ranked |= 1 << sensor;
        self.negative |= u64::from(negative) << sensor;
    }

    pub(super) fn pop(&mut self, branch: Branch) {
        let sensor = if branch == Branch::Low {
            self.lows -= 1;
            self.low[self.lows]
        } else {
            self.highs -= 1;
            self.high[self.highs]
        };
        self.ranked &= !(1 << sensor);
        self.negative &= !(1 << sensor);
    }
}
