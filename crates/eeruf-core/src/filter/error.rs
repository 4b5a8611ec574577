//! Why a filter cannot do what is asked.

use core::fmt;

/// Why a filter cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FilterError {
    /// Too few or too many consecutive readings.
    Consecutive {
        /// The number asked for.
        consecutive: u8,
    },
    /// A rate at which no robot's echoes change.
    Rate {
        /// The drift asked for, in microseconds per second.
        us_per_s: u32,
    },
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Consecutive { consecutive } => write!(f, "{consecutive} consecutive readings; expected 2 to 8"),
            Self::Rate { us_per_s } => write!(f, "echoes that change by {us_per_s} us/s; expected 0 to 400000 us/s"),
        }
    }
}

impl core::error::Error for FilterError {}
