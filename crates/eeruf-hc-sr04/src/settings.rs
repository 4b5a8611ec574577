//! [`Settings`]: the times that the sensors need.

use eeruf_core::Micros;

use crate::error::SetupError;

/// What the sensors need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Settings {
    /// How long the trigger stays high; the data sheet asks for 10 us at least.
    pub trigger: Micros,
    /// Edges sooner than this after the trigger are the trigger itself, seen through the cable.
    pub deaf: Micros,
    /// Shorter pulses are no echoes: 100 us is 17 mm, less than the sensor can measure.
    pub shortest: Micros,
    /// Pulses as long as this are the sensor's own time-out: no echo.
    pub longest: Micros,
    /// The longest that a healthy sensor holds its line where nothing is in range; many clones do for 130 to 200 ms. A
    /// line that rose after its trigger and is high for no longer is still listening, not stuck.
    pub longest_hold: Micros,
    /// No sensor may be triggered again sooner; the data sheet advises 60 ms.
    pub min_retrigger: Micros,
    /// After so many firings in a row without a pulse a sensor counts as missing.
    pub missing_after: u8,
}

impl Settings {
    /// Whether a sensor may be triggered again after this time.
    pub(crate) fn allow(&self, min_refire: Micros) -> Result<(), SetupError> {
        let min_retrigger = self.min_retrigger;
        if min_refire < min_retrigger { Err(SetupError::Retrigger { min_refire, min_retrigger }) } else { Ok(()) }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            trigger: Micros::new(10),
            deaf: Micros::new(100),
            shortest: Micros::new(100),
            longest: Micros::from_millis(36),
            longest_hold: Micros::from_millis(250),
            min_retrigger: Micros::from_millis(60),
            missing_after: 3,
        }
    }
}
