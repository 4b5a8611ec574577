//! The readings of one sensor, in order of time.

use super::statistics::Contingency;

/// Echoes this close to the next one, in microseconds, are of one steady value.
const NEXT_US: f64 = 100.0;
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

    /// Counts of the readings in two classes of firings: by steady value, or without echo, if the sensor stands; else
    /// by whether a reading lies before, on or behind the line between its neighbours, which are of the other class.
    pub(crate) fn by_class(&self, classes: &[Option<bool>]) -> Contingency {
        if !self.moves() {
            let values = self.steady();
            let mut table = Contingency::new(values.len() + 2);
            for (&us, class) in self.echo_us.iter().zip(classes) {
                let place = values.iter().position(|value| (value.from_us..=value.to_us).contains(&us));
                let category = if us.is_nan() { 0 } else { place.map_or(1, |place| 2 + place) };
                class.iter().for_each(|&class| table.add(class, category));
            }
            return table;
        }
        /// The two neighbours of a reading differ by less than that, however fast a robot drives.
        const NEIGHBOURS_US: f64 = 400.0;
        /// A reading is off the line from this on.
        const OFF_US: f64 = 150.0;
        let mut table = Contingency::new(3);
        let mut k = 1;
        while k + 1 < self.echo_us.len() {
            let [before, own, after] = [k - 1, k, k + 1].map(|k| (self.echo_us[k], classes[k]));
            let off = own.0 - 0.5 * (before.0 + after.0);
            match own.1 {
                Some(class)
                    if before.1 == Some(!class)
                        && after.1 == Some(!class)
                        && (before.0 - after.0).abs() < NEIGHBOURS_US
                        && !off.is_nan() =>
                {
                    table.add(class, if off < -OFF_US { 0 } else { 1 + usize::from(off > OFF_US) });
                    // Triples that share no reading are independent.
                    k += 3;
                }
                _ => k += 1,
            }
        }
        table
    }
}
