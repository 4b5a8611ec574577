//! Why a problem in ticks, or a question about it, is invalid.

use core::fmt;

use super::members::Members;
use crate::schedule::MAX_SENSORS;

/// Why a problem, or a question about it, is invalid. Sensors are counted from 0 here and printed from 1.
/// `{:#}` counts from 0 where `{}` counts from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ProblemError {
    /// The number of sensors is 0 or above [`MAX_SENSORS`].
    Sensors(usize),
    /// There is not one row of conflicts for each sensor.
    Rows {
        /// Rows given.
        rows: usize,
        /// Sensors of the problem.
        sensors: usize,
    },
    /// A sensor conflicts with a sensor that does not exist.
    UnknownSensor {
        /// The row.
        sensor: usize,
        /// The bit.
        other: usize,
    },
    /// A sensor conflicts with itself.
    SelfConflict(usize),
    /// x conflicts with y, but y not with x.
    OneSided {
        /// x.
        sensor: usize,
        /// y.
        other: usize,
    },
    /// The times are too long for the search of the shortest period: even firing one by one takes too many ticks.
    TooLong {
        /// The period of firing one by one, in ticks.
        period: u64,
        /// The longest period allowed, in ticks.
        most: u32,
    },
    /// The period is 0 or too long.
    Period {
        /// The period given, in ticks.
        period: u32,
        /// The longest period allowed, in ticks.
        most: u32,
    },
    /// A sensor could fire after its period has ended.
    OutsidePeriod {
        /// The sensor.
        sensor: usize,
        /// Its lag in ticks.
        lag: u32,
        /// The longest wait in ticks.
        wait_max: u32,
        /// The period in ticks.
        period: u32,
    },
    /// A pair of waits to assign lies above `wait_max`.
    Pair {
        /// The index of the pair, counted from 0.
        pair: usize,
        /// The longer of its waits, in ticks.
        wait: u32,
        /// The longest wait allowed, in ticks.
        wait_max: u32,
    },
    /// A slice given by the caller is too short.
    Short {
        /// The name of the number.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length needed.
        needed: usize,
    },
    /// The memory lent is too small.
    Memory {
        /// Words lent.
        words: usize,
        /// Words needed: [`wait::memory_words`](super::wait::memory_words).
        needed: usize,
    },
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = usize::from(!f.alternate());
        match *self {
            Self::Sensors(sensors) => write!(f, "{sensors} sensors; expected 1 to {MAX_SENSORS}"),
            Self::Rows { rows, sensors } => {
                write!(f, "{rows} rows of conflicts for {sensors} sensors; expected one row for each sensor")
            }
            Self::UnknownSensor { sensor, other } => {
                write!(f, "sensor {} conflicts with sensor {}, which does not exist", sensor + first, other + first)
            }
            Self::SelfConflict(sensor) => {
                write!(f, "sensor {} conflicts with itself; expected conflicts with other sensors only", sensor + first)
            }
            Self::OneSided { sensor, other } => write!(
                f,
                "sensor {} conflicts with sensor {}, but not the other way round; expected both or neither",
                sensor + first,
                other + first
            ),
            Self::TooLong { period, most } => {
                write!(
                    f,
                    "firing one by one already takes {period} ticks; expected at most {most}, so use a coarser tick"
                )
            }
            Self::Period { period, most } => write!(f, "a period of {period} ticks; expected 1 to {most}"),
            Self::OutsidePeriod { sensor, lag, wait_max, period } => write!(
                f,
                "sensor {} has lag {lag} and waits up to {wait_max} ticks; expected a sum below the period of {period}",
                sensor + first
            ),
            Self::Pair { pair, wait, wait_max } => {
                write!(f, "pair {} has a wait of {wait} ticks; expected at most {wait_max}", pair + first)
            }
            Self::Short { what, given, needed } => write!(f, "{what} has length {given}; expected at least {needed}"),
            Self::Memory { words, needed } => write!(f, "{words} words of memory; expected at least {needed}"),
        }
    }
}

impl core::error::Error for ProblemError {}

/// Checks the number of sensors and that there is a row of conflicts for each: symmetric, without the sensor itself.
pub(crate) fn check_conflicts(sensors: usize, conflicts: &[u64]) -> Result<(), ProblemError> {
    if sensors == 0 || sensors > MAX_SENSORS {
        return Err(ProblemError::Sensors(sensors));
    }
    if conflicts.len() != sensors {
        return Err(ProblemError::Rows { rows: conflicts.len(), sensors });
    }
    for (sensor, &row) in conflicts.iter().enumerate() {
        for other in Members(row) {
            let Some(back) = conflicts.get(other) else {
                return Err(ProblemError::UnknownSensor { sensor, other });
            };
            if other == sensor {
                return Err(ProblemError::SelfConflict(sensor));
            }
            if back >> sensor & 1 == 0 {
                return Err(ProblemError::OneSided { sensor, other });
            }
        }
    }
    Ok(())
}
