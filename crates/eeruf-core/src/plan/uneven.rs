//! [`UnevenFiring`]: scheduled firing for sensors that are not all alike.

use super::contract::{Limits, Plan};
use super::scheduled::ScheduledFiring;
use crate::judge::Firing;
use crate::schedule::{Phase, VerifiedFor};
use crate::time::{Instant, Micros};
use crate::uneven_schedule::{SensorLimits, UnevenSchedule};

/// Scheduled firing by an [`UnevenSchedule`]: as [`ScheduledFiring`], and each sensor may listen and compare as it was
/// verified for; in the first period after a change of schedules by the lesser of what both allow it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct UnevenFiring<'s, const K: usize> {
    firing: ScheduledFiring<'s, K>,
    uneven: &'s UnevenSchedule<K>,
    /// That of the period before: its last firings may still be listening.
    before: &'s UnevenSchedule<K>,
    next: Option<&'s UnevenSchedule<K>>,
}

impl<'s, const K: usize> UnevenFiring<'s, K> {
    /// Begins the first period of `schedule` at `now`, with all sensors enabled.
    pub const fn new(schedule: &'s UnevenSchedule<K>, now: Instant) -> Self {
        let firing = ScheduledFiring::new(schedule.verified().schedule(), now);
        Self { firing, uneven: schedule, before: schedule, next: None }
    }

    /// The schedule of the present period.
    pub const fn schedule(&self) -> &'s UnevenSchedule<K> {
        self.uneven
    }

    /// Changes to another schedule when the present period ends.
    ///
    /// Its first period begins late enough after the last firing to keep every interval, window and refire time that
    /// either schedule was verified for, of whatever sensors.
    pub const fn change_schedule(&mut self, schedule: &'s UnevenSchedule<K>) {
        self.firing.change_schedule(schedule.verified().schedule());
        self.next = Some(schedule);
    }
}

/// What the schedule allows of which this is the most.
fn of_most(most: &VerifiedFor) -> Limits<'_> {
    Limits { longest_window: most.window, verified_for: Some(most), audible: Some(most.audible) }
}

impl<const K: usize> Plan for UnevenFiring<'_, K> {
    fn limits(&self) -> Limits<'_> {
        of_most(self.uneven.most())
    }

    fn next_limits(&self) -> Option<Limits<'_>> {
        Some(of_most(self.next?.most()))
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        // After a change the last firings of the schedule before may still be heard.
        self.uneven.hears(receiver, emitter) || self.before.hears(receiver, emitter)
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        let (now, before) =
            (self.uneven.each().get(usize::from(sensor))?, self.before.each().get(usize::from(sensor))?);
        Some(SensorLimits { t_delta: now.t_delta.min(before.t_delta), window: now.window.min(before.window) })
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
        self.before = self.uneven;
        self.uneven = self.next.take().unwrap_or(self.uneven);
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

    fn last_firing(&self, sensor: u8, periods_ago: u8) -> Firing {
        self.firing.last_firing(sensor, periods_ago)
    }

    fn min_refire(&self) -> Micros {
        self.firing.min_refire()
    }

    #[inline]
    fn horizon(&self) -> Micros {
        self.firing.horizon()
    }
}
