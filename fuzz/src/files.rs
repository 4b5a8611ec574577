//! Every reader of files: whatever stands in one, there is an answer or an error of one line, never a panic, and what
//! was read holds what it promises.

use std::path::Path;

use arbitrary::Arbitrary;
use eeruf_core::Phase;
use eeruf_design::{RingSpec, parse};
use eeruf_sim::{AnySchedule, ScheduleFile, World};

use crate::program::log::{RangeScale, read_log_from};

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
            let scale = RangeScale { speed_of_sound, no_echo_m: f64::from(no_echo_m) / 100.0 };
            match read_log_from(input.text.as_bytes(), file, &scale) {
                Ok(columns) => {
                    let rows = columns.first().map_or(0, |column| column.t_echo.len());
                    assert!(!columns.is_empty() && columns.iter().all(|column| column.t_echo.len() == rows));
                    // Nothing from the range on that stands for silence is an echo.
                    let longest = 2e6 * scale.no_echo_m / scale.speed_of_sound + 1.0;
                    let mut echoes = columns.iter().flat_map(|column| &column.t_echo).flatten();
                    assert!(echoes.all(|echo| f64::from(echo.as_micros()) <= longest));
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
