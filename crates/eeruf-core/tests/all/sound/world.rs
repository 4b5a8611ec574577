//! A simulated world in true time around a ring: one path of sound to each sensor or a wall in front of it, a clock
//! that wraps and steps back, late polls, and every operation on a ring.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use eeruf_core::{
    Instant, Micros, Reading, ReadingKind, RingEvent, Schedule, ScheduledRing, Silence, VerifiedSchedule,
};

use super::model::{Compared, Model, Sound};
use crate::common::random::Random;

/// Room in the rings of these tests.
pub(super) const ROOM: usize = 24;
/// Largest step back of the clock between two readings that are compared.
pub(super) const STEPS: u32 = 12;

/// The sound that each sensor hears.
#[derive(Clone, Copy)]
pub(super) enum Heard {
    /// Sound of one emitter along one path of at least this many microseconds.
    Path { emitter: u8, least: u32 },
    /// The sensor's own wall after this many microseconds, give or take 15.
    Wall { t_echo: u32 },
}

/// The conditions of a run.
#[derive(Clone, Copy)]
pub(super) struct Course {
    /// Greatest lateness of polls in microseconds; every 64th is up to eight times as late.
    pub(super) late: u32,
    /// Microseconds that pass at each event.
    pub(super) handling: u32,
    /// One of this many events is followed by a random operation on the ring; 0 for never.
    pub(super) operations: u32,
    /// One of this many firings happens at another instant than its poll; 0 for never.
    pub(super) fired: u32,
    /// One of this many events is followed by a step back of the clock; 0 for never.
    pub(super) clock_steps: u32,
    /// The change of echoes that odometry expects, in microseconds a second, and its largest error.
    pub(super) expected: i64,
    pub(super) noise: u32,
    /// Greatest width, in microseconds, of the intervals within which edges are known to lie; one of 64 is up to 4 ms.
    pub(super) uncertain: u32,
}

impl Course {
    /// Polls on time, on a stationary robot.
    pub(super) const PUNCTUAL: Self =
        Self { late: 0, handling: 0, operations: 0, fired: 0, clock_steps: 0, expected: 0, noise: 0, uncertain: 0 };
}

/// Counts of the readings.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Count {
    /// Readings compared with the one before.
    pub(super) compared: u64,
    pub(super) accepted: u64,
    pub(super) ambiguous: u64,
    /// Readings that agree and that the model finds unexplained, and how many of these the ring accepted.
    pub(super) unexplained: u64,
    pub(super) unexplained_accepted: u64,
    /// Readings that the ring accepted and the model finds explained.
    pub(super) explained_accepted: u64,
}

pub(super) struct World<'s> {
    pub(super) ring: ScheduledRing<'s, ROOM>,
    heard: Vec<Heard>,
    course: Course,
    sound: Sound,
    random: Random,
    model: Model,
    now: u64,
    /// Time by which the ring's clock is behind true time.
    behind: u64,
    /// Edges to come: the time when each is seen, the receiver, and the earliest time of the edge. Steps of the clock
    /// since each sensor's second-to-last reading are at most [`STEPS`].
    arrivals: BinaryHeap<Reverse<(u64, u8, u64)>>,
    /// Firings whose true instant is reported later: the time of the report, the sensor, the instant.
    corrections: Vec<(u64, u8, u64)>,
    /// Echo time of each sensor's last reading, which a foreign path tries to match.
    last_echo: Vec<Option<u32>>,
    last_fired: Vec<u64>,
    /// The change that odometry expects of each sensor's reading.
    changes: Vec<i32>,
    stepped_at: u64,
    counts: Vec<Count>,
    initial: (Micros, Micros),
    schedules: &'s [VerifiedSchedule<ROOM>],
    unverified: &'s Schedule<ROOM>,
}

impl<'s> World<'s> {
    pub(super) fn new(
        ring: ScheduledRing<'s, ROOM>,
        start: u64,
        heard: Vec<Heard>,
        course: Course,
        sound: Sound,
        seed: u64,
        schedules: &'s [VerifiedSchedule<ROOM>],
    ) -> Self {
        let sensors = ring.sensors();
        let initial = (ring.t_delta(), ring.window());
        let unverified = ring.schedule();
        Self {
            ring,
            heard,
            course,
            sound,
            random: Random(seed),
            model: Model::new(sensors),
            now: start,
            behind: 0,
            arrivals: BinaryHeap::new(),
            corrections: vec![],
            last_echo: vec![None; sensors],
            last_fired: vec![0; sensors],
            changes: vec![0; sensors],
            stepped_at: start,
            counts: vec![Count::default(); sensors],
            initial,
            schedules,
            unverified,
        }
    }

    fn clock(&self, true_time: u64) -> Instant {
        Instant::from_wide(true_time - self.behind)
    }

    fn one_in(&mut self, many: u32) -> bool {
        many > 0 && self.random.up_to(many - 1) == 0
    }

    /// Runs until this many readings were compared; returns the counts of each sensor.
    pub(super) fn run(mut self, compared: u64) -> Vec<Count> {
        let mut events = 0_u64;
        while self.counts.iter().map(|count| count.compared).sum::<u64>() < compared && events < 40 * compared + 1000 {
            events += 1;
            self.step();
        }
        self.counts
    }

    fn step(&mut self) {
        let ahead = self.ring.next_deadline().since(self.clock(self.now)).as_micros();
        if ahead <= u32::MAX / 2 {
            self.now += u64::from(ahead);
        }
        let late = if self.one_in(64) { 8 * self.course.late } else { self.course.late };
        self.now += u64::from(self.random.up_to(late));
        let now = self.now;
        self.tell_corrections(|at, _| at <= now);
        self.deliver();
        match self.ring.poll_expecting(self.clock(self.now), |sensor| self.changes[usize::from(sensor)]) {
            Some(RingEvent::Fire { sensor, .. }) => self.fire(sensor),
            Some(RingEvent::Reading(reading)) => self.read(&reading),
            Some(RingEvent::PeriodEnded(_)) | None => {}
        }
        self.now += u64::from(self.course.handling);
        if self.one_in(self.course.clock_steps) && self.now - self.stepped_at > 1_000_000 {
            self.behind += 1 + u64::from(self.random.up_to(STEPS - 1));
            self.stepped_at = self.now;
        }
        if self.one_in(self.course.operations) {
            self.operate();
        }
    }

    /// Reports the edges that have come by now.
    fn deliver(&mut self) {
        while let Some(&Reverse((latest, receiver, earliest))) = self.arrivals.peek() {
            if latest > self.now {
                break;
            }
            self.arrivals.pop();
            // A driver may or may not know when a sensor fired before it reports an edge of it.
            if self.random.up_to(1) == 0 {
                self.tell_corrections(|_, sensor| sensor == receiver);
            }
            self.hear(receiver, earliest, latest);
        }
    }

    /// Reports an edge by one of the ring's methods.
    fn hear(&mut self, receiver: u8, earliest: u64, latest: u64) {
        let [first, last] = [earliest, latest].map(|at| self.clock(at));
        let fired = self.ring.last_firing(receiver).unwrap();
        let since = |at: Instant| at.has_reached(fired).then(|| at.since(fired));
        let way = if self.course.operations > 0 { self.random.up_to(8) } else { 8 };
        let settled = last + Micros::new(self.random.up_to(400));
        match (way, since(first), since(last)) {
            (0, ..) => self.ring.echo_within(receiver, first, last.since(first), settled).unwrap(),
            (1, Some(least), Some(most)) => self.ring.measured_between(receiver, least, most).unwrap(),
            (2, _, Some(t_echo)) if first == last => self.ring.measured(receiver, Some(t_echo)).unwrap(),
            (3, ..) if first == last => self.ring.echo_until(receiver, last, settled).unwrap(),
            (4, ..) => {
                // A disturbance, taken back.
                self.ring.echo(receiver, last).unwrap();
                self.ring.unheard(receiver).unwrap();
                self.ring.echo_between(receiver, first, last).unwrap();
            }
            (5, ..) if first == last => self.ring.echo(receiver, last).unwrap(),
            _ => self.ring.echo_between(receiver, first, last).unwrap(),
        }
    }

    /// A random interval within which an edge is known to lie: its length, and the time from its beginning to the edge.
    fn interval(&mut self) -> (u64, u64) {
        let most = self.course.uncertain;
        if most == 0 {
            return (0, 0);
        }
        let most = if self.one_in(64) { 4_000 } else { most };
        let width = self.random.up_to(most);
        // Also at the ends of the interval.
        let edge = match self.random.up_to(3) {
            0 => 0,
            1 => width,
            _ => self.random.up_to(width),
        };
        (width.into(), edge.into())
    }

    fn tell_corrections(&mut self, is_due: impl Fn(u64, u8) -> bool) {
        let (due, later): (Vec<_>, Vec<_>) =
            self.corrections.iter().copied().partition(|&(at, sensor, _)| is_due(at, sensor));
        self.corrections = later;
        for (_, sensor, at) in due {
            self.ring.fired(sensor, self.clock(at)).unwrap();
        }
    }

    fn fire(&mut self, sensor: u8) {
        let mut at = self.now;
        if self.one_in(self.course.fired) {
            // A timer fired before the poll, or a circuit delayed the firing.
            let before = u64::from(self.random.up_to(400));
            let later = u64::from(self.random.up_to(1500));
            let earliest = self.last_fired[usize::from(sensor)] + 1000;
            let early = self.random.up_to(1) == 0 && self.now - before > earliest;
            at = if early { self.now - before } else { self.now + later };
            // Known at once, or only just before its sound can be in a reading.
            let known_at = if self.random.up_to(1) == 0 { self.now } else { self.now.max(at + 250) };
            self.corrections.push((known_at, sensor, at));
            let now = self.now;
            self.tell_corrections(|at, _| at <= now);
        }
        let since = at - self.last_fired[usize::from(sensor)].min(at);
        let noise = self.random.up_to(2 * self.course.noise) as i32 - self.course.noise as i32;
        self.changes[usize::from(sensor)] = (self.course.expected * since as i64 / 1_000_000) as i32 + noise;
        self.last_fired[usize::from(sensor)] = at;
        self.model.fired(sensor, at);
        for receiver in 0..self.heard.len() {
            match self.heard[receiver] {
                Heard::Wall { t_echo } if receiver == usize::from(sensor) => {
                    let heard = at + u64::from(t_echo - 15 + self.random.up_to(30));
                    self.arrivals.push(Reverse((heard, receiver as u8, heard)));
                }
                Heard::Path { emitter, least } if emitter == sensor => {
                    let (width, edge) = self.interval();
                    let off = edge as i64 - width as i64 / 2;
                    let earliest = at + u64::from(self.length(receiver, least, at, off)) - edge;
                    self.arrivals.push(Reverse((earliest + width, receiver as u8, earliest)));
                }
                Heard::Wall { .. } | Heard::Path { .. } => {}
            }
        }
    }

    /// Draws a path's length within its allowed rate of change: if possible, it repeats the receiver's last reading or
    /// shows the change that odometry expects. The middle of the interval is `off` before the edge.
    fn length(&mut self, receiver: usize, least: u32, at: u64, off: i64) -> u32 {
        // A step of the clock between the two sounds changes what the ring sees of it as well.
        let steps = if self.course.clock_steps > 0 { STEPS } else { 0 };
        let most = self.sound.path_change as u32 - steps;
        let drawn = least + self.random.up_to(most);
        let Some(last) = self.last_echo[receiver] else { return drawn };
        let expected = (self.last_fired[receiver] + u64::from(last)).checked_add_signed(self.changes[receiver].into());
        let wanted = expected.and_then(|expected| expected.checked_add_signed(off)?.checked_sub(at));
        match wanted {
            Some(wanted) if self.random.up_to(7) > 0 => (wanted.min(u64::from(least + most)) as u32).max(least),
            _ => drawn,
        }
    }

    fn read(&mut self, reading: &Reading) {
        let y = usize::from(reading.sensor);
        if reading.kind == ReadingKind::Late {
            return;
        }
        let count = &mut self.counts[y];
        if reading.kind == ReadingKind::First {
            // The ring has forgotten everything before.
            self.model.forget(reading.sensor);
        }
        let seen = self.model.read(reading, self.sound, self.changes[y]);
        let accepted = reading.kind == ReadingKind::Accepted;
        count.compared += u64::from(reading.previous.is_some() && reading.t_echo.is_some());
        count.accepted += u64::from(accepted);
        count.ambiguous += u64::from(reading.kind == ReadingKind::Ambiguous);
        match seen {
            Some(Compared::Explained) => count.explained_accepted += u64::from(accepted),
            Some(Compared::Unexplained) => {
                count.unexplained += 1;
                count.unexplained_accepted += u64::from(accepted);
            }
            None => assert!(!accepted, "{reading:?} does not agree with what was read before"),
        }
        self.last_echo[y] = reading.t_echo.map(Micros::as_micros);
    }

    /// Performs a random operation on the ring.
    fn operate(&mut self) {
        let sensors = self.heard.len() as u32;
        let sensor = self.random.up_to(sensors - 1) as u8;
        let now = self.clock(self.now);
        let (t_delta, window) = self.initial;
        match self.random.up_to(21) {
            0 => self.ring.pause(),
            1 | 2 => self.ring.resume(),
            3 => self.ring.disable(sensor).unwrap(),
            4 => self.ring.enable(sensor).unwrap(),
            5 => {
                // Soon after a pause, and after disabling, while windows are open.
                self.ring.pause();
                self.ring.resume();
            }
            6 => {
                self.ring.disable(sensor).unwrap();
                self.ring.enable(sensor).unwrap();
            }
            7 => {
                self.ring.restart(now);
                (0..sensors as u8).for_each(|sensor| self.model.forget(sensor));
            }
            8 if !self.schedules.is_empty() => {
                // As an adaptation does.
                let which = self.random.up_to(self.schedules.len() as u32 - 1) as usize;
                let _ = self.ring.change_schedule(&self.schedules[which]);
            }
            8 => self.ring.change_to_unverified(self.unverified).unwrap(),
            9 => {
                let part = 1 + self.random.up_to(3);
                let _ = self.ring.set_t_delta(Micros::new(t_delta.as_micros() / part));
            }
            10 => {
                let part = 1 + self.random.up_to(3);
                let _ = self.ring.set_window(Micros::new(window.as_micros() / part));
            }
            11 => {
                let _ = self.ring.set_blanking(Micros::new(self.random.up_to(2000)));
            }
            12 => self.now += u64::from(self.random.up_to(300_000)),
            13 => self.ring.stuck(sensor).unwrap(),
            14 => {
                let which = self.random.up_to(2) as usize;
                self.ring.set_silence([Silence::NeverFree, Silence::NeedsAnswer, Silence::Trusted][which]);
            }
            15 => self.ring.answered(sensor).unwrap(),
            16 => self.ring.unanswered(sensor).unwrap(),
            17 => self.ring.measured(sensor, None).unwrap(),
            18 => {
                self.ring.forget(sensor).unwrap();
                self.model.forget(sensor);
            }
            19 => {
                let _ = self.ring.set_report_after(Micros::new(self.random.up_to(40_000)));
            }
            20 => {
                let more = Micros::new(self.sound.audible as u32 + self.random.up_to(20_000));
                self.ring.set_audible(more).unwrap();
                // The judge is told the expected change and ignores this.
                self.ring.moving(self.random.up_to(3_000), 0, now);
            }
            _ => {
                let more = Micros::new(self.sound.path_change as u32 + self.random.up_to(300));
                self.ring.set_path_change(more).unwrap();
            }
        }
        // A paused ring, or one whose sensors are all disabled, would hear nothing for ever.
        if self.random.up_to(3) == 0 {
            self.ring.resume();
            (0..sensors as u8).for_each(|sensor| self.ring.enable(sensor).unwrap());
        }
    }
}
