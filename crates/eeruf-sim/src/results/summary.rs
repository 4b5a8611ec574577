//! Quality of a method: figures that are always reported together, since each alone is easily improved at the cost of
//! the others.

use serde::{Deserialize, Serialize};

use super::belief::BeliefShares;
use super::readings::{Cause, Readings};
use crate::methods::Method;

/// Default tolerance of a reading against the reference, in us: 0.5 ms, which is 8.6 cm. This is Set I's error limit,
/// and equals its `T_delta`.
pub const DEFAULT_TOLERANCE_US: f64 = 500.0;

/// A method's figures over one simulation, all robots together. Shares are fractions of 1.
///
/// A reading is the result of one firing of one sensor. It is *accepted* if the method believes it: an echo or free
/// space. It is *wrong* if it differs from the reference by more than the tolerance, or has an echo although the sensor
/// alone hears none, or the reverse. It is *good* if the firing's earliest echo was not wrong, believed or not.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The method.
    pub method: Method,
    /// Number of readings.
    pub readings: usize,
    /// Number of accepted readings.
    pub accepted: usize,
    /// Share of all readings that were accepted and wrong: the harmful ones.
    pub wrong_of_all: f64,
    /// The part of `wrong_of_all` that foreign or stale sound caused. The rest are the sensor's own errors: a barely
    /// audible echo fades once, so that the sensor reads a farther object.
    pub crosstalk_of_all: f64,
    /// The part of `wrong_of_all` that was confirmed, not only tentative.
    pub confirmed_wrong_of_all: f64,
    /// Share of the accepted readings that were wrong; `None` if none was accepted.
    pub wrong_of_accepted: Option<f64>,
    /// Share of all readings that were not accepted: rejected, first of a pair, or a first silence.
    pub rejected: f64,
    /// Share of the good readings that were not accepted. These false rejections are the method's cost. `None` if no
    /// reading was good.
    pub good_lost: Option<f64>,
    /// Share of all readings that were not good and would have been wrong without a filter.
    pub wrong_before_filter: f64,
    /// Shares of the time by the state of the last belief.
    #[serde(flatten)]
    pub belief: BeliefShares,
    /// Right echoes accepted per second of simulated time, all sensors together.
    pub right_echoes_per_s: f64,
    /// Age of the last accepted reading.
    #[serde(flatten)]
    pub age_ms: Age,
    /// Accepted readings per second of simulated time, all sensors together.
    pub readings_per_s: f64,
    /// Number of sensors with less than 5 % of their readings accepted.
    pub starved: usize,
    /// Number of sensors with less than 5 % of their readings accepted and not wrong.
    pub blind: usize,
    /// Number of starved sensors that are mostly good in one phase and not in another: foreign sound comes first in
    /// some periods only, but no two consecutive readings agree.
    pub starved_in_part: usize,
}

/// Age of a sensor's last accepted reading at each of its firings, in milliseconds, measured from the firing of the
/// accepted reading, or before the first one from the start of the simulation. The least age is one period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Age {
    /// The median.
    #[serde(rename = "age_ms")]
    pub median: f64,
    /// The 99th percentile.
    #[serde(rename = "age_p99_ms")]
    pub p99: f64,
}

impl Readings {
    /// Computes the figures with [`DEFAULT_TOLERANCE_US`].
    pub fn summary(&self) -> Summary {
        self.summary_within(DEFAULT_TOLERANCE_US)
    }

    /// Computes the figures with a given tolerance, in microseconds.
    pub fn summary_within(&self, tolerance_us: f64) -> Summary {
        let (mut accepted, mut wrong, mut crosstalk, mut good, mut false_rejections) = (0, 0, 0, 0, 0);
        let (mut confirmed_wrong, mut right_echoes) = (0, 0);
        let mut ages = Vec::with_capacity(self.len());
        // Firing time of the last accepted reading by robot and sensor.
        let mut last =
            vec![[None; eeruf_core::MAX_SENSORS]; self.robot.iter().max().map_or(0, |&r| usize::from(r) + 1)];
        // Numbers of a sensor's accepted readings, of right ones among them, and of all; and in each phase the numbers
        // of good readings and of all.
        let mut shares = vec![[(0_usize, 0_usize, 0_usize); eeruf_core::MAX_SENSORS]; last.len()];
        let mut phases: Vec<Vec<Phases>> = vec![vec![Phases::new(); eeruf_core::MAX_SENSORS]; last.len()];
        for reading in 0..self.len() {
            let believed = self.is_accepted(reading);
            let is_good = self.is_good(reading, tolerance_us);
            accepted += usize::from(believed);
            let fooled = believed && self.is_wrong(reading, tolerance_us);
            wrong += usize::from(fooled);
            confirmed_wrong += usize::from(fooled && self.is_confirmed(reading));
            let foreign = matches!(self.cause[reading], Cause::Stale | Cause::Crosstalk | Cause::External);
            crosstalk += usize::from(fooled && foreign);
            good += usize::from(is_good);
            false_rejections += usize::from(is_good && !believed);
            let sensor = usize::from(self.sensor[reading]);
            let last_accepted = &mut last[usize::from(self.robot[reading])][sensor];
            ages.push(1e3 * (self.fired_s[reading] - last_accepted.unwrap_or(0.0)));
            if believed {
                *last_accepted = Some(self.fired_s[reading]);
            }
            let (taken, right, of) = &mut shares[usize::from(self.robot[reading])][sensor];
            *taken += usize::from(believed);
            let is_right = believed && !fooled;
            *right += usize::from(is_right);
            right_echoes += usize::from(is_right && !self.t_echo_us[reading].is_nan());
            *of += 1;
            count(&mut phases[usize::from(self.robot[reading])][sensor], self.phase[reading], is_good);
        }
        let fed = |&(taken, _, of): &(usize, usize, usize)| taken > 0 && 20 * taken >= of;
        let often = shares.iter().flatten().filter(|&share| fed(share)).count();
        let seeing = shares.iter().flatten().filter(|(_, right, of)| *right > 0 && 20 * right >= *of).count();
        let each = shares.iter().flatten().zip(phases.iter().flatten());
        let in_part = each.filter(|&(share, phases)| !fed(share) && differ(phases)).count();
        let per_s = |count: usize| if self.duration_s > 0.0 { count as f64 / self.duration_s } else { 0.0 };
        let share = |count: usize, of: usize| if of == 0 { 0.0 } else { count as f64 / of as f64 };
        Summary {
            method: self.method,
            readings: self.len(),
            accepted,
            wrong_of_all: share(wrong, self.len()),
            crosstalk_of_all: share(crosstalk, self.len()),
            confirmed_wrong_of_all: share(confirmed_wrong, self.len()),
            wrong_of_accepted: (accepted > 0).then(|| share(wrong, accepted)),
            rejected: share(self.len() - accepted, self.len()),
            good_lost: (good > 0).then(|| share(false_rejections, good)),
            wrong_before_filter: share(self.len() - good, self.len()),
            belief: self.belief(tolerance_us),
            right_echoes_per_s: per_s(right_echoes),
            age_ms: Age { median: quantile(&mut ages, 0.5), p99: quantile(&mut ages, 0.99) },
            readings_per_s: per_s(accepted),
            starved: self.sensors.saturating_sub(often),
            blind: self.sensors.saturating_sub(seeing),
            starved_in_part: in_part,
        }
    }
}

/// Numbers of a sensor's good readings and of all its readings in each phase.
type Phases = Vec<(usize, usize)>;

fn count(phases: &mut Phases, phase: u8, is_good: bool) {
    let phase = usize::from(phase);
    if phases.len() <= phase {
        phases.resize(phase + 1, (0, 0));
    }
    phases[phase].0 += usize::from(is_good);
    phases[phase].1 += 1;
}

/// Returns true if more than half of the readings are good in one phase and not in another.
fn differ(phases: &Phases) -> bool {
    let mut mostly_good = phases.iter().filter(|(_, of)| *of > 0).map(|(good, of)| 2 * good > *of);
    mostly_good.next().is_some_and(|first| mostly_good.any(|other| other != first))
}

/// Returns the value that this share of the values does not exceed; 0 without values. Reorders the values.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let rank = ((values.len() as f64 * share).ceil() as usize).clamp(1, values.len()) - 1;
    *values.select_nth_unstable_by(rank, f64::total_cmp).1
}
