//! Plan of the next period of a hopping ring: who fires, whether one sensor has it alone, and new lags.

use super::plan::{CATCHES_UP, HoppingPlan};
use super::schedule::longest_lag;
use super::turn::{DISABLED, FIRED, SETTLED, SOLO, Turn};
use crate::own_limits::OwnLimits;
use crate::time::{Instant, Micros};

/// A whole solo period, and the most that is saved up.
const ONE: u16 = 256;
const MOST: u16 = 2 * ONE;
/// Number of lags that are drawn in search of one that keeps the neighbours' interval.
const DRAWS: u8 = 8;

impl<const K: usize, U: OwnLimits> HoppingPlan<K, U> {
    /// Decides who fires in the period that has begun. `fired` says when a sensor that has fired last did.
    pub(super) fn plan(&mut self, fired: impl Fn(u8) -> Instant) {
        self.since_solo = self.since_solo.saturating_add(1);
        self.earned = (self.earned + u16::from(self.pace.solo_rate)).min(MOST);
        let may_be_solo = self.earned >= ONE && self.since_solo >= self.pace.solo_spacing;
        match if may_be_solo { self.longest_unserved() } else { None } {
            Some(sensor) => self.plan_solo(sensor, fired(sensor)),
            None => self.plan_all(fired),
        }
        self.obey_pause();
    }

    fn plan_all(&mut self, fired: impl Fn(u8) -> Instant) {
        self.since_shift = self.since_shift.saturating_add(1);
        if self.pace.shift_after > 0 && self.since_shift >= self.pace.shift_spacing {
            self.shift_all();
        }
        // Right after a change there is sound from before.
        self.kind = if self.since_shift > 0 { FIRED | SETTLED } else { FIRED };
        // At most 64 sensors.
        for sensor in 0..self.code.sensors() as u8 {
            let Some(turn) = self.turns.get(usize::from(sensor)) else { break };
            if !turn.is(DISABLED) && self.offset(sensor) >= self.rests_for(sensor, turn, fired(sensor)) {
                self.insert(sensor);
            }
        }
    }

    /// The sensor with nothing accepted for longest, if that is long enough.
    fn longest_unserved(&self) -> Option<u8> {
        let mut longest = (self.pace.solo_after.saturating_sub(1), None);
        for (sensor, turn) in self.turns.iter().enumerate().take(self.code.sensors()) {
            if turn.unserved > longest.0 && !turn.is(DISABLED) {
                longest = (turn.unserved, Some(sensor as u8));
            }
        }
        longest.1
    }

    /// Gives the period to one sensor, which fires when all else is silent.
    fn plan_solo(&mut self, sensor: u8, fired: Instant) {
        let silent = self.rings_for();
        // The last firing may have been late past the period's end. A clock that has jumped says nothing about it.
        let at = if silent <= self.dies.saturating_add(CATCHES_UP) { silent } else { Micros::ZERO };
        // Its own last firing is among those that it waits for, but its window may be longer.
        let at =
            at.max(self.turns.get(usize::from(sensor)).map_or(Micros::MAX, |turn| self.rests_for(sensor, turn, fired)));
        self.earned -= ONE;
        self.since_solo = 0;
        (self.kind, self.solo_at) = (FIRED | SOLO | SETTLED, at);
        self.length = self.length.max(at.saturating_add(self.dies));
        if let Some(first) = self.turns.first_mut() {
            first.order = sensor;
            self.planned = 1;
        }
    }

    /// Time after the start of the period in which a sensor that has last `fired` then must not fire yet, since it
    /// still listens.
    fn rests_for(&self, sensor: u8, turn: &Turn, fired: Instant) -> Micros {
        let own = self.own_limits.limits_of(sensor);
        let rest = own.map_or(self.window, |limits| limits.window.min(self.window));
        let rested = fired + rest;
        let rests = if self.start.has_reached(rested) { Micros::ZERO } else { rested.since(self.start) };
        // It may have fired late past the period's end. A clock that has jumped says nothing about when that was.
        let is_known = turn.is(FIRED) && rests <= rest.saturating_add(CATCHES_UP);
        if is_known { rests } else { Micros::ZERO }
    }

    /// Insertion by firing time; sensors that fire together keep their order.
    fn insert(&mut self, sensor: u8) {
        let offset = self.offset(sensor);
        let mut at = self.planned;
        while at > 0 {
            let before = self.order(at - 1);
            if self.offset(before) <= offset {
                break;
            }
            self.set_order(at, before);
            at -= 1;
        }
        self.set_order(at, sensor);
        self.planned += 1;
    }

    /// Takes a sensor out of those that fire from this place on.
    pub(super) fn leave_out(&mut self, sensor: u8, place: u8) {
        let Some(at) = (place..self.planned).find(|&at| self.order(at) == sensor) else { return };
        self.planned -= 1;
        for at in at..self.planned {
            self.set_order(at, self.order(at + 1));
        }
    }

    /// The sensor that fires at a place of the period's order.
    pub(super) fn order(&self, place: u8) -> u8 {
        self.turns.get(usize::from(place)).map_or(u8::MAX, |turn| turn.order)
    }

    fn set_order(&mut self, place: u8, sensor: u8) {
        if let Some(turn) = self.turns.get_mut(usize::from(place)) {
            turn.order = sensor;
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
            if self.code.is_welch() {
                self.order_places();
            }
            // What is pending was fired with the lags of before.
            for turn in &mut self.turns {
                turn.set(SETTLED, false);
            }
        }
    }

    /// Gives each sensor its place in the code by the order of lags, as
    /// [`HoppingSchedule::turn`](super::HoppingSchedule) does.
    fn order_places(&mut self) {
        for sensor in 0..self.code.sensors() {
            let Some(own) = self.turns.get(sensor).map(|turn| turn.lag) else { break };
            let others = self.turns.iter().take(self.code.sensors()).enumerate();
            let before = others.filter(|&(other, turn)| turn.lag < own || (turn.lag == own && other < sensor)).count();
            let place = self.code.place(before, self.phase);
            if let Some(turn) = self.turns.get_mut(sensor) {
                turn.place = place;
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

    /// Returns true if a sensor with this lag keeps the interval from its neighbours, in every phase and across the
    /// period's end.
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
