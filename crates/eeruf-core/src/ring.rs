//! [`Ring`]: scheduler and filter together, with the hygiene that real sensors need.
//!
//! The caller polls, fires what it is told to fire, hands in the instants of echo edges, and sleeps until the next
//! deadline. Nothing here blocks, allocates, panics or reads a clock.

mod sensor;

use core::fmt;

use self::sensor::{DISTURBED, Edge, LISTENING, READY, STUCK, Sensor};
use crate::filter::{Agreement, FilterError, Rule};
use crate::reading::{ReadingKind, Tally, Verdict};
use crate::refiring::ImmediateRefiring;
use crate::schedule::{Phase, Schedule};
use crate::scheduler::{ScheduledFiring, Scheduler};
use crate::time::{Instant, Micros};

/// How a [`Ring`] listens and compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RingConfig {
    /// `T_delta`: consecutive readings that differ by no more are near-identical.
    pub t_delta: Micros,
    /// `T_wind`: how long a sensor listens after it has fired. An echo at this very time still counts.
    pub window: Micros,
    /// Edges sooner than this after firing are ringing of the transducer, not echoes.
    pub blanking: Micros,
    /// How many readings running must agree, 2 to 8.
    pub consecutive: u8,
    /// For how many firings an accepted echo that is missing is waited for, 0 to 15; see
    /// [`EchoFilter::with_patience`](crate::EchoFilter::with_patience).
    pub patience: u8,
}

impl RingConfig {
    /// This `t_delta` and window, no blanking, two readings compared and no patience, as in the paper.
    pub const fn new(t_delta: Micros, window: Micros) -> Self {
        Self { t_delta, window, blanking: Micros::ZERO, consecutive: 2, patience: 0 }
    }
}

/// What a [`Ring`] tells its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RingEvent {
    /// Fire this sensor (from 0), now.
    Fire(u8),
    /// What became of an earlier firing.
    Reading(Reading),
    /// A period has ended.
    PeriodEnded(PeriodStats),
}

/// What became of one firing of one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reading {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase in which it fired.
    pub phase: Phase,
    /// The period in which it fired, counted from 0.
    pub period: u32,
    /// What the firing told.
    pub kind: ReadingKind,
    /// The echo time; `None` without echo.
    pub t_echo: Option<Micros>,
    /// The echo time that it was compared with.
    pub previous: Option<Micros>,
    /// How many firings ago this sensor's last reading was accepted; `None` if none ever was.
    pub age: Option<u16>,
}

/// What happened since the end of the period before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeriodStats {
    /// The period, counted from 0.
    pub period: u32,
    /// Its phase.
    pub phase: Phase,
    /// The readings told since the period before ended, by kind.
    pub tally: Tally<u8>,
    /// The latest firing: how long after it was due it was polled for, at most 65,535 us.
    pub max_late: Micros,
}

/// A ring of up to `K` sensors that fires by the scheduler `S`, and believes only what its filter accepts. `E` is the
/// number of echoes a sensor reports of one firing.
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
    /// How many sensors have a reading to tell before their window closes.
    ready: u8,
    agreement: Agreement,
    /// How many more period ends disturb the comparison.
    unsettled: u8,
    max_late_us: u16,
    tally: Tally<u8>,
    scheduler: S,
    /// When to tell next: when an edge came, or when the window of the oldest closes.
    tell_at: Instant,
    window: Micros,
    t_delta: Micros,
    blanking: Micros,
    period: u32,
    sensors: [Sensor<E>; K],
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
    /// [`RingError::Window`] if a sensor would fire again while it still listens.
    pub fn change_schedule(&mut self, schedule: &'s Schedule<K, M>) -> Result<(), RingError> {
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
    /// Copied from flash, since an array made anew would first be made on the stack.
    const SENSORS: [Sensor<E>; K] = [Sensor::NEW; K];

    /// A ring with a scheduler of the caller's and any number of echoes a firing.
    ///
    /// # Errors
    /// [`RingError`] if a sensor would fire again while it still listens, if the window ends within the blanking time,
    /// or if the number of consecutive readings is not 2 to 8 or the patience more than 15.
    pub fn with_scheduler(scheduler: S, config: RingConfig, now: Instant) -> Result<Self, RingError> {
        let RingConfig { t_delta, window, blanking, consecutive, patience } = config;
        // No echo time within a window can then be mistaken for an instant before the firing.
        let longest = scheduler.longest_window().min(Micros::new(u32::MAX / 2));
        if window > longest {
            return Err(RingError::Window { window, min_refire: longest });
        }
        if window <= blanking {
            return Err(RingError::Blanking { blanking, window });
        }
        let agreement = Agreement::new(consecutive, patience)?;
        Ok(Self {
            oldest: NOBODY,
            ready: 0,
            agreement,
            unsettled: 0,
            max_late_us: 0,
            tally: Tally::default(),
            scheduler,
            tell_at: now,
            window,
            t_delta,
            blanking,
            period: 0,
            sensors: Self::SENSORS,
        })
    }

    /// The next thing to do or to know, if there is one at `now`. Call again until there is none, then sleep until
    /// [`next_deadline`](Self::next_deadline).
    ///
    /// Hand in the echo edges you know of before you poll: an edge that comes after the poll that closed its window is
    /// not heard.
    /// A late poll loses nothing: firings that are due move back, and all later ones with them. After one that is late by
    /// more than `t_delta` the readings of about two periods are compared with nothing, since crosstalk has shifted by as
    /// much.
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
        if now.has_reached(due) || (self.has_to_tell() && now.has_reached(self.tell_at)) {
            return self.advance(now, expected_change_us);
        }
        if due.since(now) > self.scheduler.horizon() {
            self.jumped(now);
        }
        None
    }

    /// When to poll next. In the past if something is waiting to be told.
    pub fn next_deadline(&self) -> Instant {
        let due = self.scheduler.deadline();
        if self.has_to_tell() && !self.tell_at.has_reached(due) { self.tell_at } else { due }
    }

    /// Whether there will be something to tell without a further firing.
    #[inline]
    fn has_to_tell(&self) -> bool {
        self.ready > 0 || self.oldest != NOBODY
    }

    /// An edge on the echo line of a sensor, `at` this instant. Cheap; edges may come in any order, at any time, from
    /// any sensor, wanted or not.
    pub fn echo(&mut self, sensor: u8, at: Instant) {
        let Some(heard) = self.sensors.get_mut(usize::from(sensor)) else { return };
        match heard.echo(at, self.blanking, self.window) {
            Edge::Ready => {
                if !self.has_to_tell() || !at.has_reached(self.tell_at) {
                    self.tell_at = at;
                }
                self.ready = self.ready.saturating_add(1);
            }
            Edge::Late => self.tally.count(ReadingKind::Late),
            Edge::Noted => {}
        }
    }

    /// Reports that the echo line of a sensor was already high when it was to fire: the firing just told counts as
    /// [`ReadingKind::Stuck`], whatever edges follow.
    pub fn stuck(&mut self, sensor: u8) {
        if let Some(stuck) = self.sensors.get_mut(usize::from(sensor)) {
            if stuck.is(LISTENING) {
                stuck.set(STUCK);
            }
        }
    }

    /// Has a sensor fire no more. A firing of it that is under way is still told.
    pub fn disable(&mut self, sensor: u8) {
        self.scheduler.set_enabled(sensor, false);
    }

    /// Has a sensor fire again from its next turn on. Its readings from before are forgotten.
    pub fn enable(&mut self, sensor: u8) {
        if self.scheduler.is_enabled(sensor) {
            return;
        }
        self.scheduler.set_enabled(sensor, true);
        if let Some(sensor) = self.sensors.get_mut(usize::from(sensor)) {
            sensor.track.forget();
        }
    }

    /// Whether a sensor fires.
    pub fn is_enabled(&self, sensor: u8) -> bool {
        self.scheduler.is_enabled(sensor)
    }

    /// Begins anew with phase a at `now`, or as soon as the last firings allow. Firings under way are dropped, readings
    /// from before are forgotten; ages and the count of periods go on.
    pub fn restart(&mut self, now: Instant) {
        self.scheduler.restart(now);
        for sensor in &mut self.sensors {
            sensor.drop_firing();
        }
        self.oldest = NOBODY;
        self.ready = 0;
    }

    /// The scheduler.
    pub const fn scheduler(&self) -> &S {
        &self.scheduler
    }

    /// The clock has jumped.
    #[cold]
    fn jumped(&mut self, now: Instant) {
        self.restart(now);
    }

    /// Something is due. Firing comes first, since it should be on time; but a sensor tells what it heard before it
    /// fires again.
    #[inline]
    fn advance(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let due = self.scheduler.deadline();
        let fires = if now.has_reached(due) { self.scheduler.next_firing() } else { None };
        let told = match fires {
            Some((sensor, phase)) => match self.sensors.get_mut(usize::from(sensor)) {
                Some(untold) if untold.is(LISTENING | READY) => Some(sensor),
                fired => {
                    if let Some(fired) = fired {
                        fired.fire(phase, now);
                    }
                    self.fired(sensor, now.since(due), now);
                    self.scheduler.fire(now);
                    return Some(RingEvent::Fire(sensor));
                }
            },
            None => self.next_to_tell(now),
        };
        match told {
            Some(sensor) => self.tell(sensor, expected_change_us),
            None => self.end_period(now),
        }
    }

    #[inline]
    fn fired(&mut self, sensor: u8, late: Micros, now: Instant) {
        if late.as_micros() > self.max_late_us.into() {
            self.fired_late(late);
        }
        if self.oldest == NOBODY {
            self.oldest = sensor;
            if self.ready == 0 {
                self.tell_at = now + self.window;
            }
        }
    }

    /// Nothing in this period has fired later yet.
    #[inline(never)]
    fn fired_late(&mut self, late: Micros) {
        self.max_late_us = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        if late > self.t_delta {
            // Sound sent before this moment may be heard for a period, and its readings compared for one more. A further
            // late firing in this period changes nothing: what is told until its end is compared with nothing already.
            self.unsettled = 2;
            self.disturb();
        }
    }

    #[inline(never)]
    fn end_period(&mut self, now: Instant) -> Option<RingEvent> {
        if !now.has_reached(self.scheduler.deadline()) {
            return None;
        }
        let (phase, changed) = self.scheduler.end_period(now);
        if changed {
            self.unsettled = 2;
        }
        if self.unsettled > 0 {
            self.unsettled -= 1;
            self.disturb();
        }
        let stats = PeriodStats {
            period: self.period,
            phase,
            tally: core::mem::take(&mut self.tally),
            max_late: Micros::new(core::mem::take(&mut self.max_late_us).into()),
        };
        self.period = self.period.wrapping_add(1);
        Some(RingEvent::PeriodEnded(stats))
    }

    /// Firings have shifted against each other, by lateness or by a change of schedule, so (13a), (13b) say nothing about
    /// readings of sound from before compared with readings of sound from after. The next reading of each sensor, which
    /// may be of either, is compared with nothing.
    #[cold]
    #[inline(never)]
    fn disturb(&mut self) {
        for sensor in &mut self.sensors {
            sensor.set(DISTURBED);
        }
    }

    /// A sensor with an echo in, or one whose window has closed.
    fn next_to_tell(&self, now: Instant) -> Option<u8> {
        if self.ready > 0 {
            return self.first_ready();
        }
        (self.oldest != NOBODY && now.has_reached(self.tell_at)).then_some(self.oldest)
    }

    /// A sensor with something to tell; the oldest before others, which saves the search where it costs most: the next
    /// oldest has then to be looked for, too.
    fn first_ready(&self) -> Option<u8> {
        if self.sensor(self.oldest).is_some_and(|oldest| oldest.is(READY)) {
            return Some(self.oldest);
        }
        for (x, sensor) in self.sensors.iter().enumerate() {
            if sensor.is(READY) {
                // At most 64 sensors.
                return Some(x as u8);
            }
        }
        None
    }

    #[inline(never)]
    fn tell(&mut self, sensor: u8, mut expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let heard = self.sensors.get_mut(usize::from(sensor))?;
        let phase = heard.phase();
        let (listened, fired) = (heard.is(LISTENING), heard.fired);
        let mut ended_at = fired + self.window;
        if heard.is(READY) {
            // It was counted when its edge came.
            self.ready = self.ready.wrapping_sub(1);
            ended_at = fired + heard.held().unwrap_or_default();
        }
        let verdict = if listened {
            heard.judge(Rule { t_delta: self.t_delta, agreement: self.agreement }, || expected_change_us(sensor))
        } else {
            heard.tell_late()
        };
        if listened {
            self.scheduler.ended(sensor, ended_at);
            if self.oldest == sensor {
                self.find_oldest(fired);
            }
        }
        if self.ready == 0 {
            if let Some(oldest) = self.sensor(self.oldest) {
                self.tell_at = oldest.fired + self.window;
            }
        }
        self.tally.count(verdict.kind);
        let Verdict { kind, t_echo, previous, age } = verdict;
        let period = self.period.wrapping_sub(self.scheduler.periods_since(phase).into());
        Some(RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age }))
    }

    /// The oldest, which fired at `before`, listens no more: which one is it now? All others fired later.
    fn find_oldest(&mut self, before: Instant) {
        let (mut oldest, mut soonest) = (NOBODY, Micros::MAX);
        for (x, sensor) in self.sensors.iter().enumerate() {
            if sensor.is(LISTENING) && sensor.fired.since(before) < soonest {
                // At most 64 sensors.
                (oldest, soonest) = (x as u8, sensor.fired.since(before));
            }
        }
        self.oldest = oldest;
    }

    fn sensor(&self, sensor: u8) -> Option<&Sensor<E>> {
        self.sensors.get(usize::from(sensor))
    }
}

/// Why a [`Ring`] cannot be set up as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RingError {
    /// A sensor would fire again while it still listens.
    Window {
        /// The window asked for.
        window: Micros,
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
    },
    /// The window is over before the blanking time.
    Blanking {
        /// The blanking time asked for.
        blanking: Micros,
        /// The window asked for.
        window: Micros,
    },
    /// The filter cannot compare so many readings.
    Filter(FilterError),
}

impl From<FilterError> for RingError {
    fn from(error: FilterError) -> Self {
        Self::Filter(error)
    }
}

impl fmt::Display for RingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Window { window, min_refire } => write!(
                f,
                "a listening window of {window}; a sensor of this schedule fires again after {min_refire}, \
                 expected a window no longer than that (T_wind)"
            ),
            Self::Blanking { blanking, window } => {
                write!(f, "a blanking time of {blanking}; expected less than the window of {window}")
            }
            Self::Filter(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for RingError {}
