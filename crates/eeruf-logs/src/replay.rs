//! [`replay()`]: the tracker of a hopping ring, run again over the ring's own log.

use core::fmt;
use std::path::Path;

use eeruf_core::{
    MAX_SENSORS, Micros, Phase, ReadingKind, RingError, SensorError,
    judge::{EchoTracker, Firing, TrackerSettings, Verdict},
};

use eeruf_files::FileError;

use crate::firings::FiringLog;
use crate::reading::Reading;
use crate::write::McapWriter;

/// Why the tracker cannot be run over a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplayError {
    /// A setting is out of its range.
    Tracker(RingError),
    /// A sensor that no tracker has room for.
    Sensor(SensorError),
    /// The log does not say how a reading was weighed.
    Weighed {
        /// The sensor, from 0.
        sensor: u8,
        /// The period, from 0.
        period: u32,
    },
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tracker(error) => error.fmt(f),
            Self::Sensor(error) => error.fmt(f),
            Self::Weighed { sensor, period } => write!(
                f,
                "the firing of sensor {} in period {period} does not say how it was weighed; expected columns solo, \
                 steady and changes, as a log of method eeruf_hopping has them",
                u32::from(*sensor) + 1
            ),
        }
    }
}

impl core::error::Error for ReplayError {}

impl From<RingError> for ReplayError {
    fn from(error: RingError) -> Self {
        Self::Tracker(error)
    }
}

impl From<SensorError> for ReplayError {
    fn from(error: SensorError) -> Self {
        Self::Sensor(error)
    }
}

/// The verdicts of an [`EchoTracker`] with these settings on each firing of a log, in the order of
/// [`firings`](FiringLog::firings). With the settings of the ring that was logged, and from its start, that is what the
/// ring made of it, to the last bit; a sensor that was enabled again starts over in the ring, which the log does not
/// say.
///
/// The log must say how each reading was weighed ([`Weighed`](crate::Weighed)). Readings that it calls `too_early`,
/// `stuck` or `late` say nothing about an echo, as in the ring.
///
/// # Errors
/// A setting out of its range, or a firing of which the log does not say how it was weighed.
pub fn replay(log: &FiringLog, settings: TrackerSettings) -> Result<Vec<Verdict>, ReplayError> {
    let mut tracker = EchoTracker::<MAX_SENSORS>::new(settings)?;
    let mut weighed = Vec::with_capacity(log.firings.len());
    for (place, firing) in log.firings.iter().enumerate() {
        let missing = ReplayError::Weighed { sensor: firing.sensor, period: firing.period };
        weighed.push((firing.weighed.as_ref().ok_or(missing)?, place));
    }
    weighed.sort_by_key(|(weighed, _)| weighed.given);
    let nothing = Verdict { kind: ReadingKind::Late, t_echo: None, previous: None, age: None, explained_by: None };
    let mut verdicts = vec![nothing; log.firings.len()];
    let mut changes = weighed.first().map_or(0, |(weighed, _)| weighed.changes);
    for (weighed, place) in weighed {
        if weighed.changes != changes {
            changes = weighed.changes;
            tracker.firing_changed();
        }
        let firing = &log.firings[place];
        let (sensor, t_echo) = (usize::from(firing.sensor), firing.t_echo_us.map(Micros::new));
        verdicts[place] = match weighed.kind {
            Some(kind @ (ReadingKind::TooEarly | ReadingKind::Stuck)) => {
                tracker.skip(sensor, kind, t_echo, weighed.expected_change_us)?
            }
            Some(kind @ ReadingKind::Late) => {
                Verdict { kind, t_echo, previous: None, age: tracker.age(sensor), explained_by: None }
            }
            _ => {
                let (solo, steady) = (weighed.solo, weighed.steady);
                let expected_change_us = weighed.expected_change_us;
                let of = Firing { phase: Phase(firing.phase), solo, steady, expected_change_us };
                tracker.push(sensor, t_echo.as_slice(), of)?
            }
        };
    }
    Ok(verdicts)
}

/// Writes the ranges of a log as MCAP, each sensor onto a topic of its own, `/sonar_N`: beside it `/sonar_N/accepted`,
/// what the verdicts accept, and `/sonar_N/confirmed`, that without what is tentative. The log's name stands in errors.
///
/// # Errors
/// A log that does not say when sensors fired, or a file that cannot be written.
pub fn write_replayed(
    out: &Path,
    name: &Path,
    log: &FiringLog,
    verdicts: &[Verdict],
    speed_of_sound: f64,
) -> Result<(), FileError> {
    if log.lacks_instants {
        return Err(FileError::new(name, "no column `fired_us`; MCAP needs to know when sensors fired"));
    }
    let mut out = McapWriter::create(out)?;
    let metres = |us: u32| 0.5e-6 * f64::from(us) * speed_of_sound;
    let longest = log.firings.iter().filter_map(|firing| firing.t_echo_us).max().map_or(0.0, metres);
    for (firing, verdict) in log.firings.iter().zip(verdicts) {
        let frame = format!("sonar_{}", firing.sensor + 1);
        let topic = format!("/{frame}");
        let reading = Reading {
            sensor: firing.sensor.into(),
            at_ns: Some(firing.at_ns()),
            radiation: 0,
            field_of_view_rad: 0.26,
            min_range_m: 0.0,
            max_range_m: longest,
            range_m: firing.t_echo_us.map_or(f64::INFINITY, metres),
            variance: Some(0.0),
        };
        out.range(&topic, &frame, &reading)?;
        let range_m = match verdict.kind {
            ReadingKind::Accepted | ReadingKind::Tentative => reading.range_m,
            ReadingKind::Clear => f64::INFINITY,
            ReadingKind::TooEarly => f64::NEG_INFINITY,
            _ => continue,
        };
        let believed = Reading { range_m, ..reading };
        out.range(&format!("{topic}/accepted"), &frame, &believed)?;
        if verdict.kind != ReadingKind::Tentative {
            out.range(&format!("{topic}/confirmed"), &frame, &believed)?;
        }
    }
    out.finish()
}
