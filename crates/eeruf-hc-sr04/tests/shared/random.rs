//! Random numbers that are the same in each run.

/// xorshift32.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    /// From 0 to `most`.
    pub(crate) fn up_to(&mut self, most: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 % (most + 1)
    }
}
