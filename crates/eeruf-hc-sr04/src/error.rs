//! [`SetupError`]: reasons why a ring of sensors cannot be set up.

use core::fmt;

use eeruf_core::{Micros, RingError};

/// Reason why a ring of sensors cannot be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SetupError {
    /// A sensor would be triggered again too soon.
    Retrigger {
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
        /// The time that a sensor needs.
        min_retrigger: Micros,
    },
    /// The error of the ring itself.
    Ring(RingError),
}

impl From<RingError> for SetupError {
    fn from(error: RingError) -> Self {
        Self::Ring(error)
    }
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Retrigger { min_refire, min_retrigger } => write!(
                f,
                "a sensor of this schedule fires again after {min_refire}; its module needs at least {min_retrigger}"
            ),
            Self::Ring(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SetupError {}
