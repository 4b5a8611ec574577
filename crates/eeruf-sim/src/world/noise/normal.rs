//! Normally distributed numbers from a table of quantiles.

use std::sync::LazyLock;

/// Number of equal parts of the normal distribution in the table.
const SHARES: usize = 1024;
/// Largest magnitude of a drawn number; one normal number in 16,000 would exceed it.
pub(crate) const FARTHEST: f32 = 4.0;

/// A generator of normal numbers from a table of the distribution's quantiles, interpolated linearly.
#[derive(Debug)]
pub(crate) struct Normal([f32; SHARES + 1]);

impl Normal {
    /// Returns the table, which is made on demand.
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

    /// Returns two independent numbers of mean 0 and standard deviation 1 from 64 random bits.
    #[inline]
    pub(crate) fn pair(&self, bits: u64) -> [f32; 2] {
        [self.one((bits >> 32) as u32), self.one(bits as u32)]
    }

    #[inline]
    fn one(&self, bits: u32) -> f32 {
        // The upper ten bits select a share, so the index and the next are in range.
        let share = (bits >> 22) as usize;
        let within = (bits & 0x3f_ffff) as f32 / 4_194_304.0;
        let (low, high) = (self.0[share], self.0[share + 1]);
        low + (high - low) * within
    }
}

/// Returns the standard normal number below which a share `p` lies, by bisection of the error function.
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
    use eeruf_period::Random;

    #[test]
    fn normal_numbers_have_mean_zero_and_standard_deviation_one() {
        let (normal, mut random) = (Normal::new(), Random::new(3));
        let n = 200_000;
        let (mut sum, mut squares, mut beyond_two, mut product) = (0.0, 0.0, 0, 0.0);
        for _ in 0..n {
            let [a, b] = normal.pair(random.bits()).map(f64::from);
            sum += a + b;
            squares += a * a + b * b;
            product += a * b;
            beyond_two += u32::from(a.abs() > 2.0);
        }
        let n = f64::from(n);
        assert!((sum / n).abs() < 0.01 && (squares / n / 2.0 - 1.0).abs() < 0.01 && (product / n).abs() < 0.01);
        assert!((f64::from(beyond_two) / n - 0.0455).abs() < 0.003);
    }
}
