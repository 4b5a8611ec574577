//! Readings of one robot's sensors in a trial, for all settings of votes, and the controls that alter them.

use core::ops::Range;

use eeruf_core::Micros;

use crate::{
    geometry::{Point, Pose},
    results::{Cause, Readings},
    world::Random,
};

/// A reading of the first robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heard {
    pub(super) sensor: usize,
    pub(super) fired_s: f64,
    /// Time when the reading was complete: at the end of its echo, or of the listening time.
    pub(super) ready_s: f64,
    /// Position of the sensor when it fired.
    pub(super) seen: Pose,
    /// Echo time; NaN for silence.
    pub(super) t_echo_us: f64,
    /// The reading that the sensor would have alone.
    pub(super) reference_us: f64,
    /// The change that odometry expects of a good reading since the sensor's previous firing.
    pub(super) change_us: f64,
    pub(super) cause: Cause,
    /// True if the way of firing believes the reading.
    pub(super) accepted: bool,
}

impl Heard {
    /// Returns the readings of a part of a trial.
    pub(super) fn all(readings: &Readings, window: Micros) -> impl Iterator<Item = Self> + '_ {
        let listens_s = f64::from(window.as_micros()) * 1e-6;
        (0..readings.len()).filter(|&k| readings.robot[k] == 0).map(move |k| {
            let (fired_s, earliest_us) = (readings.fired_s[k], readings.earliest_us[k]);
            let lasts_s = if earliest_us.is_nan() { listens_s } else { earliest_us * 1e-6 };
            let place = Point::new(readings.x_m[k], readings.y_m[k]);
            Self {
                sensor: readings.sensor[k].into(),
                fired_s,
                ready_s: fired_s + lasts_s,
                seen: Pose::new(place.coords, readings.heading_rad[k]),
                t_echo_us: readings.t_echo_us[k],
                reference_us: readings.reference_us[k],
                change_us: readings.expected_change_us[k].into(),
                cause: readings.cause[k],
                accepted: readings.is_accepted(k),
            }
        })
    }

    /// Returns true if the cause is sound of another sensor, of an earlier firing, or from outside.
    pub(super) fn is_foreign(cause: Cause) -> bool {
        matches!(cause, Cause::Stale | Cause::Crosstalk | Cause::External)
    }
}

/// Controls whose rank is known in advance: each alters the readings of a good way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// A control that believes nothing.
    Never,
    /// A control that reports 0.3 m at each firing.
    Always,
    /// A control that holds each belief for 10 s.
    Holds,
    /// A control that knows the paths, and believes only its own sound of this firing.
    Genie,
    /// A control in which one sensor is masked.
    Masked,
    /// A control whose readings arrive 300 ms late.
    Late,
    /// A control in which one reading in twenty is a sound from outside.
    Foreign,
}

impl Control {
    /// Controls made from a good way by planting a flaw.
    pub const PLANTED: [Self; 3] = [Self::Masked, Self::Late, Self::Foreign];

    /// Returns the lifetime of a belief under a control, and the time for which nothing replaces it, in seconds.
    pub(super) fn life_s(control: Option<Self>, usual_s: f64) -> [f64; 2] {
        if control == Some(Self::Holds) { [10.0; 2] } else { [usual_s, 0.0] }
    }

    /// Applies the control to readings.
    pub(super) fn apply(self, heard: &mut [Heard], number: u64, c: f64) {
        const LATE_S: f64 = 0.3;
        const OFTEN: f64 = 0.05;
        const STRANGE_M: Range<f64> = 0.2..1.5;
        let mut random = Random::new(number).of(300);
        for reading in heard {
            match self {
                Self::Never => reading.accepted = false,
                Self::Always => {
                    let says = (0.6e6 / c, Cause::External, true);
                    (reading.t_echo_us, reading.cause, reading.accepted) = says;
                }
                Self::Holds => {}
                Self::Genie => reading.accepted = matches!(reading.cause, Cause::Own | Cause::Nothing),
                Self::Masked => reading.accepted &= reading.sensor != 0,
                Self::Late => reading.ready_s += LATE_S,
                Self::Foreign => {
                    let strange_us = 2e6 / c * random.between(STRANGE_M.start, STRANGE_M.end);
                    if random.between(0.0, 1.0) < OFTEN {
                        let says = (strange_us, Cause::External, true);
                        (reading.t_echo_us, reading.cause, reading.accepted) = says;
                    }
                }
            }
        }
    }
}
