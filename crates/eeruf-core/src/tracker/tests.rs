//! The tracker over consecutive firings, without the faults of patience.

extern crate std;
use super::*;
use crate::schedule::Phase;
use std::string::ToString;
use std::vec::Vec;

const PHASES: u8 = 11;

fn us(us: u32) -> Option<Micros> {
    Some(Micros::new(us))
}

fn balanced() -> EchoTracker<1> {
    EchoTracker::new(TrackerSettings::BALANCED).unwrap()
}

/// Pushes one echo time after the other, in phases that follow on each other from 0.
fn kinds(tracker: &mut EchoTracker<1>, echoes: impl IntoIterator<Item = Option<Micros>>) -> Vec<ReadingKind> {
    let mut push = |(firing, echo): (usize, Option<Micros>)| {
        tracker.push(0, echo.as_slice(), Firing::new(Phase((firing % usize::from(PHASES)) as u8)))
    };
    echoes.into_iter().enumerate().map(|echo| push(echo).unwrap().kind).collect()
}

#[test]
fn an_echo_from_two_phases_is_tentative_and_from_five_confirmed() {
    use ReadingKind::*;
    let seen = kinds(&mut balanced(), [us(9000); 6]);
    assert_eq!(seen, [First, Tentative, Tentative, Tentative, Accepted, Accepted]);
    let mut maps = EchoTracker::new(TrackerSettings::MAPS).unwrap();
    assert_eq!(kinds(&mut maps, [us(9000); 5]), [First, Rejected, Rejected, Rejected, Accepted]);
}

// An echo in one phase only is never believed however often it comes.
#[test]
fn echo_in_one_phase_is_never_believed() {
    let mut tracker = balanced();
    for _ in 0..300 {
        let verdict = tracker.push(0, &[Micros::new(9000)], Firing::new(Phase(4))).unwrap();
        assert!(matches!(verdict.kind, ReadingKind::First | ReadingKind::Rejected));
    }
}

// A reading of a sensor that fired alone is tentative at once and counts twice.
#[test]
fn lone_firing_is_tentative_and_counts_twice() {
    use ReadingKind::*;
    let mut tracker = balanced();
    let mut push = |phase, solo| {
        let firing = Firing { solo, ..Firing::new(Phase(phase)) };
        tracker.push(0, &[Micros::new(9000)], firing).unwrap().kind
    };
    assert_eq!([push(0, true), push(1, true), push(2, false)], [Tentative, Tentative, Accepted]);
}

// Crosstalk in one phase does not keep a belief alive whose wall has gone.
#[test]
fn crosstalk_in_one_phase_keeps_no_belief_alive() {
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 22]);
    assert_eq!(tracker.confirmed(0), us(9000));
    // The wall is now further away; the path of another sensor reads in phase 3 what the wall did.
    let echoes = (0..220).map(|firing| if firing % 11 == 3 { us(9000) } else { us(14_000) });
    let seen = kinds(&mut tracker, echoes);
    assert_eq!(tracker.confirmed(0), us(14_000));
    let late = &seen[44..];
    assert!(late.iter().enumerate().all(|(firing, &kind)| (kind == ReadingKind::Accepted) == (firing % 11 != 3)));
}

#[test]
fn one_silent_firing_is_not_clear_and_silence_in_five_phases_is() {
    use ReadingKind::*;
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 11]);
    let seen = kinds(&mut tracker, [None; 12]);
    assert_eq!(seen[..4], [NoEcho; 4]);
    assert_eq!(seen[11], Clear);
    assert!(tracker.is_clear(0));
}

#[test]
fn random_echoes_are_hardly_ever_believed() {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        us(2400 + (state >> 8) % 33_600)
    };
    let seen = kinds(&mut balanced(), (0..20_000).map(|_| random()));
    let believed = seen.iter().filter(|kind| matches!(kind, ReadingKind::Accepted | ReadingKind::Tentative)).count();
    let confirmed = seen.iter().filter(|kind| matches!(kind, ReadingKind::Accepted)).count();
    assert!(believed < 400 && confirmed < 40, "{believed}, {confirmed} of them confirmed, of 20,000");
}

#[test]
fn what_is_earlier_masks_and_what_is_later_contradicts() {
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 11]);
    // Crosstalk comes first in every second phase, at another time each.
    let masked = (0..110).map(|firing| if firing % 2 == 0 { us(4000 + 300 * (firing % 11)) } else { us(9000) });
    let seen = kinds(&mut tracker, masked);
    assert!((0..110).filter(|firing| firing % 2 == 1).all(|firing| seen[firing] == ReadingKind::Accepted));
    // What lies behind the wall is believed only after the wall has been contradicted.
    let seen = kinds(&mut tracker, [us(12_000); 11]);
    assert!(seen[..2].iter().all(|&kind| kind == ReadingKind::Rejected));
    assert_eq!((seen[10], tracker.confirmed(0)), (ReadingKind::Accepted, us(12_000)));
}

#[test]
fn an_echo_that_moves_faster_than_its_support_is_followed() {
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 11]);
    let seen = kinds(&mut tracker, (1..=20).map(|firing| us(9000 - 60 * firing)));
    assert!(seen.iter().all(|&kind| kind == ReadingKind::Accepted), "{seen:?}");
}

/// Number of the last 300 of 400 readings that are accepted of a robot that swings to and fro, ten firings each way,
/// while odometry expects 100 us from firing to firing and the echo moves by `part` of it. Each third firing hears
/// crosstalk.
fn accepted_of_a_swing(part: f64) -> usize {
    let mut tracker = balanced();
    let mut t_echo = 9000.0;
    let accepted = (0..400_u16).filter(|firing| {
        let expected_change_us = if firing / 10 % 2 == 0 { 100 } else { -100 };
        t_echo += part * f64::from(expected_change_us);
        let of = Firing { expected_change_us, ..Firing::new(Phase((firing % 11) as u8)) };
        let heard = if firing % 3 == 0 { 3000 + 301 * u32::from(firing % 11) } else { t_echo as u32 };
        let kind = tracker.push(0, &[Micros::new(heard)], of).unwrap().kind;
        *firing >= 100 && kind == ReadingKind::Accepted
    });
    accepted.count()
}

#[test]
fn share_of_expected_change_is_learned() {
    for part in [0.0, 0.5, 0.8, 1.0, 1.3, 2.0] {
        assert!(accepted_of_a_swing(part) >= 195, "{part}: {}", accepted_of_a_swing(part));
    }
    // Neither four times as much nor the contrary.
    assert!([4.0, -2.0].iter().all(|&part| accepted_of_a_swing(part) < 150));
}

#[test]
fn tracks_move_with_the_robot_also_while_readings_say_nothing() {
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 11]);
    for _ in 0..10 {
        tracker.skip(0, ReadingKind::TooEarly, us(100), -90).unwrap();
    }
    assert_eq!(tracker.confirmed(0), us(8100));
    assert_eq!(tracker.push(0, &[Micros::new(8100)], Firing::new(Phase(0))).unwrap().kind, ReadingKind::Accepted);
}

// A track stays where a change would move it before the firing or past the latest echo.
#[test]
fn track_stays_within_the_window_when_moved() {
    let confirmed_after = |t_echo, expected_change_us| {
        let mut tracker = balanced();
        kinds(&mut tracker, [us(t_echo); 11]);
        tracker.skip(0, ReadingKind::TooEarly, None, expected_change_us).unwrap();
        tracker.confirmed(0)
    };
    assert_eq!([confirmed_after(500, -500), confirmed_after(500, -501)], [us(0), us(500)]);
    assert_eq!([confirmed_after(LATEST - 9, 9), confirmed_after(LATEST - 9, 10)], [us(LATEST), us(LATEST - 9)]);
    // What no robot does counts as the most that one does.
    assert_eq!([confirmed_after(40_000, i32::MAX), confirmed_after(40_000, i32::MIN)], [us(72_767), us(7_232)]);
    let mut silent = balanced();
    kinds(&mut silent, [None; 11]);
    silent.skip(0, ReadingKind::TooEarly, None, 1000).unwrap();
    assert!(silent.is_clear(0));
}

#[test]
fn the_change_that_odometry_expects_moves_all_tracks() {
    let mut tracker = balanced();
    let push = |(phase, t_echo)| {
        let firing = Firing { expected_change_us: -1000, ..Firing::new(Phase(phase)) };
        tracker.push(0, &[Micros::new(t_echo)], firing).unwrap().kind
    };
    let seen: Vec<_> = (0..6).zip((0..6).map(|step| 20_000 - 1000 * step)).map(push).collect();
    assert_eq!(seen[4..], [ReadingKind::Accepted; 2]);
}

#[test]
fn a_firing_that_was_not_steady_supports_nothing() {
    let mut tracker = balanced();
    for phase in 0..PHASES {
        let firing = Firing { steady: false, ..Firing::new(Phase(phase)) };
        let kind = tracker.push(0, &[Micros::new(9000)], firing).unwrap().kind;
        assert_eq!(kind, ReadingKind::First);
    }
}

// A change of firing times takes support from what is not confirmed alone.
#[test]
fn changed_firing_times_take_unconfirmed_support() {
    let mut tracker = balanced();
    kinds(&mut tracker, [us(9000); 3]);
    tracker.firing_changed();
    assert_eq!(tracker.push(0, &[Micros::new(9000)], Firing::new(Phase(3))).unwrap().kind, ReadingKind::Rejected);
    kinds(&mut tracker, [us(9000); 11]);
    tracker.firing_changed();
    assert_eq!(tracker.push(0, &[Micros::new(9000)], Firing::new(Phase(0))).unwrap().kind, ReadingKind::Accepted);
}

// The longest times and the largest changes are echoes like any other.
#[test]
fn longest_times_and_largest_changes_are_echoes() {
    let mut tracker = balanced();
    for (phase, change) in (0..40).zip([i32::MAX, i32::MIN, 0, 1, -1].into_iter().cycle()) {
        let firing = Firing { expected_change_us: change, ..Firing::new(Phase(phase)) };
        tracker.push(0, &[Micros::MAX], firing).unwrap();
        tracker.push(0, &[Micros::ZERO], firing).unwrap();
        tracker.push(0, &[], firing).unwrap();
    }
}

#[test]
fn each_error_names_what_is_wrong_and_what_is_expected() {
    let with = |settings| EchoTracker::<1>::new(settings).unwrap_err().to_string();
    let zero = TrackerSettings { t_delta: Micros::ZERO, ..TrackerSettings::BALANCED };
    assert_eq!(with(zero), "t_delta is 0; expected 1 to 65535");
    let loose = TrackerSettings { tentative_within: Micros::new(151), ..TrackerSettings::BALANCED };
    assert_eq!(with(loose), "tentative_within is 151; expected 0 to 150");
    let few = TrackerSettings { votes: 1, ..TrackerSettings::BALANCED };
    assert_eq!(with(few), "votes is 1; expected 2 to 15");
    let error = balanced().push(1, &[], Firing::new(Phase(0))).unwrap_err();
    assert_eq!(error.to_string(), "sensor 2; expected 1 to 1");
}

#[test]
fn the_tracker_knows_each_sensors_age_as_its_verdicts_say_it() {
    let mut tracker = EchoTracker::<2>::new(TrackerSettings::BALANCED).unwrap();
    assert_eq!((tracker.age(0), tracker.age(1), tracker.age(2)), (None, None, None));
    for firing in 0..40_u8 {
        let echo = if firing % 10 < 6 { us(9000) } else { None };
        let verdict = tracker.push(1, echo.as_slice(), Firing::new(Phase(firing % PHASES))).unwrap();
        assert_eq!(tracker.age(1), verdict.age);
    }
    assert!(tracker.age(1).is_some());
    assert_eq!(tracker.age(0), None);
}

// A reading that takes the place of confirmed silence is not clear.
#[test]
fn reading_in_place_of_confirmed_silence_is_not_clear() {
    let mut tracker = EchoTracker::<1, 1>::new(TrackerSettings::BALANCED).unwrap();
    for phase in 0..5 {
        tracker.push(0, &[], Firing::new(Phase(phase))).unwrap();
        assert_eq!(tracker.is_clear(0), phase == 4);
    }
    // There is room for one track alone.
    tracker.push(0, &[Micros::new(9_000)], Firing::new(Phase(5))).unwrap();
    assert!(!tracker.is_clear(0));
}

// Confirmed, lost to silence, and back after a time: one reading confirms it again as long as it is remembered.
#[test]
fn confirmed_echo_is_remembered_for_longer_while_robot_moves() {
    let returns_after = |silent: u8, expected_change_us| {
        let mut tracker = EchoTracker::<1>::new(TrackerSettings::BALANCED.with_memory(5)).unwrap();
        kinds(&mut tracker, [us(9000); 5]);
        let mut push = |phase: u8, echo: Option<Micros>| {
            let firing = Firing { expected_change_us, ..Firing::new(Phase(phase % PHASES)) };
            tracker.push(0, echo.as_slice(), firing).unwrap().kind
        };
        // Less than a surplus could be told from.
        for phase in 5..5 + silent {
            push(phase, None);
        }
        push(5 + silent, us(9000)) == ReadingKind::Accepted
    };
    for (change, longest) in [(0, 5), (1, 15)] {
        let remembered: Vec<u8> = (3..80).filter(|&silent| returns_after(silent, change)).collect();
        assert_eq!(remembered, (3..=longest).collect::<Vec<u8>>(), "{change}");
    }
}
