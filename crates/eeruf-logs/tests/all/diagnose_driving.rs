//! `diagnose` on the log of a ring that drives towards objects and away from them.

use eeruf_logs::{Firing, FiringLog, Settings, diagnose};

use crate::random::Random;

const SENSORS: usize = 6;
const PERIOD: i64 = 60_000;
const WINDOW: i64 = 36_000;

/// The log of a ring of this many phases, and the sender of each reading. Each pair has two paths, which shorten at 1
/// to 1.9 m/s until the robot is near, and lengthen again as it backs.
fn driven(seed: u64, periods: i64, phases: i64) -> FiringLog {
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
        nearest + rate * to_turn_s.abs()
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
    let mut edges: Vec<Vec<i64>> = vec![vec![]; SENSORS];
    for &(at, x, ..) in &fired {
        for (y, edges) in edges.iter_mut().enumerate() {
            for path in paths[x][y] {
                // The last of three echoes fades now and then.
                if random.below(10) > 0 {
                    edges.push(at + travel(path, at) as i64 + random.below(61) - 30);
                }
            }
        }
    }
    edges.iter_mut().for_each(|edges| edges.sort_unstable());
    let mut firings = vec![];
    for (at, sensor, period, phase) in fired {
        let first = edges[sensor].partition_point(|edge| *edge < at + 2_000);
        let heard = edges[sensor].get(first).filter(|edge| **edge <= at + WINDOW);
        firings.push(Firing {
            sensor: sensor as u8,
            fired_us: at,
            period: period as u32,
            phase: phase as u8,
            t_echo_us: heard.map(|edge| (edge - at) as u32),
            reading: None,
            g_us_ms: None,
        });
    }
    FiringLog::new("test", firings)
}

// The log says that it cannot tell, whatever the number of phases.
#[test]
fn no_sender_is_named_while_the_robot_drives() {
    for phases in [2, 10] {
        let found = diagnose(&driven(1, 400, phases), &Settings::default());
        assert!(found.moved && found.named.iter().all(Option::is_none) && found.paths.is_empty(), "{phases}");
        assert_eq!(found.faults, [], "{phases}");
    }
}

// If echoes stay the same, as along a corridor, or a log is short, odometry says that the robot drives.
#[test]
fn odometry_says_that_the_robot_drives() {
    let short = driven(1, 12, 10);
    assert!(!diagnose(&short, &Settings::default()).moved);
    let moved = |g_us_ms: f32| {
        let mut log = short.clone();
        log.firings.iter_mut().for_each(|firing| firing.g_us_ms = Some(g_us_ms));
        diagnose(&log, &Settings::default()).moved
    };
    assert_eq!([0.0, 0.1, 0.2, 6.0].map(moved), [false, false, true, true]);
}
