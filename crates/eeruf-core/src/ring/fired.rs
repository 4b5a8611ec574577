//! [`Ring::fired`]: corrects the instant of a firing.

use super::Ring;
use super::sensor::LISTENING;
use crate::judging::Judge;
use crate::plan::Plan;
use crate::sensor_error::SensorError;
use crate::time::Instant;

impl<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize> Ring<P, J, K, E, H> {
    /// Corrects the instant at which a sensor last fired: for example to a time that a timer captured, or to allow for
    /// a delay in its circuit. Optional: without it the `now` of the poll counts.
    ///
    /// Echo times count from `at`. If it is later than the poll, the lateness of the firing grows, and all later
    /// firings move by as much, so that no interval gets shorter. Call it before you poll for readings that may contain
    /// the firing's sound: an accepted reading cannot be taken back. An instant not after the sensor's previous firing
    /// is ignored.
    ///
    /// # Errors
    /// [`SensorError`] if the sensor is out of range.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        let fired = self.sensor_mut(sensor)?;
        let polled = fired.fired();
        if at == polled || !fired.firings.may_correct(at) {
            return Ok(());
        }
        let (later_us, listens) = (fired.correct(at), fired.is(LISTENING));
        if !listens {
            // Its reading was already judged.
            self.judge.fired_later(sensor, later_us);
        }
        self.plan.fired(sensor, at);
        if listens {
            if at.has_reached(polled) {
                let later = at.since(polled);
                self.plan.postpone(sensor, later);
                let later = u16::try_from(later.as_micros()).unwrap_or(u16::MAX);
                self.punctuality.note(later);
                self.punctuality.add(later, 0);
            }
            if self.oldest == sensor || self.windows_differ() {
                self.find_oldest(polled);
                self.emit_when_oldest_ends();
            }
        }
        self.disturb();
        Ok(())
    }
}
