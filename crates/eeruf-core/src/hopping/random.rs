//! [`SmallRandom`]: the draws of new lags, the same on every machine.

/// A xorshift generator of 32 bits (Marsaglia, 2003): four bytes, no multiplication.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct SmallRandom(u32);

impl SmallRandom {
    pub(super) const fn new(seed: u32) -> Self {
        // A state of 0 would stay 0.
        Self(if seed == 0 { 0x9e37_79b9 } else { seed })
    }

    /// Evenly from 0 to `most`, which is at most 2^28.
    pub(super) fn up_to(&mut self, most: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        ((u64::from(self.0) * (u64::from(most) + 1)) >> 32) as u32
    }
}
