//! A small generator for restarts: the same numbers on each target, from a fixed seed.

/// Marsaglia's xorshift on 64 bits.
#[derive(Clone, Copy)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11
    }

    /// A number below `below`, which is at least 1.
    pub(crate) fn below(&mut self, below: u32) -> u32 {
        (((self.next() & 0xffff_ffff) * u64::from(below)) >> 32) as u32
    }
}
