//! [`Ring`]: scheduler and filter together, with what real sensors need: blanking, windows, stuck lines, late polls.
//!
//! The caller polls, fires the sensors it is asked to fire, hands in the instants of echo edges, and sleeps until the
//! next deadline. Nothing here blocks, allocates, panics or reads a clock. The room uses the scheduler and the filter.

mod config;
mod error;
mod events;
mod lateness;
mod sensor;
mod steps;

use crate::filter::Agreement;
use crate::reading::{ReadingKind, Tally};
use crate::schedule::Schedule;
use crate::scheduler::{ImmediateRefiring, ScheduledFiring, Scheduler};
use crate::time::{Instant, Micros};

use lateness::Lateness;
use sensor::{Edge, LISTENING, STUCK, Sensor};

pub use config::RingConfig;
pub use error::RingError;
pub use events::{PeriodStats, Reading, RingEvent};

/// A ring of up to `K` sensors: the scheduler `S` says when each fires, and the filter says what each reading is worth.
/// `E` is the number of echoes that a sensor reports of one firing.
///
/// ```
/// use eeruf_core::{RingConfig, RingEvent, Instant, ReadingKind, Micros, Ring, tables::TABLE_I_D};
///
/// let config = RingConfig::new(Micros::new(999), Micros::from_millis(36));
/// let mut ring = Ring::new(&TABLE_I_D, config, Instant::from_micros(0))?;
/// let mut accepted = 0;
/// for _ in 0..1000 {
///     let now = ring.next_deadline(); // where firmware would sleep
///     while let Some(event) = ring.poll(now) {
///         match event {
///             RingEvent::Fire(sensor) => ring.echo(sensor, now + Micros::from_millis(12)), // a wall 2 m away
///             RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
///             RingEvent::PeriodEnded(stats) => assert_eq!(stats.max_late, Micros::ZERO),
///         }
///     }
/// }
/// assert!(accepted > 400);
/// # Ok::<(), eeruf_core::RingError>(())
/// ```
#[derive(Clone, Debug)]
// In this order: a Cortex-M0 reaches only the first 124 bytes of a structure in one instruction.
#[repr(C)]
pub struct Ring<S, const K: usize, const E: usize = 1> {
    /// The sensor whose window closes first, or [`NOBODY`].
    oldest: u8,
    /// How many sensors have a reading to emit before their window closes.
    ready: u8,
    agreement: Agreement,
    tally: Tally<u8>,
    lateness: Lateness,
    scheduler: S,
    /// When the next reading can be emitted: when an edge came, or when the window of the oldest closes.
    emit_at: Instant,
    window: Micros,
    t_delta: Micros,
    blanking: Micros,
    period: u32,
    sensors: [Sensor<E>; K],
    /// The sum of lateness at each sensor's last firing (see [`Lateness`]); in an array of its own, since a sensor's
    /// other fields fill their words.
    totals: [u16; K],
}

/// A [`Ring`] with scheduled firing by a schedule of the paper's kind.
pub type ScheduledRing<'s, const K: usize, const E: usize = 1> = Ring<ScheduledFiring<'s, K>, K, E>;

const NOBODY: u8 = u8::MAX;

impl<'s, const K: usize, const M: usize> Ring<ScheduledFiring<'s, K, M>, K> {
    /// A ring with scheduled firing that begins at `now`.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn new(schedule: &'s Schedule<K, M>, config: RingConfig, now: Instant) -> Result<Self, RingError> {
        Self::with_scheduler(ScheduledFiring::new(schedule, now), config, now)
    }
}

impl<'s, const K: usize, const M: usize, const E: usize> Ring<ScheduledFiring<'s, K, M>, K, E> {
    /// The schedule of the present period.
    pub const fn schedule(&self) -> &'s Schedule<K, M> {
        self.scheduler.schedule()
    }

    /// Changes to another schedule when the present period ends (see [`ScheduledFiring::change_schedule`]). Readings
    /// before and after the change are not compared.
    ///
    /// # Errors
    /// [`RingError::Window`] if a sensor would fire again while it still listens; [`RingError::TDelta`] if the schedule
    /// was verified for a smaller `t_delta`.
    pub fn change_schedule(&mut self, schedule: &'s Schedule<K, M>) -> Result<(), RingError> {
        if let Some(promise) = schedule.promise() {
            if self.t_delta > promise.t_delta {
                return Err(RingError::TDelta { t_delta: self.t_delta, verified: promise.t_delta });
            }
        }
        if self.window > schedule.min_refire() {
            return Err(RingError::Window { window: self.window, min_refire: schedule.min_refire() });
        }
        self.scheduler.change_schedule(schedule);
        Ok(())
    }
}

impl<'s, const K: usize, const M: usize> Ring<ImmediateRefiring<'s, K, M>, K> {
    /// A ring with immediate refiring that begins at `now`; no sensor fires again sooner than `min_refire`.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn immediate(
        schedule: &'s Schedule<K, M>,
        config: RingConfig,
        min_refire: Micros,
        now: Instant,
    ) -> Result<Self, RingError> {
        Self::with_scheduler(ImmediateRefiring::new(schedule, min_refire, now), config, now)
    }
}

impl<S: Scheduler, const K: usize, const E: usize> Ring<S, K, E> {
    /// Copied from flash: an array made at run time would first be built on the stack.
    const SENSORS: [Sensor<E>; K] = [Sensor::NEW; K];

    /// A ring with the caller's own scheduler and any number of echoes a firing.
    ///
    /// # Errors
    /// [`RingError`] if the ring is smaller than its scheduler, if a sensor would fire again while it still listens, if
    /// the window ends within the blanking time, if `t_delta` is no shorter than the window or longer than what the
    /// schedule was verified for, or if the number of consecutive readings is not 2 to 8 or the patience more than 15.
    pub fn with_scheduler(scheduler: S, config: RingConfig, now: Instant) -> Result<Self, RingError> {
        let RingConfig { t_delta, window, blanking, consecutive, patience } = config;
        if scheduler.sensors() > K {
            return Err(RingError::Sensors { sensors: scheduler.sensors(), capacity: K });
        }
        if let Some(verified) = scheduler.verified_t_delta() {
            if t_delta > verified {
                return Err(RingError::TDelta { t_delta, verified });
            }
        }
        // No echo time within a window can then be mistaken for an instant before the firing.
        let longest = scheduler.longest_window().min(Micros::new(u32::MAX / 2));
        if window > longest {
            return Err(RingError::Window { window, min_refire: longest });
        }
        if window <= blanking {
            return Err(RingError::Blanking { blanking, window });
        }
        if t_delta >= window {
            return Err(RingError::CoarseTDelta { t_delta, window });
        }
        let agreement = Agreement::new(consecutive, patience)?;
        Ok(Self {
            oldest: NOBODY,
            ready: 0,
            agreement,
            tally: Tally::default(),
            lateness: Lateness::NEW,
            scheduler,
            emit_at: now,
            window,
            t_delta,
            blanking,
            period: 0,
            sensors: Self::SENSORS,
            totals: [0; K],
        })
    }

    /// The next event, if there is one at `now`. Call again until there is none, then sleep until
    /// [`next_deadline`](Self::next_deadline).
    ///
    /// Hand in the echo edges you know of before you poll: an edge that comes after the poll that closed its window is
    /// lost. A late poll loses nothing: firings that are due are postponed, and all later ones with them. Where late
    /// firings shift crosstalk by more than the schedule has to spare, readings are not compared with the ones before;
    /// that all firings are late alike shifts nothing. [`PeriodStats`] says how late they were.
    #[inline]
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// As [`poll`](Self::poll), for a robot that moves: `expected_change_us` is asked for the change in microseconds
    /// that a good reading of a sensor should show since its firing before (see [`EchoFilter::push_echoes`]).
    ///
    /// [`EchoFilter::push_echoes`]: crate::EchoFilter::push_echoes
    #[inline]
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let due = self.scheduler.deadline();
        if now.has_reached(due) || (self.has_pending() && now.has_reached(self.emit_at)) {
            return self.advance(now, expected_change_us);
        }
        if due.since(now) > self.scheduler.horizon() {
            self.clock_jumped(now);
        }
        None
    }

    /// When to poll next. In the past if an event is pending.
    pub fn next_deadline(&self) -> Instant {
        let due = self.scheduler.deadline();
        if self.has_pending() && !self.emit_at.has_reached(due) { self.emit_at } else { due }
    }

    /// Whether a reading will be emitted without a further firing.
    #[inline]
    fn has_pending(&self) -> bool {
        self.ready > 0 || self.oldest != NOBODY
    }

    /// An edge on the echo line of a sensor, `at` this instant. Cheap; edges may come in any order, at any time, from
    /// any sensor, wanted or not.
    pub fn echo(&mut self, sensor: u8, at: Instant) {
        let Some(heard) = self.sensors.get_mut(usize::from(sensor)) else { return };
        match heard.echo(at, self.blanking, self.window) {
            Edge::Ready => {
                if !self.has_pending() || !at.has_reached(self.emit_at) {
                    self.emit_at = at;
                }
                self.ready = self.ready.saturating_add(1);
            }
            Edge::Late => self.tally.count(ReadingKind::Late),
            Edge::Stored => {}
        }
    }

    /// Reports that the echo line of a sensor was already high when it was to fire: the firing just emitted counts as
    /// [`ReadingKind::Stuck`], whatever edges follow.
    pub fn stuck(&mut self, sensor: u8) {
        if let Some(stuck) = self.sensors.get_mut(usize::from(sensor)) {
            if stuck.is(LISTENING) {
                stuck.set(STUCK);
            }
        }
    }

    /// Stops a sensor from firing. The reading of a firing that is under way is still emitted.
    pub fn disable(&mut self, sensor: u8) {
        self.scheduler.set_enabled(sensor, false);
    }

    /// Lets a sensor fire again from its next turn on. Its readings from before are forgotten.
    pub fn enable(&mut self, sensor: u8) {
        if self.scheduler.is_enabled(sensor) {
            return;
        }
        self.scheduler.set_enabled(sensor, true);
        if let Some(sensor) = self.sensors.get_mut(usize::from(sensor)) {
            sensor.tracker.forget();
        }
    }

    /// Whether a sensor fires.
    pub fn is_enabled(&self, sensor: u8) -> bool {
        self.scheduler.is_enabled(sensor)
    }

    /// Starts again with phase a at `now`, or as soon as the last firings allow. Firings under way are dropped,
    /// readings from before are forgotten; ages and the count of periods go on.
    pub fn restart(&mut self, now: Instant) {
        self.scheduler.restart(now);
        for sensor in &mut self.sensors {
            sensor.drop_firing();
        }
        self.oldest = NOBODY;
        self.ready = 0;
        // Sound from before may still be heard in the first period.
        self.lateness.begin_anew(&mut self.totals);
    }

    /// The scheduler.
    pub const fn scheduler(&self) -> &S {
        &self.scheduler
    }

    pub(crate) const fn scheduler_mut(&mut self) -> &mut S {
        &mut self.scheduler
    }

    /// The clock has jumped.
    #[cold]
    fn clock_jumped(&mut self, now: Instant) {
        self.restart(now);
    }
}
