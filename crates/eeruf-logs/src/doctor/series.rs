//! The readings of one sensor, in order of time.

use super::statistics::{Changes, Contingency, Dependence};

/// Echoes this close to the next one, in microseconds, are of one steady value.
const NEXT_US: f64 = 100.0;
/// Changes of an echo, beyond what driving explains, are alike from each of these to the next, in microseconds;
/// smaller ones are none.
const CHANGES_US: [f64; 5] = [150.0, 500.0, 1500.0, 3000.0, 7000.0];
/// An echo changes by at most this share of the time that passes: the robot drives at up to 2 m/s.
const DRIVING: f64 = 0.012;
/// A steady value that spans more moves.
const STEADY_US: f64 = 600.0;

/// When a sensor fired, and its echo time; both in microseconds, NaN without echo.
#[derive(Clone, Debug, Default)]
pub(crate) struct Series {
    pub(crate) at_us: Vec<f64>,
    pub(crate) echo_us: Vec<f64>,
}

/// A steady value of a sensor that stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Steady {
    pub(crate) from_us: f64,
    pub(crate) to_us: f64,
    pub(crate) count: usize,
}

impl Steady {
    pub(crate) fn is_still(&self) -> bool {
        self.to_us - self.from_us <= STEADY_US
    }
}

impl Series {
    pub(crate) fn echoes(&self) -> impl Iterator<Item = f64> {
        self.echo_us.iter().copied().filter(|us| !us.is_nan())
    }

    /// The values between which the readings jump, each with at least 2 % of them, from the nearest on.
    pub(crate) fn steady(&self) -> Vec<Steady> {
        let mut sorted: Vec<f64> = self.echoes().collect();
        sorted.sort_by(f64::total_cmp);
        let mut values: Vec<Steady> = vec![];
        for &us in &sorted {
            match values.last_mut() {
                Some(value) if us - value.to_us <= NEXT_US => (value.to_us, value.count) = (us, value.count + 1),
                _ => values.push(Steady { from_us: us, to_us: us, count: 1 }),
            }
        }
        values.retain(|value| value.count * 50 >= sorted.len());
        values
    }

    /// Returns true if what the sensor sees comes nearer or goes away.
    pub(crate) fn moves(&self) -> bool {
        let values = self.steady();
        let all: usize = values.iter().map(|value| value.count).sum();
        let moving = values.iter().filter(|value| !value.is_still());
        let count = self.echoes().count();
        moving.map(|value| value.count).sum::<usize>() * 5 > count || all * 2 < count
    }

    /// The latest firing of another sensor at each of this one's, as the time before it in microseconds; NaN before
    /// the first.
    pub(crate) fn lags(&self, other: &Self) -> Vec<f64> {
        let mut next = 0;
        let lag = |&at: &f64| {
            while other.at_us.get(next).is_some_and(|&fired| fired <= at + 1.0) {
                next += 1;
            }
            next.checked_sub(1).map_or(f64::NAN, |latest| at - other.at_us[latest])
        };
        self.at_us.iter().map(lag).collect()
    }

    /// Parts the readings by two lags to another sensor: which of the two each has, and how far apart they are.
    pub(crate) fn two_classes(&self, other: &Self) -> Option<(Vec<Option<bool>>, f64)> {
        let lags = self.lags(other);
        let mut sorted: Vec<f64> = lags.iter().copied().filter(|lag| !lag.is_nan()).collect();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        if count < 20 {
            return None;
        }
        let ends = count / 50..count - count / 50;
        let widest = ends
            .clone()
            .skip(1)
            .max_by(|&a, &b| (sorted[a] - sorted[a - 1]).total_cmp(&(sorted[b] - sorted[b - 1])))?;
        let gap = sorted[widest] - sorted[widest - 1];
        let spread = (sorted[widest - 1] - sorted[ends.start]).max(sorted[ends.end - 1] - sorted[widest]);
        let fewer = widest.min(count - widest);
        if gap < 300.0 || spread > 0.25 * gap || fewer * 4 < count {
            return None;
        }
        let threshold = 0.5 * (sorted[widest] + sorted[widest - 1]);
        Some((lags.iter().map(|lag| (!lag.is_nan()).then_some(*lag > threshold)).collect(), gap))
    }

    /// Dependence of the readings on the class of the firing: of a sensor that stands by the shares of steady values,
    /// and of silence, in each class; of one that moves by the change from a reading to the next one, which is of the
    /// other class.
    pub(crate) fn dependence(&self, classes: &[Option<bool>]) -> Dependence {
        if self.moves() { self.changes(classes).dependence() } else { self.by_class(classes).dependence() }
    }

    fn by_class(&self, classes: &[Option<bool>]) -> Contingency {
        let values = self.steady();
        let mut table = Contingency::new(values.len() + 2);
        for (&us, class) in self.echo_us.iter().zip(classes) {
            let place = values.iter().position(|value| (value.from_us..=value.to_us).contains(&us));
            let category = if us.is_nan() { 0 } else { place.map_or(1, |place| 2 + place) };
            class.iter().for_each(|&class| table.add(class, category));
        }
        table
    }

    /// Pairs of a reading and the next one, by how much later the echo of the one class is than that of the other, or
    /// which of the two has none. Own echoes change as often one way as the other.
    fn changes(&self, classes: &[Option<bool>]) -> Changes {
        let mut changes = Changes::new(CHANGES_US.len() + 1);
        let mut k = 0;
        while k + 1 < self.echo_us.len() {
            let (own, next) = (self.echo_us[k], self.echo_us[k + 1]);
            match (classes[k], classes[k + 1]) {
                (Some(class), Some(other)) if class != other => {
                    let (one, two) = if class { (next, own) } else { (own, next) };
                    let driven_us = DRIVING * (self.at_us[k + 1] - self.at_us[k]);
                    let size = CHANGES_US.iter().rposition(|&least| (one - two).abs() - driven_us >= least);
                    changes.add(match (one.is_nan(), two.is_nan()) {
                        (false, false) => size.map(|size| (one > two, size)),
                        (true, true) => None,
                        (is_silent, _) => Some((is_silent, CHANGES_US.len())),
                    });
                    // Pairs that share no reading are independent, and both classes are first in turn.
                    k += 3;
                }
                _ => k += 1,
            }
        }
        changes
    }
}
