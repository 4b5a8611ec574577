//! Why a search cannot start: times off the grid, or an invalid problem.

use core::fmt;

use super::problem_error::ProblemError;
use crate::layout::LayoutError;
use crate::schedule::{MAX_PERIOD, MAX_SENSORS, ScheduleError};
use crate::time::Micros;

/// Why a search cannot start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SearchError {
    /// Times do not fit the grid.
    Grid(GridError),
    /// Free firing times are designed under the exact criterion, which needs no waits.
    PaperCriterion,
    /// The number of sensors is 0 or above 64, or there is not one lag for each.
    Lags {
        /// The number of sensors.
        sensors: usize,
        /// The number of lags.
        lags: usize,
    },
    /// The layout names a sensor out of range.
    Layout(LayoutError),
    /// The problem is invalid or too large.
    Problem(ProblemError),
    /// Even firing one by one takes longer than [`MAX_PERIOD`].
    TooLong {
        /// The time that it takes, in microseconds.
        period_us: u64,
    },
    /// Firing one by one takes longer than [`MAX_PERIOD`] because every need is rounded up to a whole tick.
    CoarseTick {
        /// The tick.
        tick: Micros,
        /// The time that it takes, in microseconds.
        period_us: u64,
    },
    /// The schedule found does not fit the capacity asked for.
    Schedule(ScheduleError),
}

impl From<GridError> for SearchError {
    fn from(error: GridError) -> Self {
        Self::Grid(error)
    }
}

impl From<LayoutError> for SearchError {
    fn from(error: LayoutError) -> Self {
        Self::Layout(error)
    }
}

impl From<ProblemError> for SearchError {
    fn from(error: ProblemError) -> Self {
        Self::Problem(error)
    }
}

impl From<ScheduleError> for SearchError {
    fn from(error: ScheduleError) -> Self {
        Self::Schedule(error)
    }
}

impl fmt::Display for SearchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grid(error) => error.fmt(f),
            Self::PaperCriterion => {
                f.write_str("criterion paper for free firing times; expected criterion exact, as there are no waits")
            }
            Self::Lags { sensors, lags } if sensors == lags => {
                write!(f, "{sensors} sensors; expected 1 to {MAX_SENSORS}")
            }
            Self::Lags { sensors, lags } => write!(f, "{lags} lags; expected one for each of {sensors} sensors"),
            Self::Layout(error) => error.fmt(f),
            Self::Problem(error) => error.fmt(f),
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
            Self::Schedule(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SearchError {}

/// Why times do not fit a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum GridError {
    /// A tick of no length.
    NoTick,
    /// A time that should be a whole number of ticks.
    OffGrid {
        /// The name of the time.
        what: &'static str,
        /// The time.
        time: Micros,
        /// The tick.
        tick: Micros,
    },
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoTick => f.write_str("a tick of 0 us; expected 1 us or more"),
            Self::OffGrid { what, time, tick } => {
                write!(f, "{what} of {time}; expected a whole number of ticks of {tick}")
            }
        }
    }
}

impl core::error::Error for GridError {}
