//! Schedule files and ring files, even and uneven: the result keeps its promises, or the error takes one line.

use eeruf_core::Phase;
use eeruf_design::RingSpec;
use eeruf_files::parse;
use eeruf_sim::ScheduleFile;

use crate::one_line;

/// Reads the text as each kind of file; most texts are errors for all kinds but one.
pub fn check(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    schedule(text);
    ring(text);
}

fn schedule(text: &str) {
    let read = match parse::<ScheduleFile>(text) {
        Ok(read) => read,
        Err(error) => return one_line(&error.to_string()),
    };
    let schedule = match read.schedule() {
        Ok(schedule) => schedule,
        Err(error) => return one_line(&error),
    };
    assert!((1..=64).contains(&schedule.sensors()));
    for phase in [Phase::A, Phase::B] {
        for sensor in 0..schedule.sensors() {
            assert!(schedule.t_fire(phase, sensor).is_some_and(|fire| fire < schedule.period()));
        }
    }
    let again = toml::to_string(&ScheduleFile::from(&schedule)).expect("a schedule can be written");
    let again = parse::<ScheduleFile>(&again).expect("what was written is a schedule").schedule();
    assert_eq!(again.as_ref(), Ok(&schedule));
}

fn ring(text: &str) {
    match RingSpec::from_text(text) {
        Ok(ring) => {
            assert!((1..=64).contains(&ring.sensors) && ring.window.as_micros() > 0, "{ring:?}");
            // Larger values to cover saturate instead of wrapping.
            let more = ring.covering(eeruf_core::Micros::MAX);
            assert!(more.t_delta == eeruf_core::Micros::MAX && more.sensors == ring.sensors);
            assert_eq!(ring.problem().sensors, ring.sensors);
        }
        Err(error) => one_line(&error.to_string()),
    }
}
