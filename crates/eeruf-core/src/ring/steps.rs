//! What a poll of a [`Ring`] does when something is due: fire, emit a reading, end the period.

use super::history::{Answer, STEP_BACK, Sounds, is_long_ago, long_before};
use super::punctuality::PeriodLateness;
use super::sensor::{LISTENING, READY, Sensor};
use super::{NOBODY, PeriodStats, Reading, Ring, RingEvent};
use crate::filter::Agreement;
use crate::reading::{Explanation, Verdict};
use crate::schedule::Phase;
use crate::scheduler::Scheduler;
use crate::time::{Instant, Micros};

impl<S: Scheduler, const K: usize, const E: usize, const H: usize> Ring<S, K, E, H> {
    /// Something is due. Firing comes first, since it should be on time; but the reading of a sensor is emitted before
    /// the sensor fires again.
    #[inline]
    pub(super) fn advance(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let first = match self.fire_due(now) {
            Ok((sensor, phase, due)) => return Some(RingEvent::Fire { sensor, phase, due }),
            Err(first) => first,
        };
        match first.or_else(|| self.next_pending(now)) {
            Some(sensor) => self.emit_reading(sensor, expected_change_us),
            None => self.end_period(now),
        }
    }

    /// Fires the sensor that is due; returns its phase and when it was due. `Err` if none is to fire, with the sensor
    /// that has a reading to emit before it fires.
    #[inline(always)]
    pub(crate) fn fire_due(&mut self, now: Instant) -> Result<(u8, Phase, Instant), Option<u8>> {
        let due = self.scheduler.deadline();
        let fires = if now.has_reached(due) { self.scheduler.next_firing() } else { None };
        let Some((sensor, phase)) = fires else { return Err(None) };
        if let Some(fired) = self.sensors.get_mut(usize::from(sensor)) {
            if fired.is(LISTENING | READY) {
                return Err(Some(sensor));
            }
            fired.fire(phase, now, self.listening.unanswered());
        }
        self.has_fired(sensor, now);
        self.scheduler.fire(now);
        // Last, since it is rare.
        let late = now.since(due);
        if late != Micros::ZERO {
            self.fired_late(late);
        }
        Ok((sensor, phase, due))
    }

    #[inline]
    fn has_fired(&mut self, sensor: u8, now: Instant) {
        if self.oldest == NOBODY || (S::UNEVEN && self.closes_first(sensor, now)) {
            self.oldest = sensor;
            if self.ready == 0 {
                self.emit_at = now + self.window_of(sensor);
            }
        }
    }

    /// Whether the window of a sensor that fires `now` closes before all others: where windows differ, the sensor that
    /// fired first need not be the first to end.
    fn closes_first(&self, sensor: u8, now: Instant) -> bool {
        let oldest = self.sensor(self.oldest).map(|oldest| oldest.fired() + self.window_of(self.oldest));
        oldest.is_none_or(|closes| !(now + self.window_of(sensor)).has_reached(closes))
    }

    #[inline(never)]
    fn fired_late(&mut self, late: Micros) {
        let late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        self.punctuality.note(late);
        if self.punctuality.add(late, self.listening.spare(self.scheduler.limits())) {
            self.disturb();
        }
    }

    /// Firings no longer keep the timetable that was verified, or it is another one.
    #[cold]
    #[inline(never)]
    pub(super) fn disturb(&mut self) {
        self.punctuality.disturb(self.listening.is_proven(&self.scheduler));
    }

    /// Ends the period, if that is due.
    #[inline(never)]
    pub(crate) fn end_period(&mut self, now: Instant) -> Option<RingEvent> {
        let due = self.scheduler.deadline();
        if !now.has_reached(due) {
            return None;
        }
        self.punctuality.note(u16::try_from(now.since(due).as_micros()).unwrap_or(u16::MAX));
        let (phase, changed) = self.scheduler.end_period(now);
        let PeriodLateness { latest, sum } = self.punctuality.end_period();
        if changed {
            self.disturb();
        }
        if H > 1 {
            for sensor in &mut self.sensors {
                sensor.expire(now);
            }
            if is_long_ago(self.known_from, now) {
                self.known_from = long_before(now);
            }
        }
        if S::UNEVEN {
            // Another schedule may allow other windows, also to firings under way.
            self.find_first_to_close();
            self.emit_when_oldest_ends();
        }
        let stats = PeriodStats {
            period: self.period,
            phase,
            tally: core::mem::take(&mut self.tally),
            max_late: Micros::new(latest.into()),
            sum_late: Micros::new(sum.into()),
        };
        self.period = self.period.wrapping_add(1);
        Some(RingEvent::PeriodEnded(stats))
    }

    /// A sensor with an echo in, or one whose window has closed.
    pub(crate) fn next_pending(&self, now: Instant) -> Option<u8> {
        if self.ready > 0 {
            return self.first_ready();
        }
        (self.oldest != NOBODY && now.has_reached(self.emit_at)).then_some(self.oldest)
    }

    /// A sensor with a reading to emit. The oldest goes first: after it the next oldest must be searched for too, so
    /// this saves a search where a poll costs most.
    fn first_ready(&self) -> Option<u8> {
        let is_ready = |x: u8| self.sensor(x).is_some_and(|sensor| sensor.is(READY));
        if self.ready == 1 && is_ready(self.last_ready) {
            // The only one.
            return Some(self.last_ready);
        }
        if is_ready(self.oldest) {
            return Some(self.oldest);
        }
        // At most 64 sensors.
        (0..K as u8).find(|&x| is_ready(x))
    }

    #[inline(never)]
    fn emit_reading(&mut self, sensor: u8, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let reading = self.take_reading(sensor, expected_change_us)?;
        self.tally.count(reading.kind);
        Some(RingEvent::Reading(reading))
    }

    /// The reading of a sensor, which ends its firing. It is yet to be counted.
    #[inline(always)]
    pub(crate) fn take_reading(
        &mut self,
        sensor: u8,
        mut expected_change_us: impl FnMut(u8) -> i32,
    ) -> Option<Reading> {
        let heard = self.sensors.get_mut(usize::from(sensor))?;
        let phase = heard.phase();
        let (listened, fired) = (heard.is(LISTENING), heard.fired());
        let mut ended_at = fired + self.listening.window_of(&self.scheduler, sensor);
        if heard.is(READY) {
            // Counted when its edge came.
            self.ready = self.ready.wrapping_sub(1);
            ended_at = fired + heard.held().unwrap_or_default();
        }
        let verdict = if listened && !S::COMPARES {
            heard.end()
        } else if listened {
            // On a copy, since what other sensors fired is looked at meanwhile.
            let mut compared = *heard;
            let agreement = Agreement::new(self.listening.t_delta_of(&self.scheduler, sensor), self.consecutive);
            let verdict = compared.compare(
                agreement,
                || expected_change_us(sensor),
                |first, second| self.explanation(sensor, first, second),
            );
            if let Some(heard) = self.sensors.get_mut(usize::from(sensor)) {
                *heard = compared;
            }
            verdict
        } else {
            heard.take_late()
        };
        if listened {
            self.scheduler.ended(sensor, ended_at);
            if self.oldest == sensor {
                self.find_oldest(fired);
            }
        }
        self.emit_when_oldest_ends();
        let Verdict { kind, t_echo, previous, age, explained_by } = verdict;
        let period = self.period.wrapping_sub(self.scheduler.periods_since(phase).into());
        Some(Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by })
    }

    /// The firing whose sound could be both the echo that a sensor heard `first` after the firing before its last one
    /// and the one that it heard `second` after its last.
    #[inline(always)]
    fn explanation(&self, receiver: u8, first: u32, second: u32) -> Option<Explanation> {
        if H == 1 || self.punctuality.is_on_time() {
            return None;
        }
        self.find_explanation(receiver, first, second)
    }

    #[inline(never)]
    fn find_explanation(&self, receiver: u8, first: u32, second: u32) -> Option<Explanation> {
        let own = self.sensor(receiver)?;
        let heard = [own.firings.before()? + Micros::new(first), own.fired() + Micros::new(second)];
        let path_change = self.listening.path_change_of(&self.scheduler, receiver);
        let sounds = Sounds { heard, audible: self.listening.audible(), path_change };
        let mut forgotten = sounds.is_audible_from(self.known_from);
        for (x, sensor) in self.sensors.iter().enumerate().take(self.scheduler.sensors()) {
            // At most 64 sensors.
            let x = x as u8;
            if self.scheduler.hears(receiver, x) {
                match sounds.ask(&sensor.firings, x == receiver) {
                    Answer::Explained => return Some(Explanation::Sensor(x)),
                    Answer::Forgotten => forgotten = true,
                    Answer::No => {}
                }
            }
        }
        forgotten.then_some(Explanation::History)
    }

    /// Without a reading that can be emitted sooner, the next one comes when the window of the oldest closes.
    #[inline]
    pub(super) fn emit_when_oldest_ends(&mut self) {
        if self.ready == 0 {
            if let Some(oldest) = self.sensor(self.oldest) {
                self.emit_at = oldest.fired() + self.window_of(self.oldest);
            }
        }
    }

    /// Finds the next oldest, now that the one that fired at `before` has stopped listening. All others fired later, or
    /// earlier by no more than the clock has stepped back; where windows differ, the oldest is the one whose window
    /// closes first.
    pub(super) fn find_oldest(&mut self, before: Instant) {
        if S::UNEVEN {
            return self.find_first_to_close();
        }
        // 1 us before is not 71 minutes after.
        let before = Instant::from_micros(before.as_micros().wrapping_sub(STEP_BACK.as_micros()));
        let (mut oldest, mut soonest) = (NOBODY, Micros::MAX);
        for (x, sensor) in self.sensors.iter().enumerate() {
            if sensor.is(LISTENING) && sensor.fired().since(before) < soonest {
                // At most 64 sensors.
                (oldest, soonest) = (x as u8, sensor.fired().since(before));
            }
        }
        self.oldest = oldest;
    }

    pub(super) fn find_first_to_close(&mut self) {
        let mut first: Option<(u8, Instant)> = None;
        for (x, sensor) in self.sensors.iter().enumerate() {
            // At most 64 sensors.
            let closes = sensor.fired() + self.window_of(x as u8);
            if sensor.is(LISTENING) && first.is_none_or(|(_, sooner)| !closes.has_reached(sooner)) {
                first = Some((x as u8, closes));
            }
        }
        self.oldest = first.map_or(NOBODY, |(x, _)| x);
    }

    fn sensor(&self, sensor: u8) -> Option<&Sensor<E, H>> {
        self.sensors.get(usize::from(sensor))
    }
}
