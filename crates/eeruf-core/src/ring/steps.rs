//! What a poll of a [`Ring`] does when something is due: fire, emit a reading, end the period.

use super::sensor::{COMPARE_WITH_NOTHING, LISTENING, READY, Sensor};
use super::{NOBODY, PeriodStats, Reading, Ring, RingEvent};
use crate::filter::Rule;
use crate::reading::Verdict;
use crate::scheduler::Scheduler;
use crate::time::{Instant, Micros};

impl<S: Scheduler, const K: usize, const E: usize> Ring<S, K, E> {
    /// Something is due. Firing comes first, since it should be on time; but the reading of a sensor is emitted before
    /// the sensor fires again.
    #[inline]
    pub(super) fn advance(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let due = self.scheduler.deadline();
        let fires = if now.has_reached(due) { self.scheduler.next_firing() } else { None };
        let emits = match fires {
            Some((sensor, phase)) => match self.sensors.get_mut(usize::from(sensor)) {
                Some(pending) if pending.is(LISTENING | READY) => Some(sensor),
                fired => {
                    if let Some(fired) = fired {
                        fired.fire(phase, now);
                    }
                    self.fired(sensor, now.since(due), now);
                    self.scheduler.fire(now);
                    return Some(RingEvent::Fire(sensor));
                }
            },
            None => self.next_pending(now),
        };
        match emits {
            Some(sensor) => self.emit_reading(sensor, expected_change_us),
            None => self.end_period(now),
        }
    }

    #[inline]
    fn fired(&mut self, sensor: u8, late: Micros, now: Instant) {
        if late.as_micros() > self.max_late_us.into() {
            self.fired_late(late);
        }
        if self.oldest == NOBODY {
            self.oldest = sensor;
            if self.ready == 0 {
                self.emit_at = now + self.window;
            }
        }
    }

    /// Later than any firing of this period so far.
    #[inline(never)]
    fn fired_late(&mut self, late: Micros) {
        self.max_late_us = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        if late > self.t_delta {
            // Sound sent before this moment may be heard for a period, and its readings compared for one more. A
            // further late firing in this period changes nothing: until its end all readings are compared with nothing
            // already.
            self.uncomparable_periods = 2;
            self.invalidate();
        }
    }

    #[inline(never)]
    fn end_period(&mut self, now: Instant) -> Option<RingEvent> {
        if !now.has_reached(self.scheduler.deadline()) {
            return None;
        }
        let (phase, changed) = self.scheduler.end_period(now);
        if changed {
            self.uncomparable_periods = 2;
        }
        if self.uncomparable_periods > 0 {
            self.uncomparable_periods -= 1;
            self.invalidate();
        }
        let stats = PeriodStats {
            period: self.period,
            phase,
            tally: core::mem::take(&mut self.tally),
            max_late: Micros::new(core::mem::take(&mut self.max_late_us).into()),
        };
        self.period = self.period.wrapping_add(1);
        Some(RingEvent::PeriodEnded(stats))
    }

    /// Firings have shifted against each other, by lateness or by a change of schedule. (13a), (13b) say nothing about
    /// a reading of sound from before compared with one of sound from after. The next reading of each sensor may be of
    /// either, so it is compared with nothing.
    #[cold]
    #[inline(never)]
    fn invalidate(&mut self) {
        for sensor in &mut self.sensors {
            sensor.set(COMPARE_WITH_NOTHING);
        }
    }

    /// A sensor with an echo in, or one whose window has closed.
    fn next_pending(&self, now: Instant) -> Option<u8> {
        if self.ready > 0 {
            return self.first_ready();
        }
        (self.oldest != NOBODY && now.has_reached(self.emit_at)).then_some(self.oldest)
    }

    /// A sensor with a reading to emit. The oldest goes first: after it the next oldest must be searched for too, so
    /// this saves a search where a poll costs most.
    fn first_ready(&self) -> Option<u8> {
        if self.sensor(self.oldest).is_some_and(|oldest| oldest.is(READY)) {
            return Some(self.oldest);
        }
        for (x, sensor) in self.sensors.iter().enumerate() {
            if sensor.is(READY) {
                // At most 64 sensors.
                return Some(x as u8);
            }
        }
        None
    }

    #[inline(never)]
    fn emit_reading(&mut self, sensor: u8, mut expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let heard = self.sensors.get_mut(usize::from(sensor))?;
        let phase = heard.phase();
        let (listened, fired) = (heard.is(LISTENING), heard.fired);
        let mut ended_at = fired + self.window;
        if heard.is(READY) {
            // Counted when its edge came.
            self.ready = self.ready.wrapping_sub(1);
            ended_at = fired + heard.held().unwrap_or_default();
        }
        let verdict = if listened {
            heard.compare(Rule { t_delta: self.t_delta, agreement: self.agreement }, || expected_change_us(sensor))
        } else {
            heard.take_late()
        };
        if listened {
            self.scheduler.ended(sensor, ended_at);
            if self.oldest == sensor {
                self.find_oldest(fired);
            }
        }
        if self.ready == 0 {
            if let Some(oldest) = self.sensor(self.oldest) {
                self.emit_at = oldest.fired + self.window;
            }
        }
        self.tally.count(verdict.kind);
        let Verdict { kind, t_echo, previous, age } = verdict;
        let period = self.period.wrapping_sub(self.scheduler.periods_since(phase).into());
        Some(RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age }))
    }

    /// Finds the next oldest, now that the one that fired at `before` has stopped listening. All others fired later.
    fn find_oldest(&mut self, before: Instant) {
        let (mut oldest, mut soonest) = (NOBODY, Micros::MAX);
        for (x, sensor) in self.sensors.iter().enumerate() {
            if sensor.is(LISTENING) && sensor.fired.since(before) < soonest {
                // At most 64 sensors.
                (oldest, soonest) = (x as u8, sensor.fired.since(before));
            }
        }
        self.oldest = oldest;
    }

    fn sensor(&self, sensor: u8) -> Option<&Sensor<E>> {
        self.sensors.get(usize::from(sensor))
    }
}
