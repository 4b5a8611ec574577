//! Spread of a figure over many runs.

use serde::Serialize;

use crate::{results::quantile, world::Random};

/// Quantiles of a figure over many runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The value that one run in ten does not exceed.
    pub p10: f64,
    /// The value that half of the runs do not exceed.
    pub median: f64,
    /// The value that nine runs in ten do not exceed.
    pub p90: f64,
    /// 95 % confidence interval of the median, by bootstrap.
    pub median_95: [f64; 2],
    /// 95 % confidence interval of `p90`, by bootstrap.
    pub p90_95: [f64; 2],
    /// The mean over the runs.
    pub mean: f64,
    /// 95 % confidence interval of `mean`, by bootstrap.
    pub mean_95: [f64; 2],
}

/// Number of samples that the bootstrap draws.
const SAMPLES: usize = 1000;
/// Seed of the bootstrap, so that equal values have equal intervals.
const SEED: u64 = 1979;

impl Spread {
    /// Computes the quantiles of some values; `None` without any.
    ///
    /// ```
    /// use eeruf_sim::experiments::Spread;
    /// let spread = Spread::of((1..=10).map(f64::from)).unwrap();
    /// assert_eq!((spread.p10, spread.median, spread.p90, spread.mean), (1.0, 5.0, 9.0, 5.5));
    /// assert_eq!(Spread::of([]), None);
    /// ```
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<_> = values.into_iter().collect();
        let mut at = |share| quantile(&mut values, share);
        let (p10, median, p90) = (at(0.1), at(0.5), at(0.9));
        let interval = |share| interval_95(&values, |sample| quantile(sample, share));
        let (median_95, p90_95) = (interval(0.5), interval(0.9));
        let (mean, mean_95) = (mean(&values), interval_95(&values, |sample| mean(sample)));
        (!values.is_empty()).then_some(Self { p10, median, p90, median_95, p90_95, mean, mean_95 })
    }
}

/// Returns the mean of some values; 0 without any.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Returns the 95 % interval of a figure by the percentile bootstrap (Efron, 1979); `[0, 0]` without values.
pub(super) fn interval_95(values: &[f64], figure: impl Fn(&mut [f64]) -> f64) -> [f64; 2] {
    if values.is_empty() {
        return [0.0; 2];
    }
    let mut random = Random::new(SEED);
    let mut sample = vec![0.0; values.len()];
    let mut draw = || {
        for drawn in &mut sample {
            *drawn = values[(random.bits() % values.len() as u64) as usize];
        }
        figure(&mut sample)
    };
    let mut figures: Vec<_> = (0..SAMPLES).map(|_| draw()).collect();
    [0.025, 0.975].map(|share| quantile(&mut figures, share))
}

/// Returns the 95 % confidence interval of a share seen in `count` of `of` trials: Wilson's interval (E. B. Wilson,
/// "Probable inference, the law of succession, and statistical inference", J. Am. Stat. Assoc. 22, 1927). Unlike the
/// bootstrap's, it has a width even if the share is 0 or 1.
pub(super) fn share_95(count: usize, of: usize) -> [f64; 2] {
    if of == 0 {
        return [0.0, 1.0];
    }
    const Z: f64 = 1.959_964;
    let (n, share) = (of as f64, count as f64 / of as f64);
    let middle = share + Z * Z / (2.0 * n);
    let half = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    [-1.0, 1.0].map(|side| ((middle + side * half) / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_share_is_wilsons() {
        // The interval is defined by this quadratic at both ends: (share - p)^2 = z^2 p (1 - p) / n.
        for (count, of) in [(0, 100), (1, 100), (50, 100), (97, 100), (100, 100), (3, 7)] {
            let share = count as f64 / of as f64;
            for p in share_95(count, of) {
                let off = (share - p) * (share - p) - 1.959_964 * 1.959_964 * p * (1.0 - p) / of as f64;
                assert!(off.abs() < 1e-12, "{count} of {of}: {p}");
            }
        }
        assert!(share_95(100, 100)[0] < 0.97 && share_95(0, 100)[1] > 0.03);
    }

    // The interval of a median contains it and narrows with more values.
    #[test]
    fn interval_of_a_median_holds_it_and_narrows() {
        let of = |count: u32| Spread::of((0..count).map(|n| f64::from(n * 7919 % count) / f64::from(count))).unwrap();
        let (few, many) = (of(50), of(5000));
        for spread in [few, many] {
            let [low, high] = spread.median_95;
            assert!(low <= spread.median && spread.median <= high && (low..=high).contains(&0.5), "{spread:?}");
        }
        let width = |spread: &Spread| spread.median_95[1] - spread.median_95[0];
        assert!(width(&many) < width(&few) / 5.0);
        // The interval of the median of n evenly spread values reaches 1.96 / sqrt(4 n) to either side.
        assert!((width(&many) - 2.0 * 1.96 / 20_000_f64.sqrt()).abs() < 0.006, "{}", width(&many));
    }
}
