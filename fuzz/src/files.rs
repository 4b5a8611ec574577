//! Every reader of files: whatever stands in one, there is an answer or an error of one line, never a panic, and what
//! was read holds what it promises.

use std::path::Path;

use arbitrary::Arbitrary;
use eeruf_core::Phase;
use eeruf_design::{RingSpec, parse};
use eeruf_logs::{Echo, Options, read_csv};
use eeruf_sim::{AnySchedule, ScheduleFile, World};

/// What the fuzzer makes up: which reader, and the text of the file.
#[derive(Arbitrary, Debug)]
pub struct Input<'a> {
    pub reader: Reader,
    pub text: &'a str,
}

/// A reader of files.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Reader {
    Schedule,
    Ring,
    World,
    Certificate,
    Log { speed_of_sound: u16, no_echo_m: u16 },
}

/// Reads the text.
pub fn check(input: &Input<'_>) {
    let file = Path::new("file");
    match input.reader {
        Reader::Schedule => match parse::<ScheduleFile>(input.text) {
            Ok(read) => match read.schedule() {
                Ok(schedule) => holds(&schedule),
                Err(error) => one_line(&error),
            },
            Err(error) => one_line(&error.to_string()),
        },
        Reader::Ring => match RingSpec::from_text(input.text) {
            Ok(ring) => assert!((1..=64).contains(&ring.sensors), "{ring:?}"),
            Err(error) => one_line(&error.to_string()),
        },
        Reader::World => match World::from_text(file, input.text) {
            Ok(world) => assert!(world.robots().iter().all(|robot| robot.sensors.len() <= 64)),
            Err(error) => one_line(&error.to_string()),
        },
        Reader::Certificate => {
            if let Err(error) = eeruf_check::check(input.text) {
                one_line(&error.to_string());
            }
        }
        Reader::Log { speed_of_sound, no_echo_m } => {
            let speed_of_sound = f64::from(speed_of_sound) + 1.0;
            let options =
                Options { speed_of_sound, no_echo_m: f64::from(no_echo_m) / 100.0, ..Options::default() };
            let mut readings = vec![];
            match read_csv(input.text.as_bytes(), file, &options, |_, reading| readings.push(*reading)) {
                Ok(report) => {
                    let of = |sensor| readings.iter().filter(|reading| reading.sensor == sensor).count();
                    let sensors = report.sensors.len();
                    assert!(sensors > 0 && (0..sensors).all(|sensor| of(sensor) as u64 == report.messages));
                    // Nothing from the range on that stands for silence is an echo.
                    let silent = |range_m: f64| range_m >= options.no_echo_m;
                    assert!(readings.iter().all(|reading| match reading.echo() {
                        Echo::At(range_m) => !silent(range_m),
                        _ => true,
                    }));
                }
                Err(error) => one_line(&error.to_string()),
            }
        }
    }
}

fn holds(schedule: &AnySchedule) {
    assert!((1..=64).contains(&schedule.sensors()));
    for phase in [Phase::A, Phase::B] {
        for sensor in 0..schedule.sensors() {
            assert!(schedule.t_fire(phase, sensor).is_some_and(|fire| fire < schedule.period()));
        }
    }
}

fn one_line(error: &str) {
    assert!(!error.is_empty() && !error.contains('\n'), "{error}");
}
