//! Events that the ring may emit, derived from its inputs.

use eeruf_core::{
    Instant, Micros, PeriodStats, Phase, Reading, ReadingKind, Ring, Schedule, SensorError, Silence, Tally,
    judge::{Explanation, Judge},
    plan::Plan,
};

use super::{SENSORS, Step};

/// True if a restart keeps the intervals between different sensors too.
const RESTARTS_KEEP_INTERVALS: bool = true;

/// Largest error of the ring's time stamps, in microseconds.
const STAMPS: u64 = 64;

/// A reading that counts in comparisons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heard {
    /// The echo; `Some(None)` for silence, `None` if unknown.
    echo: Option<Option<u32>>,
    /// Time of the firing.
    fired: u64,
    t_delta: u32,
    /// True if foreign sound explains this reading and the previous one.
    ambiguous: bool,
    /// The change that odometry expects since the previous one.
    expected: i32,
    /// The possible error of the echo.
    off: u32,
}

impl Heard {
    fn agrees(&self, before: &Self) -> bool {
        match (before.echo, self.echo) {
            (Some(Some(s)), Some(Some(t))) => {
                (i64::from(t) - i64::from(s) - i64::from(self.expected)).unsigned_abs() <= self.t_delta.into()
            }
            (Some(None), Some(None)) => true,
            _ => false,
        }
    }
}

/// The driver's evidence on a firing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Evidence {
    Listened,
    Nothing,
    Held,
    Stuck,
}

/// A firing whose reading is not yet emitted.
#[derive(Clone, Debug)]
pub(crate) struct Open {
    pub(crate) at: u64,
    pub(crate) phase: u8,
    pub(crate) period: u32,
    /// The edges within the window, earliest first, and the first one within the blanking time.
    pub(crate) echoes: Vec<u32>,
    pub(crate) early: Option<u32>,
    pub(crate) evidence: Evidence,
    /// The possible error of the echoes, in units of 2 us; [`WIDE`] if too large.
    pub(crate) off: u32,
}

impl Open {
    /// Returns true if the sensor has a reading that can be emitted, if one echo is enough.
    pub(crate) fn is_ready(&self) -> bool {
        !self.echoes.is_empty() || self.off == WIDE
    }

    /// The kind of a reading without information about an echo; `None` while the line is held.
    pub(crate) fn unusable(&self, silence: Silence) -> Option<ReadingKind> {
        match self.evidence {
            Evidence::Stuck => Some(ReadingKind::Stuck),
            _ if self.off == WIDE => Some(ReadingKind::Late),
            _ if !self.echoes.is_empty() => None,
            _ if self.early.is_some() => Some(ReadingKind::TooEarly),
            Evidence::Nothing if silence == Silence::NeedsAnswer => Some(ReadingKind::Unanswered),
            Evidence::Nothing => Some(ReadingKind::NoEcho),
            _ => None,
        }
    }

    /// Returns true if the line is held and the sensor has heard nothing.
    pub(crate) fn is_held(&self, silence: Silence) -> bool {
        self.evidence == Evidence::Held && self.echoes.is_empty() && self.unusable(silence).is_none()
    }
}

pub(crate) const WIDE: u32 = 255;

/// An echo: the time of its firing, the microseconds until it came, and the possible error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Echo {
    pub(crate) fired: u64,
    pub(crate) t_echo: u32,
    pub(crate) off: u32,
}

/// Returns true if these firings explain two echoes as one path that changes by no more than `change`
/// (docs/explanation/theory.md, 2.1). `own` is true for the receiver's firings.
pub(crate) fn explain(fired: &[u64], own: bool, [before, now]: [Echo; 2], audible: u64, change: u64) -> bool {
    let most = u64::from(before.off.max(now.off));
    let (audible, change) = (audible + 2 * most, change + u64::from(before.off + now.off));
    let lengths = |echo: Echo| {
        let heard = echo.fired + u64::from(echo.t_echo) + most;
        let fired = fired.iter().copied().filter(move |&fired| !own || fired != echo.fired);
        fired.filter_map(move |fired| heard.checked_sub(fired)).filter(move |&length| length <= audible)
    };
    lengths(before).any(|one| lengths(now).any(|other| one.abs_diff(other) <= change))
}

/// Settings by which the ring listens and compares.
#[derive(Clone, Copy, Debug)]
pub(super) struct Listening {
    pub(super) t_delta: Micros,
    pub(super) window: Micros,
    pub(super) blanking: Micros,
    pub(super) consecutive: usize,
    pub(super) path_change: Micros,
    pub(super) audible: Micros,
    pub(super) report_after: Micros,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Sensor {
    pub(crate) open: Option<Open>,
    /// The last firing whose reading was emitted, and its late edge, which was not.
    pub(crate) emitted: Option<Open>,
    pub(crate) late: Option<u32>,
    pub(crate) had_late: bool,
    /// True if the sensor held its line at that reading and still does.
    pub(crate) is_held: bool,
    pub(super) last_fired: Option<Last>,
    /// All instants of firings.
    pub(crate) fired: Vec<u64>,
    /// The earlier readings that count, newest last.
    pub(super) heard: Vec<Heard>,
    /// Readings since the comparison was last disturbed.
    pub(super) undisturbed: u32,
    pub(super) age: Option<u16>,
}

/// The last firing of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Last {
    pub(super) at: u64,
    /// Scheduled time, in microseconds since period 0 after the restart began.
    pub(super) planned: u64,
    /// Number of restarts and changes of schedule before it.
    pub(super) epoch: u32,
}

pub(super) struct Model<'s> {
    pub(super) lines: Lines,
    pub(super) listening: Listening,
    pub(super) enabled: [bool; SENSORS],
    pub(super) schedule: &'s Schedule<SENSORS>,
    pub(super) next_schedule: Option<&'s Schedule<SENSORS>>,
    /// Periods since the ring began, and since its last restart or change of schedule.
    pub(super) period: u32,
    pub(super) since: u64,
    pub(super) phase: u8,
    pub(super) last: Option<Last>,
    pub(super) last_sensor: Option<usize>,
    pub(super) paused: bool,
    pub(super) epoch: u32,
    /// The schedule of the previous epoch.
    pub(super) before: Option<&'s Schedule<SENSORS>>,
    /// True if no poll was late since the last firing.
    pub(super) on_time: bool,
    /// Number of periods that have ended since something disturbed the comparison.
    pub(super) quiet_periods: u32,
}

pub(crate) fn instant(time: u64) -> Instant {
    Instant::from_micros(time as u32)
}

pub(super) fn planned(schedule: &Schedule<SENSORS>, period: u64, phase: u8, sensor: usize) -> u64 {
    let t_fire = schedule.t_fire(Phase(phase), sensor).expect("the sensor is there");
    period * u64::from(schedule.period().as_micros()) + u64::from(t_fire.as_micros())
}

/// The shortest time that a schedule always keeps between firings of `x` and `y`.
pub(super) fn always_kept(schedule: &Schedule<SENSORS>, x: usize, y: usize) -> u64 {
    let firings = |sensor| (0..3).map(move |period| planned(schedule, period, (period % 2) as u8, sensor));
    let mut least = u64::MAX;
    for s in firings(x) {
        for t in firings(y) {
            least = least.min(s.abs_diff(t));
        }
    }
    least
}

impl Sensor {
    /// Returns true if the sensor has fired and nothing was reported since then.
    pub(crate) fn is_silent(&self) -> bool {
        self.open.as_ref().is_some_and(|open| open.echoes.is_empty() && open.early.is_none())
    }

    /// Notes that the sensor fires.
    pub(crate) fn fire(&mut self, at: u64, phase: u8, period: u32, silence: Silence) {
        assert!(self.open.is_none() && self.late.is_none(), "fired before its reading was out");
        let evidence = if silence == Silence::Trusted { Evidence::Listened } else { Evidence::Nothing };
        self.open = Some(Open { at, phase, period, echoes: vec![], early: None, evidence, off: 0 });
        (self.emitted, self.had_late, self.is_held) = (None, false, false);
        self.fired.push(at);
    }

    /// Stores evidence about the open firing, if there is one.
    pub(crate) fn shows(&mut self, evidence: Evidence) {
        if let Some(open) = self.open.as_mut().filter(|open| open.evidence != Evidence::Stuck) {
            open.evidence = evidence;
        }
    }

    /// Records an edge between two instants: the middle counts, unless it may be off by more than 300 us. Returns true
    /// if it came after the window, which is still open.
    pub(crate) fn edge_between(&mut self, earliest: u64, latest: u64, window: Micros, blanking: Micros) -> bool {
        let (width, [first, last]) = (latest - earliest, [blanking, window].map(|us| i64::from(us.as_micros())));
        let (middle, off) = (earliest + width / 2, width - width / 2);
        if off <= 300 {
            return self.edge(middle, off.div_ceil(2) as u32, window, blanking);
        }
        let fired = self.open.as_ref().or(self.emitted.as_ref()).map(|open| open.at);
        let Some(since) = fired.map(|fired| middle as i64 - fired as i64) else { return false };
        let off = off as i64;
        if since + off < first || (self.open.is_some() && since - off > last) {
            return self.edge(middle, 0, window, blanking);
        }
        if let Some(open) = &mut self.open {
            if open.echoes.first().is_none_or(|&echo| i64::from(echo) > since - off) {
                open.off = WIDE;
            }
        }
        false
    }

    /// Records an edge that may be off by `off` units. Returns true if it came after the window, which is still open.
    fn edge(&mut self, at: u64, off: u32, window: Micros, blanking: Micros) -> bool {
        let [window, blanking] = [window, blanking].map(|us| u64::from(us.as_micros()));
        if let Some(open) = &mut self.open {
            let Some(t_echo) = at.checked_sub(open.at) else { return false };
            if t_echo > window {
                if open.evidence == Evidence::Held {
                    open.evidence = Evidence::Listened;
                }
                return true;
            }
            if t_echo < blanking {
                // The first edge, unless an echo came before.
                if open.early.is_none() && open.echoes.is_empty() {
                    open.early = Some(t_echo as u32);
                }
                return false;
            }
            open.echoes.push(t_echo as u32);
            open.echoes.sort_unstable();
            open.off = open.off.max(off);
        } else if let Some(emitted) = &self.emitted {
            let late = at.checked_sub(emitted.at).filter(|&late| late > window);
            if let Some(late) = late.filter(|_| !self.had_late) {
                (self.late, self.had_late) = (Some(late as u32), true);
            }
        }
        false
    }

    /// Takes back the last echo, if possible; with several echoes per firing all are dropped.
    pub(crate) fn unhear(&mut self, echoes: usize) {
        match &mut self.open {
            Some(open) if open.is_ready() && echoes == 1 => {
                (open.early, open.off) = (None, 0);
                open.echoes.clear();
            }
            None if self.late.is_some() => (self.late, self.had_late) = (None, false),
            _ => {}
        }
    }
}

/// The state of all lines, as drivers report it.
pub(crate) struct Lines {
    pub(crate) now: u64,
    pub(crate) sensors: [Sensor; SENSORS],
    /// Counts of readings in this period.
    pub(crate) tally: Tally<u8>,
    /// Time until which an echo need not be emitted.
    pub(crate) settled: u64,
    pub(crate) silence: Silence,
}

impl Lines {
    pub(crate) fn new(now: u64, silence: Silence) -> Self {
        Self { now, sensors: Default::default(), tally: Tally::default(), settled: 0, silence }
    }

    /// Drops all firings.
    pub(crate) fn drop_firings(&mut self) {
        for sensor in &mut self.sensors {
            (sensor.open, sensor.emitted, sensor.late, sensor.is_held) = (None, None, None, false);
        }
    }

    /// Passes a report of a driver or a robot to the ring. Returns false for any other step.
    pub(crate) fn hand_in<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
        &mut self,
        ring: &mut Ring<P, J, K, E, H>,
        step: &Step,
    ) -> bool {
        let (now, count) = (self.now, ring.sensors() as u8);
        let is_there = |sensor: u8| sensor < count;
        match *step {
            Step::Edge { sensor, ago, width, settles } => {
                let latest = now - u64::from(ago);
                let (earliest, settled) = (latest - u64::from(width), now + u64::from(settles.unwrap_or(0)));
                let [first, last] = [earliest, latest].map(instant);
                let (width, until) = (Micros::new(width.into()), instant(settled));
                let done = match (settles, earliest == latest) {
                    (None, true) => ring.echo(sensor, last).is_ok(),
                    (None, false) => ring.echo_between(sensor, first, last).is_ok(),
                    (Some(_), true) => ring.echo_until(sensor, last, until).is_ok(),
                    (Some(_), false) => ring.echo_within(sensor, first, width, until).is_ok(),
                };
                assert_eq!(done, is_there(sensor));
                if done {
                    self.settled = self.settled.max(settled);
                    self.hear(ring, sensor, earliest, latest);
                }
            }
            Step::Measured { sensor, t_echo, width } => {
                let Some((x, fired, least)) = self.echo_of(ring, sensor, t_echo) else { return true };
                let most = least + u64::from(width);
                if fired + most > now {
                    // It would be reported before it came.
                    return true;
                }
                let [from, to] = [least, most].map(|us| Micros::new(us as u32));
                match width {
                    0 => ring.measured(x, Some(from)).expect("a sensor that there is"),
                    _ => ring.measured_between(x, from, to).expect("a sensor that there is"),
                }
                self.hear(ring, x, fired + least, fired + most);
            }
            Step::Answered(sensor, answers) => {
                let done = match (answers, sensor % 2) {
                    (true, 0) => ring.measured(sensor, None),
                    (true, _) => ring.answered(sensor),
                    (false, _) => ring.unanswered(sensor),
                };
                self.shows(done, sensor, if answers { Evidence::Listened } else { Evidence::Nothing });
            }
            Step::Holds(sensor) => self.shows(ring.holds(sensor), sensor, Evidence::Held),
            Step::Stuck(sensor) => self.shows(ring.stuck(sensor), sensor, Evidence::Stuck),
            Step::Silence(which) => {
                self.silence = [Silence::Trusted, Silence::NeverFree, Silence::NeedsAnswer][usize::from(which % 3)];
                ring.set_silence(self.silence);
            }
            Step::Unheard(sensor) => {
                assert_eq!(ring.unheard(sensor).is_ok(), is_there(sensor));
                if is_there(sensor) {
                    self.sensors[usize::from(sensor)].unhear(E);
                }
            }
            // The judge is told the expected change and ignores this.
            Step::Moving(speed) => ring.moving((speed / 16).into(), (speed % 16).into(), instant(now)),
            Step::PathChange(us) => {
                assert_eq!(ring.set_path_change(Micros::new(us.into())).is_ok(), us < u16::MAX);
            }
            Step::Audible(units) => ring.set_audible(Micros::new(64 * u32::from(units))).expect("less than a minute"),
            _ => return false,
        }
        true
    }

    /// Picks an existing sensor, with the time of its firing and a made-up echo time.
    pub(crate) fn echo_of<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
        &self,
        ring: &Ring<P, J, K, E, H>,
        sensor: u8,
        t_echo: u16,
    ) -> Option<(u8, u64, u64)> {
        let x = sensor % ring.sensors() as u8;
        let fired = *self.sensors[usize::from(x)].fired.last()?;
        Some((x, fired, t_echo_of(t_echo, [ring.window_of(x), ring.blanking(), ring.t_delta_of(x)])))
    }

    fn shows(&mut self, done: Result<(), SensorError>, sensor: u8, evidence: Evidence) {
        if done.is_ok() {
            self.sensors[usize::from(sensor)].shows(evidence);
        }
    }

    fn hear<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
        &mut self,
        ring: &Ring<P, J, K, E, H>,
        sensor: u8,
        earliest: u64,
        latest: u64,
    ) {
        let (window, blanking) = (ring.window_of(sensor), ring.blanking());
        if self.sensors[usize::from(sensor)].edge_between(earliest, latest, window, blanking) {
            self.tally.count(ReadingKind::Late);
        }
    }
}

/// Maps many of the fuzzer's numbers to interesting ones: close to the borders of window and blanking, or close to one
/// another.
fn t_echo_of(made_up: u16, [window, blanking, t_delta]: [Micros; 3]) -> u64 {
    let (which, rest) = (made_up % 4, u64::from(made_up / 4));
    let near = |border: Micros| (u64::from(border.as_micros()) + rest % 4).saturating_sub(2);
    match which {
        0 => near(window),
        1 => near(blanking),
        2 => u64::from(window.as_micros()) / 2 + rest % 8 * u64::from(t_delta.as_micros()) / 4,
        _ => 4 * rest,
    }
}

impl<'s> Model<'s> {
    pub(super) fn invalidate(&mut self) {
        self.quiet_periods = 0;
        for sensor in &mut self.lines.sensors {
            sensor.undisturbed = 0;
        }
    }

    pub(super) fn fired(&mut self, sensor: u8, deadline: u64) {
        let x = usize::from(sensor);
        assert!(x < SENSORS && self.enabled[x] && !self.paused, "sensor {sensor} is not to fire");
        assert!(self.lines.now >= deadline, "fired before the deadline");
        let at = planned(self.schedule, self.since, self.phase, x);
        match self.last {
            Some(last) if last.epoch == self.epoch => {
                let (passed, gap) = (self.lines.now - last.at, at - last.planned);
                assert!(passed >= gap, "{passed} us after the firing before, {gap} us in the schedule");
                assert!(
                    !self.on_time || passed == gap,
                    "{passed} us after the firing before, {gap} us in the schedule"
                );
                if passed > gap {
                    // How much is for the ring to judge; comparisons need some time without lateness.
                    self.invalidate();
                }
            }
            _ => self.invalidate(),
        }
        if let Some(before) = self.before {
            // Firings under the previous schedule.
            for y in 0..SENSORS {
                let last = self.lines.sensors[y].last_fired.filter(|last| last.epoch + 1 == self.epoch);
                let kept = match x == y {
                    true => before.min_refire().as_micros().into(),
                    false if RESTARTS_KEEP_INTERVALS => always_kept(before, y, x),
                    false => 0,
                };
                let passed = last.map_or(u64::MAX, |last| self.lines.now - last.at);
                assert!(passed >= kept, "sensors {y} and {x} {passed} us apart, kept {kept}");
            }
        }
        let fired = Last { at: self.lines.now, planned: at, epoch: self.epoch };
        (self.last, self.last_sensor) = (Some(fired), Some(x));
        self.on_time = true;
        let sensor = &mut self.lines.sensors[x];
        sensor.fire(self.lines.now, self.phase, self.period, self.lines.silence);
        sensor.last_fired = Some(fired);
    }

    /// Returns true if firings of sensor `x` explain two readings of sensor `y`, along a path that changes by up to P
    /// plus `slack` and is heard for `slack` longer.
    fn explains(&self, x: usize, y: usize, pair: [Heard; 2], slack: u64) -> bool {
        let echo = |of: Heard| Echo { fired: of.fired, t_echo: of.echo.flatten().unwrap_or(0), off: of.off };
        let [audible, change] =
            [self.listening.audible, self.listening.path_change].map(|us| u64::from(us.as_micros()));
        explain(&self.lines.sensors[x].fired, x == y, pair.map(echo), audible + slack, change + slack)
    }

    /// Checks a reading for which odometry expected this change.
    pub(super) fn emitted(&mut self, reading: &Reading, expected: i32) {
        let listening = self.listening;
        let x = usize::from(reading.sensor);
        let quiet = self.quiet_periods >= 4;
        let sensor = &mut self.lines.sensors[x];
        if reading.kind == ReadingKind::Late && reading.t_echo.is_some() {
            let late = sensor.late.take().expect("a late edge came in");
            if sensor.is_held {
                self.answered(x);
            }
            let sensor = &mut self.lines.sensors[x];
            let emitted = sensor.emitted.as_ref().expect("its reading was out before");
            assert_eq!((reading.t_echo, reading.previous, reading.age), (Some(Micros::new(late)), None, sensor.age));
            assert_eq!(reading.phase, Phase(emitted.phase));
            self.lines.tally.count(ReadingKind::Late);
            return;
        }
        let open = sensor.open.take().expect("it has fired");
        assert_eq!((reading.phase, reading.period), (Phase(open.phase), open.period));
        // Under another schedule it may fire again before a newly set window has closed.
        let changed = sensor.last_fired.is_some_and(|last| last.epoch < self.epoch);
        assert!(
            changed || open.is_ready() || self.lines.now >= open.at + u64::from(listening.window.as_micros()),
            "emitted before its window closed"
        );
        let micros = |us: Option<u32>| us.map(Micros::new);
        let echo = open.echoes.first().copied();
        if open.is_held(self.lines.silence) {
            // The reading must leave the knowledge unchanged.
            assert!(matches!(reading.kind, ReadingKind::NoEcho | ReadingKind::Clear), "{reading:?} while it holds");
            assert_eq!((reading.t_echo, reading.previous, reading.age), (None, None, sensor.age));
            if sensor.heard.last().is_some_and(|last| last.echo != Some(None)) {
                sensor.heard.clear();
                sensor.undisturbed = 0;
            }
            (sensor.is_held, sensor.emitted) = (true, Some(open));
            self.lines.tally.count(reading.kind);
            return;
        }
        let kind = open.unusable(self.lines.silence);
        let heard = kind.is_none().then_some(echo);
        match kind {
            Some(ReadingKind::Stuck | ReadingKind::Late) => assert_eq!(reading.t_echo, None),
            Some(ReadingKind::TooEarly) => assert_eq!(reading.t_echo, micros(open.early)),
            _ => assert_eq!(reading.t_echo, micros(echo)),
        }
        let ambiguous = reading.kind == ReadingKind::Ambiguous;
        let t_delta = listening.t_delta.as_micros();
        let heard_now = Heard { echo: heard, fired: open.at, t_delta, ambiguous, expected, off: 2 * open.off };
        let last = sensor.heard.last().copied();
        sensor.heard.push(heard_now);
        sensor.undisturbed += 1;
        let agree = |pair: &[Heard]| matches!(pair, [before, now] if now.agrees(before) && !now.ambiguous);
        let running = 1 + sensor.heard.windows(2).rev().take_while(|pair| agree(pair)).count();
        let enough = running >= listening.consecutive;
        let before = last.and_then(|last| last.echo).flatten();
        let pair = last.filter(|last| heard.flatten().is_some() && heard_now.agrees(last));
        self.explained(reading, pair.map(|last| (last, heard_now)));
        let sensor = &mut self.lines.sensors[x];
        let possible: &[ReadingKind] = match (kind, heard.flatten()) {
            (Some(_), _) => kind.as_slice(),
            (None, None) if enough => &[ReadingKind::Clear, ReadingKind::NoEcho],
            (None, None) => &[ReadingKind::NoEcho],
            (None, Some(_)) if ambiguous => &[ReadingKind::Ambiguous],
            (None, Some(_)) if enough => &[ReadingKind::Accepted, ReadingKind::Repeated, ReadingKind::First],
            (None, Some(_)) if running > 1 => &[ReadingKind::Repeated, ReadingKind::First],
            (None, Some(_)) if before.is_some() => &[ReadingKind::Rejected, ReadingKind::First],
            (None, Some(_)) => &[ReadingKind::First],
        };
        // If nothing disturbed the comparison, only the first is possible.
        let sure = quiet && sensor.undisturbed > listening.consecutive as u32 + 4;
        let possible = if sure { &possible[..1] } else { possible };
        assert!(possible.contains(&reading.kind), "{reading:?}, possible: {possible:?}; heard {:?}", sensor.heard);
        if matches!(reading.kind, ReadingKind::Accepted | ReadingKind::Rejected | ReadingKind::Repeated) {
            assert_eq!(reading.previous, micros(before), "compared with the firing before");
        }
        sensor.age = match sensor.age {
            _ if reading.kind == ReadingKind::Accepted => Some(0),
            Some(age) => Some(age.saturating_add(1)),
            None => None,
        };
        assert_eq!(reading.age, sensor.age);
        sensor.emitted = Some(open);
        self.lines.tally.count(reading.kind);
    }

    /// Checks the ring's verdict on two readings that agree against all firings: nothing explains a believed reading,
    /// and the named sensor explains an ambiguous one.
    fn explained(&self, reading: &Reading, pair: Option<(Heard, Heard)>) {
        let y = usize::from(reading.sensor);
        let explains =
            |x: usize, slack: u64| pair.is_some_and(|(before, now)| self.explains(x, y, [before, now], slack));
        match (reading.kind, reading.explained_by) {
            (ReadingKind::Accepted | ReadingKind::Repeated, None) => {
                let by = (0..SENSORS).find(|&x| explains(x, 0));
                assert_eq!(by, None, "{reading:?} is explained; {pair:?}");
            }
            (ReadingKind::Ambiguous, Some(Explanation::Sensor(x))) => {
                assert!(explains(x.into(), STAMPS), "{reading:?} is not explained; {pair:?}");
            }
            // A firing that the ring has forgotten.
            (ReadingKind::Ambiguous, Some(Explanation::History)) => {
                assert!(pair.is_some(), "{reading:?} does not agree")
            }
            (kind, by) => assert!(kind != ReadingKind::Ambiguous && by.is_none(), "{reading:?}"),
        }
    }

    /// Notes that a sensor has shown that it listened: if its line was held after its reading, silence counts now.
    pub(super) fn answered(&mut self, x: usize) {
        let sensor = &mut self.lines.sensors[x];
        if core::mem::take(&mut sensor.is_held) {
            let fired = sensor.emitted.as_ref().map_or(0, |emitted| emitted.at);
            let t_delta = self.listening.t_delta.as_micros();
            sensor.heard.push(Heard { echo: Some(None), fired, t_delta, ambiguous: false, expected: 0, off: 0 });
            sensor.undisturbed += 1;
            sensor.age = sensor.age.map(|age| age.saturating_add(1));
        }
    }

    pub(super) fn ended(&mut self, stats: &PeriodStats) {
        assert_eq!((stats.period, stats.phase), (self.period, Phase(self.phase)));
        assert_eq!(stats.tally, self.lines.tally);
        self.lines.tally = Tally::default();
        self.period += 1;
        self.phase = 1 - self.phase;
        self.since += 1;
        self.quiet_periods += 1;
        if let Some(next) = self.next_schedule.take() {
            self.new_epoch(next);
            // The new schedule begins with the phase that would have come next.
            self.since = u64::from(self.phase);
        }
    }

    /// Notes that the last firing, of sensor `x`, came at this time.
    pub(super) fn fired_at(&mut self, x: usize, at: u64) {
        let (Some(open), Some(last)) = (&mut self.lines.sensors[x].open, &mut self.last) else { return };
        let later = at > last.at;
        (open.at, last.at) = (at, at);
        self.lines.sensors[x].last_fired = self.last;
        self.lines.sensors[x].fired.pop();
        self.lines.sensors[x].fired.push(at);
        if later {
            // Like a firing that is polled late: how much is for the ring to judge.
            self.invalidate();
        }
    }

    pub(super) fn pause(&mut self, pauses: bool) {
        self.paused = pauses;
        self.on_time = false;
        if !pauses {
            for sensor in &mut self.lines.sensors {
                sensor.heard.clear();
                sensor.undisturbed = 0;
            }
        }
    }

    /// Notes changed listening settings, which the ring must accept if and only if it can.
    pub(super) fn listen(&mut self, done: bool, changed: Listening) {
        let Listening { t_delta, window, blanking, .. } = changed;
        let longest =
            self.next_schedule.map_or(self.schedule, |next| next).min_refire().min(self.schedule.min_refire());
        assert_eq!(done, window <= longest && t_delta < window && blanking < window, "{changed:?}, at most {longest}");
        if done {
            if t_delta > self.listening.t_delta {
                self.invalidate();
            }
            self.listening = changed;
        }
    }

    /// Begins with another schedule, or restarts with the same one.
    pub(super) fn new_epoch(&mut self, schedule: &'s Schedule<SENSORS>) {
        self.before = Some(self.schedule);
        self.epoch += 1;
        self.schedule = schedule;
        self.since = 0;
        self.invalidate();
    }

    /// Notes that every possible event was emitted.
    pub(super) fn drained(&self) {
        for (x, sensor) in self.lines.sensors.iter().enumerate() {
            assert!(sensor.late.is_none() || self.lines.now < self.lines.settled, "sensor {x} has a late edge to tell");
            if let Some(open) = &sensor.open {
                assert!(!open.is_ready() || self.lines.now < self.lines.settled, "sensor {x} has an echo to tell");
                let closes = self.listening.window.max(self.listening.report_after);
                let closes = open.at + u64::from(closes.as_micros());
                assert!(self.lines.now < closes.max(self.lines.settled), "the window of sensor {x} has closed");
            }
        }
    }
}
