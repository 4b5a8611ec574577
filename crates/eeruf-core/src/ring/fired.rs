//! [`Ring::fired`]: when a sensor really fired.

use super::Ring;
use super::sensor::LISTENING;
use crate::scheduler::Scheduler;
use crate::sensor_error::SensorError;
use crate::time::{Instant, Micros};

impl<S: Scheduler, const K: usize, const E: usize> Ring<S, K, E> {
    /// The sensor of the last [`Fire`](super::RingEvent::Fire) has fired `at` this instant: by what a timer captured,
    /// for example, or after a pause that its circuit needs. Optional: without it the `now` of the poll counts.
    ///
    /// Echo times count from then, the lateness of the firing grows, and all later firings move by as much, so that no
    /// interval gets shorter. Call it before the next poll. Where another sensor has fired in between, how far
    /// crosstalk has moved is not known, and nothing is compared until two periods have ended. An instant before the
    /// poll, which cannot be, and one that comes after the firing's reading are ignored.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        let fired = self.sensor_mut(sensor)?;
        let polled = fired.fired;
        let later = at.since(polled);
        if fired.is(LISTENING) && later != Micros::ZERO && at.has_reached(polled) {
            fired.postpone(later);
            self.scheduler.postpone(sensor, later);
            self.lengthen(sensor, later);
            if self.oldest == sensor {
                self.find_oldest(polled);
                self.emit_when_oldest_ends();
            }
        }
        Ok(())
    }

    /// The timetable got longer at the firing of a sensor.
    fn lengthen(&mut self, sensor: u8, later: Micros) {
        let later = u16::try_from(later.as_micros()).unwrap_or(u16::MAX);
        let last = self.lateness.last_firing(sensor);
        self.lateness.watch(&mut self.totals);
        if !self.lateness.add(later) {
            self.uncompare_next();
        }
        if let Some(total) = self.totals.get_mut(usize::from(sensor)) {
            *total = total.saturating_add(later);
        }
        let Some((late, stretch)) = last else {
            self.lateness.lose_track();
            return self.uncompare_next();
        };
        let (late, stretch) = (late.saturating_add(later), stretch.saturating_add(later));
        self.lateness.note(late);
        self.lateness.remember(sensor, late, stretch);
        if !self.lateness.comparable(stretch, self.tolerated()) {
            self.uncompare_pending();
        }
    }
}
