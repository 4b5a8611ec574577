//! [`Random`]: seeded pseudo-random numbers, the same on every machine.

use std::cell::Cell;

/// SplitMix64 (Steele, Lea and Flood, 2014).
#[derive(Clone, Debug)]
pub struct Random(Cell<u64>);

impl Random {
    /// From a seed.
    pub const fn new(seed: u64) -> Self {
        Self(Cell::new(seed))
    }

    /// Any number.
    pub fn any(&self) -> u64 {
        let state = self.0.get().wrapping_add(0x9e37_79b9_7f4a_7c15);
        self.0.set(state);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From `least` to `most`.
    pub fn within(&self, least: u32, most: u32) -> u32 {
        let width = u64::from(most - least) + 1;
        // Less than 2^32.
        least + (self.any() % width) as u32
    }

    /// Once in so many times.
    pub fn once_in(&self, times: u32) -> bool {
        self.within(1, times) == 1
    }

    /// A duration of any order of magnitude up to `most`.
    pub fn duration(&self, most: u32) -> u32 {
        let bits = self.within(0, 32 - most.leading_zeros());
        ((self.any() & 0xffff_ffff) as u32).checked_shr(32 - bits).unwrap_or(0).min(most)
    }

    /// One of these.
    pub fn one_of<T: Copy>(&self, these: &[T]) -> T {
        these[self.within(0, these.len() as u32 - 1) as usize]
    }
}
