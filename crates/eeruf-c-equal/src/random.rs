//! [`Random`]: seeded pseudo-random numbers, the same on every machine, or numbers from a fuzzer's bytes.

use std::cell::Cell;
use std::fmt;
use std::rc::Rc;

/// Numbers from a seed, or from bytes.
#[derive(Clone, Debug)]
pub struct Random(Source);

#[derive(Clone, Debug)]
enum Source {
    /// SplitMix64 (Steele, Lea and Flood, 2014): the seed and the state.
    Seed(u64, Cell<u64>),
    /// Bytes, and the number taken so far; clones share both.
    Bytes(Rc<[u8]>, Rc<Cell<usize>>),
}

impl fmt::Display for Random {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Source::Seed(seed, _) => write!(f, "seed {seed}"),
            Source::Bytes(bytes, taken) => write!(f, "byte {} of {}", taken.get(), bytes.len()),
        }
    }
}

impl Random {
    /// Creates a generator that draws from a seed.
    pub const fn new(seed: u64) -> Self {
        Self(Source::Seed(seed, Cell::new(seed)))
    }

    /// Creates a generator that draws from bytes, little-endian, as many as each number needs. Past the end all are 0.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self(Source::Bytes(bytes.into(), Rc::default()))
    }

    /// Returns true if the bytes are used up; never with a seed.
    pub fn is_over(&self) -> bool {
        matches!(&self.0, Source::Bytes(bytes, taken) if taken.get() >= bytes.len())
    }

    /// Draws any number.
    pub fn any(&self) -> u64 {
        self.any_of(8)
    }

    /// Any number; a byte source fills only its lowest `count` bytes.
    fn any_of(&self, count: usize) -> u64 {
        match &self.0 {
            Source::Seed(_, state) => {
                state.set(state.get().wrapping_add(0x9e37_79b9_7f4a_7c15));
                let z = state.get();
                let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                z ^ (z >> 31)
            }
            Source::Bytes(bytes, taken) => {
                let begin = taken.replace(taken.get() + count);
                let rest = bytes.get(begin..).unwrap_or_default();
                rest.iter().take(count).rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
            }
        }
    }

    /// Draws a number from `least` to `most`.
    pub fn within(&self, least: u32, most: u32) -> u32 {
        let width = u64::from(most - least) + 1;
        let bytes = (u64::BITS - (width - 1).leading_zeros()).div_ceil(8) as usize;
        // Less than 2^32.
        least + (self.any_of(bytes) % width) as u32
    }

    /// Returns true once in this many times on average.
    pub fn once_in(&self, times: u32) -> bool {
        self.within(1, times) == 1
    }

    /// Draws a duration of any order of magnitude up to `most`.
    pub fn duration(&self, most: u32) -> u32 {
        let bits = self.within(0, 32 - most.leading_zeros());
        ((self.any_of(4) & 0xffff_ffff) as u32).checked_shr(32 - bits).unwrap_or(0).min(most)
    }

    /// Draws one of these values.
    pub fn one_of<T: Copy>(&self, these: &[T]) -> T {
        these[self.within(0, these.len() as u32 - 1) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_give_as_many_as_a_number_needs_and_then_noughts() {
        let r = Random::of_bytes(&[7, 0x34, 0x12, 9, 1, 2, 3]);
        assert_eq!((r.within(5, 5), r.within(0, 9), r.within(0, 0xffff)), (5, 7, 0x1234));
        assert_eq!((r.clone().within(0, 255), r.within(0, 255), r.is_over()), (9, 1, false));
        assert_eq!((r.any(), r.is_over(), r.any()), (0x0302, true, 0));
    }

    #[test]
    fn a_seed_gives_the_numbers_of_splitmix64() {
        // The first number of the reference implementation for the seed 1,234,567.
        assert_eq!(Random::new(1_234_567).any(), 6_457_827_717_110_365_317);
        assert!(!Random::new(0).is_over());
    }
}
