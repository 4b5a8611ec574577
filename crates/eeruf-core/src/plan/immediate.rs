//! [`ImmediateRefiring`]: each sensor fires again as soon as its echo has arrived and its wait is over (Sec. 3, Figs.
//! 2a, 2b).
//!
//! There is no common period, so neighbours drift past each other; that is why the paper goes on to scheduled firing.
//! With constant waits crosstalk locks in: a sensor y that hears x takes on x's rhythm, and its error becomes
//!
//! ```text
//! T_err = T_echo + T_wait,x - T_wait,y                 = T_echo for equal waits      (8)
//! T_err,a = T_echo + T_x,a - T_y,a                                                  (10a)
//! T_err,b = T_echo + T_x,b - T_y,b                                                  (10b)
//! ```
//!
//! With (8) the filter takes crosstalk for a true echo. With (10a), (10b) consecutive readings differ, and the filter
//! rejects them.

use core::ops::Deref;

use super::contract::{Plan, PlanLimits};
use crate::judging::FiringContext;
use crate::schedule::{MAX_PERIOD, Phase, Schedule};
use crate::sensor_set::SensorSet;
use crate::time::{Instant, Micros};

/// Immediate refiring: a sensor fires again `T_wait` after it has stopped listening; the first time after `T_lag +
/// T_wait`.
pub type ImmediateRefiring<'s, const K: usize, const M: usize = 2> = Refiring<&'s Schedule<K, M>, K, M>;

/// [`ImmediateRefiring`] over any pointer `T` to a [`Schedule`]: with an `Arc` it owns the schedule.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Refiring<T, const K: usize, const M: usize = 2> {
    schedule: T,
    min_refire: Micros,
    sensors: [Turn; K],
    /// Sensors that have fired and are still listening.
    listening: SensorSet,
    enabled: SensorSet,
    period_start: Instant,
    phase: u8,
    paused: bool,
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Turn {
    /// Time when the sensor fires next; while it listens, the time when it fired.
    at: Instant,
    phase: u8,
}

impl<T: Deref<Target = Schedule<K, M>>, const K: usize, const M: usize> Refiring<T, K, M> {
    /// A plan that begins at `now` with the lags and waits of `schedule`, whose period only sets how often periods end.
    /// No sensor fires again within `min_refire`, which is at most [`MAX_PERIOD`](crate::MAX_PERIOD).
    pub fn new(schedule: T, min_refire: Micros, now: Instant) -> Self {
        let sensors = [Turn { at: now, phase: 0 }; K];
        // Instants further ahead than half a turn of the clock would count as past.
        let min_refire = min_refire.min(MAX_PERIOD);
        let mut refiring = Self {
            schedule,
            min_refire,
            sensors,
            listening: SensorSet::NONE,
            enabled: SensorSet::ALL,
            period_start: now,
            phase: 0,
            paused: false,
        };
        refiring.restart(now);
        refiring
    }

    /// The enabled sensor that is due first, measured from the start of the period: all times lie within half a turn of
    /// the clock from there.
    fn first(&self) -> Option<(u8, Instant)> {
        let mut first: Option<(u8, Instant)> = None;
        for (x, turn) in self.sensors.iter().take(self.schedule.sensors()).enumerate() {
            // At most 64 sensors.
            let x = x as u8;
            let waits = !self.paused && self.is_enabled(x) && !self.listening.contains(x);
            if waits && first.is_none_or(|(_, at)| !turn.at.has_reached(at)) {
                first = Some((x, turn.at));
            }
        }
        first
    }

    fn period_end(&self) -> Instant {
        self.period_start + self.schedule.period()
    }

    fn wait(&self, phase: u8, sensor: u8) -> Micros {
        self.schedule.t_wait(Phase(phase)).get(usize::from(sensor)).copied().unwrap_or(Micros::ZERO)
    }
}

fn previous_phase<const M: usize>(phase: u8) -> u8 {
    // At most `MAX_PHASES`.
    if phase == 0 { (M - 1) as u8 } else { phase - 1 }
}

fn next_phase<const M: usize>(phase: u8) -> u8 {
    if usize::from(phase) + 1 < M { phase + 1 } else { 0 }
}

impl<T: Deref<Target = Schedule<K, M>>, const K: usize, const M: usize> Plan for Refiring<T, K, M> {
    fn next_firing(&self) -> Option<(u8, Phase)> {
        let (sensor, due) = self.first()?;
        let turn = self.sensors.get(usize::from(sensor))?;
        self.period_end().has_reached(due).then_some((sensor, Phase(turn.phase)))
    }

    fn fire(&mut self, now: Instant) {
        let Some((sensor, _)) = self.first() else { return };
        self.listening.set(sensor, true);
        if let Some(turn) = self.sensors.get_mut(usize::from(sensor)) {
            turn.at = now;
        }
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        if let Some(turn) = self.sensors.get_mut(usize::from(sensor)) {
            // While it listens this is when it fired; afterwards its next firing follows from that.
            turn.at += by;
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        let phase = Phase(self.phase);
        self.phase = next_phase::<M>(self.phase);
        self.period_start = self.period_end();
        // After a long silence the missed periods are skipped, not ended one by one.
        if now.has_reached(self.period_end()) {
            self.period_start = now;
        }
        // A disabled sensor stays due, but its instant must not fall half a turn of the clock behind.
        for (x, turn) in self.sensors.iter_mut().enumerate() {
            if !self.listening.contains(x as u8) && now.has_reached(turn.at) {
                turn.at = now;
            }
        }
        (phase, false)
    }

    fn deadline(&self) -> Instant {
        match self.first() {
            Some((_, due)) if self.period_end().has_reached(due) => due,
            _ => self.period_end(),
        }
    }

    fn ended(&mut self, sensor: u8, at: Instant) {
        let Some(&Turn { at: fired, phase }) = self.sensors.get(usize::from(sensor)) else { return };
        if !self.listening.contains(sensor) {
            return;
        }
        self.listening.set(sensor, false);
        let phase = next_phase::<M>(phase);
        let mut next = at + self.wait(phase, sensor);
        let soonest = fired + self.min_refire;
        if soonest.has_reached(next) {
            next = soonest;
        }
        if let Some(turn) = self.sensors.get_mut(usize::from(sensor)) {
            *turn = Turn { at: next, phase };
        }
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.enabled.set(sensor, enabled);
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
    }

    fn sensors(&self) -> usize {
        self.schedule.sensors()
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.schedule.sensors() && self.enabled.contains(sensor)
    }

    fn restart(&mut self, now: Instant) {
        self.period_start = now;
        self.phase = 0;
        // No sensor waits for longer, unless the clock has jumped.
        let longest = self.min_refire.max(self.schedule.period());
        for (x, turn) in self.sensors.iter_mut().enumerate() {
            let mut at = now + self.schedule.t_fire(Phase::A, x).unwrap_or(Micros::ZERO);
            // A sensor that has stopped listening already waits for its refire time.
            let listens = self.listening.contains(x as u8);
            let soonest = if listens { turn.at + self.min_refire } else { turn.at };
            if soonest.has_reached(at) && soonest.since(now) <= longest {
                at = soonest;
            }
            *turn = Turn { at, phase: 0 };
        }
        self.listening = SensorSet::NONE;
    }

    fn last_firing(&self, sensor: u8, _periods_ago: u8) -> FiringContext {
        let Some(turn) = self.sensors.get(usize::from(sensor)) else { return FiringContext::new(Phase::A) };
        // Once it has ended, its next firing's phase is known already.
        let ended = !self.listening.contains(sensor);
        FiringContext::new(Phase(if ended { previous_phase::<M>(turn.phase) } else { turn.phase }))
    }

    fn limits(&self) -> PlanLimits<'_> {
        // It fires only sensors that have stopped listening.
        PlanLimits { longest_window: Micros::MAX, verified_for: None, audible: None }
    }

    fn min_refire(&self) -> Micros {
        self.min_refire
    }

    fn horizon(&self) -> Micros {
        // The end of the period is always among the deadlines.
        self.schedule.period().saturating_add(self.schedule.period())
    }
}
