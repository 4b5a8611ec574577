//! [`RingError`]: why a ring cannot be set up as asked.

use core::fmt;

use crate::filter::FilterError;
use crate::time::Micros;

/// Why a [`Ring`](super::Ring) cannot be set up as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RingError {
    /// A sensor would fire again while it still listens.
    Window {
        /// The window asked for.
        window: Micros,
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
    },
    /// The window is over before the blanking time.
    Blanking {
        /// The blanking time asked for.
        blanking: Micros,
        /// The window asked for.
        window: Micros,
    },
    /// The filter cannot compare so many readings.
    Filter(FilterError),
}

impl From<FilterError> for RingError {
    fn from(error: FilterError) -> Self {
        Self::Filter(error)
    }
}

impl fmt::Display for RingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Window { window, min_refire } => write!(
                f,
                "a listening window of {window}; a sensor of this schedule fires again after {min_refire}, \
                 expected a window no longer than that (T_wind)"
            ),
            Self::Blanking { blanking, window } => {
                write!(f, "a blanking time of {blanking}; expected less than the window of {window}")
            }
            Self::Filter(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for RingError {}
