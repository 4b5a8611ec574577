//! [`HoppingFiring`]: the scheduler of a hopping ring. What a period is made of is decided in `plan`.

use super::code::HoppingCode;
use super::lateness::Lateness;
use super::random::SmallRandom;
use super::schedule::HoppingSchedule;
use super::settings::{HoppingListening, HoppingSettings, Pace};
use super::turn::{SETTLED, SOLO, Turn};
use crate::schedule::Phase;
use crate::scheduler::{Limits, Scheduler};
use crate::sensor_set::SensorSet;
use crate::time::{Instant, Micros};

/// A firing that is later than this moves all that follow. Up to this the timetable stands, so that lateness does not
/// add up; intervals can be shorter than planned by as much.
pub(super) const CATCHES_UP: Micros = Micros::new(1000);

/// Fires each sensor at its lag plus the wait of the phase, and in a *solo period* one sensor alone.
///
/// Crosstalk moves by at least the step of the code from phase to phase while lags stand. When lags change, the first
/// period after the change is *unsettled*: its readings may hold sound from before. A solo period lasts long enough
/// that all sound from before it has died when its sensor fires, and that sensor's own when the next period begins.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingFiring<const K: usize> {
    pub(super) turns: [Turn; K],
    /// Who fires in this period, in order.
    pub(super) order: [u8; K],
    /// How many fire in it, and how many of them have.
    pub(super) planned: u8,
    place: u8,
    pub(super) phase: u8,
    /// Counts periods modulo 8, for the ring.
    count: u8,
    pub(super) start: Instant,
    /// When the next firing or the end of the period is due: it is asked for several times a poll.
    due: Instant,
    /// How long the period lasts.
    pub(super) length: Micros,
    /// After how long its sensor fires in a solo period.
    pub(super) solo_at: Option<Micros>,
    /// When any sensor last fired.
    pub(super) last_fired: Instant,
    /// What has been earned of solo periods, in 1/256.
    pub(super) earned: u16,
    pub(super) since_solo: u8,
    pub(super) since_shift: u8,
    /// Whether lags have changed or the timetable broke off, for the tracker.
    pub(super) changed: bool,
    pub(super) random: SmallRandom,
    pub(super) disabled: SensorSet,
    paused: bool,
    lateness: Lateness,
    pub(super) code: HoppingCode,
    pub(super) period: Micros,
    pub(super) pace: Pace,
    pub(super) window: Micros,
    /// From a firing until its sensor no longer listens, and nothing of it is heard in a window that opens then.
    pub(super) dies: Micros,
}

impl<const K: usize> HoppingFiring<K> {
    pub(super) fn new(
        schedule: &HoppingSchedule<K>,
        settings: HoppingSettings,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> Self {
        let HoppingListening { window, blanking, reach } = listening;
        let mut firing = Self {
            turns: core::array::from_fn(|sensor| Turn::new(schedule.t_lag(sensor).unwrap_or(Micros::ZERO))),
            order: [u8::MAX; K],
            planned: 0,
            place: 0,
            phase: 0,
            count: 0,
            start: now,
            due: now,
            length: schedule.period(),
            solo_at: None,
            last_fired: now,
            earned: 0,
            since_solo: 0,
            since_shift: 0,
            changed: false,
            random: SmallRandom::new(seed),
            disabled: SensorSet::NONE,
            paused: false,
            lateness: Lateness::NEW,
            code: *schedule.code(),
            period: schedule.period(),
            pace: Pace::of(&settings),
            window,
            dies: reach.saturating_sub(blanking).max(window).saturating_add(Micros::new(1)),
        };
        firing.begin_period();
        firing
    }

    /// The lag of a sensor as it is now; `None` for one that is not there.
    pub fn t_lag(&self, sensor: usize) -> Option<Micros> {
        self.turns.get(sensor).filter(|_| sensor < self.code.sensors()).map(|turn| turn.lag)
    }

    /// The phase of the present period, from 0.
    pub const fn phase(&self) -> Phase {
        Phase(self.phase)
    }

    /// The sensor that the present period belongs to, if it is a solo period.
    pub fn solo(&self) -> Option<u8> {
        self.solo_at.and_then(|_| self.order.first().copied())
    }

    /// Of a sensor's last firing: its phase, whether it was alone, and whether what it hears moves as the code says.
    pub(super) fn last_firing(&self, sensor: u8, tolerated: u16) -> (Phase, bool, bool) {
        let Some(turn) = self.turns.get(usize::from(sensor)) else { return (Phase(0), false, false) };
        let steady = turn.is(SETTLED) && self.lateness.is_steady(turn.late, tolerated);
        (Phase(turn.phase), turn.is(SOLO), steady)
    }

    /// What became of a sensor's reading.
    pub(super) fn heard(&mut self, sensor: u8, accepted: bool, fits: bool) {
        if let Some(turn) = self.turns.get_mut(usize::from(sensor)) {
            turn.heard(accepted, fits);
        }
    }

    /// When a sensor fires in this period, after its start, unless it is a solo period.
    pub(super) fn offset(&self, sensor: u8) -> Micros {
        let Some(turn) = self.turns.get(usize::from(sensor)) else { return Micros::MAX };
        let step = self.code.step().as_micros();
        turn.lag.saturating_add(Micros::new(u32::from(turn.place) * step))
    }

    /// The next firing of this period, and how long after its start it is due.
    fn next(&self) -> Option<(u8, Micros)> {
        let sensor = self.next_sensor()?;
        Some((sensor, self.solo_at.unwrap_or_else(|| self.offset(sensor))))
    }

    fn next_sensor(&self) -> Option<u8> {
        if self.place < self.planned { self.order.get(usize::from(self.place)).copied() } else { None }
    }

    fn begin_period(&mut self) {
        self.place = 0;
        self.plan();
        self.set_paused(self.paused);
    }

    fn find_due(&mut self) {
        self.due = self.start + self.next().map_or(self.length, |(_, offset)| offset);
    }

    /// Nothing that is heard across this moment moves as the code says.
    fn break_off(&mut self) {
        self.lateness.break_off();
        self.changed = true;
    }
}

impl<const K: usize> Scheduler for HoppingFiring<K> {
    const COMPARES: bool = false;

    fn deadline(&self) -> Instant {
        self.due
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.next_sensor().map(|sensor| (sensor, Phase(self.count)))
    }

    fn fire(&mut self, now: Instant) {
        let Some(sensor) = self.next_sensor() else { return };
        let late = now.since(self.due);
        let is_solo = self.solo_at.is_some();
        if late > CATCHES_UP {
            self.break_off();
        }
        // Nothing else fires in a solo period, so that it may move freely.
        if late > CATCHES_UP || is_solo {
            self.start += late;
        }
        let late = if is_solo { 0 } else { u16::try_from(late.as_micros()).unwrap_or(u16::MAX) };
        if !is_solo {
            self.lateness.note(late);
        }
        self.place += 1;
        self.last_fired = now;
        let settled = if is_solo { SOLO | SETTLED } else { SETTLED * u8::from(self.since_shift > 0) };
        if let Some(turn) = self.turns.get_mut(usize::from(sensor)) {
            turn.fire(now, late, self.phase, settled);
        }
        self.find_due();
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        let Some(turn) = self.turns.get_mut(usize::from(sensor)) else { return };
        let is_solo = turn.is(SOLO);
        let late = Micros::new(turn.late.into()).saturating_add(by);
        turn.fired += by;
        if !is_solo {
            turn.late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
            self.lateness.note(turn.late);
        }
        if !self.last_fired.has_reached(turn.fired) {
            self.last_fired = turn.fired;
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
        let phase = Phase(self.count);
        let end = self.due;
        let left_out = now.since(end) > self.period;
        self.start = if left_out { now } else { end };
        self.lateness.end_period();
        if left_out {
            self.break_off();
        }
        self.count = (self.count + 1) & 7;
        let code = self.code;
        self.phase = if self.phase + 1 < code.phases() { self.phase + 1 } else { 0 };
        for (sensor, turn) in (0..).zip(self.turns.iter_mut().take(code.sensors())) {
            turn.place = if self.phase == 0 { 0 } else { code.next_place(sensor, turn.place) };
        }
        self.begin_period();
        (phase, false)
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn sensors(&self) -> usize {
        self.code.sensors()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.disabled.set(sensor, !enabled);
        if !enabled {
            self.leave_out(sensor, self.place);
            self.find_due();
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        if paused {
            // What is left of the period.
            self.planned = self.place;
        }
        self.find_due();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.sensors() && !self.disabled.contains(sensor)
    }

    fn restart(&mut self, now: Instant) {
        for turn in &mut self.turns {
            turn.clear(SETTLED);
        }
        self.start = now;
        self.break_off();
        self.begin_period();
    }

    fn periods_since(&self, phase: Phase) -> u8 {
        self.count.wrapping_sub(phase.0) & 7
    }

    fn limits(&self) -> Limits<'_> {
        Limits { longest_window: self.min_refire(), verified_for: None }
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
