//! [`JudgeError`]: settings out of range.

use core::fmt;

/// Why a judge cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum JudgeError {
    /// Too few or too many consecutive readings for an [`EchoFilter`](crate::EchoFilter).
    Consecutive {
        /// The number asked for.
        consecutive: u8,
    },
    /// A rate for a [`RateFilter`](crate::judge::RateFilter) at which no robot's echoes change.
    Rate {
        /// The drift asked for, in microseconds per second.
        us_per_s: u32,
    },
    /// A setting of an [`EchoTracker`](crate::judge::EchoTracker) out of its range; times are in microseconds.
    Setting {
        /// Its field in [`TrackerSettings`](crate::judge::TrackerSettings).
        name: &'static str,
        /// The value given.
        value: u32,
        /// The least that it may be.
        least: u32,
        /// The most that it may be.
        most: u32,
    },
}

impl fmt::Display for JudgeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Consecutive { consecutive } => write!(f, "{consecutive} consecutive readings; expected 2 to 8"),
            Self::Rate { us_per_s } => write!(f, "echoes that change by {us_per_s} us/s; expected 0 to 400000 us/s"),
            Self::Setting { name, value, least, most } => write!(f, "{name} is {value}; expected {least} to {most}"),
        }
    }
}

impl core::error::Error for JudgeError {}
