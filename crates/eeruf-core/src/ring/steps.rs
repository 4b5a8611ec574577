//! The steps that a poll of a [`Ring`] takes when something is due: fire, emit a reading, end the period.

use super::history::{Firings, Pair, STEP_BACK, is_long_ago, long_before};
use super::listening::Listening;
use super::punctuality::PeriodLateness;
use super::sensor::{Ended, LISTENING, READY, Sensor, off_by};
use super::{NOBODY, PeriodStats, Reading, Ring, RingEvent};
use crate::filter::heard;
use crate::judging::{Explained, Heard, Judge, Sounds};
use crate::plan::Plan;
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::time::{Instant, Micros};

impl<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize> Ring<P, J, K, E, H> {
    /// Takes the step that is due. Firing comes first, since it should be on time; but a sensor's reading is emitted
    /// before the sensor fires again.
    #[inline]
    pub(super) fn advance(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let first = match self.fire_due(now) {
            Ok(fires) => return Some(fires),
            Err(first) => first,
        };
        match first.or_else(|| self.next_pending(now)) {
            Some(sensor) => {
                let due = self.plan.deadline();
                let reading = self.emit_reading(sensor, expected_change_us);
                self.brought_forward(due, now);
                reading
            }
            None => self.end_period(now),
        }
    }

    /// Fires the sensor that is due. `Err` if none is, with the sensor whose reading must be emitted before it fires.
    #[inline(always)]
    fn fire_due(&mut self, now: Instant) -> Result<RingEvent, Option<u8>> {
        let due = self.plan.deadline();
        let fires = if now.has_reached(due) { self.plan.next_firing() } else { None };
        let Some((sensor, phase)) = fires else { return Err(None) };
        if let Some(fired) = self.sensors.get_mut(usize::from(sensor)) {
            if fired.is(LISTENING | READY) {
                return Err(Some(sensor));
            }
            fired.fire(self.period, now, self.listening.unanswered());
            // At most 64 sensors, which did not listen.
            self.listening_now = self.listening_now.wrapping_add(1);
        }
        self.has_fired(sensor, now);
        self.plan.fire(now);
        // Last, since it is rare.
        let late = now.since(due);
        if late != Micros::ZERO {
            self.fired_late(late);
        }
        Ok(RingEvent::Fire { sensor, phase, due })
    }

    #[inline]
    fn has_fired(&mut self, sensor: u8, now: Instant) {
        if self.oldest == NOBODY {
            self.oldest = sensor;
            if self.ready == 0 {
                self.emit_at = now + self.closes_after(sensor);
            }
        } else if self.windows_differ() {
            self.find_first_to_close();
        }
    }

    #[inline(never)]
    fn fired_late(&mut self, late: Micros) {
        let late = u16::try_from(late.as_micros()).unwrap_or(u16::MAX);
        self.punctuality.note(late);
        if self.punctuality.add(late, self.listening.spare(self.plan.limits())) {
            self.disturb();
        }
    }

    /// Notes that firings no longer keep the verified timetable, or that the timetable changed.
    #[cold]
    #[inline(never)]
    pub(super) fn disturb(&mut self) {
        self.punctuality.disturb(self.listening.is_proven(&self.plan));
    }

    /// Notes at `now` that the next firing, due at `due`, may be due sooner.
    pub(super) fn brought_forward(&mut self, due: Instant, now: Instant) {
        self.plan.due_from(if now.has_reached(due) { due } else { now });
    }

    /// Ends the period, if that is due.
    #[inline(never)]
    fn end_period(&mut self, now: Instant) -> Option<RingEvent> {
        let due = self.plan.deadline();
        if !now.has_reached(due) {
            return None;
        }
        self.punctuality.note(u16::try_from(now.since(due).as_micros()).unwrap_or(u16::MAX));
        let differed = self.windows_differ();
        let (phase, changed) = self.plan.end_period(now);
        let PeriodLateness { latest, sum } = self.punctuality.end_period();
        if changed {
            self.disturb();
        }
        // At most 64 sensors.
        let sensors = self.plan.sensors();
        for (x, sensor) in (0..).zip(self.sensors.iter_mut().take(sensors)) {
            if sensor.expire(now) {
                // Its next reading cannot be compared: the instant of its previous firing is no longer known.
                self.judge.forget(x);
            }
        }
        if is_long_ago(self.known_from, now) {
            self.known_from = long_before(now);
        }
        if differed || self.windows_differ() {
            // Another schedule may allow other windows, also to firings in progress.
            self.find_first_to_close();
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

    /// A sensor with an echo, or one whose window has closed.
    fn next_pending(&self, now: Instant) -> Option<u8> {
        if self.ready > 0 {
            return self.first_ready();
        }
        (self.oldest != NOBODY && now.has_reached(self.emit_at)).then_some(self.oldest)
    }

    /// A sensor with a reading to emit. The oldest goes first: the next oldest must be searched for after it anyway, so
    /// this saves a search in the most expensive poll.
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

    /// Emits the reading of a sensor, which ends its firing.
    #[inline(never)]
    fn emit_reading(&mut self, sensor: u8, mut expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let own = self.sensors.get_mut(usize::from(sensor))?;
        let (fired, since_before) = (own.fired(), own.firings.since_before());
        let periods_ago = own.periods_ago(self.period);
        let (listened, was_ready) = (own.is(LISTENING), own.is(READY));
        if was_ready {
            // Counted when its edge came.
            self.ready = self.ready.wrapping_sub(1);
        }
        let mut firing = self.plan.last_firing(sensor, periods_ago);
        let Verdict { kind, t_echo, previous, age, explained_by } = if listened {
            let Ended { is_held, unusable, echoes, uncertain } = own.end(self.listening.unwitnessed());
            let mut ended_at = fired + self.closes_after(sensor);
            let echoes = heard(&echoes);
            if was_ready && unusable != Some(ReadingKind::Late) {
                ended_at = fired + echoes.first().copied().unwrap_or_default();
            }
            firing.expected_change_us = expected_change_us(sensor);
            let t_delta = self.listening.t_delta_of(&self.plan, sensor);
            let heard = Heard { sensor, fired, since_before, echoes, firing, t_delta };
            let mut verdict = match unusable {
                Some(kind) => self.judge.skip(&heard, kind),
                None if is_held => {
                    self.judge.hold(&heard);
                    let kind = if self.judge.is_clear(sensor) { ReadingKind::Clear } else { ReadingKind::NoEcho };
                    Verdict { age: self.judge.age(sensor), ..heard.unjudged(Some(kind)) }
                }
                None => {
                    let (sensors, plan, listening) = (&self.sensors, &self.plan, &self.listening);
                    // The proof is about two readings that differ by no more than `T_delta`, at times that are known.
                    let is_exact = firing.expected_change_us == 0 && uncertain[0] | uncertain[1] == 0;
                    let on_time = self.punctuality.is_on_time() && is_exact;
                    let known_from = self.known_from;
                    self.judge.judge(
                        &heard,
                        &Memory { receiver: sensor, uncertain, sensors, plan, listening, known_from, on_time },
                    )
                }
            };
            self.plan.judged(&heard, &verdict, &self.judge);
            if unusable == Some(ReadingKind::NoEcho) {
                // Whatever judge and plan make of silence without a witness, it is not reported as free space.
                verdict.kind = ReadingKind::NoEcho;
            }
            self.plan.ended(sensor, ended_at);
            self.listening_now = self.listening_now.wrapping_sub(1);
            if self.listening_now == 0 {
                self.oldest = NOBODY;
            } else if self.oldest == sensor {
                self.find_oldest(fired);
            }
            verdict
        } else {
            let (t_echo, is_held) = own.end_late();
            if is_held {
                self.judge_silence(sensor);
            }
            let age = self.judge.age(sensor);
            Verdict { kind: ReadingKind::Late, t_echo, previous: None, age, explained_by: None }
        };
        self.emit_when_oldest_ends();
        self.tally.count(kind);
        let period = self.period.wrapping_sub(periods_ago.into());
        let phase = firing.phase;
        Some(RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by }))
    }

    /// Sets the next emission to the end of the oldest window, if no reading can be emitted sooner.
    #[inline]
    pub(super) fn emit_when_oldest_ends(&mut self) {
        if self.ready == 0 && self.oldest != NOBODY {
            self.emit_at = self.closes(self.oldest);
        }
    }

    /// Finds the next oldest, now that the one that fired at `before` has stopped listening. All others fired later, or
    /// earlier by no more than the clock has stepped back; where windows differ, the oldest is the one whose window
    /// closes first.
    pub(super) fn find_oldest(&mut self, before: Instant) {
        if self.windows_differ() {
            self.find_first_to_close();
            return;
        }
        // So 1 us before does not count as 71 minutes after.
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

    /// Finds the sensor whose window closes first, if windows differ.
    pub(super) fn find_first_to_close(&mut self) {
        self.oldest = NOBODY;
        // At most 64 sensors.
        for x in 0..self.sensors() as u8 {
            let listens = self.sensor(x).is_some_and(|sensor| sensor.is(LISTENING));
            if listens && (self.oldest == NOBODY || !self.closes(x).has_reached(self.closes(self.oldest))) {
                self.oldest = x;
            }
        }
        self.emit_when_oldest_ends();
    }

    /// Time from a firing to its reading if there is no echo.
    #[inline]
    fn closes_after(&self, sensor: u8) -> Micros {
        self.window_of(sensor).max(self.report_after)
    }

    /// The time when a sensor's last firing ends if there is no echo.
    fn closes(&self, sensor: u8) -> Instant {
        let fired = self.sensor(sensor).map_or(Instant::default(), Sensor::fired);
        fired + self.closes_after(sensor)
    }

    fn sensor(&self, sensor: u8) -> Option<&Sensor<E, H>> {
        self.sensors.get(usize::from(sensor))
    }
}

/// Explanation by a firing that is not remembered.
const UNKNOWN: Explained = Explained::By(Explanation::History);

/// The remembered firings of all sensors, for the reading of one.
struct Memory<'r, P, const E: usize, const H: usize> {
    receiver: u8,
    /// Uncertainty of the receiver's echoes: of its last firing, of the previous one, and of all earlier ones.
    uncertain: [u8; 3],
    sensors: &'r [Sensor<E, H>],
    plan: &'r P,
    listening: &'r Listening,
    known_from: Instant,
    /// True if it is proven that nothing explains readings that agree.
    on_time: bool,
}

impl<P: Plan, const E: usize, const H: usize> Sounds for Memory<'_, P, E, H> {
    #[inline(always)]
    fn explain(&self, first: Micros, second: Micros) -> Explained {
        if self.on_time {
            return Explained::ByNothing;
        }
        // A copy, so that its fields need not be in memory before this call.
        Self { ..*self }.explain_pair(1, first, second, Micros::ZERO)
    }

    fn explain_after(&self, ago: u8, first: Micros, second: Micros, more: Micros) -> Explained {
        self.explain_pair(ago, first, second, more)
    }

    fn is_masked(&self, t_echo: Micros) -> bool {
        let receiver = self.receiver;
        let Some(own) = self.sensors.get(usize::from(receiver)) else { return false };
        let (heard, audible) = (own.fired() + t_echo, self.listening.audible());
        let is_heard = |(x, sensor): (u8, &Sensor<E, H>)| {
            x != receiver && self.plan.hears(receiver, x) && sensor.firings.is_heard_at(heard, audible, 0)
        };
        // At most 64 sensors.
        own.firings.is_heard_at(heard, audible, 1) || (0..).zip(self.emitters()).any(is_heard)
    }
}

impl<P: Plan, const E: usize, const H: usize> Memory<'_, P, E, H> {
    #[inline(never)]
    fn explain_pair(&self, ago: u8, first: Micros, second: Micros, more: Micros) -> Explained {
        let (receiver, [one, before, earlier]) = (self.receiver, off_by(self.uncertain));
        let other = if ago == 1 { before } else { earlier };
        let own = self.sensors.get(usize::from(receiver));
        let Some([Some(fired), Some(fired_before)]) = own.map(|own| own.firings.last_and(ago)) else { return UNKNOWN };
        let mut pair = self.pair([fired_before + first, fired + second]).widened(one, other, one.max(other));
        pair.path_change = pair.path_change.saturating_add(more);
        self.ask(&pair, |firings, own| pair.explains(firings, own.then_some(ago)))
    }

    fn pair(&self, heard: [Instant; 2]) -> Pair {
        let path_change = self.listening.path_change_of(self.plan, self.receiver);
        Pair { heard, audible: self.listening.audible(), path_change }
    }

    fn emitters(&self) -> &[Sensor<E, H>] {
        self.sensors.get(..self.plan.sensors()).unwrap_or(self.sensors)
    }

    /// Searches the firings of all sensors that the receiver can hear, itself included, for an explanation.
    #[inline(always)]
    fn ask(&self, pair: &Pair, explain: impl Fn(&Firings<H>, bool) -> bool) -> Explained {
        let receiver = self.receiver;
        let sensors = self.emitters();
        // At most 64 sensors.
        for (x, sensor) in (0..).zip(sensors) {
            if self.plan.hears(receiver, x) && explain(&sensor.firings, x == receiver) {
                return Explained::By(Explanation::Sensor(x));
            }
        }
        let mut forgotten = pair.is_audible_from(self.known_from);
        for (x, sensor) in (0..).zip(sensors) {
            forgotten |= self.plan.hears(receiver, x) && pair.is_audible_from(sensor.firings.oldest());
        }
        if forgotten { UNKNOWN } else { Explained::ByNothing }
    }
}
