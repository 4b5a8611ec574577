//! Settings that can change while a ring runs.

use core::ops::Deref;

use super::history::is_just_ahead;
use super::listening::Listening;
use super::{NOBODY, Ring};
use crate::filter::EchoFilter;
use crate::judging::Judge;
use crate::own_limits::OwnLimits;
use crate::plan::{Plan, ScheduledFiring, TableFiring};
use crate::ring_error::RingError;
use crate::schedule::Schedule;
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};
use crate::verified::VerifiedSchedule;

impl<'s, const N: usize, const M: usize, U: OwnLimits, J: Judge, const K: usize, const E: usize, const H: usize>
    Ring<ScheduledFiring<'s, N, M, U>, J, K, E, H>
{
    /// Changes to another schedule when the current period ends (see [`ScheduledFiring::change_schedule`]). `t_delta`,
    /// window, P and R stay. If sensors have limits of their own, each keeps the lesser of both schedules' in the first
    /// period after the change.
    ///
    /// # Errors
    /// [`RingError::TDelta`] or [`RingError::VerifiedWindow`] if the schedule was verified for less than the ring's
    /// `t_delta` or window; [`RingError::Blanking`] if a sensor would listen no longer than the blanking time. The ring
    /// is then unchanged.
    pub fn change_schedule<L: OwnLimits<Held<'s> = U>>(
        &mut self,
        schedule: &'s VerifiedSchedule<N, M, L>,
    ) -> Result<(), RingError> {
        self.change_to(schedule.schedule(), schedule.own_limits().hold())
    }
}

impl<T, const N: usize, const M: usize, U: OwnLimits, J: Judge, const K: usize, const E: usize, const H: usize>
    Ring<TableFiring<T, N, M, U>, J, K, E, H>
where
    T: Deref<Target = Schedule<N, M>> + Clone,
{
    /// Changes like [`change_schedule`](Ring::change_schedule), to a schedule and the limits that it was verified for,
    /// which the plan holds from then on.
    ///
    /// # Errors
    /// As for [`change_schedule`](Ring::change_schedule); [`RingError::Window`] if a sensor would fire too soon.
    pub fn change_to(&mut self, schedule: T, own_limits: U) -> Result<(), RingError> {
        // Checked as if the ring began with that schedule.
        let begun = TableFiring::holding(schedule.clone(), own_limits, Instant::from_micros(0));
        Listening::checked(self.t_delta(), self.window(), self.blanking(), &begun)?;
        self.plan.change_to(schedule, own_limits);
        Ok(())
    }
}

impl<'s, const N: usize, const M: usize, J: Judge, const K: usize, const E: usize, const H: usize>
    Ring<ScheduledFiring<'s, N, M>, J, K, E, H>
{
    /// Changes like [`change_schedule`](Ring::change_schedule), to an unverified schedule.
    ///
    /// # Errors
    /// [`RingError::Window`] if a sensor would fire again while it still listens.
    pub fn change_to_unverified(&mut self, schedule: &'s Schedule<N, M>) -> Result<(), RingError> {
        self.change_to(schedule, ())
    }
}

impl<P: Plan, const K: usize, const E: usize, const H: usize> Ring<P, EchoFilter<K, E>, K, E, H> {
    /// Sets `t_delta` for all readings to come.
    ///
    /// # Errors
    /// [`RingError::TDelta`] for more than the schedule was verified for, [`RingError::CoarseTDelta`] for one that is
    /// no shorter than the window. The ring is then unchanged.
    pub fn set_t_delta(&mut self, t_delta: Micros) -> Result<(), RingError> {
        self.listening = self.listening.changed(t_delta, self.window(), self.blanking(), &self.plan)?;
        self.disturb();
        Ok(())
    }
}

impl<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize> Ring<P, J, K, E, H> {
    /// Changes the plan.
    pub(crate) fn change_plan<Refused>(
        &mut self,
        change: impl FnOnce(&mut P) -> Result<(), Refused>,
    ) -> Result<(), Refused> {
        change(&mut self.plan)?;
        self.disturb();
        Ok(())
    }

    /// Sets the listening window, also for firings in progress.
    ///
    /// # Errors
    /// [`RingError`] for more than the schedule allows or was verified for, or for no more than the blanking time or
    /// `t_delta`. The ring is then unchanged.
    pub fn set_window(&mut self, window: Micros) -> Result<(), RingError> {
        self.listening = self.listening.changed(self.t_delta(), window, self.blanking(), &self.plan)?;
        if self.windows_differ() {
            self.find_first_to_close();
        }
        self.emit_when_oldest_ends();
        Ok(())
    }

    /// Sets the least time from a firing to a reading without an echo, for modules that report over a bus or by a
    /// pulse's width after their window has closed; 0 for the end of the window. Echoes are not affected:
    /// [`measured`](Self::measured) takes any echo time within the window.
    ///
    /// # Errors
    /// [`RingError::Window`] for more than the time until a sensor fires again. The ring is then unchanged.
    pub fn set_report_after(&mut self, report_after: Micros) -> Result<(), RingError> {
        let min_refire = self.plan.min_refire();
        if report_after > min_refire {
            return Err(RingError::Window { window: report_after, min_refire });
        }
        self.report_after = report_after;
        if self.windows_differ() {
            self.find_first_to_close();
        }
        self.emit_when_oldest_ends();
        Ok(())
    }

    /// Sets the blanking time, for which a sensor is deaf after it has fired. It may be less than at the start: ringing
    /// and a sensor's own stale echoes then count as edges; the promise about foreign sound does not depend on the
    /// blanking time.
    ///
    /// # Errors
    /// [`RingError::Blanking`] for one that is no shorter than the window, or longer than 65,535 us. The ring is then
    /// unchanged.
    pub fn set_blanking(&mut self, blanking: Micros) -> Result<(), RingError> {
        self.listening = self.listening.changed(self.t_delta(), self.window(), blanking, &self.plan)?;
        Ok(())
    }

    /// Sets P, the largest change of a foreign sound's path from one reading to the next (see
    /// [`RingConfig::path_change`](super::RingConfig::path_change)), for example when the robot's speed changes.
    ///
    /// # Errors
    /// [`RingError::PathChange`] for more than 65,534 us. The ring is then unchanged.
    pub fn set_path_change(&mut self, path_change: Micros) -> Result<(), RingError> {
        self.listening = self.listening.with_path_change(path_change)?;
        self.disturb();
        Ok(())
    }

    /// Sets R, how long sound is audible.
    ///
    /// # Errors
    /// [`RingError::Audible`] for more than 67 s. The ring is then unchanged.
    pub fn set_audible(&mut self, audible: Micros) -> Result<(), RingError> {
        self.listening = self.listening.with_audible(audible)?;
        self.disturb();
        Ok(())
    }

    /// Stops a sensor from firing. The reading of a firing that is in progress is still emitted.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn disable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.sensor_mut(sensor)?;
        self.plan.set_enabled(sensor, false);
        Ok(())
    }

    /// Lets a sensor fire again from its next turn on. Its earlier readings are forgotten.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor out of range.
    pub fn enable(&mut self, sensor: u8) -> Result<(), SensorError> {
        let was_enabled = self.plan.is_enabled(sensor);
        self.sensor_mut(sensor)?;
        if !was_enabled {
            self.judge.forget(sensor);
            self.plan.set_enabled(sensor, true);
            self.disturb();
        }
        Ok(())
    }

    /// Stops all sensors from firing until [`resume`](Self::resume). Readings of firings in progress are still emitted;
    /// periods continue, so that a deadline still comes once per period. For a longer sleep do not poll, and
    /// [`restart`](Self::restart) after it.
    pub fn pause(&mut self) {
        self.plan.set_paused(true);
    }

    /// Lets sensors fire again: from the next period on with scheduled firing, at once with immediate refiring. Earlier
    /// readings are forgotten; a judge may keep its beliefs.
    pub fn resume(&mut self) {
        self.plan.set_paused(false);
        // At most 64 sensors.
        for sensor in 0..self.sensors() as u8 {
            self.judge.resume(sensor);
        }
        self.disturb();
    }

    /// Starts again with phase a at `now`, or as soon as the last firings allow. Firings in progress are dropped and
    /// earlier readings forgotten; ages and the count of periods continue. Restart a
    /// [`SensorWatch`](crate::watch::SensorWatch) at the same time.
    pub fn restart(&mut self, now: Instant) {
        self.plan.restart(now);
        // Sound from before may still be heard, and its firings are no longer known by this clock.
        self.known_from = now;
        let sensors = self.sensors();
        for sensor in self.sensors.iter_mut().take(sensors) {
            // A firing corrected to an instant just ahead is still known.
            if is_just_ahead(sensor.fired(), self.known_from) {
                self.known_from = sensor.fired();
            }
            sensor.drop_firings(now);
        }
        self.judge.restart();
        self.oldest = NOBODY;
        (self.ready, self.listening_now) = (0, 0);
        self.disturb();
    }
}
