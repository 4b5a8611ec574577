//! [`ScheduledFiring`]: every sensor fires once per period, by the table of a schedule (Sec. 3.1, Fig. 3).

use super::contract::Scheduler;
use crate::schedule::{Phase, Schedule};
use crate::sensor_set::SensorSet;
use crate::time::{Instant, Micros};

/// Scheduled firing: every sensor fires once per period, at the time the [`Schedule`] gives for the phase.
///
/// A firing that is polled late moves all that follow by as much: the timetable may stretch but never shrinks, so that
/// no two firings ever come closer than in the schedule, however late the caller is.
///
/// ```
/// use eeruf_core::{Instant, Micros, Phase, ScheduledFiring, Scheduler, SchedulerStep, tables::TABLE_I_D};
/// let mut scheduler = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
/// let first = scheduler.deadline();
/// assert_eq!(first, Instant::from_micros(24_000));
/// assert_eq!(scheduler.poll(Instant::from_micros(23_999)), None);
/// assert_eq!(scheduler.poll(first), Some(SchedulerStep::Fire { sensor: 0, phase: Phase::A, late: Micros::ZERO }));
/// ```
#[derive(Clone, Debug)]
// In this order for the short offsets of a Cortex-M0: see `Ring`.
#[repr(C)]
pub struct ScheduledFiring<'s, const K: usize, const M: usize = 2> {
    phase: u8,
    /// Place in the firing order of the sensor after the next one.
    following: u8,
    /// The next sensor to fire; `K` or more when all have.
    next: u8,
    /// Whether any sensor is disabled, since asking all 64 takes time at every firing.
    some_disabled: bool,
    /// When it is due, or when the period ends. Worked out once per step, since it is asked for at every poll.
    due: Instant,
    schedule: &'s Schedule<K, M>,
    /// When a sensor last fired, or long enough ago.
    last_fired: Instant,
    disabled: SensorSet,
    next_schedule: Option<&'s Schedule<K, M>>,
}

impl<'s, const K: usize, const M: usize> ScheduledFiring<'s, K, M> {
    /// Begins the first period of `schedule` at `now`, with all sensors enabled.
    pub const fn new(schedule: &'s Schedule<K, M>, now: Instant) -> Self {
        let now = now.as_micros();
        let (next, gap) = schedule.firing(0, 0);
        Self {
            phase: 0,
            following: 1,
            next,
            some_disabled: false,
            due: Instant::from_micros(now.wrapping_add(gap.as_micros())),
            schedule,
            last_fired: Instant::from_micros(now.wrapping_sub(settling_time(schedule).as_micros())),
            disabled: SensorSet::NONE,
            next_schedule: None,
        }
    }

    /// The schedule of the present period.
    pub const fn schedule(&self) -> &'s Schedule<K, M> {
        self.schedule
    }

    /// Changes to another schedule when the present period ends.
    ///
    /// Since neither schedule was verified against the other, its first period begins late enough after the last firing
    /// to keep every interval and every refire time that the present schedule keeps.
    pub const fn change_schedule(&mut self, schedule: &'s Schedule<K, M>) {
        self.next_schedule = Some(schedule);
    }

    /// Turns to the following sensor, its gap after this instant, or to the next enabled one after it; if there is
    /// none, to the end of the period.
    #[inline]
    fn turn(&mut self, from: Instant) {
        self.due = from;
        self.turn_once();
        if self.some_disabled {
            self.skip_disabled();
        }
    }

    #[cold]
    fn skip_disabled(&mut self) {
        while usize::from(self.next) < K && self.disabled.contains(self.next) {
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

    /// When a period may begin that was not verified against what fired before.
    fn settled(&self) -> Instant {
        self.last_fired + settling_time(self.schedule)
    }

    fn begin_period(&mut self, phase: u8, start: Instant) {
        self.phase = phase;
        self.following = 0;
        self.turn(start);
    }
}

/// How long to stay silent after the last firing of a schedule so that a period which was not verified against it may
/// begin. Two neighbours fire once each per period, so no interval between them that the schedule always keeps is
/// longer than half of it.
const fn settling_time<const K: usize, const M: usize>(schedule: &Schedule<K, M>) -> Micros {
    let half_period = Micros::new(schedule.period().as_micros().div_ceil(2));
    let min_refire = schedule.min_refire();
    if min_refire.as_micros() > half_period.as_micros() { min_refire } else { half_period }
}

impl<const K: usize, const M: usize> Scheduler for ScheduledFiring<'_, K, M> {
    #[inline]
    fn fire(&mut self, now: Instant) {
        self.last_fired = now;
        // From now, not from when it was due: all that follows moves by as much as this firing is late.
        self.turn(now);
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        let phase = Phase(self.phase);
        // Periods in which nothing fired need not be caught up with.
        let mut start = if now.since(self.due) > self.schedule.period() { now } else { self.due };
        let changed = self.next_schedule.is_some();
        if let Some(next) = self.next_schedule.take() {
            let settled = self.settled();
            if settled.has_reached(start) {
                start = settled;
            }
            self.schedule = next;
        }
        let next_phase = if usize::from(self.phase) + 1 < M { self.phase + 1 } else { 0 };
        self.begin_period(next_phase, start);
        (phase, changed)
    }

    #[inline]
    fn next_firing(&self) -> Option<(u8, Phase)> {
        (usize::from(self.next) < K).then_some((self.next, Phase(self.phase)))
    }

    #[inline]
    fn deadline(&self) -> Instant {
        self.due
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.disabled.set(sensor, !enabled);
        self.some_disabled = self.disabled != SensorSet::NONE;
        self.skip_disabled();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.schedule.sensors() && !self.disabled.contains(sensor)
    }

    fn restart(&mut self, now: Instant) {
        let settled = self.settled();
        // A clock that has jumped says nothing about when the last firing was.
        let soon = !now.has_reached(settled) && settled.since(now) <= self.horizon();
        let start = if soon { settled } else { now };
        self.begin_period(0, start);
    }

    fn periods_since(&self, phase: Phase) -> u8 {
        // At most `MAX_PHASES` phases.
        if self.phase >= phase.0 { self.phase - phase.0 } else { (self.phase + M as u8).saturating_sub(phase.0) }
    }

    fn longest_window(&self) -> Micros {
        self.schedule.min_refire()
    }

    #[inline]
    fn horizon(&self) -> Micros {
        // Settling takes less than two periods and the firing time less than one, and a period at most 2^28 us.
        Micros::new(3 * self.schedule.period().as_micros())
    }
}
