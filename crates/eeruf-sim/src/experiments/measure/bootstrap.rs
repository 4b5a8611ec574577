//! Confidence intervals by bootstrap over rooms.

use crate::{results::quantile, world::Random};

/// Number of bootstrap samples.
const TIMES: u64 = 2000;
/// A cost counts a thing that is seen later, or never, as seen after this time: a choice.
const LATE_MS: f64 = 1_000.0;

/// An estimate with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The 95 % confidence interval.
    pub interval_95: [f64; 2],
}

/// Bootstrap samples: the number of times that each room was drawn in each sample. All conditions of a set of rooms
/// share the samples, so that ratios are paired.
#[derive(Debug)]
pub(super) struct Bootstrap(Vec<Vec<u16>>);

impl Bootstrap {
    pub(super) fn new(rooms: usize, key: u64) -> Self {
        let again = |time: u64| {
            let mut random = Random::new(time).of(key);
            let mut counts = vec![0; rooms];
            for _ in 0..rooms {
                counts[(random.bits() % rooms as u64) as usize] += 1;
            }
            counts
        };
        Self((0..TIMES).map(again).collect())
    }

    /// Computes a figure for all rooms, and for each sample.
    pub(super) fn figures(&self, of: impl Fn(&[u16]) -> f64) -> Vec<f64> {
        let once = self.0.first().map_or(0, Vec::len);
        core::iter::once(vec![1; once]).chain(self.0.iter().cloned()).map(|counts| of(&counts)).collect()
    }
}

impl Estimate {
    /// Makes an estimate from the value for all rooms and the values for the samples.
    pub(super) fn of(figures: &[f64]) -> Self {
        let (value, mut again) =
            (figures.first().copied().unwrap_or(f64::NAN), figures.get(1..).unwrap_or(&[]).to_vec());
        Self { value, interval_95: [0.025, 0.975].map(|share| quantile(&mut again, share)) }
    }

    /// Returns true if the interval contains this value.
    pub fn holds(&self, value: f64) -> bool {
        (self.interval_95[0]..=self.interval_95[1]).contains(&value)
    }
}

/// Latencies in order of length, each with its room.
#[derive(Debug)]
pub(super) struct Latencies(Vec<(f64, usize)>);

impl Latencies {
    /// Sorts the latencies of all rooms, given in order; NaN for a room without a thing, which is left out.
    pub(super) fn new(latencies_ms: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<_> = latencies_ms.zip(0..).filter(|(latency, _)| !latency.is_nan()).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
        Self(sorted)
    }

    /// Returns the 95th percentile with these weights of rooms; infinite if more than 5 % are never seen.
    pub(super) fn t95_ms(&self, counts: &[u16]) -> f64 {
        self.within_ms(0.95, counts)
    }

    /// Returns the time within which a share of things is seen, with these weights of rooms.
    pub(super) fn within_ms(&self, share: f64, counts: &[u16]) -> f64 {
        let count = |&(_, room): &(f64, usize)| counts.get(room).map_or(0, |&count| u32::from(count));
        let all: u32 = self.0.iter().map(count).sum();
        let rank = (f64::from(all) * share).ceil() as u32;
        let mut passed = 0;
        let found = self.0.iter().find(|of| {
            passed += count(of);
            passed >= rank
        });
        found.map_or(f64::INFINITY, |of| of.0)
    }

    /// The mean time until a thing is seen, at most a second each, with these weights of rooms. Unlike the 95th
    /// percentile it does not jump where about one thing in twenty is never seen.
    pub(super) fn mean_ms(&self, counts: &[u16]) -> f64 {
        let (mut all, mut sum_ms) = (0.0, 0.0);
        for &(latency_ms, room) in &self.0 {
            let count = counts.get(room).map_or(0.0, |&count| f64::from(count));
            all += count;
            sum_ms += count * latency_ms.min(LATE_MS);
        }
        if all > 0.0 { sum_ms / all } else { LATE_MS }
    }

    /// The share that is never seen.
    pub(super) fn never(&self) -> f64 {
        self.0.iter().filter(|of| of.0.is_infinite()).count() as f64 / self.0.len().max(1) as f64
    }

    /// Returns the number of things.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn t95_has_what_is_never_seen_in_it() {
        let of = |never: usize| Latencies::new((0..100).map(|k| if k < never { f64::INFINITY } else { k as f64 }));
        assert_eq!((of(0).t95_ms(&[1; 100]), of(5).t95_ms(&[1; 100])), (94.0, 99.0));
        assert_eq!((of(6).t95_ms(&[1; 100]), of(6).never()), (f64::INFINITY, 0.06));
        // Where it jumps, a mean moves by a hundredth of a second at most.
        assert!((of(6).mean_ms(&[1; 100]) - of(5).mean_ms(&[1; 100]) - 9.95).abs() < 1e-9);
        assert_eq!(Latencies::new([f64::NAN].into_iter()).mean_ms(&[1]), 1_000.0);
        // A room without a thing does not count; one drawn twice counts twice.
        let three = Latencies::new([30.0, f64::NAN, 10.0].into_iter());
        assert_eq!((three.len(), three.t95_ms(&[1, 9, 1]), three.t95_ms(&[0, 9, 2])), (2, 30.0, 10.0));
    }

    // A mean's bootstrap interval is as wide as its standard error predicts.
    #[test]
    fn interval_is_as_wide_as_rooms_differ() {
        let bootstrap = Bootstrap::new(400, 1);
        let mean = |counts: &[u16]| {
            counts.iter().enumerate().map(|(k, &count)| f64::from(count) * (k % 2) as f64).sum::<f64>() / 400.0
        };
        let Estimate { value, interval_95: [low, high] } = Estimate::of(&bootstrap.figures(mean));
        assert_eq!(value, 0.5);
        assert!((high - low - 2.0 * 1.96 * 0.5 / 20.0).abs() < 0.01, "{low} to {high}");
    }
}
