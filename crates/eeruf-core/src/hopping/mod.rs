//! Time hopping: a ring whose firing times move through a cycle of many phases, so that no sensor stays blind.
//!
//! Two phases reject crosstalk, but a sensor that foreign sound reaches first in one of them never has a reading
//! accepted. Here waits move through a code of many phases ([`HoppingCode`]), and an echo is believed that several of
//! them support ([`EchoTracker`]). A sensor that hears nothing of its own for a while gets a *solo period*, in which it
//! fires alone; where settings say so, one whose readings keep disagreeing draws a new lag.
//!
//! Rules and measurements: `docs/explanation/hopping.md`.

mod code;
mod error;
mod lateness;
mod plan;
mod planning;
mod random;
mod schedule;
mod settings;
#[cfg(test)]
mod tests;
mod turn;
mod weighed;

use crate::judging::Judge;
use crate::own_limits::OwnLimits;
use crate::ring::{Ring, RingConfig};
use crate::time::Instant;
use crate::tracker::EchoTracker;

pub use code::HoppingCode;
pub use error::HoppingError;
pub(crate) use lateness::Lateness;
pub(crate) use plan::CATCHES_UP;
pub use plan::HoppingPlan;
pub use schedule::HoppingSchedule;
pub use settings::{HoppingListening, HoppingSettings};
pub use weighed::Weighed;

/// A ring of up to `K` sensors that hops in time, with `H` hypotheses for each sensor and up to `E` echoes of a firing.
/// It is used like a
/// [`ScheduledRing`](crate::ScheduledRing); its readings are also [`Tentative`](crate::ReadingKind::Tentative).
///
/// One path of fixed length from one sensor to another is never accepted, not even tentatively, however late firings
/// are, if its sound dies within `reach` of [`HoppingListening`] and that is less than a period:
/// `docs/explanation/theory.md` section 9 says why, and what is not covered.
///
/// ```
/// use eeruf_core::hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings};
/// use eeruf_core::{Instant, Micros, ReadingKind, RingEvent};
/// let code = HoppingCode::new(8, 2, Micros::new(240))?;
/// let schedule = HoppingSchedule::<8>::spread(code, Micros::from_millis(60))?;
/// let listening = HoppingListening::new(Micros::from_millis(36));
/// let start = Instant::from_micros(0);
/// let mut ring = HoppingRing::<8>::hopping(&schedule, HoppingSettings::BALANCED, listening, 1, start)?;
/// let mut accepted = 0;
/// for _ in 0..1000 {
///     let now = ring.next_deadline(); // where firmware would sleep
///     while let Some(event) = ring.poll(now) {
///         match event {
///             RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(12))?, // a wall 2 m away
///             RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
///             RingEvent::PeriodEnded(_) => {}
///         }
///     }
/// }
/// assert!(accepted > 400);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// `U` is [`EachSensor`](crate::EachSensor) where sensors have limits of their own.
pub type HoppingRing<const K: usize, const H: usize = 4, const E: usize = 1, U = ()> =
    Ring<HoppingPlan<K, U>, EchoTracker<K, H, E>, K, E, 1>;

impl<const K: usize, const H: usize, const E: usize> HoppingRing<K, H, E> {
    /// A ring that hops in time and begins at `now`. The seed is for the draws of new lags.
    ///
    /// # Errors
    /// [`HoppingError`] for a tracker's setting out of its range, and as for [`HoppingPlan::new`]; or for a window that
    /// ends within the blanking time.
    pub fn hopping(
        schedule: &HoppingSchedule<K>,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        Self::with_limits(schedule, (), settings, listening, seed, now)
    }
}

impl<const K: usize, const H: usize, const E: usize, U: OwnLimits> HoppingRing<K, H, E, U> {
    /// As [`hopping`](HoppingRing::hopping), for sensors that have limits of their own, by [`HoppingSchedule::limits`]
    /// or [`hopping_schedule!`](crate::hopping_schedule!) with `each_meets`.
    ///
    /// # Errors
    /// As there, and as for [`HoppingPlan::with_limits`].
    #[inline(always)]
    pub fn with_limits(
        schedule: &HoppingSchedule<K>,
        own_limits: U,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        let tracker = EchoTracker::new(settings.tracker)?;
        let plan = HoppingPlan::with_limits(schedule, own_limits, settings, listening, seed, now)?;
        let config = RingConfig::new().with_window(listening.window).with_blanking(listening.blanking);
        Ok(Self::judged_by(plan, tracker, config.with_echoes::<E>(), now)?)
    }
}

impl<J: Judge, const K: usize, const E: usize, const H: usize, U: OwnLimits> Ring<HoppingPlan<K, U>, J, K, E, H> {
    /// Changes to the lags and the period of another schedule with the same code, as adaptation asks for when a period
    /// has ended (see [`Adaptation`](crate::adaptation::Adaptation)). The period that has begun starts again once all
    /// sound from before has died, which takes a window and `reach` at most; what is confirmed starts over. Where
    /// sensors have limits of their own, both schedules must meet the same requirements.
    ///
    /// # Errors
    /// [`HoppingError::OtherCode`], or [`HoppingError::Period`] for a period that is shorter than window and code
    /// together, or than twice the code and a step. The ring then goes on as before.
    pub fn change_hopping(&mut self, schedule: &HoppingSchedule<K>) -> Result<(), HoppingError> {
        self.change_plan(|plan| plan.change_schedule(schedule))
    }
}
