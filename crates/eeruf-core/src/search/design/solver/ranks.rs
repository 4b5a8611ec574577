//! The sensors whose rank of `|d|` is decided so far, from the largest down.
//!
//! Indices: each sensor is ranked at most once, so that there are at most `MAX_SENSORS`.

use crate::schedule::MAX_SENSORS;

/// The sensors whose rank of `|d|` is decided.
#[derive(Clone, Copy)]
pub(super) struct Ranks {
    sensors: [u8; MAX_SENSORS],
    count: usize,
    pub(super) ranked: u64,
    pub(super) negative: u64,
}

impl Ranks {
    pub(super) const NONE: Self = Self { sensors: [0; MAX_SENSORS], count: 0, ranked: 0, negative: 0 };

    /// The ranked sensors, descending.
    pub(super) fn highs(&self) -> &[u8] {
        &self.sensors[..self.count]
    }

    pub(super) fn push(&mut self, sensor: u8, negative: bool) {
        self.sensors[self.count] = sensor;
        self.count += 1;
        self.ranked |= 1 << sensor;
        self.negative |= u64::from(negative) << sensor;
    }

    pub(super) fn pop(&mut self) {
        self.count -= 1;
        let sensor = self.sensors[self.count];
        self.ranked &= !(1 << sensor);
        self.negative &= !(1 << sensor);
    }
}
