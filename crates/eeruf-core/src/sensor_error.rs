//! [`SensorError`]: a sensor out of range.

use core::fmt;

/// A sensor out of range. Sensors are counted from 0 in code and printed from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SensorError {
    /// The sensor that was asked for, from 0.
    pub sensor: u8,
    /// Number of sensors in the ring.
    pub sensors: u8,
}

impl SensorError {
    /// An error for a ring, which has at most 255 sensors.
    pub(crate) fn new(sensor: u8, sensors: usize) -> Self {
        Self { sensor, sensors: u8::try_from(sensors).unwrap_or(u8::MAX) }
    }
}

impl fmt::Display for SensorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sensor {}; expected 1 to {}", u16::from(self.sensor) + 1, self.sensors)
    }
}

impl core::error::Error for SensorError {}
