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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_draws_of_a_seed_are_those_of_the_generator() {
        // The first numbers of the generator by its shifts 13, 17 and 5.
        for (seed, numbers) in [
            (1_u32, [270_369_u32, 67_634_689, 2_647_435_461, 307_599_695, 2_398_689_233]),
            (7, [1_892_583, 470_389_255, 3_882_205_507, 3_069_989_445, 2_854_842_367]),
        ] {
            let (mut random, most) = (SmallRandom::new(seed), 1 << 28);
            for number in numbers {
                let expected = (u64::from(number) * ((1 << 28) + 1)) >> 32;
                assert_eq!(u64::from(random.up_to(most)), expected, "seed {seed}");
            }
        }
    }

    #[test]
    fn drawn_numbers_are_uniform_whatever_the_seed() {
        for seed in [0, 1, 7, u32::MAX] {
            let mut random = SmallRandom::new(seed);
            assert_eq!(random.up_to(0), 0);
            let mut drawn = [0_u32; 10];
            for _ in 0..10_000 {
                drawn[random.up_to(9) as usize] += 1;
            }
            assert!(drawn.iter().all(|times| times.abs_diff(1000) < 150), "seed {seed}: {drawn:?}");
        }
    }
}
