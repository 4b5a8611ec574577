//! Time hopping: a ring whose firing times move through a cycle of many phases, so that no sensor stays blind.
//!
//! Two phases reject crosstalk, but a sensor that foreign sound reaches first in one of them never has a reading
//! accepted. Here waits move through a code of many phases ([`HoppingCode`]), and an echo is believed that several of
//! them support ([`EchoTracker`]). A sensor that hears nothing of its own for a while gets a *solo period*, in which it
//! fires alone; one whose readings keep disagreeing draws a new lag.
//!
//! The room uses the ring, the tracker and the scheduler's trait. Rules and measurements: `docs/hopping.md`.

mod code;
mod emit;
mod error;
mod firing;
mod lateness;
mod plan;
mod random;
mod schedule;
mod settings;
#[cfg(test)]
mod tests;
mod timetable;
mod turn;
mod weighed;

use crate::reading::{ReadingKind, Verdict};
use crate::ring::{AgreementRing, PeriodStats, Reading, Ring, RingConfig, RingEvent};
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};
use crate::tracker::{EchoTracker, Firing};

use timetable::Timetable;

pub use code::HoppingCode;
pub use emit::{HoppingHeader, HoppingRust, HoppingTab, HoppingToml};
pub use error::HoppingError;
pub use firing::HoppingFiring;
pub use schedule::HoppingSchedule;
pub use settings::{HoppingListening, HoppingSettings};
pub use weighed::Weighed;

/// A ring of up to `K` sensors that hops in time, with `H` hypotheses for each sensor. It is used like a
/// [`Ring`]; its readings are also [`Tentative`](ReadingKind::Tentative).
///
/// One path of fixed length from one sensor to another is never accepted, not even tentatively, however late firings
/// are, if its sound dies within `reach` of [`HoppingListening`] and that is less than a period: `docs/theory.md`
/// section 9 says why, and what is not covered.
///
/// ```
/// use eeruf_core::*;
/// let code = HoppingCode::new(8, 2, Micros::new(240))?;
/// let schedule = HoppingSchedule::<8>::spread(code, Micros::from_millis(60), 4)?;
/// let listening = HoppingListening::new(Micros::from_millis(36));
/// let start = Instant::from_micros(0);
/// let mut ring = HoppingRing::<8>::new(&schedule, HoppingSettings::BALANCED, listening, 1, start)?;
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
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingRing<const K: usize, const H: usize = 4> {
    ring: AgreementRing<Timetable<K>, K>,
    tracker: EchoTracker<K, H>,
    /// By how much, in microseconds, firings may differ in lateness and crosstalk still move by more than `t_delta`.
    tolerated: u16,
    changes: u8,
}

impl<const K: usize, const H: usize> HoppingRing<K, H> {
    /// A ring that begins at `now`. The seed is for the draws of new lags.
    ///
    /// # Errors
    /// [`HoppingError`] for a tracker's setting out of its range, a `t_delta` that is not below the step of the code,
    /// more votes to confirm an echo than there are phases, a period that is shorter than window and code together or
    /// than twice the code and a step, a window longer than [`HoppingListening::MAX_WINDOW`] or one that ends within
    /// the blanking time.
    pub fn new(
        schedule: &HoppingSchedule<K>,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        let (code, HoppingListening { window, blanking, .. }) = (schedule.code(), listening);
        let tracker = EchoTracker::new(settings.tracker)?;
        let t_delta = settings.tracker.t_delta;
        if code.step() <= t_delta {
            return Err(HoppingError::TDelta { t_delta, step: code.step() });
        }
        let votes = settings.tracker.votes;
        if votes > code.phases() {
            return Err(HoppingError::Votes { votes, phases: code.phases() });
        }
        // The sensor must have stopped listening, and a path must not read the same with two ages.
        let two_ages = code.two_ages();
        let least = window.saturating_add(code.longest_drop()).max(two_ages);
        if schedule.period() < least {
            return Err(HoppingError::Period { period: schedule.period(), least });
        }
        let most = HoppingListening::MAX_WINDOW;
        if window > most {
            return Err(HoppingError::Window { window, most });
        }
        let timetable = Timetable::new(schedule, settings, listening, seed, now);
        let config = RingConfig::new().with_t_delta(t_delta).with_window(window).with_blanking(blanking);
        let ring = Ring::remembering(timetable, config, now)?;
        // A track may be off by as much as its readings, and a step is at most 65,535 us.
        let tolerated = (code.step().abs_diff(t_delta).as_micros() - 1) / 2;
        Ok(Self { ring, tracker, tolerated: tolerated as u16, changes: 0 })
    }

    /// The next event, if there is one at `now`: see [`Ring::poll`].
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// As [`poll`](Self::poll), for a robot that moves: see [`Ring::poll_expecting`].
    #[inline]
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        match self.ring.fire_due(now) {
            Ok((sensor, _, due)) => {
                self.notice_changes();
                Some(RingEvent::Fire { sensor, phase: self.firing().phase(), due })
            }
            Err(first) => self.poll_others(now, first, expected_change_us),
        }
    }

    /// What may be due beside a firing; a sensor whose reading is to be emitted before it fires comes `first`.
    #[inline(never)]
    fn poll_others(
        &mut self,
        now: Instant,
        first: Option<u8>,
        expected_change_us: impl FnMut(u8) -> i32,
    ) -> Option<RingEvent> {
        if first.is_none() && !self.ring.is_due(now) {
            if self.ring.has_jumped(now) {
                self.restart(now);
            }
            return None;
        }
        match first.or_else(|| self.ring.next_pending(now)) {
            Some(sensor) => self.emit_reading(sensor, expected_change_us),
            None => self.end_period(now),
        }
    }

    /// Lets the tracker know where firing times have changed.
    #[inline(always)]
    fn notice_changes(&mut self) {
        if self.ring.scheduler().changed {
            self.take_changes();
        }
    }

    #[cold]
    #[inline(never)]
    fn take_changes(&mut self) {
        self.ring.scheduler_mut().changed = false;
        self.tracker.firing_changed();
        self.changes = self.changes.wrapping_add(1);
    }

    #[inline(never)]
    fn end_period(&mut self, now: Instant) -> Option<RingEvent> {
        let ended = self.firing().phase();
        let mut event = self.ring.end_period(now);
        if let Some(RingEvent::PeriodEnded(PeriodStats { phase, .. })) = &mut event {
            *phase = ended;
            self.plan();
            self.notice_changes();
        }
        event
    }

    /// Plans the period that has begun.
    fn plan(&mut self) {
        let (timetable, fired) = self.ring.scheduler_and_firings();
        timetable.plan(fired);
    }

    #[inline(never)]
    fn emit_reading(&mut self, sensor: u8, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let reading = self.ring.take_reading(sensor, |_| 0)?;
        self.notice_changes();
        let (phase, solo, steady) = self.ring.scheduler().last_firing(sensor, self.tolerated);
        let firing = Firing { phase, solo, steady, expected_change_us: 0 };
        let Verdict { kind, t_echo, previous, age, explained_by } = self.weigh(&reading, firing, expected_change_us);
        self.ring.count(kind);
        Some(RingEvent::Reading(Reading { phase, kind, t_echo, previous, age, explained_by, ..reading }))
    }

    /// What the tracker makes of a reading.
    #[inline(always)]
    fn weigh(&mut self, reading: &Reading, firing: Firing, mut expected_change_us: impl FnMut(u8) -> i32) -> Verdict {
        let &Reading { sensor, kind, t_echo, .. } = reading;
        let place = usize::from(sensor);
        let weighed = match kind {
            ReadingKind::Late => {
                return Verdict { kind, t_echo, previous: None, age: self.tracker.age(place), explained_by: None };
            }
            ReadingKind::Stuck | ReadingKind::TooEarly | ReadingKind::Unanswered => {
                let skipped = self.tracker.skip(place, kind, t_echo, expected_change_us(sensor));
                skipped.map(|verdict| (verdict, self.tracker.is_clear(place)))
            }
            _ => self.tracker.weigh(place, t_echo, Firing { expected_change_us: expected_change_us(sensor), ..firing }),
        };
        let Ok((verdict, is_clear)) = weighed else {
            return Verdict { kind, t_echo, previous: None, age: None, explained_by: None };
        };
        let confirmed = matches!(verdict.kind, ReadingKind::Accepted | ReadingKind::Clear);
        // A sensor that is known to have nothing in range is not fooled by what does not fit.
        let fits = confirmed || is_clear;
        // Nor does silence or another lag help one whose line is stuck, or that does not answer: it costs the others
        // nothing.
        if !matches!(verdict.kind, ReadingKind::Stuck | ReadingKind::Unanswered) {
            self.ring.scheduler_mut().heard(sensor, confirmed || verdict.kind == ReadingKind::Tentative, fits);
        }
        verdict
    }

    /// When to poll next. In the past if an event is pending.
    pub fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    /// An edge on the echo line of a sensor: see [`Ring::echo`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        self.ring.echo(sensor, at)
    }

    /// When the sensor of the last [`Fire`](RingEvent::Fire) really fired: see [`Ring::fired`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        let polled = self.ring.last_firing(sensor);
        if polled.is_some_and(|polled| !at.has_reached(polled)) {
            // Before the poll that asked for it, which cannot be.
            return Ok(());
        }
        self.ring.fired(sensor, at)?;
        let fired = self.ring.last_firing(sensor);
        if let Some(fired) = fired.filter(|_| fired != polled) {
            self.ring.scheduler_mut().fired(fired);
        }
        Ok(())
    }

    /// When a sensor last fired: see [`Ring::last_firing`].
    pub fn last_firing(&self, sensor: u8) -> Option<Instant> {
        self.ring.last_firing(sensor)
    }

    /// The echo line of a sensor was high when it was to fire: see [`Ring::stuck`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn stuck(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.stuck(sensor)
    }

    /// Asks silence for a witness, from the next firing on: see [`Ring::expect_answers`].
    pub fn expect_answers(&mut self) {
        self.ring.expect_answers();
    }

    /// Reports that a sensor has shown that it listens: see [`Ring::answered`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn answered(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.answered(sensor)
    }

    /// Takes that back: see [`Ring::unanswered`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn unanswered(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.unanswered(sensor)
    }

    /// Hands in what was measured of a sensor's last firing: see [`Ring::measured`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn measured(&mut self, sensor: u8, t_echo: Option<Micros>) -> Result<(), SensorError> {
        self.ring.measured(sensor, t_echo)
    }

    /// Forgets the tracks of a sensor: see [`Ring::forget`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn forget(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.forget(sensor)?;
        self.tracker.forget(sensor.into());
        Ok(())
    }

    /// Stops a sensor from firing: see [`Ring::disable`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn disable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.disable(sensor)
    }

    /// Lets a sensor fire again from the next period on. Its tracks are forgotten.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn enable(&mut self, sensor: u8) -> Result<(), SensorError> {
        if !self.ring.is_enabled(sensor) {
            self.ring.enable(sensor)?;
            self.tracker.forget(sensor.into());
        }
        Ok(())
    }

    /// Whether a sensor fires.
    pub fn is_enabled(&self, sensor: u8) -> bool {
        self.ring.is_enabled(sensor)
    }

    /// Lets no sensor fire until [`resume`](Self::resume); periods go on: see [`Ring::pause`].
    pub fn pause(&mut self) {
        self.ring.pause();
    }

    /// Lets sensors fire again, as of the next period. Their tracks are forgotten.
    pub fn resume(&mut self) {
        self.ring.resume();
        for sensor in 0..self.sensors() {
            self.tracker.forget(sensor);
        }
    }

    /// Starts again at `now`: firings under way are dropped, and what is not confirmed has no support.
    pub fn restart(&mut self, now: Instant) {
        self.ring.restart(now);
        self.plan();
    }

    /// When sensors fire: lags as they are now, the phase, whose solo period it is.
    pub const fn firing(&self) -> HoppingFiring<'_, K> {
        HoppingFiring(self.ring.scheduler())
    }

    /// For the log of a reading that was just emitted: how it was weighed, with the change that the poll expected of
    /// its sensor, 0 for a robot that stands; `None` for a sensor that is not there. With that, its phase and its echo
    /// time an [`EchoTracker`] does again what this ring's did.
    pub fn weighed(&self, sensor: u8, expected_change_us: i32) -> Option<Weighed> {
        if usize::from(sensor) >= self.sensors() {
            return None;
        }
        let (_, solo, steady) = self.ring.scheduler().last_firing(sensor, self.tolerated);
        Some(Weighed { solo, steady, changes: self.changes, expected_change_us })
    }

    /// How often firing times have changed against each other otherwise than by the phase, such as by new lags, modulo
    /// 256: each time [`EchoTracker::firing_changed`] was called.
    pub const fn changes(&self) -> u8 {
        self.changes
    }

    /// How many sensors there are.
    pub fn sensors(&self) -> usize {
        self.ring.sensors()
    }

    /// What is known of each sensor's echo.
    pub const fn tracker(&self) -> &EchoTracker<K, H> {
        &self.tracker
    }
}
