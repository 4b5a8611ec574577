//! [`Difference`]: two methods compared scene by scene.

use serde::Serialize;

use super::spread::{interval_95, mean};
use crate::results::quantile;

/// Difference of a figure between two methods on the same scenes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Number of scenes in which both methods have the figure.
    pub pairs: usize,
    /// Mean difference.
    pub mean: f64,
    /// 95 % confidence interval of the mean, by the percentile bootstrap over scenes.
    pub mean_95: [f64; 2],
    /// Median difference.
    pub median: f64,
    /// A confidence interval of the median of at least 95 %: the interval of the sign test, exact for any distribution.
    /// `None` for fewer than six scenes, which are too few for one.
    pub median_95: Option<[f64; 2]>,
    /// Number of scenes in which the difference is below 0.
    pub less: usize,
    /// Number of scenes in which the difference is above 0.
    pub more: usize,
    /// Two-sided p-value of the exact sign test over the scenes that differ; 1 without any.
    pub p_sign: f64,
}

impl Difference {
    /// Computes the figures from the differences, one for each scene; `None` if there are none.
    ///
    /// ```
    /// use eeruf_sim::experiments::Difference;
    /// let found = Difference::of([-3.0, -1.0, -4.0, -1.0, 5.0, -9.0]).unwrap();
    /// assert_eq!((found.median, found.median_95, found.less), (-3.0, Some([-9.0, 5.0]), 5));
    /// assert_eq!(found.p_sign, 2.0 * 7.0 / 64.0);
    /// ```
    pub fn of(differences: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<_> = differences.into_iter().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let pairs = sorted.len();
        let (less, more) = (sorted.partition_point(|x| *x < 0.0), pairs - sorted.partition_point(|x| *x <= 0.0));
        let median_95 = outside(pairs).map(|outside| [sorted[outside], sorted[pairs - 1 - outside]]);
        let (mean, mean_95) = (mean(&sorted), interval_95(&sorted, |sample| mean(sample)));
        let p_sign = (2.0 * at_most(less.min(more), less + more)).min(1.0);
        let median = quantile(&mut sorted, 0.5);
        (pairs > 0).then_some(Self { pairs, mean, mean_95, median, median_95, less, more, p_sign })
    }
}

/// Returns the number of the `n` values on either side of the sign test's 95 % interval of the median.
fn outside(n: usize) -> Option<usize> {
    let mut below = 0.0;
    let beyond = (0..n).find(|&k| {
        below += share(k, n);
        below > 0.025
    });
    beyond.and_then(|beyond| beyond.checked_sub(1))
}

/// Returns the probability of at most `k` heads in `n` throws of a coin.
fn at_most(k: usize, n: usize) -> f64 {
    (0..=k).map(|k| share(k, n)).sum()
}

/// Returns the probability of `k` heads in `n` throws.
fn share(k: usize, n: usize) -> f64 {
    if n < 50 {
        let choose = (0..k).fold(1.0, |choose, k| choose * (n - k) as f64 / (k + 1) as f64);
        return choose.round() * libm::pow(0.5, n as f64);
    }
    let ln = |n: usize| libm::lgamma(n as f64 + 1.0);
    libm::exp(ln(n) - ln(k) - ln(n - k) - n as f64 * core::f64::consts::LN_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sign_interval_follows_the_published_table() {
        // Ranks of the 95 % interval of a median, Conover, Practical Nonparametric Statistics.
        for (n, rank) in [(6, 1), (8, 1), (9, 2), (12, 3), (20, 6), (30, 10), (50, 18), (100, 40)] {
            assert_eq!(outside(n), Some(rank - 1), "{n}");
        }
        assert_eq!(outside(5), None);
        assert!((share(30, 60) - 0.102_578_173).abs() < 1e-9 && (at_most(60, 60) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn median_interval_covers_the_median_of_any_distribution() {
        let mut random = crate::world::Random::new(3);
        let mut covered = 0;
        for _ in 0..2_000 {
            // Skewed: the median of e^(3 u) - e^1.5 is 0.
            let drawn = (0..25).map(|_| libm::exp(3.0 * random.between(0.0, 1.0)) - libm::exp(1.5));
            let [low, high] = Difference::of(drawn).unwrap().median_95.unwrap();
            covered += usize::from(low <= 0.0 && 0.0 <= high);
        }
        assert!((1_900..1_960).contains(&covered), "{covered}");
    }

    #[test]
    fn equal_scenes_differ_in_neither_direction() {
        let found = Difference::of([0.0; 9]).unwrap();
        assert_eq!((found.less, found.more, found.p_sign, found.mean_95), (0, 0, 1.0, [0.0; 2]));
        assert_eq!(Difference::of([]), None);
    }
}
