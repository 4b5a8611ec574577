//! [`HoppingPlan`]: when the sensors of a hopping ring fire. What a period is made of is decided in `planning`.

use super::code::HoppingCode;
use super::error::HoppingError;
use super::lateness::Lateness;
use super::random::SmallRandom;
use super::schedule::HoppingSchedule;
use super::settings::{HoppingListening, HoppingSettings, Pace};
use super::turn::{DISABLED, FIRED, SETTLED, SOLO, Turn};
use super::weighed::Weighed;
use crate::judging::{Firing, Heard, Judge};
use crate::own_limits::{OwnLimits, SensorLimits};
use crate::plan::{Limits, Plan, Upcoming};
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// A firing that is later than this moves all that follow. Up to this the timetable stands, so that lateness does not
/// add up; intervals can be shorter than planned by as much.
pub(crate) const CATCHES_UP: Micros = Micros::new(1000);

/// No sensor has this number.
const NOBODY: u8 = u8::MAX;

/// Fires each sensor at its lag plus the wait of the phase, and in a *solo period* one sensor alone.
///
/// Crosstalk moves by at least the step of the code from phase to phase while lags stand. When lags change, the first
/// period after the change is *unsettled*: its readings may hold sound from before. A solo period lasts long enough
/// that all sound from before it has died when its sensor fires, and that sensor's own when the next period begins.
///
/// A period that begins is planned by when sensors last fired: the ring knows that, and it would take four bytes a
/// sensor to know it here too.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order: a Cortex-M0 reaches only the first 31 bytes of a structure, and the first 31 of its words, in one
// instruction. What a firing needs comes first.
#[repr(C)]
pub struct HoppingPlan<const K: usize, U = ()> {
    /// The sensor that fires next, or [`NOBODY`].
    next: u8,
    /// Number of this period's sensors that have fired, and of those that fire in it.
    place: u8,
    pub(super) planned: u8,
    pub(super) phase: u8,
    /// Flags of each sensor that fires in it: [`FIRED`], [`SOLO`] and [`SETTLED`].
    pub(super) kind: u8,
    /// Lags have changed or the timetable broke off, and the tracker does not know yet.
    pub(super) changed: bool,
    /// The number of times that somebody has, modulo 256.
    changes: u8,
    pub(super) since_shift: u8,
    pub(super) since_solo: u8,
    paused: bool,
    /// Credit towards solo periods, in 1/256.
    pub(super) earned: u16,
    pub(super) start: Instant,
    /// When the next firing or the end of the period is due: it is asked for several times a poll.
    due: Instant,
    /// When any sensor last fired.
    last_fired: Instant,
    lateness: Lateness,
    pub(super) code: HoppingCode,
    /// The length of the present period.
    pub(super) length: Micros,
    /// After how long its sensor fires in a solo period.
    pub(super) solo_at: Micros,
    pub(super) period: Micros,
    pub(super) random: SmallRandom,
    pub(super) window: Micros,
    /// From a firing until its sensor no longer listens, and nothing of it is heard in a window that opens then.
    pub(super) dies: Micros,
    pub(super) pace: Pace,
    /// Largest difference in lateness of firings, in microseconds, with which crosstalk still moves by more than
    /// `t_delta`.
    tolerated: u16,
    pub(super) turns: [Turn; K],
    pub(super) own_limits: U,
}

impl<const K: usize> HoppingPlan<K> {
    /// A plan whose first period begins at `now`. Of `settings.tracker` it needs what decides how far crosstalk must
    /// move; the seed is for the draws of new lags.
    ///
    /// # Errors
    /// [`HoppingError`] for a `t_delta` that is not below the step of the code, more votes to confirm an echo than
    /// there are phases, a period that is shorter than window and code together or than twice the code and a step, or a
    /// window longer than [`HoppingListening::MAX_WINDOW`].
    pub fn new(
        schedule: &HoppingSchedule<K>,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        Self::with_limits(schedule, (), settings, listening, seed, now)
    }
}

impl<const K: usize, U: OwnLimits> HoppingPlan<K, U> {
    /// As [`new`](HoppingPlan::new), for sensors that have limits of their own:
    /// [`HoppingSchedule::limits`] gives them. `listening` says the most for all.
    ///
    /// # Errors
    /// As there, by the limits of each sensor; also for lags that are redrawn, which would not keep them.
    pub fn with_limits(
        schedule: &HoppingSchedule<K>,
        own_limits: U,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        let code = schedule.code();
        let verified_for = own_limits.most();
        if verified_for.is_some() && settings.shift_after > 0 {
            return Err(HoppingError::Shift { shift_after: settings.shift_after });
        }
        let t_delta = settings.tracker.t_delta;
        if code.step() <= t_delta {
            return Err(HoppingError::TDelta { t_delta, step: code.step() });
        }
        let votes = settings.tracker.votes;
        if votes > code.phases() {
            return Err(HoppingError::Votes { votes, phases: code.phases() });
        }
        let least = shortest_period(code, &own_limits, listening.window);
        if schedule.period() < least {
            return Err(HoppingError::Period { period: schedule.period(), least });
        }
        let most = HoppingListening::MAX_WINDOW;
        if listening.window > most {
            return Err(HoppingError::Window { window: listening.window, most });
        }
        let window = listening.window;
        let mut plan = Self {
            next: NOBODY,
            place: 0,
            planned: 0,
            phase: 0,
            kind: FIRED,
            changed: false,
            changes: 0,
            since_shift: 0,
            since_solo: 0,
            paused: false,
            earned: 0,
            start: now,
            due: now,
            last_fired: now,
            lateness: Lateness::NEW,
            code: *schedule.code(),
            length: schedule.period(),
            solo_at: Micros::ZERO,
            period: schedule.period(),
            random: SmallRandom::new(seed),
            window,
            dies: listening.dies().max(verified_for.map_or(Micros::ZERO, |most| most.min_interval)),
            pace: Pace::of(&settings),
            // A track may be off by as much as its readings, and a step is at most 65,535 us.
            tolerated: (schedule.code().step().abs_diff(settings.tracker.t_delta).as_micros().saturating_sub(1) / 2)
                as u16,
            turns: core::array::from_fn(|sensor| {
                let lag = schedule.t_lag(sensor).unwrap_or(Micros::ZERO);
                // At most 64 sensors.
                Turn::new(lag, code.place(schedule.turn(own_limits.leader_of(sensor as u8).into()), 0))
            }),
            own_limits,
        };
        // No sensor has fired.
        plan.plan(|_| now);
        Ok(plan)
    }

    /// Takes the lags and the period of another schedule with the same code. The period that has begun starts again,
    /// once all sound from before has died; for sensors that have limits of their own both schedules must meet the
    /// same requirements.
    pub(super) fn change_schedule(&mut self, schedule: &HoppingSchedule<K>) -> Result<(), HoppingError> {
        if *schedule.code() != self.code {
            return Err(HoppingError::OtherCode);
        }
        let least = shortest_period(&self.code, &self.own_limits, self.window);
        if schedule.period() < least {
            return Err(HoppingError::Period { period: schedule.period(), least });
        }
        let rings_for = self.rings_for();
        if rings_for <= self.length.saturating_add(self.dies) {
            self.start += rings_for;
        } else {
            // A clock that has jumped says nothing about when anything fired.
            self.break_off();
        }
        self.period = schedule.period();
        for (sensor, turn) in self.turns.iter_mut().enumerate() {
            turn.lag = schedule.t_lag(sensor).unwrap_or_default();
            // At most 64 sensors.
            let leader = self.own_limits.leader_of(sensor as u8);
            turn.place = self.code.place(schedule.turn(leader.into()), self.phase);
            // What is pending was fired by the schedule of before.
            turn.set(SETTLED, false);
        }
        self.changed = true;
        self.clear_period();
        Ok(())
    }

    /// The lag of a sensor as it is now; `None` for one that is out of range.
    pub fn t_lag(&self, sensor: usize) -> Option<Micros> {
        self.turns.get(sensor).filter(|_| sensor < self.code.sensors()).map(|turn| turn.lag)
    }

    /// The phase of the present period, from 0.
    pub const fn phase(&self) -> Phase {
        Phase(self.phase)
    }

    /// The sensor that the present period belongs to, if it is a solo period.
    pub fn solo(&self) -> Option<u8> {
        self.turns.first().filter(|_| self.is_solo()).map(|turn| turn.order)
    }

    /// Number of times that firing times have changed against each other otherwise than by the phase, such as by new
    /// lags, modulo 256: each time [`EchoTracker::firing_changed`](crate::judge::EchoTracker::firing_changed) was
    /// called.
    pub const fn changes(&self) -> u8 {
        self.changes
    }

    /// For the log of a reading that was just emitted: how it was weighed, with the change that the poll expected of
    /// its sensor, 0 for a robot that stands; `None` for a sensor that is out of range. With that, its phase and its
    /// echo time an [`EchoTracker`](crate::judge::EchoTracker) does again what the ring's did.
    pub fn weighed(&self, sensor: u8, expected_change_us: i32) -> Option<Weighed> {
        if usize::from(sensor) >= self.sensors() {
            return None;
        }
        let Firing { solo, steady, .. } = self.last_firing(sensor, 0);
        Some(Weighed { solo, steady, changes: self.changes, expected_change_us })
    }

    /// For how long after the start of the period something may still be heard, of whoever fired last.
    pub(super) fn rings_for(&self) -> Micros {
        let silent = self.last_fired + self.dies;
        if self.start.has_reached(silent) { Micros::ZERO } else { silent.since(self.start) }
    }

    /// Returns true if the present period belongs to one sensor.
    #[inline(always)]
    const fn is_solo(&self) -> bool {
        self.kind & SOLO != 0
    }

    /// When a sensor fires in this period, after its start, unless it is a solo period.
    #[inline(always)]
    pub(super) fn offset(&self, sensor: u8) -> Micros {
        let Some(turn) = self.turns.get(usize::from(sensor)) else { return Micros::MAX };
        // The step is at most 65,535 us, the lag less than a period of at most 2^28 us.
        Micros::new(turn.lag.as_micros() + u32::from(turn.place) * self.code.step().as_micros())
    }

    /// Finds who fires next, and when; or when the period ends.
    pub(super) fn find_due(&mut self) {
        if self.is_solo() && self.place < self.planned {
            self.next = self.order(self.place);
            self.due = self.start + self.solo_at;
        } else {
            self.find_next();
        }
    }

    /// The same unless a solo firing is still to come.
    #[inline(always)]
    fn find_next(&mut self) {
        let turn = self.turns.get(usize::from(self.place)).filter(|_| self.place < self.planned);
        self.next = turn.map_or(NOBODY, |turn| turn.order);
        self.due = self.start + turn.map_or(self.length, |turn| self.offset(turn.order));
    }

    /// Another period: no sensor fires until it is planned.
    fn clear_period(&mut self) {
        self.place = 0;
        self.planned = 0;
        self.kind = FIRED;
        self.length = self.period;
        self.find_due();
    }

    /// Lets no sensor fire for the rest of the period, if the ring is paused.
    pub(super) fn obey_pause(&mut self) {
        if self.paused {
            self.planned = self.place;
        }
        self.find_due();
    }

    /// The firing of a sensor came late.
    #[cold]
    #[inline(never)]
    fn fired_late(&mut self, sensor: u8, late: Micros) {
        if late > CATCHES_UP {
            self.break_off();
        }
        // Nothing else fires in a solo period, so that it may move freely.
        if late > CATCHES_UP || self.is_solo() {
            self.start += late;
            self.find_due();
        }
        if !self.is_solo() {
            let late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
            self.lateness.note(late);
            if let Some(turn) = self.turns.get_mut(usize::from(sensor)) {
                turn.late = late;
            }
        }
    }

    /// A firing was later than was noted when it was polled for: all that this period has had so far are noted again,
    /// since firings that are late alike are steady. It is one of them, or the last of the period before.
    #[cold]
    #[inline(never)]
    fn note_anew(&mut self, late: u16) {
        self.lateness.begin_anew();
        for place in 0..self.place {
            let fired = self.turns.get(usize::from(self.order(place)));
            self.lateness.note(fired.map_or(late, |turn| turn.late));
        }
        self.lateness.note(late);
    }

    /// Nothing that is heard across this moment moves as the code says.
    fn break_off(&mut self) {
        self.lateness.break_off();
        self.changed = true;
    }
}

/// The shortest period at which each sensor has stopped listening when it fires again, and no path reads the same with
/// two ages.
fn shortest_period(code: &HoppingCode, own_limits: &impl OwnLimits, window: Micros) -> Micros {
    let rests = match own_limits.most() {
        None => window.saturating_add(code.longest_drop()),
        Some(_) => {
            let own = |x: u8| own_limits.limits_of(x).map_or(window, |limits| limits.window.min(window));
            let fires_after = |x: u8| own(x).saturating_add(code.drop_of(own_limits.leader_of(x)));
            // At most 64 sensors.
            (0..code.sensors() as u8).map(fires_after).max().unwrap_or_default()
        }
    };
    rests.max(code.two_ages())
}

impl<const K: usize, U: OwnLimits> Plan for HoppingPlan<K, U> {
    fn deadline(&self) -> Instant {
        self.due
    }

    /// To the end of the period that has begun, since the next is decided then.
    fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        (self.place..self.planned).map(|place| {
            let sensor = self.order(place);
            let due = if place == self.place { self.due } else { self.start + self.offset(sensor) };
            Upcoming { sensor, phase: self.phase(), due }
        })
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        // There is room for at most 64 sensors. To compare with the room spares the look-up its check.
        (usize::from(self.next) < K).then_some((self.next, self.phase()))
    }

    #[inline(always)]
    fn fire(&mut self, now: Instant) {
        let (sensor, late) = (self.next, now.since(self.due));
        let Some(turn) = self.turns.get_mut(usize::from(sensor)) else { return };
        turn.fire(self.phase, self.kind);
        self.last_fired = now;
        if late == Micros::ZERO && !self.is_solo() {
            self.lateness.note_punctual();
        }
        self.place += 1;
        // There is no second firing in a solo period.
        self.find_next();
        // Last, since it is rare: what is known here need not be saved for afterwards.
        if late != Micros::ZERO {
            self.fired_late(sensor, late);
        }
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        let Some(turn) = self.turns.get_mut(usize::from(sensor)) else { return };
        let is_solo = turn.is(SOLO);
        let late = Micros::new(turn.late.into()).saturating_add(by);
        if !is_solo {
            let late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
            turn.late = late;
            self.note_anew(late);
        }
        if late > CATCHES_UP {
            self.break_off();
        }
        if late > CATCHES_UP || is_solo {
            self.start += by;
            self.find_due();
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        let phase = self.phase();
        let end = self.due;
        let left_out = now.since(end) > self.period;
        self.start = if left_out { now } else { end };
        self.lateness.end_period();
        if left_out {
            self.break_off();
        }
        let code = self.code;
        self.phase = if self.phase + 1 < code.phases() { self.phase + 1 } else { 0 };
        for (sensor, turn) in (0..).zip(self.turns.iter_mut().take(code.sensors())) {
            turn.place = code.next_place(self.own_limits.leader_of(sensor), turn.place);
        }
        self.clear_period();
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

    fn judged(&mut self, heard: &Heard<'_>, &Verdict { kind, .. }: &Verdict, judge: &impl Judge) {
        let sensor = heard.sensor;
        let confirmed = matches!(kind, ReadingKind::Accepted | ReadingKind::Clear);
        // Neither silence nor another lag helps a sensor whose line is stuck, or that does not answer: it costs the
        // others nothing.
        if matches!(kind, ReadingKind::Stuck | ReadingKind::Unanswered) {
            return;
        }
        if let Some(turn) = self.turns.get_mut(usize::from(sensor)) {
            // A sensor that is known to have nothing in range is not fooled by what does not fit.
            turn.heard(confirmed || kind == ReadingKind::Tentative, confirmed || judge.is_clear(sensor));
        }
    }

    fn fired(&mut self, _sensor: u8, at: Instant) {
        if !self.last_fired.has_reached(at) {
            self.last_fired = at;
        }
    }

    fn may_fire_ahead(&self) -> bool {
        false
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn sensors(&self) -> usize {
        self.code.sensors()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(turn) = self.turns.get_mut(usize::from(sensor)) {
            turn.set(DISABLED, !enabled);
        }
        if !enabled {
            self.leave_out(sensor, self.place);
            self.find_due();
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.obey_pause();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        let turn = self.turns.get(usize::from(sensor)).filter(|_| usize::from(sensor) < self.sensors());
        turn.is_some_and(|turn| !turn.is(DISABLED))
    }

    fn restart(&mut self, now: Instant) {
        for turn in &mut self.turns {
            turn.set(SETTLED, false);
        }
        self.start = now;
        if let Some(most) = self.own_limits.most() {
            // What pairs keep between their firings they keep across a restart, unless the clock has jumped.
            let settled = self.last_fired + most.min_interval;
            if !now.has_reached(settled) && settled.since(now) <= most.min_interval {
                self.start = settled;
            }
        }
        self.break_off();
        self.clear_period();
    }

    fn last_firing(&self, sensor: u8, _periods_ago: u8) -> Firing {
        let Some(turn) = self.turns.get(usize::from(sensor)) else { return Firing::new(Phase(0)) };
        let steady = turn.is(SETTLED) && self.lateness.is_steady(turn.late, self.tolerated);
        Firing { phase: Phase(turn.phase), solo: turn.is(SOLO), steady, expected_change_us: 0 }
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
        // No sensor is planned to fire sooner.
        self.window
    }

    fn horizon(&self) -> Micros {
        // Longer than the longest solo period.
        let dies = self.dies.saturating_add(self.dies);
        self.period.saturating_add(self.period).saturating_add(dies)
    }
}
