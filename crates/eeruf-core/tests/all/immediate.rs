//! Promises of immediate refiring to a ring, one by one; `contract` has the slower test of the whole contract.

use eeruf_core::tables::TABLE_I_D;
use eeruf_core::{
    Instant, Micros, Phase, Schedule,
    plan::{ImmediateRefiring, Plan, Upcoming},
};

fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

fn at(ms: u32) -> Instant {
    Instant::from_micros(1000 * ms)
}

/// Two sensors whose waits are 10 and 55 ms, in periods of 100 ms.
fn schedule() -> Schedule<2> {
    Schedule::new(ms(100), [Micros::ZERO; 2], [[ms(10), ms(55)]; 2]).unwrap()
}

/// Polls at each deadline until an instant, and ends each firing after 5 ms; returns the firings.
fn firings(refiring: &mut ImmediateRefiring<'_, 2>, until: Instant) -> Vec<(u8, Instant)> {
    let mut fired = vec![];
    while until.has_reached(refiring.deadline()) {
        let now = refiring.deadline();
        if let Some(Upcoming { sensor, .. }) = refiring.poll(now) {
            refiring.ended(sensor, now + ms(5));
            fired.push((sensor, now));
        }
    }
    fired
}

// A sensor that fired later than it was polled waits for its refire time from then.
#[test]
fn late_sensor_waits_for_refire_from_its_firing() {
    let schedule = schedule();
    let mut refiring = ImmediateRefiring::new(&schedule, ms(40), at(0));
    assert!(matches!(refiring.poll(at(10)), Some(Upcoming { sensor: 0, .. })));
    refiring.postpone(0, ms(3));
    refiring.ended(0, at(20));
    assert_eq!((refiring.deadline(), refiring.next_firing()), (at(10 + 3 + 40), Some((0, Phase::B))));
}

// The end of a period does not change when a sensor that listens fires again.
#[test]
fn end_of_period_stays_when_listening_sensor_fires() {
    let schedule = schedule();
    let mut refiring = ImmediateRefiring::new(&schedule, ms(120), at(0));
    for now in [10, 55] {
        assert!(refiring.poll(at(now)).is_some());
    }
    assert_eq!(refiring.poll(at(100)), None);
    refiring.ended(0, at(101));
    assert_eq!((refiring.deadline(), refiring.next_firing()), (at(10 + 120), Some((0, Phase::B))));
}

// The end of the period is a deadline when no sensor is due before it.
#[test]
fn end_of_period_is_a_deadline() {
    let schedule = schedule();
    let mut refiring = ImmediateRefiring::new(&schedule, ms(400), at(0));
    firings(&mut refiring, at(60));
    assert_eq!((refiring.deadline(), refiring.next_firing()), (at(100), None));
}

// A disabled sensor does not fire until it is enabled, and no sensor fires during a pause.
#[test]
fn disabled_sensor_does_not_fire_until_enabled() {
    let schedule = schedule();
    let mut refiring = ImmediateRefiring::new(&schedule, ms(40), at(0));
    refiring.set_enabled(0, false);
    assert!(!refiring.is_enabled(0) && refiring.is_enabled(1));
    let fired = firings(&mut refiring, at(300));
    assert!(fired.len() > 3 && fired.iter().all(|&(sensor, _)| sensor == 1), "{fired:?}");
    refiring.set_enabled(0, true);
    refiring.set_paused(true);
    assert!(refiring.is_enabled(0) && firings(&mut refiring, at(600)).is_empty());
    refiring.set_paused(false);
    let fired = firings(&mut refiring, at(900));
    assert!([0, 1].iter().all(|sensor| fired.iter().any(|(fired, _)| fired == sensor)), "{fired:?}");
}

#[test]
fn no_sensor_beyond_the_last_is_enabled() {
    let refiring = ImmediateRefiring::new(&TABLE_I_D, Micros::ZERO, at(0));
    assert!((0..=u8::MAX).all(|sensor| refiring.is_enabled(sensor) == (sensor < 12)));
}

#[test]
fn each_sensor_has_its_own_phase_and_the_given_refire_time() {
    let mut refiring = ImmediateRefiring::new(&TABLE_I_D, ms(40), at(0));
    assert_eq!(refiring.min_refire(), ms(40));
    for phase in [Phase::A, Phase::B, Phase::A] {
        while refiring.next_firing().is_none() {
            refiring.end_period(refiring.deadline());
        }
        let due = refiring.deadline();
        let (sensor, fires_in) = refiring.next_firing().unwrap();
        refiring.fire(due);
        assert_eq!((fires_in, refiring.last_firing(sensor, 0).phase), (phase, phase));
        refiring.ended(sensor, due + ms(12));
        assert_eq!(refiring.last_firing(sensor, 0).phase, phase);
        // The others are silent meanwhile.
        for other in (0..12).filter(|&other| other != sensor) {
            refiring.set_enabled(other, false);
        }
    }
}
