//! `diagnose` on a ring whose paths are known: the simplest world there is, in which each pair has two paths.

use eeruf_logs::{Diagnosis, Firing, FiringLog, Settings, Symptom, diagnose, timing};

use crate::random::Random;

const SENSORS: usize = 6;
const PERIOD: i64 = 60_000;
const WINDOW: i64 = 36_000;

/// The ring and its faults.
struct World {
    /// Number of phases; 2 to 7.
    phases: i64,
    /// True if lags are redrawn every 50 periods.
    shifts: bool,
    deaf: Option<usize>,
}

impl World {
    const HEALTHY: Self = Self { phases: 7, shifts: true, deaf: None };

    /// The log of this many periods, and the sender of each reading.
    fn log(&self, seed: u64, periods: i64) -> (FiringLog, Vec<Option<usize>>) {
        let random = &mut Random(seed);
        let mut travel = [[[0; 2]; SENSORS]; SENSORS];
        for x in 0..SENSORS {
            for y in x..SENSORS {
                // Sound takes the same time in both directions.
                let two = [6_000 + random.below(12_000), 18_000 + random.below(22_000)];
                (travel[x][y], travel[y][x]) = (two, two);
            }
        }
        let mut lags = [0; SENSORS];
        let mut fired = vec![];
        for period in 0..periods {
            if period == 0 || self.shifts && period % 50 == 0 {
                lags = core::array::from_fn(|_| random.below(50_000));
            }
            let phase = period % self.phases;
            for (sensor, lag) in lags.iter().enumerate() {
                let wait = 240 * ((sensor as i64 + 1) * phase % 7);
                fired.push((period * PERIOD + lag + wait, sensor, period, phase));
            }
        }
        fired.sort_unstable();
        let mut edges: Vec<Vec<(i64, usize)>> = vec![vec![]; SENSORS];
        for &(at, x, ..) in &fired {
            for (line, edges) in edges.iter_mut().enumerate() {
                for travel in travel[x][line] {
                    // The last of three echoes fades now and then.
                    if random.below(20) > 0 {
                        edges.push((at + travel + random.below(61) - 30, x));
                    }
                }
            }
        }
        edges.iter_mut().for_each(|edges| edges.sort_unstable());
        let (mut firings, mut truth) = (vec![], vec![]);
        for (at, sensor, period, phase) in fired {
            let first = edges[sensor].partition_point(|edge| edge.0 < at + 2_000);
            let mut heard = edges[sensor].get(first).filter(|edge| edge.0 <= at + WINDOW).copied();
            if self.deaf == Some(sensor) {
                heard = None;
            }
            let sender = heard.map(|edge| edge.1);
            firings.push(Firing {
                sensor: sensor as u8,
                fired_us: at,
                period: period as u32,
                phase: phase as u8,
                t_echo_us: heard.map(|edge| (edge.0 - at) as u32),
                reading: None,
                g_us_ms: None,
            });
            truth.push(sender);
        }
        (FiringLog::new("test", firings), truth)
    }
}

/// The share of foreign readings that are named correctly, and the share of correct names.
fn named(log: &FiringLog, truth: &[Option<usize>], found: &Diagnosis) -> (f64, f64) {
    let (mut foreign, mut right, mut named) = (0, 0, 0);
    for ((firing, truth), name) in log.firings.iter().zip(truth).zip(&found.named) {
        let is_foreign = truth.is_some_and(|sender| sender != usize::from(firing.sensor));
        foreign += u32::from(is_foreign);
        if let Some(name) = name.filter(|name| name.sender != firing.sensor) {
            named += 1;
            right += u32::from(*truth == Some(usize::from(name.sender)));
        }
    }
    (f64::from(right) / f64::from(foreign.max(1)), f64::from(right) / f64::from(named.max(1)))
}

// Under many phases most senders are named and the names are right.
#[test]
fn many_phases_name_most_senders_rightly() {
    for seed in 1..=5 {
        let (log, truth) = World::HEALTHY.log(seed, 600);
        let found = diagnose(&log, &Settings::default());
        let (share, right) = named(&log, &truth, &found);
        assert!(share > 0.7 && right > 0.99, "seed {seed}: {share} named, {right} right");
        assert_eq!(found.faults, [], "seed {seed}");
        assert!(found.paths.iter().all(|path| path.accidents < 0.01 && path.offsets.0 <= path.offsets.1));
    }
}

// Under two phases no sender is named as two offsets prove nothing.
#[test]
fn two_phases_name_no_sender() {
    let (log, _) = World { phases: 2, shifts: false, ..World::HEALTHY }.log(1, 600);
    let found = diagnose(&log, &Settings::default());
    assert!(found.named.iter().all(Option::is_none) && found.paths.is_empty());
    assert!((2..=6).contains(&found.most_offsets), "{}", found.most_offsets);
}

// Fewer than 20 firings show no path.
#[test]
fn a_few_firings_show_no_path() {
    let (log, _) = World::HEALTHY.log(1, 19);
    assert_eq!(diagnose(&log, &Settings::default()).paths, []);
}

#[test]
fn a_deaf_sensor_whose_sound_others_hear_is_named() {
    for sensor in 0..SENSORS {
        let (log, _) = World { deaf: Some(sensor), ..World::HEALTHY }.log(1, 600);
        let found = diagnose(&log, &Settings::default());
        let named: Vec<_> = found.faults.iter().map(|of| (of.sensor, of.symptom)).collect();
        assert_eq!((&named[..], found.silent()), (&[(sensor, Symptom::Deaf)][..], vec![]));
    }
}

#[test]
fn timing_finds_drift_and_jitter_and_refuses_lags_that_moved() {
    let fires_at =
        |sensor: u8, phase: u8| (sensor < 4).then_some(15_000 * u32::from(sensor) + 1_000 * u32::from(phase));
    let random = &mut Random(7);
    let mut firings = vec![];
    for period in 0..500_u32 {
        for sensor in 0..4 {
            let phase = (period % 2) as u8;
            let due = f64::from(period) * 60_000.0 + f64::from(fires_at(sensor, phase).unwrap());
            // 40 millionths of drift, and up to 60 us of jitter, uniform.
            let fired_us = (due * 1.000_04 + random.below(61) as f64).round() as i64;
            firings.push(Firing { sensor, fired_us, period, phase, t_echo_us: None, reading: None, g_us_ms: None });
        }
    }
    let mut log = FiringLog::new("test", firings);
    let found = timing(&log, 60_000, fires_at).unwrap();
    assert!((found.drift_ppm - 40.0).abs() < 4.0 * found.drift_error_ppm && found.drift_error_ppm < 0.1, "{found:?}");
    assert!((found.jitter_us - 60.0 / 12_f64.sqrt()).abs() < 1.0, "{found:?}");
    assert!((55.0..=61.0).contains(&found.late_99_us), "{found:?}");
    let of_three = timing(&log, 60_000, |sensor, phase| fires_at(sensor, phase).filter(|_| sensor < 3));
    assert_eq!(of_three.unwrap_err(), "the log has sensor 4 in phase 0, which the schedule does not have");
    log.firings.iter_mut().filter(|firing| firing.sensor == 2 && firing.period > 250).for_each(|firing| {
        firing.fired_us += 5_000;
    });
    let moved = timing(&log, 60_000, fires_at).unwrap_err();
    assert!(moved.starts_with("35 % of the firings are more than 1 ms from the schedule"), "{moved}");
}

// A log is read as it was written and a clock of 32 bits may wrap.
#[test]
fn log_is_read_as_written_and_its_clock_may_wrap() {
    let (log, _) = World::HEALTHY.log(3, 50);
    let mut text = Vec::new();
    log.write(&mut text).unwrap();
    assert_eq!(FiringLog::read_from(&text[..], "log".as_ref()).unwrap(), log);
    let wrapped = "sensor,fired_us,period,phase,t_echo_us\n0,4294967000,0,0,\n1,5000,0,0,700\n";
    let read = FiringLog::read_from(wrapped.as_bytes(), "log".as_ref()).unwrap();
    assert_eq!((read.clock.as_str(), read.firings[1].fired_us), ("unnamed", 4_294_972_296));
    let said = |text: &str| FiringLog::read_from(text.as_bytes(), "log".as_ref()).unwrap_err().to_string();
    assert!(said("sensor,period,phase,t_echo_us\n0,0,0,\n").contains("no column `fired_us`"));
    assert_eq!(
        said("a,b\n"),
        "log: no column `sensor`; expected sensor, fired_us, period, phase, t_echo_us; `eeruf logs` says what else \
         the file holds"
    );
    let header = "# clock: board\nsensor,fired_us,period,phase,t_echo_us\n";
    assert_eq!(said(&format!("{header}64,0,0,0,\n")), "log, line 3: column sensor: `64`; expected 0 to 63");
    assert_eq!(
        said(&format!("{header}1,0,0,0,-5\n")),
        "log, line 3: column t_echo_us: `-5`; expected microseconds, or nothing"
    );
    assert_eq!(said(header), "log: 0 firings; expected one or more");
}
