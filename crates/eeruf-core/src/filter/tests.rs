//! What the filter makes of firings in a row.

extern crate std;
use super::*;
use crate::reading::ReadingKind;
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
fn the_earliest_echo_that_repeats_is_accepted_whatever_comes_before_it() {
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
            age: Some(0)
        }
    );
}

#[test]
fn more_echoes_than_fit_leave_the_earliest() {
    let mut held = [NO_ECHO; 3];
    for echo in [7, 3, 9, 1, 8] {
        insert(&mut held, echo);
    }
    assert_eq!(held, [1, 3, 7]);
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
fn an_accepted_echo_that_fades_is_waited_for_before_a_later_one_is_accepted() {
    use ReadingKind::*;
    let mut filter = filter::<4>(100, 2).with_patience(3).unwrap();
    let mut seen = |firings: &[&[u32]]| kinds(&mut filter, firings);
    assert_eq!(seen(&[&[5000, 9000], &[5000, 9000], &[5000, 9000]]), [First, Accepted, Accepted]);
    assert_eq!(seen(&[&[9000], &[5050, 9000], &[9000], &[9000]]), [Rejected, Accepted, Rejected, Rejected]);
    assert_eq!(seen(&[&[9000], &[9000], &[5000, 9000], &[5000, 9000]]), [Accepted; 4]);
}

#[test]
fn silence_is_not_confirmed_while_an_echo_is_waited_for() {
    use ReadingKind::*;
    let firings: [&[u32]; 9] = [&[], &[], &[5000], &[5000], &[], &[], &[], &[5000], &[]];
    let mut patient = filter::<2>(100, 2).with_patience(2).unwrap();
    let seen = kinds(&mut patient, &firings);
    assert_eq!(seen, [NoEcho, Clear, First, Accepted, NoEcho, Clear, Clear, First, Clear]);
    let seen = kinds(&mut filter::<2>(100, 2), &firings);
    assert_eq!(seen, [NoEcho, Clear, First, Accepted, NoEcho, Clear, Clear, First, NoEcho]);
}

#[test]
fn an_echo_heard_in_one_phase_only_is_never_accepted_however_patient_the_filter() {
    for patience in 0..=15 {
        let mut filter = filter::<8>(100, 2).with_patience(patience).unwrap();
        let firings = [[3000, 9000], [7000, 12_000]].into_iter().cycle().take(60).collect::<Vec<_>>();
        let firings: Vec<&[u32]> = firings.iter().map(|echoes| &echoes[..]).collect();
        assert!(!kinds(&mut filter, &firings).contains(&ReadingKind::Accepted));
    }
}

#[test]
fn an_echo_that_is_waited_for_moves_as_expected() {
    let mut filter = filter::<2>(50, 2).with_patience(4).unwrap();
    let mut push = |us: &[u32]| {
        let echoes: Vec<_> = us.iter().map(|&us| Micros::new(us)).collect();
        filter.push_echoes(0, &echoes, -1_000).unwrap().kind
    };
    for t_echo in [10_000, 9_000, 8_000] {
        push(&[t_echo]);
    }
    push(&[]);
    assert_eq!(push(&[6_000]), ReadingKind::Accepted);
    for _ in 0..20 {
        push(&[]);
    }
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
    let error = filter::<1>(1, 2).with_patience(16).unwrap_err();
    assert_eq!(error.to_string(), "a patience of 16 firings; expected 0 to 15");
    let error = filter::<1>(1, 2).push(1, None).unwrap_err();
    assert_eq!(error.to_string(), "sensor 2; expected 1 to 1");
}

#[test]
fn a_sensor_with_one_echo_is_remembered_in_eight_bytes() {
    assert_eq!(size_of::<Tracker<1>>(), 8);
}

#[test]
fn an_echo_that_is_waited_for_holds_back_only_what_is_later_and_would_be_accepted() {
    use ReadingKind::*;
    // Another is heard twice of three times: not accepted anyway.
    let mut three = filter::<2>(100, 3).with_patience(5).unwrap();
    let seen = kinds(&mut three, &[&[1000], &[1000], &[1000], &[2000], &[2000]]);
    assert_eq!(seen, [First, Repeated, Accepted, Rejected, Repeated]);
    // The later one of two is missing.
    let mut two = filter::<2>(100, 2).with_patience(5).unwrap();
    let seen = kinds(&mut two, &[&[1000, 2000], &[1000, 2000], &[1000], &[1000]]);
    assert_eq!(seen, [First, Accepted, Accepted, Accepted]);
}

#[test]
fn an_echo_that_is_waited_for_takes_the_place_of_a_later_one_that_is_heard() {
    use ReadingKind::*;
    let mut filter = filter::<2>(100, 2).with_patience(5).unwrap();
    let seen = kinds(&mut filter, &[&[1000], &[1000], &[2000, 3000]]);
    assert_eq!(seen, [First, Accepted, Rejected]);
    let verdict = filter.push_echoes(0, &[1000, 2000].map(Micros::new), 0).unwrap();
    assert_eq!((verdict.kind, verdict.t_echo), (Accepted, Some(Micros::new(1000))));
}

#[test]
fn an_echo_that_is_waited_for_stands_behind_the_earlier_ones() {
    let mut filter = filter::<3>(100, 2).with_patience(5).unwrap();
    kinds(&mut filter, &[&[500, 1000], &[500, 1000], &[500]]);
    let verdict = filter.push_echoes(0, &[Micros::new(3000)], 0).unwrap();
    assert_eq!((verdict.kind, verdict.previous), (ReadingKind::Rejected, Some(Micros::new(500))));
}

#[test]
fn an_echo_that_is_waited_for_beyond_the_longest_time_is_no_silence() {
    let mut filter = filter::<2>(100, 3).with_patience(6).unwrap();
    let mut push = |us: &[u32], change| {
        let echoes: Vec<_> = us.iter().map(|&us| Micros::new(us)).collect();
        filter.push_echoes(0, &echoes, change).unwrap().kind
    };
    for _ in 0..3 {
        push(&[u32::MAX - 10], 0);
    }
    let silent = [push(&[], 1000), push(&[], 0), push(&[], 0)];
    assert_eq!(silent[..2], [ReadingKind::NoEcho; 2]);
}

#[test]
fn patience_is_for_sensors_that_report_several_echoes() {
    let firings: Vec<&[u32]> =
        [&[5000][..], &[5000], &[9000], &[9000], &[], &[], &[5000], &[5000]].into_iter().collect();
    let patient = &mut filter::<1>(100, 2).with_patience(8).unwrap();
    assert_eq!(kinds(patient, &firings), kinds(&mut filter::<1>(100, 2), &firings));
}
