//! A corpus of rings for ports that cannot call Rust: the inputs and events of each ring. `EERUF_CORPUS=FILE` writes
//! it, for `c/micropython/test_corpus.py`. The repository keeps its [`golden`] part, which `EERUF_WRITE=1` writes.
//!
//! Lines: `#` the name of a ring; `S` a schedule: period, phases, then the firing times by phase; `V` requirements
//! (`t_delta`, interval, window, neighbours, layout, stale echo), then separation and window, both 0 if not met; `L`
//! how a ring listens (`t_delta`, window, blanking, consecutive, path change, audible) and its start. Then echoes `E`,
//! echoes between two instants `I`, stuck lines `K`, corrected firings `F`, silence `G`, sensors enabled or not `N`,
//! restarts `R`, another path change `C` or `audible` `A`, and polls `P` with the deadline after it and the event, if
//! there is one. `O`: the state in front of a sensor at an instant: kind, echo, age, reason, explanation. 2^32 - 1
//! stands for no echo, or in `L` for the default; as the explanation of a reading 254 stands for history and 255 for
//! none. Flow rings follow: see [`flow`]. Rings named `between` have lines `I`.

mod flow;
mod golden;

use std::fmt::Write;

use eeruf_core::{
    EchoFilter, Instant, Layout, Micros, PeriodStats, Phase, Reading, ReadingKind, Requirements, Ring, RingConfig,
    RingEvent, Schedule, Silence,
    judge::{Explanation, Judge},
    plan::{Plan, ScheduledFiring},
    watch::{Doubt, SensorState, SensorWatch},
};

use crate::common::random::Random;

const K: usize = 16;
const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/ring-golden.txt");
/// Number of rings in the corpus besides [`RARE`]; `EERUF_RINGS` sets it for a longer comparison.
const RINGS: u64 = 40;
/// Seeds of rings in which a port differs if it handles a limit wrongly: `audible`, `path_change`, the tolerated
/// lateness, the periods for which an irregular firing counts, the period of a late edge, restarts, proven timetables,
/// `t_delta`.
const RARE: [u64; 12] = [67, 86, 390, 449, 672, 1043, 1494, 1531, 1984, 2369, 2505, 2893];
const STEPS: u32 = 64;
/// Interval between samples that is too long for any punctual edge.
const LOOKS: u32 = 900;
const NONE: u32 = u32::MAX;

type ScheduledBy<'s, const M: usize> = Ring<ScheduledFiring<'s, K, M>, EchoFilter<K>, K>;

/// The corpus.
struct Text(String);

impl Text {
    fn add(&mut self, kind: char, numbers: impl IntoIterator<Item = u32>) {
        self.0.push(kind);
        for number in numbers {
            write!(self.0, " {number}").unwrap();
        }
        self.0.push('\n');
    }
}

impl Random {
    fn within(&mut self, least: u32, most: u32) -> u32 {
        least + self.up_to(most - least)
    }

    fn once_in(&mut self, times: u32) -> bool {
        self.up_to(times - 1) == 0
    }

    fn one_of<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.up_to(these.len() as u32 - 1) as usize]
    }

    /// A duration of any order of magnitude up to `most`.
    fn duration(&mut self, most: u32) -> u32 {
        let bits = self.up_to(32 - most.leading_zeros());
        most.min(self.next() as u32 & ((1_u64 << bits) - 1) as u32)
    }
}

fn explanation(explained_by: Option<Explanation>) -> u32 {
    match explained_by {
        Some(Explanation::Sensor(sensor)) => sensor.into(),
        Some(Explanation::History) => 254,
        None => 255,
    }
}

/// A state as numbers.
fn flat_state(state: SensorState) -> [u32; 5] {
    match state {
        SensorState::Obstacle { t_echo, age } => [1, t_echo.as_micros(), age.as_micros(), 0, 255],
        SensorState::Clear { age } => [2, NONE, age.as_micros(), 0, 255],
        SensorState::TooClose { age } => [3, NONE, age.as_micros(), 0, 255],
        SensorState::Unanswered { since } => [4, NONE, since.as_micros(), 0, 255],
        SensorState::Unknown { since, why } => {
            let (why, by) = match why {
                Doubt::NoFiring => (0, None),
                Doubt::Unsure => (1, None),
                Doubt::Rejected => (2, None),
                Doubt::Ambiguous(by) => (3, Some(by)),
                Doubt::NoWitness => (4, None),
                _ => unreachable!("{why:?}"),
            };
            [0, NONE, since.as_micros(), why, explanation(by)]
        }
        _ => unreachable!("{state:?}"),
    }
}

/// An event as numbers.
fn flat(event: &RingEvent) -> Vec<u32> {
    let echo = |t_echo: Option<Micros>| t_echo.map_or(NONE, Micros::as_micros);
    match *event {
        RingEvent::Fire { sensor, phase: Phase(phase), due } => vec![0, sensor.into(), phase.into(), due.as_micros()],
        RingEvent::Reading(Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by }) => {
            let explained_by = explanation(explained_by);
            let verdict = [echo(t_echo), echo(previous), age.unwrap_or(u16::MAX).into(), explained_by];
            [&[1, sensor.into(), phase.0.into(), period, kind as u32][..], &verdict].concat()
        }
        RingEvent::PeriodEnded(PeriodStats { period, phase, tally, max_late, sum_late }) => {
            let counts = ReadingKind::ALL.map(|kind| tally.of(kind));
            [&[2, phase.0.into(), period, max_late.as_micros(), sum_late.as_micros()][..], &counts].concat()
        }
    }
}

/// A schedule for which crosstalk mostly moves, with the `t_delta` and window that it was verified for.
fn schedule(r: &mut Random, text: &mut Text, phases: u32) -> (u32, u32, Vec<Vec<Micros>>) {
    let sensors = r.within(1, 6);
    let period = r.within(30_000, 90_000);
    let wait = r.within(900, 1_400);
    let rows: Vec<Vec<u32>> = (0..phases)
        .map(|phase| (0..sensors).map(|x| (x * period / (sensors + 1) + phase * wait * (x + 1)) % period).collect())
        .collect();
    text.add('S', [period, phases].into_iter().chain(rows.concat()));
    (period, sensors, rows.into_iter().map(|row| row.into_iter().map(Micros::new).collect()).collect())
}

/// Verifies a schedule of two phases; returns it, verified or not, with its `t_delta` and window if it was.
fn verify(r: &mut Random, text: &mut Text, schedule: Schedule<K>) -> (Schedule<K>, Option<[u32; 2]>) {
    let (t_delta, neighbours) = (r.within(50, 500), r.up_to(4));
    let layout = r.up_to(2);
    let requirements = Requirements {
        min_interval: Micros::new(r.duration(6_000)),
        window: Micros::new(r.up_to(1) * r.within(10_000, 90_000)),
        stale_echo: r.once_in(4),
        layout: [Layout::Line, Layout::Ring, Layout::Blocks][layout as usize](neighbours as u8),
        ..Requirements::new(Micros::new(t_delta))
    };
    let verified = schedule.verified(&requirements).ok();
    let numbers =
        verified.map(|verified| [verified.verified_for().separation, verified.window()].map(Micros::as_micros));
    let asked = [t_delta, requirements.min_interval.as_micros(), requirements.window.as_micros(), neighbours];
    let asked = asked.into_iter().chain([layout, requirements.stale_echo.into()]);
    text.add('V', asked.chain(numbers.unwrap_or_default()));
    match verified {
        Some(verified) => (verified.into_schedule(), numbers.map(|[_, window]| [t_delta, window])),
        None => (schedule, None),
    }
}

/// Events around a ring, and its sounds: an obstacle in front of each sensor, or one path from each to the next.
struct World {
    now: u32,
    late: u32,
    /// Factor by which jumps of the clock and disturbances of firings and sensors are rarer.
    calm: u32,
    own: Vec<u32>,
    path: u32,
    /// True if the only sound is that of the path.
    path_only: bool,
    echoes: Vec<(u32, u8)>,
    /// Greatest interval between samples of the lines in microseconds; 0 if falls are seen at once.
    looks: u32,
}

/// Hands in an edge.
fn edge<P: Plan, J: Judge, const N: usize, const H: usize>(
    (r, text): (&mut Random, &mut Text),
    ring: &mut Ring<P, J, N, 1, H>,
    sensor: u8,
    at: u32,
    looks: u32,
) {
    if looks == 0 {
        text.add('E', [sensor.into(), at]);
        ring.echo(sensor, Instant::from_micros(at)).unwrap();
    } else {
        let before = at.wrapping_sub(r.duration(looks));
        text.add('I', [sensor.into(), before, at]);
        ring.echo_between(sensor, Instant::from_micros(before), Instant::from_micros(at)).unwrap();
    }
}

impl World {
    fn turn_clock(&mut self, r: &mut Random, deadline: u32) {
        let ahead = deadline.wrapping_sub(self.now);
        let ahead = if ahead < 1 << 31 { ahead } else { 0 };
        let by = match r.up_to(1000 * self.calm - 1) {
            0 => r.next() as u32,
            1 => r.duration(10_000_000).wrapping_neg(),
            2..10 => r.duration(100).wrapping_neg(),
            10..100 => r.duration(5_000),
            100..110 => ahead.wrapping_add(r.duration(1_000_000)),
            110..500 => ahead.wrapping_add(r.duration(self.late)),
            _ => ahead,
        };
        self.now = self.now.wrapping_add(by);
    }

    fn fired(&mut self, r: &mut Random, sensor: u8, at: u32) {
        let sensors = self.own.len() as u32;
        let own = self.own[usize::from(sensor)];
        if !self.path_only {
            match r.up_to(9) {
                0 => {}
                1 => self.echoes.push((at.wrapping_add(r.duration(90_000)), sensor)),
                _ => self.echoes.push((at.wrapping_add(own + r.duration(300)), sensor)),
            }
        }
        if self.path_only || r.once_in(3) {
            let next = (u32::from(sensor) + 1) % sensors;
            self.echoes.push((at.wrapping_add(self.path + r.duration(100)), next as u8));
        }
    }

    fn heard(&mut self) -> Vec<(u32, u8)> {
        let now = self.now;
        if self.echoes.len() > 200 {
            // They belong to the time before the jump.
            self.echoes.clear();
        }
        let mut heard = vec![];
        self.echoes.retain(|&(at, sensor)| {
            let is_heard = now.wrapping_sub(at) < 1 << 31;
            if is_heard {
                heard.push((at, sensor));
            }
            !is_heard
        });
        heard
    }
}

/// Runs a ring, and records its events.
fn run<const M: usize>(
    r: &mut Random,
    text: &mut Text,
    schedule: &Schedule<K, M>,
    promised: Option<[u32; 2]>,
    looks: u32,
) {
    let [t_delta, window] = promised.unwrap_or_else(|| [r.within(50, 900), schedule.min_refire().as_micros()]);
    let window = r.one_of(&[window, window - window / 3]);
    let (blanking, consecutive) = (r.up_to(1) * r.duration(3_000), r.one_of(&[2, 2, 3]));
    let period = schedule.period().as_micros();
    let path_change = r.one_of(&[NONE, NONE, 0, 100, t_delta / 2, t_delta + 300, 60_000]);
    let audible = r.one_of(&[NONE, NONE, window / 2, 2 * period, 4 * period]);
    let starts = [0, r.duration(300_000).wrapping_neg(), r.next() as u32];
    let start = r.one_of(&starts);
    text.add('L', [t_delta, window, blanking, consecutive.into(), path_change, audible, start]);
    let asked = |us: u32| (us != NONE).then_some(Micros::new(us));
    let mut config = RingConfig::new().with_blanking(Micros::new(blanking)).with_consecutive(consecutive);
    (config.t_delta, config.window) = (asked(t_delta), asked(window));
    (config.path_change, config.audible) = (asked(path_change), asked(audible));
    let mut ring = ScheduledBy::<M>::unverified(schedule, config, Instant::from_micros(start)).unwrap();
    ring.set_silence(silence(text, period));
    let mut watch = SensorWatch::<K>::new(0, Instant::from_micros(start));
    let sensors = schedule.sensors() as u8;
    let paths = [r.within(100, window), r.within(100, 2 * period)];
    let mut world = World {
        now: start,
        late: r.one_of(&[0, 0, 30, 300, 3_000, 100_000]),
        calm: r.one_of(&[1, 10, 100]),
        own: (0..sensors).map(|_| r.within(1, window)).collect(),
        path: r.one_of(&paths),
        path_only: r.once_in(2),
        echoes: vec![],
        looks,
    };
    for _ in 0..STEPS {
        world.turn_clock(r, ring.next_deadline().as_micros());
        for (at, sensor) in world.heard() {
            edge((r, text), &mut ring, sensor, at, looks);
        }
        if r.once_in(16 * world.calm) {
            operate(r, text, &mut ring, world.now);
            if text.0.lines().last().is_some_and(|line| line.starts_with('R')) {
                watch.restart(Instant::from_micros(world.now));
            }
        }
        for _ in 0..20 {
            let event = ring.poll(Instant::from_micros(world.now));
            let numbers = [world.now, ring.next_deadline().as_micros()];
            text.add('P', numbers.into_iter().chain(event.iter().flat_map(flat)));
            let Some(event) = event else { break };
            watch.observe(&event, Instant::from_micros(world.now));
            if let RingEvent::Reading(Reading { sensor, .. }) = event {
                let at = world.now.wrapping_add(100 * u32::from(sensor));
                let state = watch.state(sensor, Instant::from_micros(at)).unwrap();
                text.add('O', [sensor.into(), at].into_iter().chain(flat_state(state)));
            }
            let polls_again = Instant::from_micros(world.now).has_reached(ring.next_deadline()) || r.once_in(8);
            if let RingEvent::Fire { sensor, .. } = event {
                let mut fired = world.now;
                if r.once_in(24 * world.calm) {
                    text.add('K', [sensor.into()]);
                    ring.stuck(sensor).unwrap();
                }
                if r.once_in(8 * world.calm) {
                    let by = r.duration(4_000);
                    fired = if r.once_in(2) { fired.wrapping_add(by) } else { fired.wrapping_sub(by) };
                    correct(text, &mut ring, sensor, fired);
                }
                world.fired(r, sensor, fired);
            }
            if !polls_again {
                break;
            }
        }
    }
}

/// Picks one of the settings of silence, and records it.
fn silence(text: &mut Text, which: u32) -> Silence {
    text.add('G', [which % 3]);
    [Silence::NeverFree, Silence::NeedsAnswer, Silence::Trusted][which as usize % 3]
}

fn correct<const M: usize>(text: &mut Text, ring: &mut ScheduledBy<'_, M>, sensor: u8, at: u32) {
    text.add('F', [sensor.into(), at]);
    ring.fired(sensor, Instant::from_micros(at)).unwrap();
}

/// Performs a random operation on the ring.
fn operate<const M: usize>(r: &mut Random, text: &mut Text, ring: &mut ScheduledBy<'_, M>, now: u32) {
    let sensor = r.up_to(ring.sensors() as u32 - 1) as u8;
    match r.up_to(9) {
        0 => {
            text.add('R', [now]);
            ring.restart(Instant::from_micros(now));
        }
        1 => {
            let path_change = r.within(0, 1_000);
            text.add('C', [path_change]);
            ring.set_path_change(Micros::new(path_change)).unwrap();
        }
        2 => {
            let audible = r.duration(300_000);
            text.add('A', [audible]);
            ring.set_audible(Micros::new(audible)).unwrap();
        }
        // The reading of this firing may have been emitted.
        3 | 4 => correct(text, ring, sensor, now.wrapping_sub(r.duration(100_000))),
        what => {
            let on = what > 6;
            text.add('N', [sensor.into(), on.into()]);
            if on { ring.enable(sensor).unwrap() } else { ring.disable(sensor).unwrap() }
        }
    }
}

fn run_phases<const M: usize>(r: &mut Random, text: &mut Text, looks: u32) {
    let (period, sensors, rows) = schedule(r, text, M as u32);
    let lags = vec![Micros::ZERO; sensors as usize];
    let rows: [&[Micros]; M] = std::array::from_fn(|phase| rows[phase].as_slice());
    run(r, text, &Schedule::<K, M>::from_slices(Micros::new(period), &lags, rows).unwrap(), None, looks);
}

fn run_two_phases(r: &mut Random, text: &mut Text, looks: u32) {
    let (period, sensors, rows) = schedule(r, text, 2);
    let lags = vec![Micros::ZERO; sensors as usize];
    let plain = Schedule::<K>::from_slices(Micros::new(period), &lags, [&rows[0], &rows[1]]).unwrap();
    let (schedule, promised) = if r.once_in(5) { (plain, None) } else { verify(r, text, plain) };
    run(r, text, &schedule, promised, looks);
}

fn run_table(seed: u64, text: &mut Text, looks: u32) {
    let mut r = Random(seed);
    match seed % 8 {
        6 => run_phases::<1>(&mut r, text, looks),
        7 => run_phases::<3>(&mut r, text, looks),
        _ => run_two_phases(&mut r, text, looks),
    }
}

/// The corpus, with this many rings with tables from the first seeds.
fn corpus(rings: u64) -> String {
    let mut text = Text(String::new());
    for seed in (0..rings).chain(RARE) {
        writeln!(text.0, "# table {seed}").unwrap();
        run_table(seed, &mut text, 0);
    }
    for seed in 0..rings.div_ceil(2) {
        writeln!(text.0, "# flow {seed}").unwrap();
        flow::run_any(&mut Random(seed), &mut text, 0);
    }
    for seed in 0..rings.div_ceil(4) {
        writeln!(text.0, "# table between {seed}").unwrap();
        run_table(seed, &mut text, LOOKS);
        writeln!(text.0, "# flow between {seed}").unwrap();
        flow::run_any(&mut Random(seed), &mut text, LOOKS);
    }
    text.0
}

#[test]
fn corpus_matches_golden() {
    if let Some(file) = std::env::var_os("EERUF_CORPUS") {
        let rings = std::env::var("EERUF_RINGS").map_or(RINGS, |rings| rings.parse().expect("a number of rings"));
        std::fs::write(file, corpus(rings)).expect("the corpus can be written");
    }
    let corpus = corpus(RINGS);
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(GOLDEN, golden::of(&corpus)).expect("the golden can be written");
    }
    let kept = std::fs::read_to_string(GOLDEN).expect("tests/data/ring-golden.txt");
    let differences = golden::differences(&kept, &corpus);
    assert!(
        differences.is_empty(),
        "core says something else than tests/data/ring-golden.txt:\n{differences}EERUF_CORPUS=FILE writes all lines, \
         to be compared with those of the commit before; EERUF_WRITE=1 writes the golden, and the commit says why"
    );
    golden::assert_complete(&kept);
}
