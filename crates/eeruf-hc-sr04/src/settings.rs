//! [`Settings`]: times and limits of the sensors.

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{Instant, Micros, RingConfig, RingError, SpeedOfSound};
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
    /// Shortest pulse that counts as the sensor's own time-out, which may be a nineteenth short, and not as an echo.
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

/// Makes a flow ring of `K` such modules, which listen as far as they see, with all times from the module, as
/// `eeruf design` has them at 20 degrees Celsius. The compiler can make it, for a `static`; then give it the robot's
/// own seed ([`FlowRing::set_seed`]) and the current time ([`restart`](eeruf_core::Ring::restart)).
///
/// ```
/// use eeruf_core::{Instant, flow::FlowRing};
/// use eeruf_hc_sr04::{flow_ring, modules::HC_SR04};
/// use std::sync::Mutex; // on a board a mutex of its own, or a cell
///
/// static RING: Mutex<FlowRing<8>> = Mutex::new(match flow_ring(&HC_SR04) {
///     Ok(ring) => ring,
///     Err(_) => panic!("the times of an HC-SR04 are valid"),
/// });
///
/// let mut ring = RING.lock().unwrap();
/// ring.set_seed(0xe661_0001)?;
/// ring.restart(Instant::from_micros(5_000));
/// assert_eq!((ring.sensors(), ring.window().as_micros(), ring.blanking().as_micros()), (8, 24_310, 117));
/// # Ok::<(), eeruf_core::RingError>(())
/// ```
///
/// # Errors
/// As for [`FlowRing::flow`], for times of the module that are out of range.
pub const fn flow_ring<const K: usize>(module: &Module) -> Result<FlowRing<K>, RingError> {
    const SOUND: SpeedOfSound = SpeedOfSound::at_celsius_tenths(200);
    let (window, audible) = (SOUND.echo_time(module.sees_to_mm), SOUND.echo_time(module.hears_to_mm).as_micros());
    let (blanking, rest_us) = (Micros::new(module.blanking_us), module.rest_us);
    // A sensor that fires while its last sound is heard would take old echoes for new ones.
    let rest = Micros::new(if rest_us > audible { rest_us } else { audible });
    let turns = TurnSettings::for_module(1, window, rest, blanking);
    let turns = TurnSettings { most: Micros::new(audible), least: Micros::new(audible / 11 * 2), ..turns };
    let listens = window.saturating_add(Micros::new(module.interface.rise_us()));
    let config = RingConfig::new().with_window(listens).with_blanking(blanking);
    FlowRing::flow(K, turns, BeliefSettings::DEFAULT, config, Instant::from_micros(0))
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
