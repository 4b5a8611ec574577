//! A log of a hopping ring suffices: an [`EchoTracker`] that is handed the phase, the raw echo time and the
//! [`Weighed`](eeruf_core::hopping::Weighed) of each reading says what the ring said.

use std::collections::BTreeMap;

use eeruf_core::{
    Instant, Micros, ReadingKind, RingEvent,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    judge::{EchoTracker, Firing, Verdict},
};

use crate::common::random::Random;

const SENSORS: usize = 8;
const BLANKING: u32 = 2_000;
const WINDOW: u32 = 36_000;

fn ring(settings: HoppingSettings, seed: u32) -> HoppingRing<SENSORS> {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(60_000)).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
    let mut ring = HoppingRing::hopping(&schedule, settings, listening, seed, Instant::from_micros(0)).unwrap();
    // What the log does not say.
    ring.set_silence(eeruf_core::Silence::Trusted);
    ring
}

/// Odometry's expectation for a sensor: half of them see a wall that the robot leaves.
fn expected_change_us(sensor: u8) -> i32 {
    if sensor % 2 == 0 { 20 } else { i32::from(sensor) * 30 - 100 }
}

#[test]
fn a_tracker_does_from_the_log_what_the_rings_own_did() {
    let (mut kinds, mut solo, mut unsteady, mut changes) = (BTreeMap::<String, u32>::new(), 0, 0, 0);
    for seed in 0..12 {
        let settings = HoppingSettings::BALANCED.with_shift_after(10).with_shift_spacing(12);
        let (mut ring, mut random) = (ring(settings, seed as u32), Random(seed));
        let mut twin = EchoTracker::<SENSORS>::new(settings.tracker).unwrap();
        // When each sensor fired, what it is to report, and edges that are still to come.
        let (mut fired, mut raw, mut edges) = ([0; SENSORS], [None; SENSORS], Vec::<(u32, u8)>::new());
        let (mut periods, mut known) = (0, 0_u8);
        while periods < 200 {
            let now = ring.next_deadline().as_micros() + if random.up_to(9) == 0 { random.up_to(900) } else { 0 };
            edges.sort_unstable();
            while let Some(&(at, sensor)) = edges.first().filter(|edge| edge.0 <= now) {
                ring.echo(sensor, Instant::from_micros(at)).unwrap();
                edges.remove(0);
                // The first counts, unless it is too early, as one may be that the firing before has left over.
                let (place, since) = (usize::from(sensor), Micros::new(at.saturating_sub(fired[usize::from(sensor)])));
                let first =
                    raw[place].is_none_or(|first| first < Micros::new(BLANKING) && since >= Micros::new(BLANKING));
                if first && since <= Micros::new(WINDOW) {
                    raw[place] = Some(since);
                }
            }
            while let Some(event) = ring.poll_expecting(Instant::from_micros(now), expected_change_us) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        let at = now + if random.up_to(3) == 0 { random.up_to(40) } else { 0 };
                        ring.fired(sensor, Instant::from_micros(at)).unwrap();
                        // The other half hears mostly nothing, or what is random.
                        let length = match random.up_to(19) {
                            0 => 0,
                            1 => BLANKING - 1 - random.up_to(500),
                            2 => WINDOW + 1 + random.up_to(500),
                            3..=5 => BLANKING + random.up_to(WINDOW - BLANKING),
                            _ if sensor % 2 == 0 => 9_000 + 20 * periods + random.up_to(30),
                            6..=12 => 0,
                            _ => 9_000 + random.up_to(9_000),
                        };
                        (fired[usize::from(sensor)], raw[usize::from(sensor)]) = (at, None);
                        if random.up_to(60) == 0 {
                            ring.stuck(sensor).unwrap();
                        } else if length > 0 {
                            edges.push((at + length, sensor));
                        }
                    }
                    RingEvent::Reading(reading) => {
                        let place = usize::from(reading.sensor);
                        let change = expected_change_us(reading.sensor);
                        let weighed = ring.plan().weighed(reading.sensor, change).unwrap();
                        assert_eq!((weighed.changes, weighed.expected_change_us), (ring.plan().changes(), change));
                        if core::mem::replace(&mut known, weighed.changes) != weighed.changes {
                            twin.firing_changed();
                            changes += 1;
                        }
                        let says = match reading.kind {
                            ReadingKind::Late => Verdict {
                                kind: ReadingKind::Late,
                                t_echo: reading.t_echo,
                                previous: None,
                                age: twin.age(place),
                                explained_by: None,
                            },
                            kind @ (ReadingKind::Stuck | ReadingKind::TooEarly) => {
                                twin.skip(place, kind, raw[place], change).unwrap()
                            }
                            _ => {
                                let firing = Firing {
                                    phase: reading.phase,
                                    solo: weighed.solo,
                                    steady: weighed.steady,
                                    expected_change_us: weighed.expected_change_us,
                                };
                                twin.push(place, raw[place].as_slice(), firing).unwrap()
                            }
                        };
                        let said = Verdict {
                            kind: reading.kind,
                            t_echo: reading.t_echo,
                            previous: reading.previous,
                            age: reading.age,
                            explained_by: reading.explained_by,
                        };
                        assert_eq!(said, says, "seed {seed}, period {periods}: {reading:?}, {weighed:?}");
                        *kinds.entry(format!("{:?}", reading.kind)).or_default() += 1;
                        solo += u32::from(weighed.solo);
                        unsteady += u32::from(!weighed.steady);
                    }
                    RingEvent::PeriodEnded(_) => {
                        periods += 1;
                        if periods % 50 == 0 {
                            ring.disable(3).unwrap();
                            assert!(!ring.is_enabled(3) && ring.is_enabled(4));
                        } else if periods % 50 == 10 && periods > 50 {
                            ring.enable(3).unwrap();
                            twin.forget(3);
                            assert!(ring.is_enabled(3));
                        }
                    }
                }
            }
        }
    }
    for kind in ["Accepted", "Tentative", "Rejected", "First", "NoEcho", "Clear", "Stuck", "TooEarly", "Late"] {
        assert!(kinds.contains_key(kind), "no reading was {kind}: {kinds:?}");
    }
    assert!(solo > 20 && unsteady > 20 && changes > 20, "{solo} {unsteady} {changes}");
    assert!(ring(HoppingSettings::BALANCED, 1).plan().weighed(SENSORS as u8, 0).is_none());
}

// A firing that was late by what the caller says makes its reading unsteady.
#[test]
fn lateness_by_the_caller_makes_reading_unsteady() {
    for (late, steady) in [(0, true), (3000, false)] {
        let mut ring = ring(HoppingSettings::BALANCED, 1);
        let (mut periods, mut readings) = (0, 0);
        while periods < 3 {
            let now = ring.next_deadline();
            while let Some(event) = ring.poll(now) {
                match event {
                    RingEvent::Fire { sensor, .. } if periods == 2 && sensor == 1 => {
                        ring.fired(sensor, now + Micros::new(late)).unwrap();
                    }
                    RingEvent::Reading(reading) if periods == 2 && reading.sensor == 1 => {
                        assert_eq!(
                            ring.plan().weighed(1, 0).map(|weighed| weighed.steady),
                            Some(steady),
                            "{late} us late"
                        );
                        readings += 1;
                    }
                    RingEvent::PeriodEnded(_) => periods += 1,
                    _ => {}
                }
            }
        }
        assert!(readings > 0);
    }
}
