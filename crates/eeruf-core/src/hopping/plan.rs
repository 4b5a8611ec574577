//! What the next period of a hopping ring is made of: who fires, whether one sensor has it alone, and new lags.

use super::firing::{CATCHES_UP, HoppingFiring};
use super::schedule::longest_lag;
use super::turn::{FIRED, SETTLED};
use crate::time::Micros;

/// A whole solo period, and the most that is saved up.
const ONE: u16 = 256;
const MOST: u16 = 2 * ONE;
/// How many lags are drawn in search of one that keeps the neighbours' interval.
const DRAWS: u8 = 8;

impl<const K: usize> HoppingFiring<K> {
    /// Decides who fires in the period that begins.
    pub(super) fn plan(&mut self) {
        self.planned = 0;
        self.solo_at = None;
        self.length = self.period;
        self.since_solo = self.since_solo.saturating_add(1);
        self.earned = (self.earned + u16::from(self.pace.solo_rate)).min(MOST);
        if self.earned >= ONE && self.since_solo >= self.pace.solo_spacing {
            if let Some(sensor) = self.longest_unserved() {
                self.plan_solo(sensor);
                return;
            }
        }
        self.since_shift = self.since_shift.saturating_add(1);
        if self.pace.shift_after > 0 && self.since_shift >= self.pace.shift_spacing {
            self.shift_all();
        }
        // At most 64 sensors.
        for sensor in 0..self.code.sensors() as u8 {
            if self.may_fire(sensor) {
                self.insert(sensor);
            }
        }
    }

    /// The sensor with nothing accepted for longest, if that is long enough.
    fn longest_unserved(&self) -> Option<u8> {
        let mut longest = (self.pace.solo_after.saturating_sub(1), None);
        for (sensor, turn) in self.turns.iter().enumerate().take(self.code.sensors()) {
            if turn.unserved > longest.0 && !self.disabled.contains(sensor as u8) {
                longest = (turn.unserved, Some(sensor as u8));
            }
        }
        longest.1
    }

    /// Gives the period to one sensor, which fires when all else is silent.
    fn plan_solo(&mut self, sensor: u8) {
        let silent = self.last_fired + self.dies;
        let silent = if self.start.has_reached(silent) { Micros::ZERO } else { silent.since(self.start) };
        // The last firing may have been late past the period's end. A clock that has jumped says nothing about it.
        let at = if silent <= self.dies.saturating_add(CATCHES_UP) { silent } else { Micros::ZERO };
        // Its own last firing is among those that it waits for, but its window may be longer.
        let at = at.max(self.rests_for(sensor));
        self.earned -= ONE;
        self.since_solo = 0;
        self.solo_at = Some(at);
        self.length = self.length.max(at.saturating_add(self.dies));
        if let Some(first) = self.order.first_mut() {
            *first = sensor;
            self.planned = 1;
        }
    }

    /// How long after the start of the period a sensor must not fire yet, since it still listens.
    fn rests_for(&self, sensor: u8) -> Micros {
        let Some(turn) = self.turns.get(usize::from(sensor)) else { return Micros::MAX };
        let rested = turn.fired + self.window;
        let rests = if self.start.has_reached(rested) { Micros::ZERO } else { rested.since(self.start) };
        // It may have fired late past the period's end. A clock that has jumped says nothing about when that was.
        let is_known = turn.is(FIRED) && rests <= self.window.saturating_add(CATCHES_UP);
        if is_known { rests } else { Micros::ZERO }
    }

    fn may_fire(&self, sensor: u8) -> bool {
        !self.disabled.contains(sensor) && self.offset(sensor) >= self.rests_for(sensor)
    }

    /// Insertion by firing time; sensors that fire together keep their order.
    fn insert(&mut self, sensor: u8) {
        let offset = self.offset(sensor);
        let mut at = usize::from(self.planned);
        while at > 0 {
            let Some(&before) = self.order.get(at - 1) else { break };
            if self.offset(before) <= offset {
                break;
            }
            if let Some(entry) = self.order.get_mut(at) {
                *entry = before;
            }
            at -= 1;
        }
        if let Some(entry) = self.order.get_mut(at) {
            *entry = sensor;
            self.planned += 1;
        }
    }

    /// Takes a sensor out of those that fire from this place on.
    pub(super) fn leave_out(&mut self, sensor: u8, place: u8) {
        let (from, to) = (usize::from(place), usize::from(self.planned));
        let Some(to_come) = self.order.get_mut(from..to) else { return };
        if let Some(at) = to_come.iter().position(|&entry| entry == sensor) {
            for behind in at..to_come.len() {
                if let Some(&next) = to_come.get(behind + 1) {
                    if let Some(entry) = to_come.get_mut(behind) {
                        *entry = next;
                    }
                }
            }
            self.planned -= 1;
        }
    }

    /// New lags for all sensors whose readings do not fit.
    fn shift_all(&mut self) {
        let mut shifted = false;
        for sensor in 0..self.code.sensors() {
            let misfits = self.turns.get(sensor).map_or(0, |turn| turn.misfits);
            if misfits >= self.pace.shift_after {
                shifted |= self.shift(sensor);
            }
        }
        if shifted {
            self.since_shift = 0;
            self.changed = true;
            // What is pending was fired with the lags of before.
            for turn in &mut self.turns {
                turn.clear(SETTLED);
            }
        }
    }

    /// Draws a new lag for a sensor.
    fn shift(&mut self, sensor: usize) -> bool {
        for _ in 0..DRAWS {
            let lag = Micros::new(self.random.up_to(longest_lag(&self.code, self.period).as_micros()));
            if self.keeps_interval(sensor, lag) {
                if let Some(turn) = self.turns.get_mut(sensor) {
                    (turn.lag, turn.misfits) = (lag, 0);
                }
                return true;
            }
        }
        false
    }

    /// Whether a sensor with this lag keeps the interval from its neighbours, in every phase and across the period's
    /// end.
    fn keeps_interval(&self, sensor: usize, lag: Micros) -> bool {
        let interval = self.pace.shift_interval;
        if interval == Micros::ZERO {
            return true;
        }
        // Waits differ by no more than the width of the code.
        let least = interval.saturating_add(self.code.width());
        let n = usize::from(self.pace.neighbours);
        let neighbours = self.turns.iter().enumerate().take(self.code.sensors());
        let mut neighbours = neighbours.filter(|&(other, _)| other != sensor && other.abs_diff(sensor) < n);
        neighbours.all(|(_, turn)| {
            let apart = turn.lag.abs_diff(lag);
            apart >= least && self.period.saturating_sub(apart) >= least
        })
    }
}
