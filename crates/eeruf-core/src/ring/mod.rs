//! [`Ring`]: scheduler and filter together, with what real sensors need: blanking, windows, stuck lines, late polls.
//!
//! The caller polls, fires the sensors it is asked to fire, hands in the instants of echo edges, and sleeps until the
//! next deadline. Nothing here blocks, allocates, panics or reads a clock. The room uses the scheduler and the filter.

mod changes;
mod config;
mod error;
mod events;
mod fired;
mod lateness;
mod listening;
mod sensor;
mod steps;

use crate::filter::Agreement;
use crate::reading::{ReadingKind, Tally};
use crate::schedule::Schedule;
use crate::scheduler::{ImmediateRefiring, ScheduledFiring, Scheduler, UnevenFiring};
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};
use crate::uneven_schedule::UnevenSchedule;
use crate::verified::VerifiedSchedule;

use lateness::Lateness;
use listening::Listening;
use sensor::{LISTENING, Noted, STUCK, Sensor};

pub use config::RingConfig;
pub use error::RingError;
pub use events::{PeriodStats, Reading, RingEvent};

/// A ring of up to `K` sensors: the scheduler `S` says when each fires, and the filter says what each reading is worth.
/// `E` is the number of echoes that a sensor reports of one firing.
///
/// ```
/// use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
///
/// let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
/// let mut accepted = 0;
/// for _ in 0..1000 {
///     let now = ring.next_deadline(); // where firmware would sleep
///     while let Some(event) = ring.poll(now) {
///         match event {
///             RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(12))?, // a wall 2 m away
///             RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
///             RingEvent::PeriodEnded(stats) => assert_eq!(stats.max_late, Micros::ZERO),
///         }
///     }
/// }
/// assert!(accepted > 400);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order: a Cortex-M0 reaches only the first 124 bytes of a structure in one instruction, of single bytes 31.
// What comes before the sensors is whole words, or they are built on the stack and copied.
#[repr(C)]
pub struct Ring<S, const K: usize, const E: usize = 1> {
    /// The sensor whose window closes first, or [`NOBODY`].
    oldest: u8,
    /// How many sensors have a reading to emit before their window closes.
    ready: u8,
    /// The last of them to get it, or a sensor that has emitted it since.
    last_ready: u8,
    agreement: Agreement,
    /// When the next reading can be emitted: when an edge came, or when the window of the oldest closes.
    emit_at: Instant,
    listening: Listening,
    period: u32,
    scheduler: S,
    lateness: Lateness,
    sensors: [Sensor<E>; K],
    /// The sum of lateness at each sensor's last firing (see [`Lateness`]); in an array of its own, since a sensor's
    /// other fields fill their words.
    totals: [u16; K],
    tally: Tally<u8>,
}

/// A [`Ring`] with scheduled firing by a schedule of the paper's kind.
pub type ScheduledRing<'s, const K: usize, const E: usize = 1> = Ring<ScheduledFiring<'s, K>, K, E>;

const NOBODY: u8 = u8::MAX;

impl<'s, const K: usize, const M: usize, const E: usize> Ring<ScheduledFiring<'s, K, M>, K, E> {
    /// A ring with scheduled firing that begins at `now`. It listens and compares as the schedule was verified for,
    /// unless `config` asks for less.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn new(schedule: &'s VerifiedSchedule<K, M>, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        Self::unverified(schedule, config, now)
    }

    /// As [`new`](Self::new), by a schedule that nobody has verified: the conventional method with its constant waits,
    /// for comparison. Crosstalk may be accepted, whatever [`ReadingKind`] says; `config` needs `t_delta` and window.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn unverified(schedule: &'s Schedule<K, M>, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        Self::with_scheduler(ScheduledFiring::new(schedule, now), config, now)
    }

    /// The schedule of the present period.
    pub const fn schedule(&self) -> &'s Schedule<K, M> {
        self.scheduler.schedule()
    }
}

impl<'s, const K: usize, const E: usize> Ring<UnevenFiring<'s, K>, K, E> {
    /// A ring of sensors that are not all alike, with scheduled firing that begins at `now`. Each sensor listens and
    /// compares as it was verified for, unless `config` asks for less: what it says is the most for all.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn uneven(schedule: &'s UnevenSchedule<K>, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        Self::with_scheduler(UnevenFiring::new(schedule, now), config, now)
    }

    /// The schedule of the present period.
    pub const fn schedule(&self) -> &'s UnevenSchedule<K> {
        self.scheduler.schedule()
    }
}

impl<'s, const K: usize, const M: usize, const E: usize> Ring<ImmediateRefiring<'s, K, M>, K, E> {
    /// A ring with immediate refiring that begins at `now`; no sensor fires again sooner than `min_refire`. `config`
    /// needs `t_delta` and window, since nothing can be verified without a common period.
    ///
    /// # Errors
    /// As for [`Ring::with_scheduler`].
    pub fn immediate(
        schedule: &'s Schedule<K, M>,
        config: RingConfig<E>,
        min_refire: Micros,
        now: Instant,
    ) -> Result<Self, RingError> {
        Self::with_scheduler(ImmediateRefiring::new(schedule, min_refire, now), config, now)
    }
}

impl<S: Scheduler, const K: usize, const E: usize> Ring<S, K, E> {
    /// Copied from flash: an array made at run time would first be built on the stack.
    const SENSORS: [Sensor<E>; K] = [Sensor::NEW; K];

    /// A ring with the caller's own scheduler. Where its schedule was verified, it listens and compares as it was
    /// verified for, unless `config` asks for less.
    ///
    /// # Errors
    /// [`RingError`] if `config` asks for more than the schedule was verified for, or does not say `t_delta` and window
    /// where it was not; if the ring is smaller than its scheduler, if a sensor would fire again while it still
    /// listens, if `t_delta` or blanking time are no shorter than the window or longer than 65,535 us, or if the number
    /// of consecutive readings is not 2 to 8 or the patience more than 15.
    pub fn with_scheduler(scheduler: S, config: RingConfig<E>, now: Instant) -> Result<Self, RingError> {
        if scheduler.sensors() > K {
            return Err(RingError::Sensors { sensors: scheduler.sensors(), capacity: K });
        }
        let listening = Listening::new(&config, &scheduler)?;
        let agreement = Agreement::new(config.consecutive, config.patience)?;
        Ok(Self {
            oldest: NOBODY,
            ready: 0,
            agreement,
            last_ready: NOBODY,
            tally: Tally::default(),
            lateness: Lateness::NEW,
            scheduler,
            emit_at: now,
            listening,
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
        if self.is_due(now) {
            return self.advance(now, expected_change_us);
        }
        if self.has_jumped(now) {
            self.clock_jumped(now);
        }
        None
    }

    /// Whether there may be an event.
    #[inline(always)]
    pub(crate) fn is_due(&self, now: Instant) -> bool {
        now.has_reached(self.scheduler.deadline()) || (self.has_pending() && now.has_reached(self.emit_at))
    }

    /// Whether the clock must have jumped, since what is next is too far ahead.
    #[inline(always)]
    pub(crate) fn has_jumped(&self, now: Instant) -> bool {
        self.scheduler.deadline().since(now) > self.scheduler.horizon()
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
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    #[inline]
    pub fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        let window = self.listening.window_of(&self.scheduler, sensor);
        let Some(heard) = self.sensors.get_mut(usize::from(sensor)) else {
            return self.no_such(sensor);
        };
        match heard.echo(at, self.listening.blanking(), window) {
            Noted::Ready => {
                if !self.has_pending() || !at.has_reached(self.emit_at) {
                    self.emit_at = at;
                }
                self.ready = self.ready.saturating_add(1);
                self.last_ready = sensor;
            }
            Noted::Late => self.tally.count(ReadingKind::Late),
            // As is every edge of a sensor that the ring has room for and does not have.
            Noted::Unwanted if usize::from(sensor) >= self.sensors() => return self.no_such(sensor),
            Noted::Stored | Noted::Unwanted => {}
        }
        Ok(())
    }

    /// Reports that the echo line of a sensor was already high when it was to fire: the firing just emitted counts as
    /// [`ReadingKind::Stuck`], whatever edges follow.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn stuck(&mut self, sensor: u8) -> Result<(), SensorError> {
        let stuck = self.sensor_mut(sensor)?;
        if stuck.is(LISTENING) {
            stuck.set(STUCK);
        }
        Ok(())
    }

    /// Whether a sensor fires.
    pub fn is_enabled(&self, sensor: u8) -> bool {
        self.scheduler.is_enabled(sensor)
    }

    /// `T_delta`: consecutive readings that differ by no more are near-identical. Where sensors have their own, the
    /// largest: see [`t_delta_of`](Self::t_delta_of).
    pub const fn t_delta(&self) -> Micros {
        self.listening.t_delta()
    }

    /// `T_delta` of one sensor.
    pub fn t_delta_of(&self, sensor: u8) -> Micros {
        self.listening.t_delta_of(&self.scheduler, sensor)
    }

    /// `T_wind`: how long a sensor listens after it has fired. Where sensors have their own, the longest: see
    /// [`window_of`](Self::window_of).
    pub const fn window(&self) -> Micros {
        self.listening.window()
    }

    /// `T_wind` of one sensor.
    #[inline]
    pub fn window_of(&self, sensor: u8) -> Micros {
        self.listening.window_of(&self.scheduler, sensor)
    }

    /// How long a sensor is deaf after it has fired.
    pub const fn blanking(&self) -> Micros {
        self.listening.blanking()
    }

    /// The number of sensors.
    pub fn sensors(&self) -> usize {
        self.scheduler.sensors()
    }

    /// The error is made out of line, since it is rare and takes more instructions than all else.
    #[cold]
    #[inline(never)]
    fn no_such(&self, sensor: u8) -> Result<(), SensorError> {
        Err(SensorError::new(sensor, self.sensors()))
    }

    #[inline]
    fn sensor_mut(&mut self, sensor: u8) -> Result<&mut Sensor<E>, SensorError> {
        let sensors = self.scheduler.sensors();
        match self.sensors.get_mut(usize::from(sensor)) {
            Some(found) if usize::from(sensor) < sensors => Ok(found),
            _ => Err(SensorError::new(sensor, sensors)),
        }
    }

    /// The scheduler.
    pub const fn scheduler(&self) -> &S {
        &self.scheduler
    }

    pub(crate) const fn scheduler_mut(&mut self) -> &mut S {
        &mut self.scheduler
    }

    /// The scheduler, and when each sensor last fired, if it ever has.
    pub(crate) fn scheduler_and_firings(&mut self) -> (&mut S, impl Fn(u8) -> Instant + '_) {
        let sensors = &self.sensors;
        (&mut self.scheduler, |sensor| sensors.get(usize::from(sensor)).map_or(Instant::default(), |of| of.fired))
    }

    /// When a sensor last fired, if it ever has.
    pub(crate) fn last_firing(&self, sensor: u8) -> Option<Instant> {
        self.sensors.get(usize::from(sensor)).map(|of| of.fired)
    }

    /// Counts a reading that was [taken](Self::take_reading).
    pub(crate) fn count(&mut self, kind: ReadingKind) {
        self.tally.count(kind);
    }

    /// The clock has jumped.
    #[cold]
    fn clock_jumped(&mut self, now: Instant) {
        self.restart(now);
    }
}
