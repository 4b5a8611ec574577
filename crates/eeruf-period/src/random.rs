//! Seeded pseudo-random numbers, the same on every machine.

/// A stream of pseudo-random numbers: `SplitMix64` (Steele, Lea and Flood, 2014), whose finaliser also serves as the
/// hash behind [`Random::of`].
#[derive(Clone, Copy, Debug)]
pub struct Random(u64);

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

#[inline]
const fn mix(state: u64) -> u64 {
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Random {
    /// The stream that a seed starts.
    pub const fn new(seed: u64) -> Self {
        Self(mix(seed.wrapping_add(GOLDEN)))
    }

    /// The stream from a raw state of the published generator, for draws that others must be able to repeat.
    pub const fn from_state(state: u64) -> Self {
        Self(state)
    }

    /// The stream of a key within this stream, which does not advance.
    #[inline]
    pub const fn of(self, key: u64) -> Self {
        Self(mix(self.0 ^ key.wrapping_add(1).wrapping_mul(GOLDEN)))
    }

    /// The next 64 bits.
    #[inline]
    pub const fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mix(self.0)
    }

    /// A number from `low` to below `high`, uniformly.
    #[inline]
    pub const fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_different_keys_differ_and_of_the_same_key_agree() {
        let random = Random::new(1);
        assert_eq!(random.of(5).bits(), random.of(5).bits());
        assert_ne!(random.of(5).bits(), random.of(6).bits());
        assert_ne!(Random::new(2).of(5).bits(), random.of(5).bits());
    }
}
