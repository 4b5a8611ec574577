//! The filter: a reading counts only if it is near-identical to the previous one (Eq. 11).
//!
//! ```text
//! |T_i - T_(i-1)| <= T_delta      (11)
//! ```
//!
//! A true echo does not depend on the waits and passes. Crosstalk is rejected, since it moves by more than `T_delta` if
//! firings kept a schedule that meets (13a), (13b). A [`Ring`](crate::Ring) does not rely on that: it checks whether
//! sound of another firing explains two readings that agree. If a sensor reports several echoes per firing, all are
//! compared, and the earliest that repeats is accepted: crosstalk that arrives before the true echo then no longer
//! hides it.
//!
//! This module holds the public filter and the tracker behind it; it uses readings and times, and knows nothing about
//! schedules.

mod agreement;
mod echoes;
mod median;
#[cfg(test)]
mod tests;
mod tracker;

use crate::judging::{Explained, Heard, Judge, Sounds};
use crate::reading::{ReadingKind, Verdict};
use crate::ring_error::RingError;
use crate::sensor_error::SensorError;
use crate::time::Micros;

pub(crate) use agreement::{Consecutive, Tolerance};
use echoes::LATEST;
pub(crate) use echoes::{NO_ECHO, SILENCE, heard, insert, shift};
pub use median::MedianFilter;
use tracker::Tracker;

/// Compares the consecutive readings of up to `K` sensors, each with up to `E` echoes per firing.
///
/// ```
/// use eeruf_core::{EchoFilter, ReadingKind, Micros};
/// let mut filter = EchoFilter::<2>::new(Micros::new(500), 2)?;
/// let mut push = |echo_us: u32| filter.push(1, Some(Micros::new(echo_us))).map(|verdict| verdict.kind);
/// assert_eq!(push(9_000)?, ReadingKind::First);
/// assert_eq!(push(9_500)?, ReadingKind::Accepted); // just within t_delta
/// assert_eq!(push(10_001)?, ReadingKind::Rejected); // just beyond
/// assert_eq!(push(10_001)?, ReadingKind::Accepted); // the new value was the one to compare with
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EchoFilter<const K: usize, const E: usize = 1> {
    trackers: [Tracker<E>; K],
    tolerance: Tolerance,
}

impl<const K: usize, const E: usize> EchoFilter<K, E> {
    /// A filter that accepts a reading when `consecutive` readings in a row (2 in the paper) are each within `t_delta`
    /// of the one before.
    ///
    /// # Errors
    /// [`RingError::Consecutive`] unless 2 to 8 readings are compared.
    pub const fn new(t_delta: Micros, consecutive: u8) -> Result<Self, RingError> {
        match Consecutive::new(consecutive) {
            Ok(consecutive) => Ok(Self::of(Tolerance::new(t_delta, consecutive))),
            Err(error) => Err(error),
        }
    }

    #[inline]
    pub(crate) const fn of(tolerance: Tolerance) -> Self {
        Self { trackers: Self::NOTHING_KNOWN, tolerance }
    }

    /// Initial state, copied from flash: an array made at run time would first be built on the stack.
    const NOTHING_KNOWN: [Tracker<E>; K] = [Tracker::NEW; K];

    /// Judges one firing of a sensor (from 0) by the time of its echo, or `None` without echo. The filter does not know
    /// what was fired, so it promises nothing about foreign sound.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn push(&mut self, sensor: u8, t_echo: Option<Micros>) -> Result<Verdict, SensorError> {
        self.push_echoes(sensor, t_echo.as_slice(), 0)
    }

    /// Judges like [`push`](Self::push), with all echoes of the firing in any order (the earliest `E` count) and the
    /// change in microseconds that a good reading is expected to show since the previous firing: `-2 v dt / c` for an
    /// object approached at `v`, where `dt` is the time between the two firings (see
    /// [`Schedule::refire_after`](crate::Schedule::refire_after)). The filter does not know what was fired: with an
    /// expected change it accepts crosstalk under any schedule. [`Ring::poll_expecting`](crate::Ring::poll_expecting)
    /// checks for that too.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn push_echoes(
        &mut self,
        sensor: u8,
        echoes: &[Micros],
        expected_change_us: i32,
    ) -> Result<Verdict, SensorError> {
        let Some(tracker) = self.trackers.get_mut(usize::from(sensor)) else {
            return Err(SensorError::new(sensor, K));
        };
        let mut earliest = [NO_ECHO; E];
        for echo in echoes {
            // The longest duration stands for silence.
            insert(&mut earliest, (*echo).min(LATEST));
        }
        Ok(tracker.push(self.tolerance, heard(&earliest), expected_change_us, |_, _| Explained::ByNothing))
    }

    /// Forgets the readings of a sensor, so that its next one is compared with nothing. The age keeps counting.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn forget(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.trackers.get_mut(usize::from(sensor)).ok_or(SensorError::new(sensor, K))?.forget();
        Ok(())
    }
}

impl<const K: usize, const E: usize> Judge for EchoFilter<K, E> {
    fn t_delta(&self) -> Micros {
        self.tolerance.t_delta
    }

    #[inline(always)]
    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        let &Heard { sensor, echoes, firing, t_delta, .. } = heard;
        let tolerance = Tolerance { t_delta, ..self.tolerance };
        match self.trackers.get_mut(usize::from(sensor)) {
            Some(tracker) => tracker
                .push(tolerance, echoes, firing.expected_change_us, |first, second| sounds.explain(first, second)),
            None => heard.unjudged(None),
        }
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        match self.trackers.get_mut(usize::from(heard.sensor)) {
            Some(tracker) => tracker.skip(kind, heard.echoes.first().copied()),
            None => heard.unjudged(Some(kind)),
        }
    }

    fn hold(&mut self, heard: &Heard<'_>) {
        if let Some(tracker) = self.trackers.get_mut(usize::from(heard.sensor)).filter(|tracker| !tracker.is_silent()) {
            tracker.forget();
        }
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        self.trackers.get(usize::from(sensor))?.age()
    }

    fn is_clear(&self, sensor: u8) -> bool {
        let tracker = self.trackers.get(usize::from(sensor));
        tracker.is_some_and(|tracker| tracker.is_clear(self.tolerance.consecutive))
    }

    fn forget(&mut self, sensor: u8) {
        if let Some(tracker) = self.trackers.get_mut(usize::from(sensor)) {
            tracker.forget();
        }
    }

    fn restart(&mut self) {
        for tracker in &mut self.trackers {
            tracker.forget();
        }
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        if let Some(tracker) = self.trackers.get_mut(usize::from(sensor)) {
            tracker.shift(later_us);
        }
    }
}
