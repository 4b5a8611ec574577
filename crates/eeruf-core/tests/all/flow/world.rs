//! A simulated world in true time around a flow ring, and an operator that calls all operations of the ring.

use eeruf_core::{
    Instant, Micros, ReadingKind, Ring, RingEvent, Silence,
    flow::{Belief, BeliefSettings, FlowRing, InTurn, TurnSettings},
    plan::Plan,
};

use super::{BEGIN, CONFIG, DEFAULT};

/// A random generator, with the total change in ns that a path may have shown so far.
pub(super) struct Dice {
    pub(super) state: u64,
    pub(super) travel: u64,
}

impl Dice {
    pub(super) fn below(&mut self, limit: u32) -> u32 {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (((self.state >> 33) * u64::from(limit)) >> 31) as u32
    }
}

/// A ring of HC-SR04 modules in true time, which does not wrap.
pub(super) struct World<P = InTurn<24>, const E: usize = 1> {
    pub(super) ring: Ring<P, Belief<24, E>, 24, E, 3>,
    begin: u32,
    pub(super) now: u64,
    /// Edges to come: the time when the fallen line is seen, the sensor, and the earliest time of the edge.
    edges: Vec<(u64, u8, u64)>,
    /// Greatest width of the intervals within which edges are known to lie.
    pub(super) uncertain: u32,
    pub(super) dice: Dice,
    /// Greatest lateness of polls.
    pub(super) late: u32,
    pub(super) tick: u32,
    /// Greatest lateness of a step so far, as the ring reports it.
    pub(super) latest: u32,
    /// Firings: instant and sensor.
    pub(super) fired: Vec<(u64, u8)>,
    pub(super) operates: Option<Operates>,
}

/// An operator that calls all operations of a ring.
#[derive(Clone, Copy)]
pub(super) struct Operates {
    pub(super) speed_mm_s: u32,
    /// The top speed, if the speed varies from 0 to it.
    pub(super) top_mm_s: Option<u32>,
    /// Instant of the last report of speed, or the beginning.
    pub(super) told: u64,
    pub(super) asleep_until: u64,
    /// True while the ring is paused; pauses are short, since a paused ring hears nothing.
    pub(super) paused: bool,
}

#[derive(Default, Clone)]
pub(super) struct Seen {
    pub(super) fired: u32,
    pub(super) accepted: u32,
    pub(super) ambiguous: u32,
    /// Number of echoes that were compared with an earlier one.
    pub(super) compared: u32,
    /// Number of firings until the first reading was accepted.
    pub(super) first: Option<u32>,
}

impl World {
    pub(super) fn new(sensors: usize, seed: u32, late: u32, tick: u32, speed_mm_s: u16) -> Self {
        Self::believing(sensors, seed, late, tick, BeliefSettings { top_speed_mm_s: speed_mm_s, ..DEFAULT })
    }

    pub(super) fn believing(sensors: usize, seed: u32, late: u32, tick: u32, belief: BeliefSettings) -> Self {
        let mut turns = TurnSettings::new(seed);
        turns.dice = turns.dice.max(Micros::new(8 * tick));
        World::of(
            FlowRing::flow(sensors, turns, belief, CONFIG, Instant::from_micros(BEGIN)).unwrap(),
            seed,
            late,
            tick,
        )
    }
}

impl<P: Plan, const E: usize> World<P, E> {
    pub(super) fn of(ring: Ring<P, Belief<24, E>, 24, E, 3>, seed: u32, late: u32, tick: u32) -> Self {
        Self {
            ring,
            begin: BEGIN,
            now: 0,
            edges: vec![],
            uncertain: 0,
            dice: Dice { state: seed.into(), travel: 0 },
            late,
            tick,
            latest: 0,
            fired: vec![],
            operates: None,
        }
    }

    pub(super) fn instant(&self, true_time: u64) -> Instant {
        Instant::from_micros(self.begin.wrapping_add(true_time as u32))
    }

    /// Moves the path by at most the change allowed up to an instant.
    fn travel(&mut self, until: u64) {
        if let Some(of) = &mut self.operates {
            // By twice the speed over that of the slowest sound, 331 m/s.
            self.dice.travel += u64::from(of.speed_mm_s) * 2 * until.saturating_sub(of.told) * 1000 / 331_000;
            of.told = of.told.max(until);
        }
    }

    /// Performs a random operation on the ring.
    fn operate(&mut self) {
        self.travel(self.now);
        let Some(mut of) = self.operates else { return };
        let sensors = self.ring.sensors() as u32;
        let (sensor, now) = (self.dice.below(sensors) as u8, self.instant(self.now));
        if of.paused && self.dice.below(4) == 0 {
            of.paused = false;
            self.ring.resume();
        }
        match self.dice.below(300) {
            0 => {
                of.paused = true;
                self.ring.pause();
            }
            1 => self.ring.resume(),
            4 => self.ring.disable(sensor).unwrap(),
            5..=7 => (0..sensors as u8).for_each(|sensor| self.ring.enable(sensor).unwrap()),
            8 => self.ring.forget(sensor).unwrap(),
            9 => self.ring.restart(now),
            10 => {
                // The clock jumps.
                self.begin = self.begin.wrapping_add(self.dice.below(1 << 30));
                let now = self.instant(self.now);
                self.ring.restart(now);
            }
            11 => of.asleep_until = self.now + u64::from(self.dice.below(300_000)),
            12 => {
                let which = self.dice.below(3) as usize;
                self.ring.set_silence([Silence::NeverFree, Silence::NeedsAnswer, Silence::Trusted][which]);
            }
            13 => self.ring.set_report_after(Micros::new(self.dice.below(60_000))).unwrap(),
            14 => self.ring.set_window(Micros::new(20_000 + self.dice.below(5_001))).unwrap(),
            15 => self.ring.set_blanking(Micros::new(self.dice.below(2_000))).unwrap(),
            // No less than the limits of the path.
            16 => self.ring.set_audible(Micros::new(33_500 + self.dice.below(20_000))).unwrap(),
            17 => self.ring.set_path_change(Micros::new(150 + self.dice.below(300))).unwrap(),
            18 => assert!(self.ring.upcoming().count() <= self.ring.sensors()),
            19..=38 => {
                if let Some(top) = of.top_mm_s {
                    of.speed_mm_s = [0, 3 * top / 10, top][self.dice.below(3) as usize];
                    self.ring.moving(of.speed_mm_s, 0, now);
                }
            }
            _ => {}
        }
        self.operates = Some(of);
    }

    /// Reports an edge by one of the ring's methods.
    fn hear(&mut self, sensor: u8, earliest: u64, latest: u64) {
        let [first, last] = [earliest, latest].map(|at| self.instant(at));
        let settled = last + Micros::new(self.dice.below(400));
        let fired = self.ring.last_firing(sensor).unwrap();
        let since = |at: Instant| at.has_reached(fired).then(|| at.since(fired));
        let way = if self.operates.is_some() { self.dice.below(8) } else { 7 };
        match (way, since(first), since(last)) {
            (0, ..) => self.ring.echo_within(sensor, first, last.since(first), settled).unwrap(),
            (1, Some(least), Some(most)) => self.ring.measured_between(sensor, least, most).unwrap(),
            (2, _, Some(t_echo)) if first == last => self.ring.measured(sensor, Some(t_echo)).unwrap(),
            (3, ..) if first == last => self.ring.echo_until(sensor, last, settled).unwrap(),
            (4, ..) if E == 1 => {
                // A disturbance, taken back.
                self.ring.echo_between(sensor, first, last).unwrap();
                self.ring.unheard(sensor).unwrap();
                self.ring.echo_between(sensor, first, last).unwrap();
            }
            _ => self.ring.echo_between(sensor, first, last).unwrap(),
        }
    }

    /// Reports the state of a sensor that fired.
    fn report(&mut self, sensor: u8) {
        match self.dice.below(64) {
            0 => self.ring.stuck(sensor).unwrap(),
            1 => self.ring.unanswered(sensor).unwrap(),
            2 => self.ring.measured(sensor, None).unwrap(),
            3..20 => self.ring.answered(sensor).unwrap(),
            _ => {}
        }
    }

    /// Fires a sensor a little sooner or later than asked, tells the ring, and returns the instant.
    fn fire(&mut self, sensor: u8) -> u64 {
        if self.operates.is_none() {
            return self.now;
        }
        let at = match self.dice.below(8) {
            0 => self.now + u64::from(self.dice.below(900)),
            1 => self.now - u64::from(self.dice.below(300)).min(self.now),
            _ => self.now,
        };
        self.travel(at);
        if at == self.now {
            return at;
        }
        let told = self.instant(at);
        self.ring.fired(sensor, told).unwrap();
        at
    }

    /// Runs until an instant; `sound` gives the times after a firing at which lines fall, and their sensors.
    pub(super) fn run(
        &mut self,
        until: u64,
        seen: &mut [Seen],
        mut sound: impl FnMut(u64, u8, &mut Dice) -> Vec<(u64, u8)>,
    ) {
        while self.now < until {
            let ahead = u64::from(self.ring.next_deadline().since(self.instant(self.now)).as_micros());
            let ahead = if ahead > 1 << 30 { 0 } else { ahead };
            let late = u64::from(self.dice.below(self.late + 1));
            let tick = u64::from(self.tick);
            let asleep_until = self.operates.map_or(0, |of| of.asleep_until);
            let wakes = (self.now + ahead + late).next_multiple_of(tick).max(asleep_until);
            self.edges.sort_unstable();
            let edge = self.edges.first().map(|edge| edge.0).filter(|&at| at <= wakes);
            self.now = edge.unwrap_or(wakes).max(self.now);
            if let Some(at) = edge {
                let (_, sensor, earliest) = self.edges.remove(0);
                self.hear(sensor, earliest, at);
                // The loop is late for the reading, too, or polls at once.
                if self.late > 0 || self.now < asleep_until {
                    continue;
                }
            }
            self.operate();
            let now = self.instant(self.now);
            // Flow knows no direction: its judge does not ask for this change.
            let change = self.operates.map_or(0, |of| of.speed_mm_s as i32 / 3);
            while let Some(event) = self.ring.poll_expecting(now, |_| change) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        seen[usize::from(sensor)].fired += 1;
                        let at = self.fire(sensor);
                        if self.operates.is_some() {
                            self.report(sensor);
                        }
                        self.fired.push((at, sensor));
                        for (edge, sensor) in sound(at, sensor, &mut self.dice) {
                            let width = self.dice.below(self.uncertain + 1);
                            // The edge lies anywhere in the interval, also at its ends.
                            let before = [0, width, self.dice.below(width + 1)][self.dice.below(3) as usize];
                            let earliest = edge - u64::from(before);
                            self.edges.push((earliest + u64::from(width), sensor, earliest));
                        }
                    }
                    RingEvent::Reading(reading) => {
                        let seen = &mut seen[usize::from(reading.sensor)];
                        seen.compared += u32::from(reading.t_echo.is_some() && reading.previous.is_some());
                        match reading.kind {
                            ReadingKind::Accepted => {
                                seen.accepted += 1;
                                if seen.fired > 0 {
                                    seen.first.get_or_insert(seen.fired);
                                }
                            }
                            ReadingKind::Ambiguous => seen.ambiguous += 1,
                            _ => {}
                        }
                    }
                    RingEvent::PeriodEnded(stats) => self.latest = self.latest.max(stats.max_late.as_micros()),
                }
            }
        }
    }
}
