//! Random logs of rings, with the share of wrong readings and which sensors fool which.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use eeruf_logs::{Doctor, Examination, Options, read_stream};

use crate::random::Random;

const SPEED_OF_SOUND: f64 = 343.2;

/// A log, and the truth about it.
pub(crate) struct Log {
    text: String,
    /// The share of the readings that are another's sound.
    pub(crate) wrong: f64,
    /// By sender and receiver, the share of the rounds in which the receiver is fooled.
    pub(crate) fooled: BTreeMap<(usize, usize), f64>,
}

impl Log {
    /// The doctor's findings.
    pub(crate) fn examine(&self) -> Examination {
        let (options, mut doctor) = (Options::default(), Doctor::new(SPEED_OF_SOUND));
        let report = read_stream(self.text.as_bytes(), "log".as_ref(), &options, |_, of| doctor.push(of)).unwrap();
        assert!(report.damage.is_empty(), "{:?}", report.damage);
        doctor.examine(&report.firing, &report.names())
    }
}

impl Random {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.below(1 << 30) as f64 / f64::from(1 << 30)
    }

    fn one_in(&mut self, n: i64) -> bool {
        self.below(n) == 0
    }
}

/// Own echo times of a sensor that stands, or that drives at up to 1 m/s past corners, in microseconds.
fn own(random: &mut Random, rounds: usize, step_s: f64, stands: bool) -> Vec<f64> {
    const NEAREST_US: f64 = 2_500.0;
    const FARTHEST_US: f64 = 22_000.0;
    let mut echo = random.between(3_500.0, 20_000.0);
    let mut speed = random.between(-1.0, 1.0);
    let mut next = || {
        if stands {
            return echo;
        }
        if random.between(0.0, 1.0) < step_s / 2.0 {
            speed = random.between(-1.0, 1.0);
        }
        echo += 2e6 * speed * step_s / SPEED_OF_SOUND;
        if !(NEAREST_US..FARTHEST_US).contains(&echo) {
            (speed, echo) = (-speed, echo.clamp(NEAREST_US, FARTHEST_US));
        }
        if random.one_in(250) {
            echo = random.between(NEAREST_US, FARTHEST_US);
        }
        echo
    };
    (0..rounds).map(|_| next()).collect()
}

/// Formatting of printed readings: with 12 us of scatter, and in every third log in whole centimetres.
struct Printed(bool);

impl Printed {
    fn draw(random: &mut Random) -> Self {
        Self(random.one_in(3))
    }

    fn range_m(&self, random: &mut Random, echo_us: f64) -> f64 {
        let noise: f64 = (0..12).map(|_| random.between(-0.5, 0.5)).sum();
        let range_m = 0.5e-6 * SPEED_OF_SOUND * (echo_us + 12.0 * noise);
        if self.0 { (range_m * 100.0).round().max(1.0) / 100.0 } else { range_m }
    }
}

/// Picks a sensor with occasional random readings, or none.
fn chatters(random: &mut Random, sensors: usize, chatters: bool) -> (usize, f64) {
    let (sensor, share) = (random.below(sensors as i64) as usize, random.between(0.1, 0.3));
    (if chatters { sensor } else { usize::MAX }, share)
}

/// Four modules that measure by themselves, each by its own clock, read in turn every 40 ms; every second robot drives;
/// with or without paths between them.
pub(crate) fn free_running(seed: u64, crosstalk: bool, chatter: bool) -> Log {
    const ROUNDS: usize = 1000;
    const MODULES: usize = 4;
    let random = &mut Random(seed);
    let stands = random.one_in(2);
    let periods = [0; MODULES].map(|_| random.between(48_800.0, 49_600.0));
    let phases = [0; MODULES].map(|_| random.between(0.0, 49_000.0));
    let own: Vec<_> = (0..MODULES).map(|_| own(random, ROUNDS, 0.16, stands)).collect();
    let mut paths = vec![];
    for pair in 0..MODULES * MODULES {
        if pair / MODULES != pair % MODULES && crosstalk && random.between(0.0, 1.0) < 0.35 {
            let speed = if stands { 0.0 } else { 2e6 * random.between(-0.3, 0.3) / SPEED_OF_SOUND };
            paths.push((pair / MODULES, pair % MODULES, 1e6 * random.between(1.0, 8.0) / SPEED_OF_SOUND, speed));
        }
    }
    let (printed, (chattering, share)) = (Printed::draw(random), chatters(random, MODULES, chatter));
    let (mut text, mut wrong) = ("time_s,sensor,range_m\n".to_owned(), 0);
    for round in 0..ROUNDS {
        for module in 0..MODULES {
            let read_us = 200_000.0 + 160_000.0 * round as f64 + 40_000.0 * module as f64;
            let last = |of: usize, at: f64| phases[of] + ((at - phases[of]) / periods[of]).floor() * periods[of];
            let fired = last(module, read_us) - periods[module];
            let mut heard = own[module][round];
            for &(sender, _, travel_us, speed) in paths.iter().filter(|path| path.1 == module) {
                let travel_us = travel_us + speed * ((0.16 * round as f64) % 10.0 - 5.0).abs();
                let first = last(sender, fired) - periods[sender];
                let sent = (0..4).map(|n| first + f64::from(n) * periods[sender] + travel_us - fired);
                heard = sent.filter(|after| *after > 800.0).fold(heard, f64::min);
            }
            wrong += u32::from(heard < own[module][round] - 150.0);
            if module == chattering && random.between(0.0, 1.0) < share {
                heard = random.between(900.0, heard);
            }
            let range_m = printed.range_m(random, heard);
            _ = writeln!(text, "{:.3},{},{range_m:.4}", read_us * 1e-6, module + 1);
        }
    }
    Log { text, wrong: f64::from(wrong) / (ROUNDS * MODULES) as f64, fooled: BTreeMap::new() }
}

/// A loop of a driving robot that fires each sensor when the echo of the one before has ended, a line for each round.
pub(crate) fn blocking_loop(seed: u64, crosstalk: bool) -> Log {
    let random = &mut Random(seed);
    let (sensors, rounds) = (2 + random.below(4) as usize, 200 * (1 + random.below(3) as usize));
    let wait_us = [100.0, 1_000.0, 5_000.0, 10_000.0, 30_000.0][random.below(5) as usize];
    let own: Vec<_> = (0..sensors).map(|_| own(random, rounds, 0.1, false)).collect();
    // A path of its own, or the second bounce of the sender's sound.
    let mut paths = BTreeMap::new();
    for pair in (0..sensors * sensors).filter(|pair| pair / sensors < pair % sensors) {
        if crosstalk && random.one_in(2) {
            let fixed = (random.below(10) < 7).then(|| wait_us + random.between(4_000.0, 30_000.0));
            paths.insert((pair / sensors, pair % sensors), fixed);
        }
    }
    let printed = Printed::draw(random);
    let names: Vec<_> = (1..=sensors).map(|sensor| format!("sonar{sensor}_m")).collect();
    let (mut text, mut fooled, mut wrong) = (names.join(",") + "\n", BTreeMap::<_, f64>::new(), 0.0);
    for round in 0..rounds {
        let (mut fired, mut now, mut cells) = (vec![], 0.0, vec![]);
        for receiver in 0..sensors {
            let (mut heard, mut by) = (own[receiver][round], None);
            for (&(sender, _), fixed) in paths.iter().filter(|((_, to), _)| *to == receiver) {
                let after = fired[sender] + fixed.unwrap_or(2.0 * own[sender][round] + 600.0) - now;
                if (400.0..heard).contains(&after) {
                    (heard, by) = (after, Some(sender));
                }
            }
            if let Some(sender) = by {
                *fooled.entry((sender, receiver)).or_default() += 1.0 / rounds as f64;
                wrong += 1.0 / (rounds * sensors) as f64;
            }
            fired.push(now);
            cells.push(format!("{:.4}", printed.range_m(random, heard)));
            now += heard + wait_us + 500.0;
        }
        text += &(cells.join(",") + "\n");
    }
    Log { text, wrong, fooled }
}

/// A healthy ring's kind: of firing stamps in turn or by alternating lags, of modules that are polled, or of a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Healthy {
    InTurn,
    Alternating,
    Polled,
    Server,
}

/// A ring of 300 rounds without crosstalk; every second robot drives, and in one of five logs one sensor sees an edge
/// between two walls.
pub(crate) fn healthy(seed: u64, kind: Healthy, chatter: bool) -> Log {
    const ROUNDS: usize = 300;
    if kind == Healthy::Polled {
        return free_running(seed, false, chatter);
    }
    let random = &mut Random(seed);
    let sensors = if kind == Healthy::Server { 2 + random.below(3) } else { 2 + random.below(7) } as usize;
    let stands = random.one_in(2);
    let gap_us = [33_000.0, 40_000.0, 60_000.0][random.below(3) as usize];
    let period_us = match kind {
        Healthy::InTurn => gap_us * sensors as f64,
        Healthy::Alternating => [60_000.0, 80_000.0][random.below(2) as usize],
        _ => [250_000.0, 1_000_000.0][random.below(2) as usize],
    };
    let own: Vec<_> = (0..sensors).map(|_| own(random, ROUNDS, period_us * 1e-6, stands)).collect();
    let (printed, (chattering, share)) = (Printed::draw(random), chatters(random, sensors, chatter));
    let (edge, behind) = (random.below(5 * sensors as i64) as usize, random.between(1_500.0, 9_000.0));
    let mut rows = vec![];
    for round in 0..ROUNDS {
        for sensor in 0..sensors {
            let (nth, of) = (sensor as f64, sensors as f64);
            let at = match kind {
                Healthy::InTurn => nth * gap_us + random.between(0.0, 400.0),
                Healthy::Alternating => 0.7 * period_us * nth / of + 3_000.0 * nth * (round % 2) as f64 / (of - 1.0),
                _ => period_us * (nth + random.between(0.0, 1.0)) / (of + 1.0),
            };
            let mut echo = own[sensor][round];
            if sensor == edge && random.below(10) < 3 {
                echo += behind;
            }
            if sensor == chattering && random.between(0.0, 1.0) < share {
                echo = random.between(900.0, echo);
            }
            rows.push((period_us * round as f64 + at, sensor, printed.range_m(random, echo)));
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = "time_s,sensor,range_m\n".to_owned();
    rows.iter().for_each(|(at, sensor, range_m)| _ = writeln!(text, "{:.6},{},{range_m:.4}", at * 1e-6, sensor + 1));
    Log { text, wrong: 0.0, fooled: BTreeMap::new() }
}
