//! Why a search cannot begin.

use core::fmt;

use super::grid::GridError;
use super::{design, wait};
use crate::schedule::{MAX_PERIOD, MAX_SENSORS, ScheduleError};

/// Why a search cannot begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// The needs make no sense or are too large.
    Design(design::ProblemError),
    /// Even firing one by one takes longer than [`MAX_PERIOD`].
    TooLong {
        /// What it takes, in microseconds.
        period_us: u64,
    },
    /// The waits sought make no sense.
    Wait(wait::ProblemError),
    /// The schedule found does not fit the capacity asked for.
    Schedule(ScheduleError),
}

impl From<GridError> for SearchError {
    fn from(error: GridError) -> Self {
        Self::Grid(error)
    }
}

impl From<design::ProblemError> for SearchError {
    fn from(error: design::ProblemError) -> Self {
        Self::Design(error)
    }
}

impl From<wait::ProblemError> for SearchError {
    fn from(error: wait::ProblemError) -> Self {
        Self::Wait(error)
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
            Self::Design(error) => error.fmt(f),
            Self::TooLong { period_us } => write!(
                f,
                "firing one by one already takes {} s; expected at most {MAX_PERIOD}, so a shorter interval or window, or a \
                 smaller t_delta",
                period_us / 1_000_000
            ),
            Self::Wait(error) => error.fmt(f),
            Self::Schedule(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SearchError {}
