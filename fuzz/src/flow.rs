//! Rings that fire in turn, checked in true time against the promises of their documentation:
//!
//! - only enabled, rested sensors fire, after the least quiet and never during a pause; no call moves a deadline into
//!   the past, and no firing is late for a caller who polls on time;
//! - each firing gives one reading, from its own echoes and evidence: nothing is free space without a witness;
//! - two readings or votes that are believed are never explained by firings as one path of sound;
//! - counts increase one by one, and the ring never falls silent.

use arbitrary::Arbitrary;
use eeruf_core::{
    EachSensor, Micros, Reading, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Silence, Tally, Uneven,
    flow::{BeliefSettings, FlowRing, InTurn, TurnSettings, Votes},
    judge::{Explanation, Judge, MOfN},
    plan::{OwnLimits, Plan},
};

use crate::ring::{Echo, Lines, SENSORS, Step, explain, instant, time_of};

/// Random input.
#[derive(Arbitrary, Debug)]
pub struct Input {
    /// Reading of the clock at the start; large values make it wrap soon.
    pub start: u32,
    pub sensors: u8,
    pub turns: [u16; 4],
    pub seed: u32,
    pub times: [u16; 3],
    pub window: u16,
    pub blanking: u8,
    pub memory: u8,
    pub hold: u8,
    pub top_speed: u16,
    pub alone: bool,
    pub votes: u8,
    pub kind: Kind,
    pub steps: Vec<Step>,
}

/// The ring.
#[derive(Arbitrary, Debug)]
pub enum Kind {
    Plain,
    /// Rings with up to three echoes per firing.
    Echoes,
    /// Rings in which some sensors fire together and some share an echo line.
    Uneven {
        together: u8,
        line: u8,
        window: u16,
    },
    /// Rings that accept m of n readings.
    Votes {
        m: u8,
        n: u8,
    },
}

/// The rule by which a judge accepts readings.
#[derive(Clone, Copy)]
struct Believes {
    /// Number of readings that must agree.
    m: usize,
    n: usize,
    /// Largest difference between the belief and a reading that fits it; `None` for a judge without belief.
    near: Option<Micros>,
    /// True if the robot stands still and the ring knows it.
    stands: bool,
}

/// Performs all steps on the ring and the model.
pub fn check(input: &Input) {
    let us = |us: u16| Micros::new(us.into());
    // Mostly short, so that sensors hear each other, and in step.
    let [least, more, rest, dice] = input.turns;
    let least = us(100 + least % 8_192);
    let (most, rest) = (least.saturating_add(us(1_000 + more / 2)), us(1_000 + rest / 2));
    let dice = us(if dice % 1_024 < 512 { 0 } else { dice % 1_024 });
    let turns = TurnSettings { least, most, rest, dice, seed: input.seed.max(1) };
    let [t_delta, near, path_change] = input.times.map(|time| us(time % 1_024));
    let votes = [Votes::ByMotion, Votes::EveryEcho, Votes::TwoInARow][usize::from(input.votes % 3)];
    let (memory, hold, alone) = (input.memory, 1 + input.hold % 100, input.alone);
    let top_speed_mm_s = if input.top_speed % 2 == 0 { 0 } else { 10 + input.top_speed / 16 };
    let belief = BeliefSettings { t_delta, near, path_change, memory, hold, top_speed_mm_s, alone, votes };
    let (window, blanking) = (us(5_000 + input.window / 2), Micros::new(16 * u32::from(input.blanking)));
    let config = RingConfig::new().with_window(window).with_blanking(blanking);
    let sensors = 1 + usize::from(input.sensors) % SENSORS;
    let begin = (1 << 32) + u64::from(input.start);
    let now = instant(begin);
    let m = if votes == Votes::EveryEcho || (votes == Votes::ByMotion && alone) { 1 } else { 2 };
    let two = Believes { m, n: 2, near: Some(near), stands: top_speed_mm_s == 0 };
    match input.kind {
        Kind::Plain => {
            if let Ok(mut ring) = FlowRing::<SENSORS>::flow(sensors, turns, belief, config, now) {
                assert_eq!(ring.set_seed(!input.seed).is_ok(), input.seed != u32::MAX);
                Model::new(ring, begin, &turns, two).run(&input.steps);
            }
        }
        Kind::Echoes => {
            if let Ok(ring) = FlowRing::<SENSORS, 3>::flow(sensors, turns, belief, config, now) {
                Model::new(ring, begin, &turns, two).run(&input.steps);
            }
        }
        Kind::Uneven { together, line, window: own } => {
            let mask = (1 << sensors) - 1;
            let [together, lines] = [together, line].map(|set| [u64::from(set) & mask]);
            let windows: Vec<_> = (0..sensors).map(|x| if x % 2 == 0 { window } else { us(own) }).collect();
            let is_set = |set: &[u64; 1]| set[0].count_ones() > 1;
            let uneven = Uneven {
                together: if is_set(&together) { &together } else { &[] },
                shared_lines: if is_set(&lines) { &lines } else { &[] },
                window: &windows,
                ..Uneven::NONE
            };
            let requirements = Requirements { window, uneven: Some(uneven), ..Requirements::new(t_delta) };
            let Ok(limits) = TurnSettings::limits::<SENSORS>(sensors, &requirements) else { return };
            let ring =
                FlowRing::<SENSORS, 1, EachSensor<SENSORS>>::with_limits(sensors, limits, turns, belief, config, now);
            if let Ok(ring) = ring {
                Model::new(ring, begin, &turns, two).run(&input.steps);
            }
        }
        Kind::Votes { m, n } => {
            let (plan, judge) = (InTurn::<SENSORS>::new(sensors, turns, window, now), MOfN::new(m, n, t_delta));
            let (Ok(plan), Ok(judge)) = (plan, judge.map(|judge| judge.with_top_speed(top_speed_mm_s))) else { return };
            let config = config.with_path_change(path_change);
            let of = Believes { m: m.into(), n: n.into(), near: None, ..two };
            if let Ok(ring) = Ring::<_, MOfN<SENSORS, 5>, SENSORS, 1, 7>::judged_by(plan, judge, config, now) {
                Model::new(ring, begin, &turns, of).run(&input.steps);
            }
        }
    }
}

/// A reading: the time of its firing, its echoes, and their possible error.
#[derive(Clone, Debug)]
struct Heard {
    fired: u64,
    echoes: Vec<u32>,
    off: u32,
}

/// A ring, with true time in 64 bits; the ring itself sees a counter that wraps.
struct Model<U, J, const E: usize, const H: usize> {
    ring: Ring<InTurn<SENSORS, U>, J, SENSORS, E, H>,
    lines: Lines,
    begin: u64,
    least: u64,
    most: u64,
    rest: u64,
    believes: Believes,
    paused: bool,
    enabled: [bool; SENSORS],
    /// The readings of each sensor, newest last.
    heard: [Vec<Heard>; SENSORS],
    /// The last firing, its sensor and its time; and the time of the ring's restart.
    last: Option<(usize, u64)>,
    restarted: u64,
    period: u32,
    /// Time of the last poll; everything due by then is done.
    polled: u64,
}

impl<U: OwnLimits, J: Judge, const E: usize, const H: usize> Model<U, J, E, H> {
    fn new(
        ring: Ring<InTurn<SENSORS, U>, J, SENSORS, E, H>,
        now: u64,
        turns: &TurnSettings,
        believes: Believes,
    ) -> Self {
        let [least, most, rest] = [turns.least, turns.most, turns.rest].map(|us| u64::from(us.as_micros()));
        Self {
            ring,
            lines: Lines::new(now, Silence::NeverFree),
            begin: now,
            least,
            most,
            rest,
            believes,
            paused: false,
            enabled: [true; SENSORS],
            heard: Default::default(),
            last: None,
            restarted: 0,
            period: 0,
            polled: now,
        }
    }

    fn run(mut self, steps: &[Step]) {
        self.drain();
        for step in steps.iter().take(400) {
            if self.act(step) {
                self.drain();
            } else {
                let due = time_of(self.ring.plan().deadline(), self.lines.now);
                assert!(due >= self.lines.now, "{step:?} leaves {due} due at {}", self.lines.now);
            }
        }
    }

    /// Performs a step. Returns true if the ring must be polled after it.
    fn act(&mut self, step: &Step) -> bool {
        let count = self.ring.sensors() as u8;
        if let Step::Measured { sensor, t_echo, width } = *step
            && let Some((_, fired, least)) = self.lines.echo_of(&self.ring, sensor, t_echo)
        {
            self.wait(fired + least + u64::from(width));
        }
        let (now, at) = (self.lines.now, instant(self.lines.now));
        if self.lines.hand_in(&mut self.ring, step) {
            self.believes.stands &= !matches!(step, Step::Moving(speed) if *speed > 0);
            return false;
        }
        let known = |sensor: u8| sensor < count;
        match *step {
            Step::Sleep { late } => {
                self.lines.now = time_of(self.ring.next_deadline(), now).max(now) + u64::from(late.unwrap_or(0));
                return true;
            }
            Step::Pass(units) => {
                self.lines.now += 64 * u64::from(units);
                return true;
            }
            Step::PassLong(units) if now - self.begin < 1 << 29 => {
                self.lines.now += u64::from(units) << 20;
                return true;
            }
            Step::Forget(sensor) => assert_eq!(self.ring.forget(sensor).is_ok(), known(sensor)),
            Step::Disable(sensor) | Step::Enable(sensor) => {
                let enables = matches!(step, Step::Enable(_));
                let done = if enables { self.ring.enable(sensor) } else { self.ring.disable(sensor) };
                assert_eq!(done.is_ok(), known(sensor));
                if known(sensor) {
                    self.enabled[usize::from(sensor)] = enables;
                }
            }
            Step::ReportAfter(us) => {
                let _ = self.ring.set_report_after(Micros::new(us.into()));
                return true;
            }
            Step::Window(us) => {
                let _ = self.ring.set_window(Micros::new(us.into()));
                return true;
            }
            Step::Blanking(units) => {
                let _ = self.ring.set_blanking(Micros::new(16 * u32::from(units)));
            }
            Step::Restart => {
                self.ring.restart(at);
                (self.last, self.restarted) = (None, now);
                self.lines.drop_firings();
            }
            Step::Pause | Step::Resume => {
                self.paused = matches!(step, Step::Pause);
                if self.paused { self.ring.pause() } else { self.ring.resume() }
            }
            Step::Fired(by) => self.fired(by),
            // Steps for tables or filters only.
            _ => {}
        }
        false
    }

    /// Reports the true time of the last firing, if its poll was just now and no echo has come yet.
    fn fired(&mut self, by: u8) {
        let Some((x, at)) = self.last.filter(|&(x, at)| at == self.lines.now && self.lines.sensors[x].is_silent())
        else {
            return;
        };
        let true_time = if by % 2 == 0 { at - u64::from(by) } else { at + u64::from(by) };
        self.lines.now = self.lines.now.max(true_time);
        self.ring.fired(x as u8, instant(true_time)).expect("a sensor that there is");
        self.last = Some((x, true_time));
        if let Some(open) = &mut self.lines.sensors[x].open {
            open.at = true_time;
        }
        self.lines.sensors[x].fired.pop();
        self.lines.sensors[x].fired.push(true_time);
        self.polled = self.lines.now;
    }

    /// Polls at each deadline until this time.
    fn wait(&mut self, until: u64) {
        while self.lines.now < until {
            self.lines.now = time_of(self.ring.next_deadline(), self.lines.now).clamp(self.lines.now, until);
            self.drain();
        }
    }

    /// Polls until nothing is left to do or to report.
    fn drain(&mut self) {
        let at = instant(self.lines.now);
        for turn in 0.. {
            assert!(turn < 1000, "the ring never comes to rest");
            let plan = self.ring.plan();
            assert!(plan.deadline().since(at) <= plan.horizon() || at.has_reached(plan.deadline()), "too far ahead");
            assert!(self.ring.upcoming().all(|next| self.enabled[usize::from(next.sensor)]));
            let believed = self.ring.plan().sensors() as u8;
            let believed: Vec<_> = (0..believed).map(|x| self.ring.judge().believed(x)).collect();
            let Some(event) = self.ring.poll(at) else { break };
            match event {
                RingEvent::Fire { sensor, due, .. } => {
                    let due = time_of(due, self.lines.now);
                    assert!(due >= self.polled, "due at {due}, not done at {}", self.polled);
                    self.fire(sensor.into());
                }
                RingEvent::Reading(reading) => self.read(&reading, believed[usize::from(reading.sensor)]),
                RingEvent::PeriodEnded(stats) => {
                    assert_eq!((stats.period, stats.tally), (self.period, self.lines.tally));
                    assert!(u64::from(stats.max_late.as_micros()) <= self.lines.now - self.begin);
                    (self.period, self.lines.tally) = (self.period + 1, Tally::default());
                }
            }
        }
        self.polled = self.lines.now;
        assert!(
            time_of(self.ring.next_deadline(), self.lines.now) > self.lines.now,
            "a deadline in the past, and nothing to do"
        );
        let listens = self.ring.report_after();
        for (x, sensor) in self.lines.sensors.iter().enumerate().take(self.ring.sensors()) {
            assert_eq!(self.ring.is_enabled(x as u8), self.enabled[x]);
            assert!(sensor.late.is_none() || self.lines.now < self.lines.settled, "sensor {x} has a late edge to tell");
            if let Some(open) = &sensor.open {
                assert!(
                    E > 1 || !open.is_ready() || self.lines.now < self.lines.settled,
                    "sensor {x} has an echo to tell"
                );
                let closes = open.at + u64::from(self.ring.window_of(x as u8).max(listens).as_micros());
                assert!(self.lines.now < closes.max(self.lines.settled), "the window of sensor {x} has closed");
            }
        }
    }

    fn fire(&mut self, x: usize) {
        assert!(x < self.ring.sensors() && self.enabled[x] && !self.paused, "sensor {x} is not to fire");
        let hears = |y: usize| self.ring.plan().hears(x as u8, y as u8);
        if let Some((y, at)) = self.last {
            // Sensors that fire together do not hear each other.
            assert!(
                self.lines.now >= at + self.least || !hears(y),
                "sensors {y} and {x} {} us apart",
                self.lines.now - at
            );
        }
        let since = self.lines.sensors[x].fired.last().map_or(u64::MAX, |&at| self.lines.now - at);
        assert!(since >= self.rest, "sensor {x} again after {since} us");
        assert!(
            self.restarted == 0 || self.lines.now >= self.restarted + self.most,
            "sound from before the restart is heard"
        );
        self.lines.sensors[x].fire(self.lines.now, 0, self.period, self.lines.silence);
        self.last = Some((x, self.lines.now));
    }

    fn read(&mut self, reading: &Reading, believed: Option<Micros>) {
        let x = usize::from(reading.sensor);
        self.lines.tally.count(reading.kind);
        let Some(open) = self.lines.sensors[x].open.take() else {
            let late = self.lines.sensors[x].late.take().expect("a late edge came in");
            self.lines.sensors[x].is_held = false;
            assert_eq!((reading.kind, reading.t_echo), (ReadingKind::Late, Some(Micros::new(late))));
            return;
        };
        assert_eq!(reading.period & 7, open.period & 7);
        let echoes = &open.echoes[..open.echoes.len().min(E)];
        let (unusable, kind) = (open.unusable(self.lines.silence), reading.kind);
        match (unusable, reading.t_echo) {
            (Some(ReadingKind::TooEarly), t_echo) => assert_eq!(t_echo.map(Micros::as_micros), open.early),
            (None, Some(t_echo)) => assert!(echoes.contains(&t_echo.as_micros()), "{reading:?} of {echoes:?}"),
            (_, t_echo) => assert!(t_echo.is_none() && (unusable.is_some() || echoes.is_empty()), "{reading:?}"),
        }
        let is_held = open.is_held(self.lines.silence);
        match unusable {
            Some(unusable) => assert_eq!(kind, unusable),
            None if echoes.is_empty() => {
                assert!(matches!(kind, ReadingKind::NoEcho | ReadingKind::Clear), "{reading:?}")
            }
            None => assert!(
                matches!(
                    kind,
                    ReadingKind::First
                        | ReadingKind::Accepted
                        | ReadingKind::Rejected
                        | ReadingKind::Repeated
                        | ReadingKind::Ambiguous
                ),
                "{reading:?}"
            ),
        }
        let off = if open.off > 300 { 0 } else { 2 * open.off };
        let heard = Heard { fired: open.at, echoes: if unusable.is_none() { echoes.to_vec() } else { vec![] }, off };
        if let Some(t_echo) = reading.t_echo.filter(|_| unusable.is_none()) {
            self.believe(reading, t_echo.as_micros(), &heard, believed);
        }
        self.heard[x].push(heard);
        let sensor = &mut self.lines.sensors[x];
        (sensor.is_held, sensor.emitted) = (is_held, Some(open));
    }

    /// Checks a belief in earlier readings against all firings.
    fn believe(&self, reading: &Reading, t_echo: u32, now: &Heard, believed: Option<Micros>) {
        let (y, of) = (usize::from(reading.sensor), self.believes);
        let fits = match (of.near, believed) {
            (Some(near), Some(believed)) => !of.stands || believed.as_micros().abs_diff(t_echo) <= near.as_micros(),
            _ => false,
        };
        let [audible, change, t_delta] =
            [self.ring.audible(), self.ring.path_change_of(y as u8), self.ring.t_delta_of(y as u8)]
                .map(|us| u64::from(us.as_micros()));
        let explained = |x: usize, before: &Heard, echo: u32, slack: u64| {
            let pair =
                [(before, echo), (now, t_echo)].map(|(of, t_echo)| Echo { fired: of.fired, t_echo, off: of.off });
            self.ring.plan().hears(y as u8, x as u8)
                && explain(&self.lines.sensors[x].fired, x == y, pair, audible + slack, change + slack)
        };
        let emitters = 0..self.ring.sensors();
        let before = self.heard[y].iter().rev().take(of.n - 1);
        match (reading.kind, reading.explained_by) {
            (ReadingKind::Accepted, None) if of.m > 1 && !fits => {
                let votes = before.filter(|before| {
                    before.echoes.iter().any(|&echo| {
                        let agrees = !of.stands || u64::from(echo.abs_diff(t_echo)) <= t_delta;
                        agrees && !emitters.clone().any(|x| explained(x, before, echo, 0))
                    })
                });
                let votes = 1 + votes.count();
                assert!(votes >= of.m, "{reading:?} has {votes} votes, believed {believed:?}: {:?}", self.heard[y]);
            }
            (ReadingKind::Ambiguous, Some(Explanation::Sensor(x))) if of.stands => {
                let mut all =
                    self.heard[y].iter().rev().take(of.n - 1).flat_map(|of| of.echoes.iter().map(move |&e| (of, e)));
                let by_any = now.echoes.iter().any(|&t_echo| t_echo > 0)
                    && all.any(|(of, echo)| explained(x.into(), of, echo, 700));
                assert!(by_any || E > 1, "{reading:?} is not explained: {:?}", self.heard[y]);
            }
            (kind, by) => assert!(kind == ReadingKind::Ambiguous || by.is_none(), "{reading:?}"),
        }
    }
}
