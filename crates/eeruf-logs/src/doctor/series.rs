//! The readings of one sensor, in order of time.

use super::statistics::{Changes, Dependence};
use crate::statistics::median;

/// Difference to the next echo, in microseconds, up to which echoes belong to one steady value.
const NEXT_US: f64 = 100.0;
/// Bounds of classes of changes of an echo, in microseconds; smaller changes are ignored.
const CHANGES_US: [f64; 5] = [150.0, 500.0, 1500.0, 3000.0, 7000.0];
/// Largest change of an echo relative to the time passed, for a robot at up to 3 m/s.
const DRIVING: f64 = 0.018;
/// Spread of values above which they count as moving.
const STEADY_US: f64 = 600.0;

/// Firing times of a sensor, and its echo times; both in microseconds, NaN without echo.
#[derive(Clone, Debug, Default)]
pub(crate) struct Series {
    pub(crate) at_us: Vec<f64>,
    pub(crate) echo_us: Vec<f64>,
}

/// The scatter of a sensor's readings, in microseconds, and the step of its values, 0 for none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scatter {
    pub(crate) us: f64,
    pub(crate) step_us: f64,
}

impl Scatter {
    /// Returns the largest difference, in microseconds, at which two readings with such scatter count as equal.
    pub(crate) fn same_us(self, other: Self) -> f64 {
        (3.0 * self.us.hypot(other.us)).max(45.0)
    }
}

/// Shares of a sensor's echoes that no motion explains.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Odd {
    /// Share far from the readings before and after, at no recurring value.
    pub(crate) isolated: f64,
    /// Share far from the reading before, if one of the two has no recurring value.
    pub(crate) jumps: f64,
    /// Share at no recurring value.
    pub(crate) loose: f64,
    /// Share of all values that equal the most frequent one.
    pub(crate) stands: f64,
    pub(crate) echoes: usize,
}

/// A steady value of a sensor at rest.
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

    /// The values between which the readings jump, each with at least 2 % of them, the nearest first.
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

    /// Returns true if the object in front of the sensor comes nearer or moves away.
    pub(crate) fn moves(&self) -> bool {
        let values = self.steady();
        let all: usize = values.iter().map(|value| value.count).sum();
        let moving = values.iter().filter(|value| !value.is_still());
        let count = self.echoes().count();
        moving.map(|value| value.count).sum::<usize>() * 5 > count || all * 2 < count
    }

    /// The step of which all values are multiples, if it is coarse.
    pub(crate) fn step_us(&self) -> Option<f64> {
        let mut sorted: Vec<f64> = self.echoes().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup_by(|a, b| (*a - *b).abs() < 0.5);
        let step = sorted.windows(2).map(|two| two[1] - two[0]).fold(f64::INFINITY, f64::min);
        let is_multiple = |us: &f64| (us / step - (us / step).round()).abs() < 0.02;
        let is_coarse = sorted.len() >= 4 && (25.0..2000.0).contains(&step) && sorted.iter().all(is_multiple);
        is_coarse.then_some(step)
    }

    /// The scatter of the readings about a line through their neighbours or the next but one, at least half the step of
    /// the values. Two alternating sounds do not count as scatter.
    pub(crate) fn scatter(&self) -> Scatter {
        /// Difference in microseconds above which a reading is of another sound.
        const OTHER_US: f64 = 1000.0;
        let about = |apart: usize| {
            let off = |five: &[f64]| (five[2] - 0.5 * (five[2 - apart] + five[2 + apart])).abs();
            let mut off: Vec<f64> = self.echo_us.windows(5).map(off).filter(|us| *us < OTHER_US).collect();
            median(&mut off)
        };
        let step_us = self.step_us().unwrap_or(0.0);
        Scatter { us: (1.48 / 1.5_f64.sqrt() * about(1).min(about(2))).max(0.5 * step_us), step_us }
    }

    /// Readings that are explained neither by an object at rest nor by a moving one.
    pub(crate) fn odd(&self) -> Odd {
        /// Difference in microseconds within which readings are of one object at rest, and the share of readings that
        /// it needs.
        const NEAR_US: f64 = 150.0;
        const RECURS: f64 = 0.03;
        /// Tolerance of a jump: 15 cm, plus the motion of a robot at 1.2 m/s between two readings.
        const OFF_US: f64 = 874.0;
        const DRIVES: f64 = 2.0 * 1.2 / 343.2;
        let echoes: Vec<f64> = self.echoes().collect();
        let mut sorted = echoes.clone();
        sorted.sort_by(f64::total_cmp);
        let n = echoes.len().max(1) as f64;
        let near = |us: f64| {
            let to = sorted.partition_point(|&other| other <= us + NEAR_US);
            (to - sorted.partition_point(|&other| other < us - NEAR_US)) as f64
        };
        let crowds: Vec<f64> = echoes.iter().map(|&us| near(us) / n).collect();
        let mut steps: Vec<f64> = self.at_us.windows(2).map(|two| two[1] - two[0]).filter(|us| *us >= 0.0).collect();
        let far_us = OFF_US + DRIVES * median(&mut steps);
        let is_far = |one: usize, other: usize| (echoes[one] - echoes[other]).abs() > far_us;
        let (mut isolated, mut jumps, mut loose) = (0, 0, 0);
        for k in 0..echoes.len() {
            let recurs = |k: usize| crowds[k] >= RECURS;
            let after_jump = k > 0 && is_far(k - 1, k);
            jumps += u32::from(after_jump && !(recurs(k) && recurs(k - 1)));
            loose += u32::from(!recurs(k));
            let before_jump = k + 1 == echoes.len() || is_far(k + 1, k);
            isolated += u32::from(!recurs(k) && (after_jump || k == 0) && before_jump);
        }
        let [isolated, jumps, loose] = [isolated, jumps, loose].map(|count| f64::from(count) / n);
        Odd { isolated, jumps, loose, stands: crowds.iter().copied().fold(0.0, f64::max), echoes: echoes.len() }
    }

    /// For each firing, the number of firings of another sensor up to then.
    fn firings_before<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = usize> + 'a {
        let mut next = 0;
        self.at_us.iter().map(move |&at| {
            while other.at_us.get(next).is_some_and(|&fired| fired <= at + 1.0) {
                next += 1;
            }
            next
        })
    }

    /// For each firing, the time since the latest firing of another sensor, in microseconds; NaN before the first.
    pub(crate) fn lags(&self, other: &Self) -> Vec<f64> {
        let lag = |(next, &at): (usize, &f64)| next.checked_sub(1).map_or(f64::NAN, |latest| at - other.at_us[latest]);
        self.firings_before(other).zip(&self.at_us).map(lag).collect()
    }

    /// Pairs of consecutive readings between which the lag to another sensor's latest or next firing changes while that
    /// sensor's own echo does not, as it does in a loop that waits for it. Sound of the other moves against the lag by
    /// as much; an own echo, at rest or in motion, moves equally often with it. `same_us` is the tolerance.
    pub(crate) fn follows(&self, other: &Self, same_us: f64) -> Dependence {
        /// Least and largest change of a lag, in microseconds.
        const CHANGES_US: std::ops::Range<f64> = 300.0..30_000.0;
        let before: Vec<usize> = self.firings_before(other).collect();
        let of = |next: bool| {
            let (mut against, mut with, mut pairs) = (0, 0, 0);
            for k in (1..before.len()).step_by(2) {
                let [Some(one), Some(two)] = [k - 1, k].map(|k| (before[k] + usize::from(next)).checked_sub(1)) else {
                    continue;
                };
                let (Some(from), Some(to)) = (other.at_us.get(one), other.at_us.get(two)) else { continue };
                let lag = (self.at_us[k] - to) - (self.at_us[k - 1] - from);
                let change = self.echo_us[k] - self.echo_us[k - 1];
                let is_looped = (other.echo_us[two] - other.echo_us[one]).abs() > 0.25 * lag.abs();
                if is_looped || change.is_nan() || lag.abs() < 4.0 * same_us || !CHANGES_US.contains(&lag.abs()) {
                    continue;
                }
                pairs += 1;
                against += u32::from((change + lag).abs() <= same_us);
                with += u32::from((change - lag).abs() <= same_us);
            }
            let excess = f64::from(against) - f64::from(with);
            let deviations = excess / f64::from((against + with).max(1)).sqrt();
            Dependence { share: excess / f64::from(pairs.max(1)), deviations, count: pairs }
        };
        let (latest, next) = (of(false), of(true));
        if next.share > latest.share { next } else { latest }
    }

    /// Splits the readings by two lags to another sensor: the class of each reading, and the difference of the lags.
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

    /// Compares consecutive readings of different classes: the difference of their echoes, or which of the two has
    /// none. Own echoes change equally often in both directions. Changes that continue at the same rate to the next
    /// reading but one are motion and ignored, as are changes within four times the scatter.
    pub(crate) fn changes(&self, classes: &[Option<bool>], scatter: Scatter) -> Changes {
        let least_us = 4.0 * 2.0_f64.sqrt() * scatter.us;
        let mut changes = Changes::new(CHANGES_US.len() + 1);
        let (echo, at) = (&self.echo_us, &self.at_us);
        let mut k = 0;
        while k + 1 < echo.len() {
            let Some(class) = classes[k].filter(|&class| classes[k + 1] == Some(!class)) else {
                k += 1;
                continue;
            };
            let after = (k + 2 < echo.len() && classes[k + 2] == Some(class)).then_some(k + 2);
            let rate = after.map_or(f64::NAN, |after| (echo[after] - echo[k]) / (at[after] - at[k]));
            let driven_us = if rate.abs() <= DRIVING { rate * (at[k + 1] - at[k]) } else { 0.0 };
            let change_us = echo[k + 1] - echo[k] - driven_us;
            changes.add(match (echo[k].is_nan(), echo[k + 1].is_nan()) {
                (true, true) => None,
                (false, false) => {
                    let size = CHANGES_US.iter().rposition(|&least| change_us.abs() >= least.max(least_us));
                    size.map(|size| ((change_us > 0.0) == class, size))
                }
                (is_first, _) => Some((is_first == class, CHANGES_US.len())),
            });
            // Pairs that share no reading are independent, and both classes are first in turn.
            k += 3;
        }
        changes
    }
}
