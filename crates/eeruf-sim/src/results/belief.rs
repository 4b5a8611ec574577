//! [`BeliefShares`]: the robot's beliefs over time, which can be compared between methods that fire at different rates.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::readings::{Cause, Readings, SensorId};

/// Age, in seconds, beyond which a believed reading no longer counts.
pub const BELIEF_LASTS_S: f64 = 0.6;

/// Shares of the time of all sensors, by the state of each sensor's last belief. They add up to 1.
///
/// A believed reading counts from its firing for [`BELIEF_LASTS_S`], adjusted by odometry, unless another replaces it.
/// Each firing of the sensor compares it with the reading that the sensor would have there alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BeliefShares {
    /// Share of time that is right within the tolerance: an echo at the reference, or silence where the sensor alone
    /// hears none.
    #[serde(rename = "belief_right")]
    pub right: f64,
    /// Share of time without a belief, or with one that is too old.
    pub unknown: f64,
    /// Share of time with a belief in foreign or stale sound.
    pub phantom: f64,
    /// Share of time with one of the sensor's echoes later than the reference, or with silence where the sensor alone
    /// hears an echo.
    pub too_far: f64,
    /// Share of time with one of the sensor's echoes that is earlier than the reference, or that comes although the
    /// sensor alone hears none: faint but real.
    pub faint: f64,
}

/// A believed reading of one sensor.
struct Believed {
    fired_s: f64,
    /// Echo time, corrected to the sensor's last firing; NaN for silence.
    t_echo_us: f64,
    cause: Cause,
}

impl Readings {
    /// Computes the shares with a tolerance in microseconds.
    pub fn belief(&self, tolerance_us: f64) -> BeliefShares {
        let mut sensors: BTreeMap<SensorId, Vec<usize>> = BTreeMap::new();
        for reading in 0..self.len() {
            sensors.entry(self.id(reading)).or_default().push(reading);
        }
        let mut sum = BeliefShares::default();
        for readings in sensors.values() {
            self.add_sensor(readings, tolerance_us, &mut sum);
        }
        let total_s = self.sensors as f64 * self.duration_s;
        let share = |seconds: f64| if total_s > 0.0 { seconds / total_s } else { 0.0 };
        let [right, phantom, too_far, faint] = [sum.right, sum.phantom, sum.too_far, sum.faint].map(share);
        BeliefShares { right, unknown: (1.0 - right - phantom - too_far - faint).max(0.0), phantom, too_far, faint }
    }

    /// Adds the time of one sensor.
    fn add_sensor(&self, readings: &[usize], tolerance_us: f64, sum: &mut BeliefShares) {
        let mut believed: Option<Believed> = None;
        for (k, &reading) in readings.iter().enumerate() {
            let (fired_s, cause) = (self.fired_s[reading], self.cause[reading]);
            if self.is_accepted(reading) {
                believed = Some(Believed { fired_s, t_echo_us: self.t_echo_us[reading], cause });
            } else if let Some(believed) = &mut believed {
                believed.t_echo_us += f64::from(self.expected_change_us[reading]);
            }
            let Some(believed) = &believed else { continue };
            let ends_s = readings.get(k + 1).map_or(self.duration_s, |&next| self.fired_s[next]);
            let seconds = ends_s.min(believed.fired_s + BELIEF_LASTS_S) - fired_s;
            if seconds > 0.0 {
                *believed.state(self.reference_us[reading], tolerance_us, sum) += seconds;
            }
        }
    }
}

impl Believed {
    /// Returns the share in `of` to which the time with this belief belongs, given the reference.
    fn state<'b>(&self, reference_us: f64, tolerance_us: f64, of: &'b mut BeliefShares) -> &'b mut f64 {
        let off_us = self.t_echo_us - reference_us;
        if off_us.abs() <= tolerance_us || (self.t_echo_us.is_nan() && reference_us.is_nan()) {
            return &mut of.right;
        }
        match self.cause {
            Cause::Stale | Cause::Crosstalk | Cause::External => &mut of.phantom,
            // Silence is later than every echo, of the sensor or of the reference.
            Cause::Nothing => &mut of.too_far,
            Cause::Own if off_us > 0.0 => &mut of.too_far,
            Cause::Own => &mut of.faint,
        }
    }
}

#[cfg(test)]
mod tests {
    use eeruf_core::ReadingKind::{self, Accepted, Clear, Rejected, Tentative};

    use super::*;
    use crate::methods::Method;
    use crate::results::NO_PATH;

    /// Makes readings of one sensor, each from its firing time, kind, echo, reference, cause and expected change.
    fn of(duration_s: f64, rows: &[(f64, ReadingKind, f64, f64, Cause, i32)]) -> Readings {
        let mut readings = Readings::new(Method::Eeruf, duration_s, 1);
        for &(fired_s, kind, t_echo_us, reference_us, cause, change_us) in rows {
            readings.robot.push(0);
            readings.sensor.push(0);
            readings.period.push(0);
            readings.phase.push(0);
            readings.fired_s.push(fired_s);
            readings.x_m.push(0.0);
            readings.y_m.push(0.0);
            readings.heading_rad.push(0.0);
            readings.kind.push(kind);
            readings.t_echo_us.push(t_echo_us);
            readings.earliest_us.push(t_echo_us);
            readings.reference_us.push(reference_us);
            readings.cause.push(cause);
            readings.path.push(NO_PATH);
            readings.emitted_s.push(0.0);
            readings.expected_change_us.push(change_us);
        }
        readings
    }

    fn close(found: BeliefShares, right: f64, unknown: f64, phantom: f64, too_far: f64, faint: f64) {
        let pairs = [
            (found.right, right),
            (found.unknown, unknown),
            (found.phantom, phantom),
            (found.too_far, too_far),
            (found.faint, faint),
        ];
        assert!(pairs.iter().all(|(found, expected)| (found - expected).abs() < 1e-9), "{found:?}");
    }

    const NONE: f64 = f64::NAN;

    #[test]
    fn each_cause_counts_to_its_share() {
        // The states last 0.1 s each: unknown, right, phantom, too far, faint, and silence where there is an echo.
        let found = of(
            0.6,
            &[
                (0.1, Accepted, 9_000.0, 9_400.0, Cause::Own, 0),
                (0.2, Tentative, 5_000.0, 9_400.0, Cause::Crosstalk, 0),
                (0.3, Accepted, 12_000.0, 9_400.0, Cause::Own, 0),
                (0.4, Accepted, 7_000.0, 9_400.0, Cause::Own, 0),
                (0.5, Clear, NONE, 9_400.0, Cause::Nothing, 0),
            ],
        );
        close(found.belief(500.0), 1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0);
        // A narrower tolerance makes the first belief faint.
        close(found.belief(300.0), 0.0, 1.0 / 6.0, 1.0 / 6.0, 2.0 / 6.0, 2.0 / 6.0);
    }

    #[test]
    fn a_belief_ends_after_six_tenths_of_a_second() {
        // The reading at 0 is believed: right until 0.6, although a reading at 0.5 was rejected; unknown until 1.
        let found = of(
            1.0,
            &[(0.0, Accepted, 9_000.0, 9_000.0, Cause::Own, 0), (0.5, Rejected, 3_000.0, 9_000.0, Cause::Crosstalk, 0)],
        );
        close(found.belief(500.0), 0.6, 0.4, 0.0, 0.0, 0.0);
    }

    #[test]
    fn odometry_carries_a_belief_on() {
        let rows = |change_us| {
            of(
                0.4,
                &[
                    (0.0, Accepted, 9_000.0, 9_000.0, Cause::Own, 0),
                    (0.1, Rejected, 4_000.0, 8_400.0, Cause::Crosstalk, change_us),
                    (0.2, Rejected, 4_000.0, 7_800.0, Cause::Crosstalk, change_us),
                ],
            )
        };
        close(rows(-600).belief(500.0), 1.0, 0.0, 0.0, 0.0, 0.0);
        // Without odometry the belief is too far from 0.1 s on.
        close(rows(0).belief(500.0), 0.25, 0.0, 0.0, 0.75, 0.0);
    }

    #[test]
    fn silence_is_right_where_nothing_is_heard() {
        let found =
            of(0.4, &[(0.0, Clear, NONE, NONE, Cause::Nothing, 0), (0.2, Accepted, 20_000.0, NONE, Cause::Own, 0)]);
        close(found.belief(500.0), 0.5, 0.0, 0.0, 0.0, 0.5);
    }

    #[test]
    fn sensors_without_readings_know_nothing() {
        let mut found = of(0.5, &[(0.0, Accepted, 9_000.0, 9_000.0, Cause::Own, 0)]);
        found.sensors = 2;
        close(found.belief(500.0), 0.5, 0.5, 0.0, 0.0, 0.0);
    }
}
