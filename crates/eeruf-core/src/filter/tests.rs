//! The filter over consecutive firings.

extern crate std;
use super::*;
use crate::judging::Explained;
use crate::reading::{Explanation, ReadingKind};
use std::string::ToString;
use std::vec::Vec;

fn filter<const E: usize>(t_delta: u32, consecutive: u8) -> EchoFilter<1, E> {
    EchoFilter::new(Micros::new(t_delta), consecutive).unwrap()
}

fn kinds<const E: usize>(filter: &mut EchoFilter<1, E>, firings: &[&[u32]]) -> Vec<ReadingKind> {
    firings
        .iter()
        .map(|echoes| {
            let echoes: Vec<_> = echoes.iter().map(|&us| Micros::new(us)).collect();
            filter.push_echoes(0, &echoes, 0).unwrap().kind
        })
        .collect()
}

#[test]
fn two_readings_are_compared_as_the_paper_says() {
    use ReadingKind::*;
    let seen = kinds(&mut filter::<1>(100, 2), &[&[], &[], &[5000], &[5100], &[5201], &[], &[5201], &[5201], &[]]);
    assert_eq!(seen, [NoEcho, Clear, First, Accepted, Rejected, NoEcho, First, Accepted, NoEcho]);
}

#[test]
fn three_readings_must_each_agree_with_the_one_before() {
    use ReadingKind::*;
    let seen = kinds(&mut filter::<1>(100, 3), &[&[5000], &[5100], &[5200], &[5300], &[5401], &[5401], &[], &[], &[]]);
    assert_eq!(seen, [First, Repeated, Accepted, Accepted, Rejected, Repeated, NoEcho, NoEcho, Clear]);
}

#[test]
fn earliest_repeated_echo_is_accepted() {
    let mut filter = filter::<4>(100, 2);
    let us = |echoes: &[u32]| echoes.iter().map(|&us| Micros::new(us)).collect::<Vec<_>>();
    filter.push_echoes(0, &us(&[9000, 3000, 12000]), 0).unwrap();
    let verdict = filter.push_echoes(0, &us(&[12040, 9050, 5000]), 0).unwrap();
    assert_eq!(
        verdict,
        Verdict {
            kind: ReadingKind::Accepted,
            t_echo: Some(Micros::new(9050)),
            previous: Some(Micros::new(9000)),
            age: Some(0),
            explained_by: None,
        }
    );
}

#[test]
fn more_echoes_than_fit_leave_the_earliest() {
    let mut held = [NO_ECHO; 3];
    for echo in [7, 3, 9, 1, 8] {
        insert(&mut held, Micros::new(echo));
    }
    assert_eq!(held, [1, 3, 7].map(Micros::new));
}

#[test]
fn the_expected_change_is_taken_off_before_comparing() {
    let mut filter = filter::<1>(50, 2);
    let mut push = |us, change| filter.push_echoes(0, &[Micros::new(us)], change).unwrap().kind;
    push(10_000, 0);
    assert_eq!(push(9_000, -1_000), ReadingKind::Accepted);
    assert_eq!(push(8_051, -1_000), ReadingKind::Rejected);
    assert_eq!(push(u32::MAX - 1, i32::MAX), ReadingKind::Rejected);
}

#[test]
fn the_age_counts_firings_since_the_last_accepted_reading() {
    let mut filter = filter::<1>(50, 2);
    let mut age = |echo: Option<u32>| filter.push(0, echo.map(Micros::new)).unwrap().age;
    assert_eq!([age(Some(1000)), age(Some(1000)), age(None), age(None)], [None, Some(0), Some(1), Some(2)]);
    for _ in 0..70_000 {
        age(None);
    }
    assert_eq!(age(None), Some(65_534));
}

#[test]
fn a_forgotten_sensor_starts_again_but_does_not_grow_younger() {
    let mut filter = filter::<1>(50, 2);
    for _ in 0..2 {
        filter.push(0, Some(Micros::new(1000))).unwrap();
    }
    filter.forget(0).unwrap();
    let verdict = filter.push(0, Some(Micros::new(1000))).unwrap();
    assert_eq!((verdict.kind, verdict.age), (ReadingKind::First, Some(1)));
}

#[test]
fn errors_say_what_is_expected() {
    let error = EchoFilter::<1>::new(Micros::new(1), 9).unwrap_err();
    assert_eq!(error.to_string(), "9 consecutive readings; expected 2 to 8");
    let error = filter::<1>(1, 2).push(1, None).unwrap_err();
    assert_eq!(error.to_string(), "sensor 2; expected 1 to 1");
}

#[test]
fn a_sensor_with_one_echo_is_remembered_in_eight_bytes() {
    assert_eq!(size_of::<Tracker<1>>(), 8);
}

#[test]
fn echoes_of_alternate_firings_are_never_accepted() {
    let firings = [[3000, 9000], [7000, 12_000]].into_iter().cycle().take(60).collect::<Vec<_>>();
    let firings: Vec<&[u32]> = firings.iter().map(|echoes| &echoes[..]).collect();
    assert!(!kinds(&mut filter::<8>(100, 2), &firings).contains(&ReadingKind::Accepted));
}

/// Kinds of one sensor's readings, if sound explains all pairs of echoes up to a given time.
fn kinds_explained<const E: usize>(consecutive: u8, explained_to: u32, firings: &[&[u32]]) -> Vec<ReadingKind> {
    let agreement = Tolerance::new(Micros::new(100), Consecutive::new(consecutive).unwrap());
    let mut tracker = Tracker::<E>::NEW;
    let explained_to = Micros::new(explained_to);
    let mut push = |us: &[u32]| {
        let mut echoes = [NO_ECHO; E];
        us.iter().for_each(|&echo| insert(&mut echoes, Micros::new(echo)));
        let verdict = tracker.push(agreement, heard(&echoes), 0, |_, echo| {
            if echo <= explained_to { Explained::By(Explanation::Sensor(3)) } else { Explained::ByNothing }
        });
        assert_eq!(verdict.explained_by.is_some(), verdict.kind == ReadingKind::Ambiguous, "{verdict:?}");
        verdict.kind
    };
    firings.iter().map(|echoes| push(echoes)).collect()
}

#[test]
fn explained_echo_is_ambiguous_and_base_of_next_pair() {
    use ReadingKind::*;
    let seen = kinds_explained::<1>(2, 5040, &[&[5000], &[5030], &[5060], &[5090], &[], &[]]);
    assert_eq!(seen, [First, Ambiguous, Accepted, Accepted, NoEcho, Clear]);
}

#[test]
fn explained_echo_ends_a_run_of_three() {
    use ReadingKind::*;
    let seen = kinds_explained::<1>(3, 5040, &[&[5060], &[5080], &[5030], &[5060], &[5090], &[5090]]);
    assert_eq!(seen, [First, Repeated, Ambiguous, Repeated, Accepted, Accepted]);
}

#[test]
fn explained_echo_does_not_hide_a_later_one() {
    use ReadingKind::*;
    let seen = kinds_explained::<4>(2, 5040, &[&[5000, 9000], &[5000, 9000], &[5000], &[5000, 7000]]);
    assert_eq!(seen, [First, Accepted, Ambiguous, Ambiguous]);
}

#[test]
fn a_corrected_firing_shifts_known_echoes() {
    let agreement = Tolerance::new(Micros::new(100), Consecutive::new(2).unwrap());
    for (later_us, kind) in [(500, ReadingKind::Accepted), (-500, ReadingKind::Rejected)] {
        let mut tracker = Tracker::<1>::NEW;
        tracker.push(agreement, &[Micros::new(5500)], 0, |_, _| Explained::ByNothing);
        tracker.shift(later_us);
        assert_eq!(tracker.push(agreement, &[Micros::new(5000)], 0, |_, _| Explained::ByNothing).kind, kind);
    }
}
