//! When to fire: [`Scheduler`], and *scheduled firing* (Sec. 3.1, Fig. 3).
//!
//! A scheduler never reads a clock. The caller passes `now`, and is told the next deadline.

use crate::schedule::{Phase, Schedule};
use crate::time::{Instant, Micros};

/// What a scheduler wants done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Fire this sensor, now.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase its wait belongs to.
        phase: Phase,
        /// How long ago it was due.
        late: Micros,
    },
    /// A period has ended.
    PeriodEnded {
        /// Its phase.
        phase: Phase,
        /// Whether another schedule begins with the next one.
        changed: bool,
    },
}

/// Decides when each sensor of a ring fires: [`ScheduledFiring`], or
/// [`ImmediateRefiring`](crate::refiring::ImmediateRefiring).
pub trait Scheduler {
    /// The next step that is due, if any. Call again until there is none.
    fn poll(&mut self, now: Instant) -> Option<Step> {
        self.fire(now).or_else(|| self.end_period(now))
    }
    /// The next firing, if one is due.
    fn fire(&mut self, now: Instant) -> Option<Step>;
    /// The end of the period, if it is due and no firing is.
    fn end_period(&mut self, now: Instant) -> Option<Step>;
    /// The sensor that will fire next, if one will before the period ends.
    fn next_sensor(&self) -> Option<u8>;
    /// When the next step is due.
    fn deadline(&self) -> Instant;
    /// A sensor has stopped listening: its echo came in, or its window closed, `at` this instant.
    fn ended(&mut self, sensor: u8, at: Instant);
    /// Has a sensor fire from its next turn on, or no more.
    fn set_enabled(&mut self, sensor: u8, enabled: bool);
    /// Whether a sensor fires.
    fn is_enabled(&self, sensor: u8) -> bool;
    /// Begins anew with phase a, no sooner than `now`.
    fn restart(&mut self, now: Instant);
    /// How many periods ago the last period with this phase was, 0 for the present one; 0 without common phases.
    fn periods_since(&self, phase: Phase) -> u8;
    /// The shortest time between two firings of one sensor.
    fn min_refire(&self) -> Micros;
    /// No deadline lies further ahead than this, unless the clock has jumped.
    fn horizon(&self) -> Micros;
}

/// Scheduled firing: every sensor fires once per period, at the time the [`Schedule`] gives for the phase.
///
/// A firing that is polled late moves all that follow by as much: the timetable may stretch but never shrinks, so that
/// no two firings ever come closer than in the schedule, however late the caller is.
///
/// ```
/// use eeruf_core::{Instant, Micros, Phase, ScheduledFiring, Scheduler, Step, tables::TABLE_I_D};
/// let mut scheduler = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
/// let first = scheduler.deadline();
/// assert_eq!(first, Instant::from_micros(24_000));
/// assert_eq!(scheduler.poll(Instant::from_micros(23_999)), None);
/// assert_eq!(scheduler.poll(first), Some(Step::Fire { sensor: 0, phase: Phase::A, late: Micros::ZERO }));
/// ```
#[derive(Clone, Debug)]
// In this order for the short offsets of a Cortex-M0: see `Ring`.
#[repr(C)]
pub struct ScheduledFiring<'s, const K: usize, const M: usize = 2> {
    phase: u8,
    /// Place in the firing order of the next sensor to fire; the number of sensors when all have.
    place: u8,
    /// The next sensor to fire, or [`NOBODY`] when all have.
    next: u8,
    /// When the next step is due. Worked out once per step, since it is asked for at every poll.
    due: Instant,
    schedule: &'s Schedule<K, M>,
    /// When the present period began, moved on by all lateness since.
    start: Instant,
    /// The disabled sensors: two words, because a core of 32 bits shifts them without a library call.
    disabled: [u32; 2],
    next_schedule: Option<&'s Schedule<K, M>>,
}

const NOBODY: u8 = u8::MAX;

impl<'s, const K: usize, const M: usize> ScheduledFiring<'s, K, M> {
    /// Begins the first period of `schedule` at `now`, with all sensors enabled.
    pub const fn new(schedule: &'s Schedule<K, M>, now: Instant) -> Self {
        let (next, t_fire) = match schedule.firing_order(Phase::A) {
            [first, ..] => (*first, schedule.fire_at(0, *first as usize)),
            // Never: a schedule has a sensor.
            [] => (NOBODY, schedule.period()),
        };
        let due = Instant::from_micros(now.as_micros().wrapping_add(t_fire.as_micros()));
        Self { schedule, next_schedule: None, start: now, due, disabled: [0; 2], phase: 0, place: 0, next }
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

    /// From the present place on: the next enabled sensor, or the end of the period.
    #[inline]
    fn find_next(&mut self) {
        if self.disabled != [0; 2] {
            self.skip_disabled();
        }
        let mut t_fire = self.schedule.period();
        self.next = NOBODY;
        if let Some(firing) = self.schedule.firing(self.phase, self.place) {
            (self.next, t_fire) = firing;
        }
        self.due = self.start + t_fire;
    }

    #[cold]
    fn skip_disabled(&mut self) {
        while let Some((sensor, _)) = self.schedule.firing(self.phase, self.place) {
            if self.is_enabled(sensor) {
                return;
            }
            self.place += 1;
        }
    }

    /// How long to stay silent after the last firing before a period that was not verified against it. Two neighbours
    /// fire once each per period, so no interval between them that the schedule always keeps is longer than half of it.
    fn settling_time(&self) -> Micros {
        let half_period = Micros::new(self.schedule.period().as_micros().div_ceil(2));
        self.schedule.min_refire().max(half_period)
    }

    /// The latest firing of this period so far, if any (disabled sensors count: later, so safer).
    fn last_fired(&self) -> Option<Instant> {
        let (_, t_fire) = self.schedule.firing(self.phase, self.place.checked_sub(1)?)?;
        Some(self.start + t_fire)
    }

    fn begin_period(&mut self, phase: u8, start: Instant) {
        self.phase = phase;
        self.start = start;
        self.place = 0;
        self.find_next();
    }
}

impl<const K: usize, const M: usize> Scheduler for ScheduledFiring<'_, K, M> {
    #[inline]
    fn fire(&mut self, now: Instant) -> Option<Step> {
        if self.next == NOBODY || !now.has_reached(self.due) {
            return None;
        }
        let late = now.since(self.due);
        let step = Step::Fire { sensor: self.next, phase: Phase(self.phase), late };
        self.start += late;
        self.place += 1;
        self.find_next();
        Some(step)
    }

    fn end_period(&mut self, now: Instant) -> Option<Step> {
        if self.next != NOBODY || !now.has_reached(self.due) {
            return None;
        }
        let phase = Phase(self.phase);
        // Periods in which nothing fired need not be caught up with.
        let mut start = if now.since(self.due) > self.schedule.period() { now } else { self.due };
        let next_schedule = self.next_schedule.take();
        if let Some(next) = next_schedule {
            if let Some(last) = self.last_fired() {
                let settled = last + self.settling_time();
                if settled.has_reached(start) {
                    start = settled;
                }
            }
            self.schedule = next;
        }
        let next_phase = if usize::from(self.phase) + 1 < M { self.phase + 1 } else { 0 };
        self.begin_period(next_phase, start);
        Some(Step::PeriodEnded { phase, changed: next_schedule.is_some() })
    }

    #[inline]
    fn next_sensor(&self) -> Option<u8> {
        (self.next != NOBODY).then_some(self.next)
    }

    #[inline]
    fn deadline(&self) -> Instant {
        self.due
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(word) = self.disabled.get_mut(usize::from(sensor / 32)) {
            let bit = 1 << (sensor % 32);
            *word = if enabled { *word & !bit } else { *word | bit };
        }
        self.find_next();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        let word = self.disabled.get(usize::from(sensor / 32));
        usize::from(sensor) < self.schedule.sensors() && word.is_some_and(|word| word >> (sensor % 32) & 1 == 0)
    }

    fn restart(&mut self, now: Instant) {
        let mut start = now;
        // Also in the period before this one sensors may have fired just now.
        let last = self.last_fired().unwrap_or(self.start);
        let settled = last + self.settling_time();
        // A clock that has jumped says nothing about when the last firing was.
        if settled.has_reached(now) && settled.since(now) <= self.horizon() {
            start = settled;
        }
        self.begin_period(0, start);
    }

    fn periods_since(&self, phase: Phase) -> u8 {
        // At most `MAX_PHASES` phases.
        if self.phase >= phase.0 { self.phase - phase.0 } else { (self.phase + M as u8).saturating_sub(phase.0) }
    }

    fn min_refire(&self) -> Micros {
        self.schedule.min_refire()
    }

    #[inline]
    fn horizon(&self) -> Micros {
        // Settling takes less than two periods and the firing time less than one, and a period at most 2^28 us.
        Micros::new(3 * self.schedule.period().as_micros())
    }
}
