//! Chance: how echoes fade and jitter, when a burst from outside comes, and the generator behind both.
//!
//! What happens to one arrival is a function of the seed, the firing and the path alone ([`Chance::of`]), so that it does not
//! depend on the order in which arrivals are looked at, on the method that is simulated, or on the number of threads.

use std::sync::LazyLock;

use crate::world::WorldError;

/// How noisy a world is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Root mean square by which each arrival's level fades or grows, in dB.
    pub fading_db_rms: f64,
    /// Root mean square by which each arrival is early or late, in microseconds.
    pub jitter_us_rms: f64,
    /// How many bursts from outside (compressed air, keys, another make of sensor) are heard in a second, on average.
    pub bursts_per_s: f64,
    /// How far they are above what is just heard, in dB.
    pub burst_db: f64,
}

impl Default for Noise {
    /// 1.5 dB, 15 us, no bursts.
    fn default() -> Self {
        Self { fading_db_rms: 1.5, jitter_us_rms: 15.0, bursts_per_s: 0.0, burst_db: 20.0 }
    }
}

impl Noise {
    /// None at all.
    pub const NONE: Self = Self { fading_db_rms: 0.0, jitter_us_rms: 0.0, bursts_per_s: 0.0, burst_db: 0.0 };

    pub(crate) fn check(&self) -> Result<(), WorldError> {
        for (field, value, most, expected) in [
            ("fading_db_rms", self.fading_db_rms, 20.0, "0 to 20"),
            ("jitter_us_rms", self.jitter_us_rms, 10_000.0, "0 to 10000"),
            ("bursts_per_s", self.bursts_per_s, 10_000.0, "0 to 10000"),
        ] {
            if !(0.0..=most).contains(&value) {
                return Err(WorldError::Noise { field, value, expected });
            }
        }
        if !(-200.0..=200.0).contains(&self.burst_db) {
            return Err(WorldError::Noise { field: "burst_db", value: self.burst_db, expected: "-200 to 200" });
        }
        Ok(())
    }
}

/// A source of chance: `SplitMix64` (Steele, Lea and Flood, 2014), whose finaliser also serves as the hash behind
/// [`Chance::of`].
#[derive(Clone, Copy, Debug)]
pub struct Chance(u64);

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

#[inline]
const fn mix(state: u64) -> u64 {
    let mut z = state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Chance {
    /// The stream that a seed starts.
    pub const fn new(seed: u64) -> Self {
        Self(mix(seed.wrapping_add(GOLDEN)))
    }

    /// The stream that belongs to a key within this one; this one does not advance.
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

    /// Evenly from `low` to below `high`.
    #[inline]
    pub const fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// The time to the next event of a Poisson process that has `rate` events in a unit of time on average.
    pub fn until_next(&mut self, rate: f64) -> f64 {
        // From above 0 to 1.
        let share = ((self.bits() >> 11) + 1) as f64 / (1u64 << 53) as f64;
        -libm::log(share) / rate
    }
}

/// How many equal shares the normal distribution is cut into.
const SHARES: usize = 1024;
/// No normal number drawn here is farther from zero: one in 16,000 would be.
pub(crate) const FARTHEST: f32 = 4.0;

/// Draws two normal numbers at a time from a table of the distribution's quantiles, straight between two of them.
#[derive(Debug)]
pub(crate) struct Normal([f32; SHARES + 1]);

impl Normal {
    /// The table, made when it is first asked for.
    pub(crate) fn shared() -> &'static Self {
        static NORMAL: LazyLock<Normal> = LazyLock::new(Normal::new);
        &NORMAL
    }

    fn new() -> Self {
        let mut quantiles = [0.0; SHARES + 1];
        for (i, quantile) in quantiles.iter_mut().enumerate() {
            *quantile = match i {
                0 => -FARTHEST,
                SHARES => FARTHEST,
                _ => quantile_of(i as f64 / SHARES as f64) as f32,
            };
        }
        Self(quantiles)
    }

    /// Two independent numbers of mean 0 and standard deviation 1 from 64 random bits.
    #[inline]
    pub(crate) fn pair(&self, bits: u64) -> [f32; 2] {
        [self.one((bits >> 32) as u32), self.one(bits as u32)]
    }

    #[inline]
    fn one(&self, bits: u32) -> f32 {
        // The upper ten bits name a share, so the index and the next are in range.
        let share = (bits >> 22) as usize;
        let within = (bits & 0x3f_ffff) as f32 / 4_194_304.0;
        let (low, high) = (self.0[share], self.0[share + 1]);
        low + (high - low) * within
    }
}

/// The standard normal number that a share `p` lies below, by bisection of the error function.
fn quantile_of(p: f64) -> f64 {
    let (mut low, mut high) = (-f64::from(FARTHEST), f64::from(FARTHEST));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if 0.5 * libm::erfc(-middle * core::f64::consts::FRAC_1_SQRT_2) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_mean_zero_and_standard_deviation_one() {
        let (normal, mut chance) = (Normal::new(), Chance::new(3));
        let n = 200_000;
        let (mut sum, mut squares, mut beyond_two, mut product) = (0.0, 0.0, 0, 0.0);
        for _ in 0..n {
            let [a, b] = normal.pair(chance.bits()).map(f64::from);
            sum += a + b;
            squares += a * a + b * b;
            product += a * b;
            beyond_two += u32::from(a.abs() > 2.0);
        }
        let n = f64::from(n);
        assert!((sum / n).abs() < 0.01 && (squares / n / 2.0 - 1.0).abs() < 0.01 && (product / n).abs() < 0.01);
        assert!((f64::from(beyond_two) / n - 0.0455).abs() < 0.003);
    }

    #[test]
    fn streams_of_different_keys_differ_and_of_the_same_key_agree() {
        let chance = Chance::new(1);
        assert_eq!(chance.of(5).bits(), chance.of(5).bits());
        assert_ne!(chance.of(5).bits(), chance.of(6).bits());
        assert_ne!(Chance::new(2).of(5).bits(), chance.of(5).bits());
    }

    #[test]
    fn bursts_come_as_often_as_asked() {
        let mut chance = Chance::new(9);
        let total: f64 = (0..50_000).map(|_| chance.until_next(20.0)).sum();
        assert!((total / 50_000.0 - 0.05).abs() < 0.001);
    }
}
