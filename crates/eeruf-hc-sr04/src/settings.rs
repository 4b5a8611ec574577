//! [`Settings`]: times and limits of the sensors.

use eeruf_core::Micros;
use eeruf_modules::{HC_SR04, Module};

use crate::error::SetupError;

/// Times and limits of the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Settings {
    /// Width of the trigger pulse.
    pub trigger: Micros,
    /// Time after the trigger in which edges are crosstalk of the trigger in the cable.
    pub deaf: Micros,
    /// Shortest pulse that counts as an echo: 100 us is 17 mm, less than the sensor can measure.
    pub shortest: Micros,
    /// Latest rise after the trigger: a line that rises later was raised by another sensor, whose wires are exchanged.
    pub latest_rise: Micros,
    /// Shortest pulse that is the sensor's own time-out (up to a nineteenth short), not an echo.
    pub longest: Micros,
    /// Longest time for which a healthy sensor holds its line if nothing is in range; many clones take 130 to 200 ms. A
    /// line that rose after its trigger and has been high for a shorter time is not stuck.
    pub longest_hold: Micros,
    /// Least time between two triggers of a sensor.
    pub min_retrigger: Micros,
    /// Time for which [`recover`](crate::HcSr04Ring::recover) pulls a stuck line low: 200 us, an arbitrary choice, as
    /// in sketches on forum.arduino.cc (524295).
    pub recovery: Micros,
    /// Number of consecutive firings without a pulse after which a sensor counts as missing.
    pub missing_after: u8,
}

impl Settings {
    /// The times of this module. `None` unless it answers with the width of a pulse that also ends without an echo.
    ///
    /// ```
    /// use eeruf_hc_sr04::{Settings, modules::{HC_SR04, PING, SRF08}};
    /// assert_eq!(Settings::of(&HC_SR04), Some(Settings::default()));
    /// assert_eq!(Settings::of(&PING).map(|settings| settings.trigger.as_micros()), Some(5));
    /// assert_eq!(Settings::of(&SRF08), None);
    /// ```
    pub const fn of(module: &Module) -> Option<Self> {
        let Some(times) = module.pulse_times() else { return None };
        Some(Self {
            trigger: Micros::new(module.trigger_us),
            deaf: Micros::new(times.deaf_us),
            shortest: Micros::new(times.shortest_us),
            latest_rise: Micros::new(times.latest_rise_us),
            longest: Micros::new(times.longest_us),
            longest_hold: Micros::new(times.longest_hold_us),
            min_retrigger: Micros::new(module.rest_us),
            recovery: Micros::new(200),
            missing_after: 3,
        })
    }

    /// Returns true if a sensor may be triggered again after this time.
    pub(crate) fn allow(&self, min_refire: Micros) -> Result<(), SetupError> {
        let min_retrigger = self.min_retrigger;
        if min_refire < min_retrigger { Err(SetupError::Retrigger { min_refire, min_retrigger }) } else { Ok(()) }
    }
}

impl Default for Settings {
    /// Returns the settings of the HC-SR04.
    fn default() -> Self {
        const SETTINGS: Settings = match Settings::of(&HC_SR04) {
            Some(settings) => settings,
            None => panic!("an HC-SR04 answers by a pulse"),
        };
        SETTINGS
    }
}
