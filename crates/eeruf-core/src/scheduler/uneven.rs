//! [`UnevenFiring`]: scheduled firing for sensors that are not all alike.

use super::contract::{Limits, Scheduler};
use super::scheduled::ScheduledFiring;
use crate::schedule::Phase;
use crate::time::{Instant, Micros};
use crate::uneven_schedule::{SensorLimits, UnevenSchedule};

/// Scheduled firing by an [`UnevenSchedule`]: as [`ScheduledFiring`], and each sensor may listen and compare as it was
/// verified for.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct UnevenFiring<'s, const K: usize> {
    firing: ScheduledFiring<'s, K>,
    uneven: &'s UnevenSchedule<K>,
}

impl<'s, const K: usize> UnevenFiring<'s, K> {
    /// Begins the first period of `schedule` at `now`, with all sensors enabled.
    pub const fn new(schedule: &'s UnevenSchedule<K>, now: Instant) -> Self {
        Self { firing: ScheduledFiring::new(schedule.verified().schedule(), now), uneven: schedule }
    }

    /// The schedule.
    pub const fn schedule(&self) -> &'s UnevenSchedule<K> {
        self.uneven
    }
}

impl<const K: usize> Scheduler for UnevenFiring<'_, K> {
    const DELAYS_ALL: bool = true;
    const UNEVEN: bool = true;

    fn limits(&self) -> Limits<'_> {
        let most = self.uneven.most();
        Limits { longest_window: most.window, verified_for: Some(most) }
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.uneven.each().get(usize::from(sensor)).copied()
    }

    #[inline]
    fn deadline(&self) -> Instant {
        self.firing.deadline()
    }

    #[inline]
    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.firing.next_firing()
    }

    #[inline]
    fn fire(&mut self, now: Instant) {
        self.firing.fire(now);
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        self.firing.postpone(sensor, by);
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        self.firing.end_period(now)
    }

    fn ended(&mut self, sensor: u8, at: Instant) {
        self.firing.ended(sensor, at);
    }

    fn sensors(&self) -> usize {
        self.firing.sensors()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.firing.set_enabled(sensor, enabled);
    }

    fn set_paused(&mut self, paused: bool) {
        self.firing.set_paused(paused);
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        self.firing.is_enabled(sensor)
    }

    fn restart(&mut self, now: Instant) {
        self.firing.restart(now);
    }

    fn periods_since(&self, phase: Phase) -> u8 {
        self.firing.periods_since(phase)
    }

    fn min_refire(&self) -> Micros {
        self.firing.min_refire()
    }

    #[inline]
    fn horizon(&self) -> Micros {
        self.firing.horizon()
    }
}
