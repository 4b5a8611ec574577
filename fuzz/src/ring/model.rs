//! Events that the ring may emit, derived from what happened to it.

use eeruf_core::{Instant, Micros, PeriodStats, Phase, Reading, ReadingKind, Schedule, Tally, judge::Explanation};

use super::SENSORS;

/// True if a restart keeps the intervals between different sensors too.
const RESTARTS_KEEP_INTERVALS: bool = true;

/// Error of the ring's stamps at most, in microseconds.
const STAMPS: u64 = 64;

/// A reading that counts in comparisons.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heard {
    /// `Some(None)` stands for silence, `None` for nothing known.
    echo: Option<Option<u32>>,
    /// When it fired.
    fired: u64,
    t_delta: u32,
    /// Something foreign explains it together with the one before.
    ambiguous: bool,
    /// The change that odometry expects since the one before.
    expected: i32,
    /// The time by which the echo may be off.
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

/// A firing whose reading is not yet out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub(super) at: u64,
    pub(super) phase: u8,
    pub(super) period: u32,
    /// The earliest edge within the window, and the first one within the blanking time.
    pub(super) echo: Option<u32>,
    pub(super) early: Option<u32>,
    pub(super) stuck: bool,
    /// The time by which the echo may be off, in units of 2 us; [`WIDE`] if too much.
    pub(super) off: u32,
    /// The driver said that the sensor does not listen.
    pub(super) unanswered: bool,
}

impl Open {
    /// It has a reading that can be emitted.
    fn is_ready(&self) -> bool {
        self.echo.is_some() || self.off == WIDE
    }
}

const WIDE: u32 = 255;

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
pub(super) struct Sensor {
    pub(super) open: Option<Open>,
    /// The last firing whose reading is out, and its late edge that is not.
    pub(super) emitted: Option<Open>,
    pub(super) late: Option<u32>,
    pub(super) had_late: bool,
    pub(super) last_fired: Option<Last>,
    /// All instants at which it fired.
    pub(super) fired: Vec<u64>,
    /// The readings before, newest last, as far as they count.
    pub(super) heard: Vec<Heard>,
    /// Readings since the comparison was last disturbed.
    pub(super) undisturbed: u32,
    pub(super) age: Option<u16>,
}

/// The last firing of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Last {
    pub(super) at: u64,
    /// Where the schedule has it, in microseconds from the start of the period with number 0 since the restart.
    pub(super) planned: u64,
    /// Number of times that the ring had restarted or changed its schedule.
    pub(super) epoch: u32,
}

pub(super) struct Model<'s> {
    pub(super) now: u64,
    pub(super) listening: Listening,
    pub(super) enabled: [bool; SENSORS],
    pub(super) schedule: &'s Schedule<SENSORS>,
    pub(super) next_schedule: Option<&'s Schedule<SENSORS>>,
    /// Periods since the ring began, and since it restarted or changed.
    pub(super) period: u32,
    pub(super) since: u64,
    pub(super) phase: u8,
    pub(super) last: Option<Last>,
    pub(super) last_sensor: Option<usize>,
    pub(super) paused: bool,
    pub(super) epoch: u32,
    /// The schedule of the epoch before.
    pub(super) before: Option<&'s Schedule<SENSORS>>,
    /// Nothing was polled late since the last firing.
    pub(super) on_time: bool,
    pub(super) tally: Tally<u8>,
    /// Periods that have ended since something disturbed the comparison.
    pub(super) quiet_periods: u32,
    pub(super) sensors: [Sensor; SENSORS],
}

pub(super) fn instant(time: u64) -> Instant {
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
    /// It has fired, and nothing was heard or said since.
    pub(super) fn is_silent(&self) -> bool {
        self.open.is_some_and(|open| open.echo.is_none() && open.early.is_none())
    }
}

impl<'s> Model<'s> {
    pub(super) fn invalidate(&mut self) {
        self.quiet_periods = 0;
        for sensor in &mut self.sensors {
            sensor.undisturbed = 0;
        }
    }

    pub(super) fn fired(&mut self, sensor: u8, deadline: u64) {
        let x = usize::from(sensor);
        assert!(x < SENSORS && self.enabled[x] && !self.paused, "sensor {sensor} is not to fire");
        assert!(self.now >= deadline, "fired before the deadline");
        let at = planned(self.schedule, self.since, self.phase, x);
        match self.last {
            Some(last) if last.epoch == self.epoch => {
                let (passed, gap) = (self.now - last.at, at - last.planned);
                assert!(passed >= gap, "{passed} us after the firing before, {gap} us in the schedule");
                assert!(
                    !self.on_time || passed == gap,
                    "{passed} us after the firing before, {gap} us in the schedule"
                );
                if passed > gap {
                    // By how much is for the ring to judge; to be compared it must have been on time for a while.
                    self.invalidate();
                }
            }
            _ => self.invalidate(),
        }
        if let Some(before) = self.before {
            // What fired under the schedule before.
            for y in 0..SENSORS {
                let last = self.sensors[y].last_fired.filter(|last| last.epoch + 1 == self.epoch);
                let kept = match x == y {
                    true => before.min_refire().as_micros().into(),
                    false if RESTARTS_KEEP_INTERVALS => always_kept(before, y, x),
                    false => 0,
                };
                let passed = last.map_or(u64::MAX, |last| self.now - last.at);
                assert!(passed >= kept, "sensors {y} and {x} {passed} us apart, kept {kept}");
            }
        }
        let fired = Last { at: self.now, planned: at, epoch: self.epoch };
        (self.last, self.last_sensor) = (Some(fired), Some(x));
        self.on_time = true;
        let sensor = &mut self.sensors[x];
        assert!(sensor.open.is_none() && sensor.late.is_none(), "fired before its reading was out");
        sensor.open = Some(Open {
            at: self.now,
            phase: self.phase,
            period: self.period,
            echo: None,
            early: None,
            stuck: false,
            off: 0,
            unanswered: false,
        });
        (sensor.emitted, sensor.had_late) = (None, false);
        sensor.last_fired = Some(fired);
        sensor.fired.push(self.now);
    }

    /// Returns true if firings of sensor `x` explain two readings of sensor `y` as one path that changes by no more
    /// than `change` (docs/explanation/theory.md, 2.1).
    fn explains(&self, x: usize, y: usize, before: Heard, now: Heard, change: u64) -> bool {
        let most = u64::from(before.off.max(now.off));
        let change = change + u64::from(before.off + now.off);
        let slack = change - self.change() - u64::from(before.off + now.off);
        let audible = u64::from(self.listening.audible.as_micros()) + slack + 2 * most;
        let heard = |reading: Heard| reading.fired + u64::from(reading.echo.flatten().unwrap_or(0)) + most;
        let lengths = |reading: Heard| {
            let own = (x == y).then_some(reading.fired);
            let fired = self.sensors[x].fired.iter().copied().filter(move |&fired| own != Some(fired));
            fired.filter_map(move |fired| heard(reading).checked_sub(fired)).filter(move |&length| length <= audible)
        };
        lengths(before).any(|one| lengths(now).any(|other| one.abs_diff(other) <= change))
    }

    /// P: the largest change of a path.
    fn change(&self) -> u64 {
        self.listening.path_change.as_micros().into()
    }

    /// A reading, for which odometry expected this change.
    pub(super) fn emitted(&mut self, reading: &Reading, expected: i32) {
        let listening = self.listening;
        let x = usize::from(reading.sensor);
        let quiet = self.quiet_periods >= 4;
        let sensor = &mut self.sensors[x];
        if reading.kind == ReadingKind::Late && reading.t_echo.is_some() {
            let late = sensor.late.take().expect("a late edge came in");
            let emitted = sensor.emitted.expect("its reading was out before");
            assert_eq!((reading.t_echo, reading.previous, reading.age), (Some(Micros::new(late)), None, sensor.age));
            assert_eq!(reading.phase, Phase(emitted.phase));
            self.tally.count(ReadingKind::Late);
            return;
        }
        let open = sensor.open.take().expect("it has fired");
        assert_eq!((reading.phase, reading.period), (Phase(open.phase), open.period));
        // By another schedule it may fire again before a window that was set since has closed.
        let changed = sensor.last_fired.is_some_and(|last| last.epoch < self.epoch);
        assert!(
            changed || open.is_ready() || self.now >= open.at + u64::from(listening.window.as_micros()),
            "emitted before its window closed"
        );
        let micros = |us: Option<u32>| us.map(Micros::new);
        let (heard, kind) = match open {
            Open { stuck: true, .. } => (None, Some(ReadingKind::Stuck)),
            Open { off: WIDE, .. } => {
                assert_eq!(reading.t_echo, None);
                (None, Some(ReadingKind::Late))
            }
            Open { echo: None, early: None, unanswered: true, .. } => (None, Some(ReadingKind::NoEcho)),
            Open { echo: None, early: Some(early), .. } => {
                assert_eq!(reading.t_echo, Some(Micros::new(early)));
                (None, Some(ReadingKind::TooEarly))
            }
            Open { echo, .. } => {
                assert_eq!(reading.t_echo, micros(echo));
                (Some(echo), None)
            }
        };
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
        let sensor = &mut self.sensors[x];
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
        // Where nothing disturbed the comparison, the first of them is the one.
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
        self.tally.count(reading.kind);
    }

    /// Holds what the ring says of two readings that agree, if they do, against all firings there were: nothing
    /// explains what is believed, and what is ambiguous is explained by whom it names.
    fn explained(&self, reading: &Reading, pair: Option<(Heard, Heard)>) {
        let y = usize::from(reading.sensor);
        let explains = |x: usize, slack: u64| {
            pair.is_some_and(|(before, now)| self.explains(x, y, before, now, self.change() + slack))
        };
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

    /// An edge between two instants: the middle counts, unless it may be off by more than 300 us.
    pub(super) fn edge_between(&mut self, x: usize, earliest: u64, latest: u64) {
        let (width, [window, blanking]) =
            (latest - earliest, [self.listening.window, self.listening.blanking].map(|us| i64::from(us.as_micros())));
        let (middle, off) = (earliest + width / 2, width - width / 2);
        if off <= 300 {
            return self.edge(x, middle, off.div_ceil(2) as u32);
        }
        let Some(open) = &mut self.sensors[x].open else { return };
        let since = |at: u64| at as i64 - open.at as i64;
        if since(middle + off) < blanking {
            return self.edge(x, middle, 0);
        }
        if since(middle - off) > window {
            self.tally.count(ReadingKind::Late);
        } else if open.echo.is_none_or(|echo| i64::from(echo) > since(middle - off)) {
            open.off = WIDE;
        }
    }

    /// Takes back what was heard.
    pub(super) fn unhear(&mut self, x: usize) {
        if let Some(open) = self.sensors[x].open.as_mut().filter(|open| open.is_ready()) {
            (open.echo, open.early, open.off) = (None, None, 0);
        }
    }

    /// An edge that may be off by this many units.
    pub(super) fn edge(&mut self, x: usize, at: u64, off: u32) {
        let window = u64::from(self.listening.window.as_micros());
        let sensor = &mut self.sensors[x];
        if let Some(open) = &mut sensor.open {
            let Some(t_echo) = at.checked_sub(open.at) else { return };
            if t_echo > window {
                self.tally.count(ReadingKind::Late);
            } else if t_echo < u64::from(self.listening.blanking.as_micros()) {
                // The first to come in, unless an echo was there before.
                if open.early.is_none() && open.echo.is_none() {
                    open.early = Some(t_echo as u32);
                }
            } else {
                open.echo = Some(open.echo.map_or(t_echo as u32, |echo| echo.min(t_echo as u32)));
                open.off = open.off.max(off);
            }
        } else if let Some(emitted) = sensor.emitted {
            let late = at.checked_sub(emitted.at).filter(|&late| late > window);
            if let Some(late) = late.filter(|_| !sensor.had_late) {
                (sensor.late, sensor.had_late) = (Some(late as u32), true);
            }
        }
    }

    pub(super) fn ended(&mut self, stats: &PeriodStats) {
        assert_eq!((stats.period, stats.phase), (self.period, Phase(self.phase)));
        assert_eq!(stats.tally, self.tally);
        self.tally = Tally::default();
        self.period += 1;
        self.phase = 1 - self.phase;
        self.since += 1;
        self.quiet_periods += 1;
        if let Some(next) = self.next_schedule.take() {
            self.new_epoch(next);
            // It begins with the phase that would have come.
            self.since = u64::from(self.phase);
        }
    }

    /// The last firing, of sensor `x`, came at this time, later than its poll or not.
    pub(super) fn fired_at(&mut self, x: usize, at: u64) {
        let (Some(open), Some(last)) = (&mut self.sensors[x].open, &mut self.last) else { return };
        let later = at > last.at;
        (open.at, last.at) = (at, at);
        self.sensors[x].last_fired = self.last;
        self.sensors[x].fired.pop();
        self.sensors[x].fired.push(at);
        if later {
            // As where a firing is polled late: by how much is for the ring to judge.
            self.invalidate();
        }
    }

    pub(super) fn pause(&mut self, pauses: bool) {
        self.paused = pauses;
        self.on_time = false;
        if !pauses {
            for sensor in &mut self.sensors {
                sensor.heard.clear();
                sensor.undisturbed = 0;
            }
        }
    }

    /// Returns true if the ring listens otherwise from now on: exactly where it can.
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

    /// Another schedule, or the same again.
    pub(super) fn new_epoch(&mut self, schedule: &'s Schedule<SENSORS>) {
        self.before = Some(self.schedule);
        self.epoch += 1;
        self.schedule = schedule;
        self.since = 0;
        self.invalidate();
    }

    /// All that could be emitted has been.
    pub(super) fn drained(&self) {
        for (x, sensor) in self.sensors.iter().enumerate() {
            assert!(sensor.late.is_none(), "sensor {x} has a late edge to tell");
            if let Some(open) = sensor.open {
                assert!(!open.is_ready(), "sensor {x} has an echo to tell");
                let closes = self.listening.window.max(self.listening.report_after);
                let closes = open.at + u64::from(closes.as_micros());
                assert!(self.now < closes, "the window of sensor {x} has closed");
            }
        }
    }
}
