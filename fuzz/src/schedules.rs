//! Files of schedules, of two phases and of many, and of rings, even and uneven: an answer that holds what it promises,
//! or an error of one line.

use eeruf_core::Phase;
use eeruf_design::{PhaseFile, RingSpec};
use eeruf_files::parse;
use eeruf_sim::ScheduleFile;

use crate::one_line;

/// Reads the text as each of them: what is one kind of file is mostly an error of the others.
pub fn check(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    two_phases(text);
    many_phases(text);
    ring(text);
}

fn two_phases(text: &str) {
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

fn many_phases(text: &str) {
    let meant = PhaseFile::is_meant(text);
    let read = match parse::<PhaseFile>(text) {
        Ok(read) => read,
        Err(error) => return one_line(&error.to_string()),
    };
    let schedule = match read.schedule() {
        Ok(schedule) => schedule,
        Err(error) => return one_line(&error),
    };
    assert!(meant, "a schedule of many phases taken for one of two");
    let (sensors, phases) = (schedule.sensors(), schedule.phases());
    assert!((1..=64).contains(&sensors) && (2..=255).contains(&phases));
    for phase in 0..phases as u8 {
        let row: Vec<_> = (0..sensors).map(|sensor| schedule.t_fire(Phase(phase), sensor)).collect();
        assert!(row.iter().all(|fire| fire.is_some_and(|fire| fire < schedule.period())), "phase {phase}: {row:?}");
        assert_eq!(schedule.t_fire(Phase(phase), sensors), None);
    }
    assert_eq!(schedule.t_fire(Phase(phases as u8), 0), None);
}

fn ring(text: &str) {
    match RingSpec::from_text(text) {
        Ok(ring) => {
            assert!((1..=64).contains(&ring.sensors) && ring.window.as_micros() > 0, "{ring:?}");
            // What must be covered may grow, and never wraps.
            let more = ring.covering(eeruf_core::Micros::MAX);
            assert!(more.t_delta == eeruf_core::Micros::MAX && more.sensors == ring.sensors);
            assert_eq!(ring.problem().sensors, ring.sensors);
        }
        Err(error) => one_line(&error.to_string()),
    }
}
