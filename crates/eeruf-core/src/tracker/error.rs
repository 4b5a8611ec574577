//! Why a tracker cannot do what is asked.

use core::fmt;

/// Why a tracker cannot do what is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TrackerError {
    /// A setting out of its range; times are in microseconds.
    Setting {
        /// Its field in [`TrackerSettings`](super::TrackerSettings).
        name: &'static str,
        /// The value given.
        value: u32,
        /// The least that it may be.
        least: u32,
        /// The most that it may be.
        most: u32,
    },
    /// A sensor out of range.
    Sensor {
        /// The sensor, from 0.
        sensor: usize,
        /// Number of sensors.
        sensors: usize,
    },
}

impl fmt::Display for TrackerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Setting { name, value, least, most } => write!(f, "{name} is {value}; expected {least} to {most}"),
            Self::Sensor { sensor, sensors } => {
                write!(f, "sensor {}; expected 1 to {sensors}", sensor.saturating_add(1))
            }
        }
    }
}

impl core::error::Error for TrackerError {}
