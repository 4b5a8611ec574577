//! [`EchoTracker`]: which echo of a sensor is its own, for schedules of many phases.
//!
//! Where the filter compares each reading with the one before, the tracker keeps a few hypotheses, *tracks*, for each
//! sensor. A reading within `t_delta` of a track supports it, and only support from *different phases* counts: a path
//! from another sensor repeats itself in its own phase for ever, but moves from phase to phase. A reading later than a
//! track contradicts it, since that echo would have come first; an earlier one says nothing about it, since it masks
//! what comes later. Silence is a track like any other, later than all echoes.
//!
//! The room uses readings and times; it knows nothing of schedules. Rules and measurements:
//! `docs/explanation/hopping.md`.

mod sensor;
mod settings;
mod several;
#[cfg(test)]
mod tests;
mod track;

use crate::judging::{self, Firing, Judge, Sounds};
use crate::reading::{ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::sensor_error::SensorError;
use crate::time::Micros;

use sensor::SensorTracks;
pub use settings::TrackerSettings;
use track::LATEST;

/// The latest echo that differs from later ones.
pub(crate) const LATEST_ECHO: Micros = Micros::new(LATEST);

/// Tracks the echoes of up to `K` sensors, with up to `H` hypotheses for each. Of sensors that report up to `E` echoes
/// of a firing all are weighed; some three tracks for two echoes keep those of other sensors' sounds apart.
///
/// ```
/// use eeruf_core::{Micros, Phase, ReadingKind, judge::{EchoTracker, Firing, TrackerSettings}};
/// let mut tracker = EchoTracker::<1>::new(TrackerSettings::BALANCED)?;
/// let mut push = |phase, us| {
///     tracker.push(0, &[Micros::new(us)], Firing::new(Phase(phase))).map(|verdict| verdict.kind)
/// };
/// // Crosstalk in one phase is heard again and again, and never believed.
/// for _ in 0..100 {
///     assert!(matches!(push(3, 7_000)?, ReadingKind::First | ReadingKind::Rejected));
/// }
/// // An echo from two phases is tentative, from five confirmed.
/// let kinds = [4, 5, 6, 7, 8].map(|phase| push(phase, 9_000));
/// assert_eq!(kinds[1]?, ReadingKind::Tentative);
/// assert_eq!(kinds[4]?, ReadingKind::Accepted);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EchoTracker<const K: usize, const H: usize = 4, const E: usize = 1> {
    sensors: [SensorTracks<H>; K],
    settings: TrackerSettings,
}

impl<const K: usize, const H: usize, const E: usize> EchoTracker<K, H, E> {
    /// A tracker that knows nothing yet.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range.
    pub const fn new(settings: TrackerSettings) -> Result<Self, RingError> {
        match settings.check() {
            Ok(()) => Ok(Self { sensors: [SensorTracks::NEW; K], settings }),
            Err(error) => Err(error),
        }
    }

    /// Settings by which it weighs readings.
    pub const fn settings(&self) -> &TrackerSettings {
        &self.settings
    }

    /// Takes in one firing of a sensor (from 0) with its echo times, earliest first, each at most 16.7 s; `E` count.
    /// The verdict is
    /// [`Accepted`](ReadingKind::Accepted) for an echo near the earliest confirmed track, [`Clear`](ReadingKind::Clear)
    /// for confirmed silence, [`Tentative`](ReadingKind::Tentative) for an echo that few readings support so far and
    /// none contradicts, earlier than what is confirmed; else [`First`](ReadingKind::First),
    /// [`Rejected`](ReadingKind::Rejected) or [`NoEcho`](ReadingKind::NoEcho), of the first echo.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn push(&mut self, sensor: usize, echoes: &[Micros], firing: Firing) -> Result<Verdict, SensorError> {
        match self.sensors.get_mut(sensor) {
            Some(tracks) => Ok(tracks.push_all::<E>(echoes, firing, self.settings.t_delta, &self.settings)),
            None => Err(SensorError::new(u8::try_from(sensor).unwrap_or(u8::MAX), K)),
        }
    }

    /// A firing that says nothing about the echo time, such as one with an echo within the blanking time: nothing is
    /// supported or contradicted, and the age grows; tracks move by `expected_change_us`, as in a [`Firing`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn skip(
        &mut self,
        sensor: usize,
        kind: ReadingKind,
        t_echo: Option<Micros>,
        expected_change_us: i32,
    ) -> Result<Verdict, SensorError> {
        match self.sensors.get_mut(sensor) {
            Some(tracks) => Ok(tracks.skip(kind, t_echo, expected_change_us)),
            None => Err(SensorError::new(u8::try_from(sensor).unwrap_or(u8::MAX), K)),
        }
    }

    /// Returns true if it is confirmed that nothing is in a sensor's range.
    pub fn is_clear(&self, sensor: usize) -> bool {
        self.sensors.get(sensor).is_some_and(SensorTracks::is_clear)
    }

    /// The echo time of a sensor that is confirmed; `None` if none is, and for confirmed silence.
    pub fn confirmed(&self, sensor: usize) -> Option<Micros> {
        self.sensors.get(sensor)?.reference()
    }

    /// Firings of a sensor since its last accepted or tentative reading; `None` if none ever was.
    pub fn age(&self, sensor: usize) -> Option<u16> {
        self.sensors.get(sensor)?.age()
    }

    /// Forgets the tracks of a sensor. The age goes on.
    pub fn forget(&mut self, sensor: usize) {
        if let Some(tracks) = self.sensors.get_mut(sensor) {
            tracks.forget();
        }
    }

    /// Firing times have changed against each other otherwise than by the phase, such as by a new lag: what supported a
    /// track so far cannot be compared with what will. Tracks that are confirmed stay so; all others start over.
    #[cold]
    #[inline(never)]
    pub fn firing_changed(&mut self) {
        for tracks in &mut self.sensors {
            tracks.firing_changed();
        }
    }
}

impl<const K: usize, const H: usize, const E: usize> Judge for EchoTracker<K, H, E> {
    fn t_delta(&self) -> Micros {
        self.settings.t_delta
    }

    #[inline(always)]
    fn judge(&mut self, heard: &judging::Heard<'_>, _: &impl Sounds) -> Verdict {
        match self.sensors.get_mut(usize::from(heard.sensor)) {
            Some(tracks) => tracks.push_all::<E>(heard.echoes, heard.firing, heard.t_delta, &self.settings),
            None => heard.unjudged(None),
        }
    }

    fn skip(&mut self, heard: &judging::Heard<'_>, kind: ReadingKind) -> Verdict {
        let change_us = heard.firing.expected_change_us;
        match self.sensors.get_mut(usize::from(heard.sensor)) {
            // Silence without a witness contradicts echoes as any does, or a path would be confirmed for lack of it; it
            // is not reported as free space.
            Some(tracks) if kind == ReadingKind::NoEcho => {
                tracks.push_all::<E>(&[], heard.firing, heard.t_delta, &self.settings)
            }
            Some(tracks) => tracks.skip(kind, heard.echoes.first().copied(), change_us),
            None => heard.unjudged(Some(kind)),
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.age(sensor.into())
    }

    fn is_clear(&self, sensor: u8) -> bool {
        self.is_clear(sensor.into())
    }

    fn believed(&self, sensor: u8) -> Option<Micros> {
        self.confirmed(sensor.into())
    }

    fn comes_before_belief(&self, sensor: u8, t_echo: Micros) -> bool {
        self.sensors.get(usize::from(sensor)).is_some_and(|tracks| tracks.comes_before_belief(t_echo))
    }

    fn forget(&mut self, sensor: u8) {
        self.forget(sensor.into());
    }

    /// Tracks that are confirmed stay so: see [`EchoTracker::firing_changed`].
    fn restart(&mut self) {
        self.firing_changed();
    }

    fn firing_changed(&mut self) {
        self.firing_changed();
    }
}
