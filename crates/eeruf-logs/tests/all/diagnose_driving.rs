//! `diagnose` on the log of a ring that drives towards objects and away from them, with known senders and rates of
//! their paths.

use eeruf_logs::{Diagnosis, Firing, FiringLog, Settings, diagnose};

use crate::random::Random;

const SENSORS: usize = 6;
const PERIOD: i64 = 60_000;
const WINDOW: i64 = 36_000;

/// A sound in flight: its sender, and the change of its path in microseconds per second.
type Sent = (usize, f64);

/// The log of a ring of this many phases, and the sender of each reading. Each pair has two paths, which shorten at 1
/// to 1.9 m/s until the robot is near, and lengthen again as it backs.
fn driven(seed: u64, periods: i64, phases: i64) -> (FiringLog, Vec<Option<Sent>>) {
    let random = &mut Random(seed);
    let mut paths = [[[(0.0, 0.0); 2]; SENSORS]; SENSORS];
    for x in 0..SENSORS {
        for y in x..SENSORS {
            let mut path = |from: i64, until: i64| {
                let (nearest, rate) = (from + random.below(until - from), 3_000 + random.below(2_500));
                (nearest as f64, rate as f64)
            };
            let two = [path(4_000, 9_000), path(12_000, 26_000)];
            (paths[x][y], paths[y][x]) = (two, two);
        }
    }
    // To and fro in 4.7 seconds, which no third of a log is a multiple of.
    let travel = |(nearest, rate): (f64, f64), at_us: i64| {
        let to_turn_s = 1e-6 * (at_us.rem_euclid(4_700_000) - 2_350_000) as f64;
        (nearest + rate * to_turn_s.abs(), rate * to_turn_s.signum())
    };
    let lags: [i64; SENSORS] = core::array::from_fn(|sensor| 9_000 * (sensor as i64 * 5 % SENSORS as i64));
    let mut fired = vec![];
    for period in 0..periods {
        let phase = period % phases;
        // The powers of 2 modulo 11.
        let code = (0..phase).fold(1, |power, _| power * 2 % 11);
        for (sensor, lag) in lags.iter().enumerate() {
            let wait = 300 * ((sensor as i64 + 1) * code % 11);
            fired.push((period * PERIOD + lag + wait, sensor, period, phase));
        }
    }
    fired.sort_unstable();
    let mut edges: Vec<Vec<(i64, Sent)>> = vec![vec![]; SENSORS];
    for &(at, x, ..) in &fired {
        for (y, edges) in edges.iter_mut().enumerate() {
            for path in paths[x][y] {
                // The last of three echoes fades now and then.
                if random.below(10) > 0 {
                    let (travel_us, rate) = travel(path, at);
                    edges.push((at + travel_us as i64 + random.below(61) - 30, (x, rate)));
                }
            }
        }
    }
    edges.iter_mut().for_each(|edges| edges.sort_by_key(|edge| edge.0));
    let (mut firings, mut truth) = (vec![], vec![]);
    for (at, sensor, period, phase) in fired {
        let first = edges[sensor].partition_point(|edge| edge.0 < at + 2_000);
        let heard = edges[sensor].get(first).filter(|edge| edge.0 <= at + WINDOW);
        firings.push(Firing {
            sensor: sensor as u8,
            fired_us: at,
            period: period as u32,
            phase: phase as u8,
            t_echo_us: heard.map(|edge| (edge.0 - at) as u32),
            reading: None,
            g_us_ms: None,
        });
        truth.push(heard.map(|edge| edge.1));
    }
    (FiringLog::new("test", firings), truth)
}

/// The share of foreign readings that are named correctly, and the share of correct names.
fn named(log: &FiringLog, truth: &[Option<Sent>], found: &Diagnosis) -> (f64, f64) {
    let (mut foreign, mut right, mut named) = (0, 0, 0);
    for ((firing, truth), name) in log.firings.iter().zip(truth).zip(&found.named) {
        let sender = truth.map(|(sender, _)| sender);
        foreign += u32::from(sender.is_some_and(|sender| sender != usize::from(firing.sensor)));
        if let Some(name) = name.filter(|name| name.sender != firing.sensor) {
            named += 1;
            right += u32::from(sender == Some(usize::from(name.sender)));
        }
    }
    (f64::from(right) / f64::from(foreign.max(1)), f64::from(right) / f64::from(named.max(1)))
}

// Most senders are named, and the names are right; fewer than in a room, where all objects ahead come nearer at one
// rate.
#[test]
fn senders_are_named_while_the_robot_drives() {
    for seed in 1..=3 {
        let (log, truth) = driven(seed, 400, 10);
        let found = diagnose(&log, &Settings::default());
        let (share, right) = named(&log, &truth, &found);
        assert!(found.moved, "seed {seed}");
        assert!(share > 0.45 && right > 0.97, "seed {seed}: {share} named, {right} right");
        assert_eq!(found.faults, [], "seed {seed}");
    }
}

// A line has the rate of the path that its readings came along.
#[test]
fn paths_of_a_driving_robot_have_their_rates() {
    let (log, truth) = driven(1, 400, 10);
    let found = diagnose(&log, &Settings::default());
    let (mut right, mut of) = (0, 0);
    for path in found.paths.iter().filter(|path| path.readings >= 8) {
        let rate_us_s = path.rate_us_s.unwrap();
        let readings = log.firings.iter().zip(&truth).filter(|(firing, truth)| {
            firing.sensor == path.receiver
                && (path.periods.0..=path.periods.1).contains(&firing.period)
                && truth.is_some_and(|(sender, _)| sender == usize::from(path.sender))
        });
        let is_right = |rate: f64| (rate_us_s - rate).abs() < 300.0;
        let mut rates = readings.filter_map(|(_, truth)| *truth).map(|(_, rate)| rate);
        right += u32::from(rates.any(is_right));
        of += 1;
    }
    assert!(of >= 20 && f64::from(right) > 0.9 * f64::from(of), "{right} of {of}");
}

// Two phases name no sender of a robot that drives either.
#[test]
fn two_phases_name_no_sender_while_driving() {
    let (log, _) = driven(1, 400, 2);
    let found = diagnose(&log, &Settings::default());
    assert!(found.moved && found.named.iter().all(Option::is_none) && found.paths.is_empty());
}

// If echoes stay the same, as along a corridor, or a log is short, odometry says that the robot drives.
#[test]
fn odometry_says_that_the_robot_drives() {
    let (short, _) = driven(1, 12, 10);
    assert!(!diagnose(&short, &Settings::default()).moved);
    let moved = |g_us_ms: f32| {
        let mut log = short.clone();
        log.firings.iter_mut().for_each(|firing| firing.g_us_ms = Some(g_us_ms));
        diagnose(&log, &Settings::default()).moved
    };
    assert_eq!([0.0, 0.1, 0.2, 6.0].map(moved), [false, false, true, true]);
}
