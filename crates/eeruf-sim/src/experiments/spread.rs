//! How a figure spreads over many runs.

use serde::Serialize;

use crate::results::quantile;

/// Quantiles of a figure over many runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// One run in ten has no more.
    pub p10: f64,
    /// Half of the runs have no more.
    pub median: f64,
    /// Nine runs in ten have no more.
    pub p90: f64,
}

impl Spread {
    /// The quantiles of some values; `None` without any.
    ///
    /// ```
    /// use eeruf_sim::experiments::Spread;
    /// let spread = Spread::of((1..=10).map(f64::from)).unwrap();
    /// assert_eq!((spread.p10, spread.median, spread.p90), (1.0, 5.0, 9.0));
    /// assert_eq!(Spread::of([]), None);
    /// ```
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<_> = values.into_iter().collect();
        let mut at = |share| quantile(&mut values, share);
        let (p10, median, p90) = (at(0.1), at(0.5), at(0.9));
        (!values.is_empty()).then_some(Self { p10, median, p90 })
    }
}
