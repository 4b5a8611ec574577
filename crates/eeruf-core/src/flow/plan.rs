//! [`FlowPlan`]: when the sensors of a flow ring fire. The gaps of a cycle are decided in `planning`.

use super::settings::{FlowSettings, Pace};
use super::slot::{DISABLED, QUIET_US, Slot};
use crate::hopping::{CATCHES_UP, HoppingCode, HoppingError, HoppingListening, Lateness, Weighed};
use crate::judging::{Firing, Heard, Judge};
use crate::own_limits::{OwnLimits, SensorLimits};
use crate::plan::{Limits, Plan, Upcoming};
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::{MAX_PERIOD, Phase};
use crate::time::{Instant, Micros};

/// No sensor has this number.
pub(super) const NOBODY: u8 = u8::MAX;

/// Fires one sensor after the other, with learned gaps, on a grid of as many steps as the code has places.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct FlowPlan<const K: usize, U = ()> {
    /// The sensor that fires next, or [`NOBODY`].
    next: u8,
    /// Firings of this cycle so far, and all of them.
    pub(super) place: u8,
    pub(super) planned: u8,
    pub(super) phase: u8,
    changed: bool,
    changes: u8,
    paused: bool,
    /// The number of sensors that are in order and fire unless the ring is paused, or [`NOBODY`] if that has changed.
    pub(super) in_order: u8,
    pub(super) start: Instant,
    due: Instant,
    lateness: Lateness,
    pub(super) code: HoppingCode,
    /// Length of the present cycle, in units of the grid.
    pub(super) length: u32,
    /// The largest change by odometry in this cycle, in microseconds; stops at 65,535.
    pub(super) fastest: u16,
    tolerated: u16,
    /// Least time between two firings of a sensor: while it listens, and rests.
    pub(super) rest: Micros,
    pub(super) pace: Pace,
    pub(super) slots: [Slot; K],
    pub(super) own_limits: U,
}

impl<const K: usize> FlowPlan<K> {
    /// A plan whose first cycle begins at `now`.
    ///
    /// # Errors
    /// [`HoppingError`] for more sensors than there is room for, a code as in [`HoppingCode::new`], a step no larger
    /// than `t_delta`, a window longer than [`HoppingListening::MAX_WINDOW`], or a shortest cycle that is shorter than
    /// window and code or longer than [`MAX_PERIOD`].
    pub fn new(
        sensors: usize,
        settings: FlowSettings,
        listening: HoppingListening,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        Self::with_limits(sensors, (), settings, listening, now)
    }
}

impl<const K: usize, U: OwnLimits> FlowPlan<K, U> {
    /// As [`new`](FlowPlan::new), for sensors that have limits of their own, by [`FlowSettings::limits`]. Those that
    /// fire together do so at one instant, with the quiet that any of them needs; all else fires at other times.
    ///
    /// # Errors
    /// As there.
    pub fn with_limits(
        sensors: usize,
        own_limits: U,
        settings: FlowSettings,
        listening: HoppingListening,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        if sensors > K {
            return Err(HoppingError::Sensors { sensors, most: K });
        }
        let code = HoppingCode::new(sensors, settings.tracker.votes, settings.step)?;
        let t_delta = settings.tracker.t_delta;
        if code.step() <= t_delta {
            return Err(HoppingError::TDelta { t_delta, step: code.step() });
        }
        let most = HoppingListening::MAX_WINDOW;
        if listening.window > most {
            return Err(HoppingError::Window { window: listening.window, most });
        }
        let least = listening.window.saturating_add(code.width());
        if settings.shortest_cycle < least || settings.shortest_cycle > MAX_PERIOD {
            return Err(HoppingError::Period { period: settings.shortest_cycle, least });
        }
        // Nothing of a firing is heard in a window that opens so much later; the waits of two may bring them closer by
        // the width of the code.
        let longest = listening.dies().saturating_add(code.width());
        // At most 64 sensors.
        let pace = Pace::of(&settings, sensors as u8, longest, unit_of(&code));
        let mut plan = Self {
            next: NOBODY,
            place: 0,
            planned: 0,
            phase: 0,
            changed: false,
            changes: 0,
            paused: false,
            in_order: NOBODY,
            start: now,
            due: now,
            lateness: Lateness::NEW,
            length: pace.shortest,
            fastest: 0,
            rest: settings.rest.min(most).max(listening.window),
            tolerated: (code.step().abs_diff(t_delta).as_micros().saturating_sub(1) / 2) as u16,
            slots: [Slot::new(pace.least); K],
            code,
            pace,
            own_limits,
        };
        // In the order of firing, from its end: only the sensor that fires before another, in the cycle before, moves
        // as that does. The first one's place is 0.
        let (mut sensor, mut place) = (0, 0);
        for turn in (1..plan.code.phases()).rev() {
            place = plan.code.next_place(0, place);
            if usize::from(turn) < sensors {
                sensor = plan.sensor_before(sensor);
                if let Some(slot) = plan.slots.get_mut(usize::from(sensor)) {
                    slot.place = place;
                }
            }
        }
        for sensor in 0..sensors as u8 {
            let leader = plan.own_limits.leader_of(sensor);
            if leader != sensor {
                let place = plan.slots.get(usize::from(leader)).map_or(0, |slot| slot.place);
                if let Some(slot) = plan.slots.get_mut(usize::from(sensor)) {
                    slot.place = place;
                }
            }
        }
        plan.plan(|_, _| Micros::ZERO);
        Ok(plan)
    }

    /// The phase of the present cycle, from 0.
    pub const fn phase(&self) -> Phase {
        Phase(self.phase)
    }

    /// The quiet that a sensor gets before its firing and after it; `None` for one that is out of range.
    pub fn quiet(&self, sensor: u8) -> Option<(Micros, Micros)> {
        let slot = self.slots.get(usize::from(sensor)).filter(|_| usize::from(sensor) < self.sensors())?;
        Some((Micros::new(u32::from(slot.before) * QUIET_US), Micros::new(u32::from(slot.after) * QUIET_US)))
    }

    /// As [`HoppingPlan::weighed`](crate::hopping::HoppingPlan::weighed).
    pub fn weighed(&self, sensor: u8, expected_change_us: i32) -> Option<Weighed> {
        if usize::from(sensor) >= self.sensors() {
            return None;
        }
        let Firing { solo, steady, .. } = self.last_firing(sensor, 0);
        Some(Weighed { solo, steady, changes: self.changes, expected_change_us })
    }

    /// A sensor's firing in this cycle, after its start.
    #[inline(always)]
    pub(super) fn offset(&self, sensor: u8) -> Micros {
        self.slots.get(usize::from(sensor)).map_or(Micros::MAX, |slot| self.offset_at(sensor, slot.at))
    }

    /// The same if it fired at this place of the grid.
    #[inline(always)]
    pub(super) fn offset_at(&self, sensor: u8, at: u16) -> Micros {
        let place = self.slots.get(usize::from(sensor)).map_or(0, |slot| slot.place);
        // Below 2^32: a place is below the number of phases, so that the sum is within a unit more than the grid's.
        Micros::new(u32::from(at) * self.unit() + u32::from(place) * self.code.step().as_micros())
    }

    /// One unit of the grid, in microseconds: the code and a step.
    #[inline(always)]
    pub(super) fn unit(&self) -> u32 {
        unit_of(&self.code)
    }

    /// Length of the present cycle.
    fn cycle(&self) -> Micros {
        // Gaps and quiet are bounded, and a cycle is at most `MAX_PERIOD` if it must be longer: below 2^29.
        Micros::new(self.length * self.unit())
    }

    /// Time before the present cycle's end at which the next is planned.
    fn lead(&self) -> Micros {
        Micros::new(u32::from(self.pace.lead) * QUIET_US)
    }

    /// The sensor at a place of the cycle's order.
    pub(super) fn order(&self, place: u8) -> u8 {
        self.slots.get(usize::from(place)).map_or(NOBODY, |slot| slot.order)
    }

    /// Finds who fires next, and when; or when the cycle ends.
    #[inline(never)]
    pub(super) fn find_due(&mut self) {
        self.next = if self.place < self.planned { self.order(self.place) } else { NOBODY };
        let after = if self.next == NOBODY { self.cycle().saturating_sub(self.lead()) } else { self.offset(self.next) };
        self.due = self.start + after;
    }

    /// Lets no sensor fire for the rest of the cycle, if the ring is paused.
    pub(super) fn obey_pause(&mut self) {
        if self.paused {
            self.planned = self.place;
        }
        self.find_due();
    }

    #[cold]
    #[inline(never)]
    fn fired_late(&mut self, sensor: u8, late: Micros) {
        if late > CATCHES_UP {
            self.break_off();
            self.start += late;
            self.find_due();
        }
        let late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        self.lateness.note(late);
        if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
            slot.late = late;
        }
    }

    /// A firing was later than was noted when it was polled for: those of this cycle are noted again.
    #[cold]
    #[inline(never)]
    fn note_again(&mut self, late: u16) {
        self.lateness.begin_anew();
        for place in 0..self.place {
            let fired = self.slots.get(usize::from(self.order(place)));
            self.lateness.note(fired.map_or(late, |slot| slot.late));
        }
        self.lateness.note(late);
    }

    fn break_off(&mut self) {
        self.lateness.break_off();
        self.changed = true;
    }
}

/// One unit of the grid of a code, in microseconds.
#[inline(always)]
const fn unit_of(code: &HoppingCode) -> u32 {
    (code.phases() as u32 + 1) * code.step().as_micros()
}

impl<const K: usize, U: OwnLimits> Plan for FlowPlan<K, U> {
    fn deadline(&self) -> Instant {
        self.due
    }

    /// To the end of the cycle that has begun, since the next is decided then.
    fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        (self.place..self.planned).map(|place| {
            let sensor = self.order(place);
            let due = if place == self.place { self.due } else { self.start + self.offset(sensor) };
            Upcoming { sensor, phase: self.phase(), due }
        })
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        (usize::from(self.next) < K).then_some((self.next, self.phase()))
    }

    #[inline(always)]
    fn fire(&mut self, now: Instant) {
        let (sensor, late) = (self.next, now.since(self.due));
        let phase = self.phase;
        let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { return };
        slot.fire(phase);
        if late == Micros::ZERO {
            self.lateness.note_punctual();
        }
        self.place += 1;
        self.find_due();
        if late != Micros::ZERO {
            self.fired_late(sensor, late);
        }
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { return };
        let late = Micros::new(slot.late.into()).saturating_add(by);
        let noted = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        slot.late = noted;
        self.note_again(noted);
        if late > CATCHES_UP {
            self.break_off();
            self.start += by;
            self.find_due();
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        let phase = self.phase();
        let end = self.due + self.lead();
        let left_out = now.since(self.due) > self.cycle();
        self.start = if left_out { now } else { end };
        self.lateness.end_period();
        if left_out {
            self.break_off();
        }
        let code = self.code;
        self.phase = if self.phase + 1 < code.phases() { self.phase + 1 } else { 0 };
        for (sensor, slot) in (0..).zip(self.slots.iter_mut().take(code.sensors())) {
            slot.place = code.next_place(sensor, slot.place);
        }
        self.place = 0;
        self.planned = 0;
        self.find_due();
        (phase, left_out)
    }

    fn begin_period(&mut self, fired: impl Fn(u8) -> Instant) {
        self.plan(|plan, sensor| plan.rests_for(sensor, fired(sensor)));
    }

    #[inline(always)]
    fn take_change(&mut self) -> bool {
        let changed = core::mem::take(&mut self.changed);
        self.changes = self.changes.wrapping_add(changed.into());
        changed
    }

    fn judged(&mut self, heard: &Heard<'_>, verdict: &Verdict, judge: &impl Judge) {
        self.learn(heard, verdict, judge);
    }

    fn may_fire_ahead(&self) -> bool {
        false
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn sensors(&self) -> usize {
        self.code.sensors()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
            slot.set(DISABLED, !enabled);
        }
        self.in_order = NOBODY;
        if !enabled {
            self.leave_out(sensor);
            self.find_due();
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.obey_pause();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        let slot = self.slots.get(usize::from(sensor)).filter(|_| usize::from(sensor) < self.sensors());
        slot.is_some_and(|slot| !slot.is(DISABLED))
    }

    fn restart(&mut self, now: Instant) {
        self.start = now;
        self.break_off();
        self.place = 0;
        self.planned = 0;
        self.find_due();
    }

    fn last_firing(&self, sensor: u8, _periods_ago: u8) -> Firing {
        let Some(slot) = self.slots.get(usize::from(sensor)) else { return Firing::new(Phase(0)) };
        let steady = self.lateness.is_steady(slot.late, self.tolerated);
        Firing { steady, ..Firing::new(Phase(slot.phase)) }
    }

    fn limits(&self) -> Limits<'_> {
        Limits { longest_window: self.min_refire(), verified_for: None, audible: None }
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        self.own_limits.hears(receiver, emitter)
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.own_limits.limits_of(sensor)
    }

    fn min_refire(&self) -> Micros {
        self.rest
    }

    fn horizon(&self) -> Micros {
        // A cycle of least gaps may be longer than the longest that is asked for. Below 2^31.
        let least = self.code.sensors() as u32 * u32::from(self.pace.least_gap);
        Micros::new(2 * least.max(self.pace.longest + 1) * self.unit() + self.rest.as_micros())
    }
}

impl<const K: usize, U: OwnLimits> FlowPlan<K, U> {
    /// Raises a sensor's quiet if others fooled it or nothing of it is believed, lowers it if its reading is.
    fn learn(&mut self, heard: &Heard<'_>, verdict: &Verdict, judge: &impl Judge) {
        let sensor = heard.sensor;
        let change = u16::try_from(heard.firing.expected_change_us.unsigned_abs()).unwrap_or(u16::MAX);
        self.fastest = self.fastest.max(change);
        let pace = self.pace;
        let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { return };
        match verdict.kind {
            // Neither silence nor quiet helps a sensor that is not heard.
            ReadingKind::Stuck | ReadingKind::Unanswered => return,
            ReadingKind::Accepted | ReadingKind::Clear => {
                slot.unserved = 0;
                slot.before = slot.before.saturating_sub(pace.believed_takes).max(pace.least);
                slot.after = slot.after.saturating_sub(pace.believed_takes).max(pace.least);
                return;
            }
            ReadingKind::Tentative => {
                slot.unserved = 0;
                return;
            }
            _ => {}
        }
        slot.unserved = slot.unserved.saturating_add(1);
        let mut raise = (0, 0);
        if divides(pace.unserved_after, slot.unserved) {
            raise = (pace.unserved_adds, pace.unserved_adds);
        }
        if let Some(&echo) = heard.echoes.first() {
            if judge.comes_before_belief(sensor, echo) {
                raise.0 = pace.masked_adds.saturating_add(raise.0);
                if echo > self.gap_after(sensor) {
                    raise.1 = pace.masked_adds.saturating_add(raise.1);
                }
            }
        }
        if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
            slot.before = slot.before.saturating_add(raise.0).min(pace.most);
            slot.after = slot.after.saturating_add(raise.1).min(pace.most);
        }
    }

    /// Time from a sensor's firing in this cycle to the next of any that it does not fire together with, as planned.
    fn gap_after(&self, sensor: u8) -> Micros {
        let place = (0..self.planned).find(|&place| self.order(place) == sensor).map(|place| self.last_with(place));
        let gap = place.and_then(|place| self.slots.get(usize::from(place))).map_or(0, |slot| slot.gap);
        Micros::new(u32::from(gap) * self.unit())
    }
}

/// Returns true if a number is a multiple of another, above 0. By subtraction: small processors take a hundred
/// instructions to divide.
fn divides(number: u8, multiple: u8) -> bool {
    let mut rest = u32::from(multiple);
    for bit in (0..8).rev() {
        let part = u32::from(number) << bit;
        rest = if rest >= part { rest - part } else { rest };
    }
    rest == 0
}

#[cfg(test)]
mod tests {
    use super::divides;

    #[test]
    fn divides_is_the_remainder_of_every_pair() {
        for number in 1..=255_u8 {
            for multiple in 0..=255 {
                assert_eq!(divides(number, multiple), multiple % number == 0, "{number} {multiple}");
            }
        }
    }
}
