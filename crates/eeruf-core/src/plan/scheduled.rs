//! [`ScheduledFiring`]: every sensor fires once per period, by the table of a schedule (Sec. 3.1, Fig. 3), which the
//! plan borrows or owns.

use core::ops::Deref;

use super::contract::{Plan, PlanLimits, Upcoming};
use crate::judging::FiringContext;
use crate::own_limits::{InUse, OwnLimits, SensorLimits};
use crate::schedule::{MAX_SENSORS, Phase, Schedule, VerifiedFor};
use crate::sensor_set::SensorSet;
use crate::time::{Instant, Micros, longer};
use crate::verified::VerifiedSchedule;

/// Scheduled firing: every sensor fires once per period, at the time the [`Schedule`] gives for the phase.
///
/// A late poll delays all later firings by as much: the timetable may stretch but never shrinks, so that no two firings
/// ever come closer than in the schedule, however late the caller is.
///
/// ```
/// use eeruf_core::{Instant, Phase, plan::{Plan, ScheduledFiring, Upcoming}, tables::TABLE_I_D};
/// let mut plan = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
/// let first = plan.deadline();
/// assert_eq!(first, Instant::from_micros(24_000));
/// assert_eq!(plan.poll(Instant::from_micros(23_999)), None);
/// assert_eq!(plan.poll(first), Some(Upcoming { sensor: 0, phase: Phase::A, due: first }));
/// ```
///
/// If sensors have limits of their own, each uses those that it was verified for; in the first period after a change of
/// schedule, the lesser of the two.
pub type ScheduledFiring<'s, const K: usize, const M: usize = 2, U = ()> = TableFiring<&'s Schedule<K, M>, K, M, U>;

/// [`ScheduledFiring`] with any pointer `T` to a [`Schedule`]: with `&Schedule` it borrows, with an `Arc` it owns, so
/// that it can be cloned and outlive the schedule's creator.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order for the short offsets of a Cortex-M0: see `Ring`.
#[repr(C)]
pub struct TableFiring<T, const K: usize, const M: usize = 2, U = ()> {
    phase: u8,
    /// Place in the firing order of the sensor after the next one.
    following: u8,
    /// The next sensor to fire; out of range when all have fired.
    next: u8,
    /// State of disabled and paused sensors, kept because asking all 64 at every firing takes time.
    skips: Skips,
    /// Time when the next step is due, a firing or the period's end; stored because each poll asks for it.
    due: Instant,
    schedule: T,
    /// Time when a sensor last fired; initially a time long past.
    last_fired: Instant,
    disabled: SensorSet,
    next_schedule: Option<T>,
    own_limits: InUse<U>,
}

/// Sensors that are skipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Skips {
    Nobody,
    Disabled,
    All,
}

impl<'s, const K: usize, const M: usize> ScheduledFiring<'s, K, M> {
    /// Begins the first period of `schedule` at `now`, with all sensors enabled.
    pub fn new(schedule: &'s Schedule<K, M>, now: Instant) -> Self {
        Self::with_limits(schedule, &(), now)
    }
}

impl<'s, const K: usize, const M: usize, U: OwnLimits> ScheduledFiring<'s, K, M, U> {
    /// Fires like [`new`](ScheduledFiring::new), by a schedule whose sensors may have limits of their own.
    pub fn verified<L: OwnLimits<Held<'s> = U>>(schedule: &'s VerifiedSchedule<K, M, L>, now: Instant) -> Self {
        Self::with_limits(schedule.schedule(), schedule.own_limits(), now)
    }

    /// Fires like [`verified`](Self::verified), with the schedule and the limits as two arguments.
    pub fn with_limits<L: OwnLimits<Held<'s> = U>>(
        schedule: &'s Schedule<K, M>,
        own_limits: &'s L,
        now: Instant,
    ) -> Self {
        Self::holding(schedule, own_limits.hold(), now)
    }

    /// The schedule of the current period.
    pub const fn schedule(&self) -> &'s Schedule<K, M> {
        self.schedule
    }

    /// Changes to another schedule when the current period ends.
    ///
    /// The two schedules were not verified against each other, so the first period begins late enough after the last
    /// firing to keep every refire time of the current schedule and every interval of both.
    pub fn change_schedule<L: OwnLimits<Held<'s> = U>>(&mut self, schedule: &'s VerifiedSchedule<K, M, L>) {
        self.change_to(schedule.schedule(), schedule.own_limits().hold());
    }
}

impl<T: Deref<Target = Schedule<K, M>>, const K: usize, const M: usize, U: OwnLimits> TableFiring<T, K, M, U> {
    /// Begins the first period of a schedule at `now`, with all sensors enabled. The plan holds `own_limits`: those
    /// that the schedule was verified for, or none.
    pub fn holding(schedule: T, own_limits: U, now: Instant) -> Self {
        let (next, gap) = schedule.firing(0, 0);
        let settling = settling_time(&*schedule).as_micros();
        Self {
            phase: 0,
            following: 1,
            next,
            skips: Skips::Nobody,
            due: now + gap,
            schedule,
            last_fired: Instant::from_micros(now.as_micros().wrapping_sub(settling)),
            disabled: SensorSet::NONE,
            next_schedule: None,
            own_limits: InUse::begin(own_limits),
        }
    }

    /// The pointer to the schedule of the current period.
    pub const fn table(&self) -> &T {
        &self.schedule
    }

    /// The pointer to the schedule of the next period.
    pub fn next_table(&self) -> &T {
        self.next_schedule.as_ref().unwrap_or(&self.schedule)
    }

    /// Changes like [`change_schedule`](ScheduledFiring::change_schedule), to a schedule and the limits that it was
    /// verified for.
    pub fn change_to(&mut self, schedule: T, own_limits: U) {
        self.next_schedule = Some(schedule);
        self.own_limits.change(own_limits);
    }

    /// Moves on to the next enabled sensor or, if there is none, to the end of the period. Gaps count from this
    /// instant.
    #[inline]
    fn turn(&mut self, from: Instant) {
        self.due = from;
        self.turn_once();
        if self.skips != Skips::Nobody {
            self.skip_disabled();
        }
    }

    #[cold]
    fn skip_disabled(&mut self) {
        while is_sensor::<K>(self.next) && (self.skips == Skips::All || self.disabled.contains(self.next)) {
            self.turn_once();
        }
    }

    #[inline]
    fn turn_once(&mut self) {
        let (next, gap) = self.schedule.firing(self.phase, self.following);
        self.following = self.following.wrapping_add(1);
        self.next = next;
        self.due += gap;
    }

    /// The earliest start of a period that was not verified against earlier firings.
    fn settled(&self) -> Instant {
        self.last_fired + settling_time(&*self.schedule)
    }

    const fn phase_after(&self, phase: u8) -> u8 {
        if (phase as usize) + 1 < M { phase + 1 } else { 0 }
    }

    fn begin_period(&mut self, phase: u8, start: Instant) {
        self.phase = phase;
        self.following = 0;
        self.turn(start);
    }
}

/// Returns true if an entry of the firing order is a sensor; unused entries are not.
const fn is_sensor<const K: usize>(sensor: u8) -> bool {
    (sensor as usize) < K && (sensor as usize) < MAX_SENSORS
}

/// Silence needed between the last firing and a period that was not verified against it. For an unverified schedule it
/// is a whole period: two neighbours fire within one, so no interval can be longer.
const fn settling_time<const K: usize, const M: usize>(schedule: &Schedule<K, M>) -> Micros {
    match schedule.verified_for() {
        Some(verified_for) => longer(verified_for.min_interval, schedule.min_refire()),
        None => longer(schedule.period(), schedule.min_refire()),
    }
}

impl<'s> PlanLimits<'s> {
    /// Limits of a schedule whose sensors have limits of their own, none greater than `most`: no sensor fires again
    /// within its own window.
    fn of_most(most: &'s VerifiedFor) -> Self {
        Self { longest_window: most.window, verified_for: Some(most), audible: Some(most.audible) }
    }
}

impl<const K: usize, const M: usize> Schedule<K, M> {
    /// The limits that the plan sets for its ring.
    pub(crate) const fn limits(&self) -> PlanLimits<'_> {
        let audible = match self.verified_for() {
            Some(verified_for) => verified_for.audible,
            None => self.period(),
        };
        PlanLimits { longest_window: self.min_refire(), verified_for: self.verified_for(), audible: Some(audible) }
    }
}

impl<T: Deref<Target = Schedule<K, M>>, const K: usize, const M: usize, U: OwnLimits> Plan for TableFiring<T, K, M, U> {
    #[inline]
    fn fire(&mut self, now: Instant) {
        self.last_fired = now;
        // From now, not from when it was due: all that follows moves by as much as this firing is late.
        self.turn(now);
    }

    fn postpone(&mut self, _sensor: u8, by: Micros) {
        self.last_fired += by;
        self.due += by;
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        let phase = Phase(self.phase);
        // Periods in which nothing fired need not be caught up with.
        let left_out = now.since(self.due) > self.schedule.period();
        let mut start = if left_out { now } else { self.due };
        let changed = left_out || self.next_schedule.is_some();
        // It must not fall half a turn of the clock behind while no sensor is enabled.
        let settling = settling_time(&*self.schedule);
        if start.since(self.last_fired) > settling {
            self.last_fired = Instant::from_micros(start.as_micros().wrapping_sub(settling.as_micros()));
        }
        self.own_limits.end_period();
        if let Some(next) = self.next_schedule.take() {
            let min_interval = next.verified_for().map_or(Micros::ZERO, |verified_for| verified_for.min_interval);
            let settled = self.last_fired + longer(settling, min_interval);
            if settled.has_reached(start) {
                start = settled;
            }
            self.schedule = next;
        }
        self.begin_period(self.phase_after(self.phase), start);
        (phase, changed)
    }

    #[inline]
    fn next_firing(&self) -> Option<(u8, Phase)> {
        is_sensor::<K>(self.next).then_some((self.next, Phase(self.phase)))
    }

    /// The firings up to the end of the next period, unless another schedule begins there.
    fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        let (mut phase, mut following, mut sensor, mut due) = (self.phase, self.following, self.next, self.due);
        let mut goes_on = self.next_schedule.is_none() && self.skips != Skips::All;
        core::iter::from_fn(move || {
            loop {
                let next = Upcoming { sensor, phase: Phase(phase), due };
                let fires = is_sensor::<K>(sensor);
                if !fires {
                    if !core::mem::take(&mut goes_on) {
                        return None;
                    }
                    (phase, following) = (self.phase_after(phase), 0);
                }
                let (follows, gap) = self.schedule.firing(phase, following);
                (sensor, following) = (follows, following.wrapping_add(1));
                due += gap;
                if fires && !self.disabled.contains(next.sensor) {
                    return Some(next);
                }
            }
        })
    }

    #[inline]
    fn deadline(&self) -> Instant {
        self.due
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.disabled.set(sensor, !enabled);
        self.set_paused(self.skips == Skips::All);
    }

    fn set_paused(&mut self, paused: bool) {
        let some_disabled = self.disabled != SensorSet::NONE;
        self.skips = if paused {
            Skips::All
        } else if some_disabled {
            Skips::Disabled
        } else {
            Skips::Nobody
        };
        self.skip_disabled();
    }

    fn sensors(&self) -> usize {
        self.schedule.sensors()
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.schedule.sensors() && !self.disabled.contains(sensor)
    }

    fn restart(&mut self, now: Instant) {
        let settled = self.settled();
        // A clock that has jumped says nothing about when the last firing was.
        let soon = !now.has_reached(settled) && settled.since(now) <= self.horizon();
        if !soon {
            // The last firing is kept no further back than matters, since the clock may jump again.
            self.last_fired =
                Instant::from_micros(now.as_micros().wrapping_sub(settling_time(&*self.schedule).as_micros()));
        }
        self.begin_period(0, if soon { settled } else { now });
    }

    fn last_firing(&self, _sensor: u8, periods_ago: u8) -> FiringContext {
        // At most `MAX_PHASES` phases, which is how many periods the ring looks back.
        let before = periods_ago % M as u8;
        FiringContext::new(Phase(if self.phase >= before {
            self.phase - before
        } else {
            self.phase + M as u8 - before
        }))
    }

    fn limits(&self) -> PlanLimits<'_> {
        self.own_limits.most().map_or_else(|| self.schedule.limits(), PlanLimits::of_most)
    }

    fn next_limits(&self) -> Option<PlanLimits<'_>> {
        let next = self.next_schedule.as_deref()?;
        Some(self.own_limits.next_most().map_or_else(|| next.limits(), PlanLimits::of_most))
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        self.own_limits.hears(receiver, emitter)
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.own_limits.limits_of(sensor)
    }

    fn min_refire(&self) -> Micros {
        self.schedule.min_refire()
    }

    #[inline]
    fn horizon(&self) -> Micros {
        // Settling takes less than two periods and the firing time less than one, and a period at most 2^28 us. After a
        // change to a faster schedule it is the slower one that settles; no last firing is further back than that.
        longer(Micros::new(3 * self.schedule.period().as_micros()), self.due.since(self.last_fired))
    }
}
