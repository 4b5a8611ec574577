//! [`FlowPlan`]: when the sensors of a flow ring fire. The gaps of a cycle are decided in `planning`.

use super::settings::{FlowSettings, Pace};
use super::slot::{DISABLED, QUIET_US, Slot};
use crate::hopping::{CATCHES_UP, HoppingCode, HoppingError, HoppingListening, Lateness, Weighed};
use crate::judging::{Firing, Heard, Judge};
use crate::plan::{Limits, Plan, Upcoming};
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::{MAX_PERIOD, Phase};
use crate::time::{Instant, Micros};

/// No sensor has this number.
const NOBODY: u8 = u8::MAX;

/// Fires one sensor after the other, with learned gaps, on a grid of as many steps as the code has places.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct FlowPlan<const K: usize> {
    /// The sensor that fires next, or [`NOBODY`].
    next: u8,
    /// Firings of this cycle so far, and all of them.
    pub(super) place: u8,
    pub(super) planned: u8,
    pub(super) phase: u8,
    changed: bool,
    changes: u8,
    paused: bool,
    pub(super) start: Instant,
    due: Instant,
    lateness: Lateness,
    pub(super) code: HoppingCode,
    /// Length of the present cycle.
    pub(super) length: Micros,
    /// The largest change by odometry in this cycle, in microseconds.
    pub(super) fastest: u32,
    /// One unit of the grid.
    pub(super) unit: Micros,
    pub(super) window: Micros,
    tolerated: u16,
    pub(super) pace: Pace,
    pub(super) slots: [Slot; K],
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
        let pace = Pace::of(&settings, listening.dies().saturating_add(code.width()));
        let mut plan = Self {
            next: NOBODY,
            place: 0,
            planned: 0,
            phase: 0,
            changed: false,
            changes: 0,
            paused: false,
            start: now,
            due: now,
            lateness: Lateness::NEW,
            length: settings.shortest_cycle,
            fastest: 0,
            unit: code.width().saturating_add(code.step()).saturating_add(code.step()),
            window: listening.window,
            tolerated: (code.step().abs_diff(t_delta).as_micros().saturating_sub(1) / 2) as u16,
            slots: [Slot::new(pace.least); K],
            code,
            pace,
        };
        let mut sensor = 0;
        for turn in 0..sensors {
            if let Some(slot) = plan.slots.get_mut(usize::from(sensor)) {
                // In the order of firing: only the sensor that fires before it, in the cycle before, moves as it does.
                slot.place = code.place(turn, 0);
            }
            sensor = plan.sensor_after(sensor);
        }
        plan.plan(|_| now);
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
        let Some(slot) = self.slots.get(usize::from(sensor)) else { return Micros::MAX };
        let grid = u32::from(slot.at) * self.unit.as_micros();
        Micros::new(grid + u32::from(slot.place) * self.code.step().as_micros())
    }

    /// The sensor at a place of the cycle's order.
    pub(super) fn order(&self, place: u8) -> u8 {
        self.slots.get(usize::from(place)).map_or(NOBODY, |slot| slot.order)
    }

    /// Finds who fires next, and when; or when the cycle ends.
    #[inline(always)]
    pub(super) fn find_due(&mut self) {
        self.next = if self.place < self.planned { self.order(self.place) } else { NOBODY };
        let after = if self.next == NOBODY { self.length } else { self.offset(self.next) };
        self.due = self.start + after;
    }

    /// Lets nobody fire for what is left of the cycle, if the ring is paused.
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

impl<const K: usize> Plan for FlowPlan<K> {
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
        let end = self.due;
        let left_out = now.since(end) > self.length;
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
        self.plan(fired);
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
        self.length = self.pace.shortest_cycle;
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

    fn min_refire(&self) -> Micros {
        self.window
    }

    fn horizon(&self) -> Micros {
        let longest = self.pace.longest_cycle;
        longest.saturating_add(longest).saturating_add(self.window)
    }
}

impl<const K: usize> FlowPlan<K> {
    /// Raises a sensor's quiet if others fooled it or nothing of it is believed, lowers it if its reading is.
    fn learn(&mut self, heard: &Heard<'_>, verdict: &Verdict, judge: &impl Judge) {
        let sensor = heard.sensor;
        let change = heard.firing.expected_change_us.unsigned_abs();
        self.fastest = self.fastest.max(change);
        let pace = self.pace;
        let echo = heard.echoes.first().copied();
        let believed = judge.believed(sensor);
        let clear = judge.is_clear(sensor);
        let gap_after = self.gap_after(sensor);
        let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { return };
        let raise = |quiet: &mut u8, by: u8| *quiet = quiet.saturating_add(by).min(pace.most);
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
        let masked = match (echo, believed) {
            (Some(echo), Some(believed)) => echo < believed,
            (Some(_), None) => clear,
            (None, _) => false,
        };
        if let (true, Some(echo)) = (masked, echo) {
            raise(&mut slot.before, pace.masked_adds);
            if echo > gap_after {
                raise(&mut slot.after, pace.masked_adds);
            }
        }
        if slot.unserved % pace.unserved_after.max(1) == 0 {
            raise(&mut slot.before, pace.unserved_adds);
            raise(&mut slot.after, pace.unserved_adds);
        }
    }

    /// Time from a sensor's firing in this cycle to the next of any sensor, as planned.
    fn gap_after(&self, sensor: u8) -> Micros {
        let place = (0..self.planned).find(|&place| self.order(place) == sensor);
        let gap = place.and_then(|place| self.slots.get(usize::from(place))).map_or(0, |slot| slot.gap);
        Micros::new(u32::from(gap) * self.unit.as_micros())
    }
}
