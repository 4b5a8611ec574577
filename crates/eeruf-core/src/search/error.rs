//! Reasons why a search cannot start: times off the grid, or an invalid problem.

use core::fmt;

use crate::requirements_error::RequirementsError;
use crate::schedule::{MAX_PERIOD, MAX_SENSORS, ScheduleError};
use crate::time::Micros;

/// Reason why a search cannot start. Sensors are counted from 0 here and printed from 1; `{:#}` counts from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SearchError {
    /// The tick is zero.
    NoTick,
    /// A time is not a whole number of ticks.
    OffGrid {
        /// The name of the time.
        what: &'static str,
        /// The time.
        time: Micros,
        /// The tick.
        tick: Micros,
    },
    /// Criterion Paper was given for free firing times, which have no waits: they need Exact.
    PaperCriterion,
    /// The number of sensors is 0 or above [`MAX_SENSORS`].
    Sensors(usize),
    /// The number of lags differs from the number of sensors.
    Lags {
        /// The number of sensors.
        sensors: usize,
        /// The number of lags.
        lags: usize,
    },
    /// The layout names a sensor out of range.
    Layout(RequirementsError),
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
        /// The lag in ticks.
        lag: u32,
        /// The longest wait in ticks.
        wait_max: u32,
        /// The period in ticks.
        period: u32,
    },
    /// Even firing one by one takes too many ticks to be searched.
    TooManyTicks {
        /// The period of firing one by one, in ticks.
        period: u64,
        /// The longest period allowed, in ticks.
        most: u32,
    },
    /// Even firing one by one takes longer than [`MAX_PERIOD`].
    TooLong {
        /// The time that firing one by one takes, in microseconds.
        period_us: u64,
    },
    /// Firing one by one takes longer than [`MAX_PERIOD`] because every need is rounded up to a whole tick.
    CoarseTick {
        /// The tick.
        tick: Micros,
        /// The time of firing one by one, in microseconds.
        period_us: u64,
    },
    /// The memory that the caller lent is too small.
    Memory {
        /// Words lent.
        words: usize,
        /// Words needed: [`memory_words`](super::memory_words).
        needed: usize,
    },
    /// The schedule found does not fit the capacity asked for.
    Schedule(ScheduleError),
}

impl From<RequirementsError> for SearchError {
    fn from(error: RequirementsError) -> Self {
        Self::Layout(error)
    }
}

impl From<ScheduleError> for SearchError {
    fn from(error: ScheduleError) -> Self {
        Self::Schedule(error)
    }
}

impl fmt::Display for SearchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = usize::from(!f.alternate());
        match *self {
            Self::NoTick => f.write_str("a tick of 0 us; expected 1 us or more"),
            Self::OffGrid { what, time, tick } => {
                write!(f, "{what} of {time}; expected a whole number of ticks of {tick}")
            }
            Self::PaperCriterion => {
                f.write_str("criterion paper for free firing times; expected criterion exact, as there are no waits")
            }
            Self::Sensors(sensors) => write!(f, "{sensors} sensors; expected 1 to {MAX_SENSORS}"),
            Self::Lags { sensors, lags } => write!(f, "{lags} lags; expected one for each of {sensors} sensors"),
            Self::Layout(error) => error.fmt(f),
            Self::Period { period, most } => write!(f, "a period of {period} ticks; expected 1 to {most}"),
            Self::OutsidePeriod { sensor, lag, wait_max, period } => write!(
                f,
                "sensor {} has lag {lag} and waits up to {wait_max} ticks; expected a sum below the period of {period}",
                sensor + first
            ),
            Self::TooManyTicks { period, most } => write!(
                f,
                "firing one by one already takes {period} ticks; expected at most {most}, so use a coarser tick"
            ),
            Self::TooLong { period_us } => write!(
                f,
                "firing one by one already takes {} s; expected at most {MAX_PERIOD}, so a shorter interval \
                 or window, or a smaller t_delta",
                period_us / 1_000_000
            ),
            Self::CoarseTick { tick, period_us } => write!(
                f,
                "in ticks of {tick} firing one by one already takes {} s; expected at most {MAX_PERIOD}, so use a \
                 finer tick",
                period_us / 1_000_000
            ),
            Self::Memory { words, needed } => write!(f, "{words} words of memory; expected at least {needed}"),
            Self::Schedule(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SearchError {}
