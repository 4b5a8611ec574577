//! When the timetable of a hopping ring stands and when it moves: firings that come late, triggers that come after the
//! poll, and periods that are left out. What is heard across a move supports nothing.

use eeruf_core::{
    Instant, Micros, RingEvent,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    plan::Plan as _,
};

const PERIOD: u32 = 60_000;
const WINDOW: u32 = 36_000;
/// From one sensor's lag to the next.
const APART: u32 = 7_000;

const fn at(us: u32) -> Instant {
    Instant::from_micros(us)
}

/// A ring that begins at 0 and has room for more sensors than it has.
fn ring<const K: usize>(sensors: usize) -> HoppingRing<K> {
    let code = HoppingCode::shortest(sensors, 5, Micros::new(240)).unwrap();
    let lags = core::array::from_fn(|sensor| Micros::new(if sensor < sensors { sensor as u32 * APART } else { 0 }));
    let schedule = HoppingSchedule::new(code, Micros::new(PERIOD), lags).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW));
    // Without solo periods and new lags.
    HoppingRing::hopping(&schedule, HoppingSettings::DRIVING, listening, 1, at(0)).unwrap()
}

/// Polls for the sensor that is to fire next.
fn fires<const K: usize>(ring: &mut HoppingRing<K>, now: Instant) -> u8 {
    match ring.poll(now) {
        Some(RingEvent::Fire { sensor, .. }) => sensor,
        other => panic!("no firing but {other:?} at {now:?}"),
    }
}

// A firing up to a millisecond late moves nothing and a later one all that follow.
#[test]
fn lateness_up_to_a_millisecond_moves_nothing() {
    // How late the poll is, how long after it the trigger comes, and by how much that moves what follows.
    for (poll, trigger, moves) in [
        (1, 0, 0),
        (1000, 0, 0),
        (1001, 0, 1001),
        (5000, 0, 5000),
        (0, 1, 0),
        (0, 1000, 0),
        (0, 1001, 1001),
        (0, 5000, 5000),
        (400, 600, 0),
        // The trigger alone moves anything: what the poll was late the timetable had absorbed.
        (400, 601, 601),
    ] {
        let mut ring = ring::<8>(8);
        assert_eq!(fires(&mut ring, at(poll)), 0);
        ring.fired(0, at(poll + trigger)).unwrap();
        assert_eq!(ring.next_deadline(), at(APART + moves), "{poll} + {trigger}");
        assert_eq!(fires(&mut ring, at(APART + moves)), 1);
        assert_eq!(ring.plan().changes(), u8::from(moves > 0), "{poll} + {trigger}");
        assert_eq!(ring.next_deadline(), at(2 * APART + moves), "{poll} + {trigger}");
    }
}

/// Of some periods' firings whether what their sensors heard moves as the code says, as the readings are emitted: by
/// period of the firing and by sensor. `late` says of a sensor how late it is polled and triggered.
fn steady(ring: &mut HoppingRing<8>, periods: u32, late: impl Fn(u8) -> (u32, u32)) -> Vec<(u32, u8, bool)> {
    let (mut steady, mut next) = (Vec::new(), 0);
    let mut began = None;
    loop {
        let due = ring.next_deadline();
        // Sensors fire in the order of their lags; all that is due otherwise is polled for in time.
        let is_firing = ring.clone().poll(due).is_some_and(|event| matches!(event, RingEvent::Fire { .. }));
        let now = if is_firing { due + Micros::new(late(next).0) } else { due };
        match ring.poll(now).unwrap() {
            RingEvent::Fire { sensor, .. } => {
                ring.fired(sensor, now + Micros::new(late(sensor).1)).unwrap();
                next = (sensor + 1) % 8;
            }
            RingEvent::Reading(reading) => {
                let first = *began.get_or_insert(reading.period);
                if reading.period - first >= periods {
                    return steady;
                }
                let weighed = ring.plan().weighed(reading.sensor, 0).unwrap();
                steady.push((reading.period - first, reading.sensor, weighed.steady));
            }
            RingEvent::PeriodEnded(_) => {}
        }
    }
}

// Crosstalk moves as the code says while firings are late alike.
#[test]
fn equal_lateness_keeps_the_codes_shift() {
    // Whether the polls are late, the triggers after them, or both.
    for late in [(0, 0), (200, 0), (999, 0), (0, 30), (0, 200), (0, 999), (300, 600)] {
        let found = steady(&mut ring(8), 6, |_| late);
        assert!(found.len() >= 40 && found.iter().all(|&(_, _, steady)| steady), "{late:?}: {found:?}");
    }
}

#[test]
fn unequal_lateness_supports_nothing() {
    // Every other sensor is polled late, or triggered late: then no reading moves as the code says, once there have
    // been firings of both kinds.
    for late in [|sensor| (200 * u32::from(sensor % 2), 0), |sensor| (0, 200 * u32::from(sensor % 2))] {
        let found = steady(&mut ring(8), 6, late);
        assert!(found.len() >= 40 && found.iter().all(|&(_, _, steady)| !steady), "{found:?}");
    }
}

#[test]
fn what_is_heard_soon_after_a_restart_counts_for_nothing() {
    let mut ring = ring(8);
    let before = steady(&mut ring, 6, |_| (0, 0));
    assert!(before.iter().all(|&(_, _, steady)| steady), "{before:?}");
    let (now, changes) = (ring.next_deadline(), ring.plan().changes());
    ring.restart(now);
    let after = steady(&mut ring, 6, |_| (0, 0));
    assert!(after.iter().all(|&(period, _, steady)| period != 0 || !steady), "{after:?}");
    assert!(after.iter().all(|&(period, _, steady)| period < 3 || steady), "{after:?}");
    assert_eq!(ring.plan().changes(), changes + 1);
}

// A period is left out when its end is polled for more than a period late.
#[test]
fn period_polled_too_late_is_left_out() {
    // How late the end is polled for, when the next period ends, and how often firing times have changed.
    for (late, next_end, changes) in
        [(0, 2 * PERIOD, 0), (PERIOD, 2 * PERIOD, 0), (PERIOD + 1, 3 * PERIOD + 1, 1), (PERIOD + 9, 3 * PERIOD + 9, 1)]
    {
        let mut ring = ring::<8>(8);
        ring.pause();
        assert_eq!(ring.next_deadline(), at(PERIOD));
        assert!(matches!(ring.poll(at(PERIOD + late)), Some(RingEvent::PeriodEnded(_))));
        assert_eq!((ring.next_deadline(), ring.plan().changes()), (at(next_end), changes), "{late} us late");
    }
}

#[test]
fn a_ring_with_more_room_than_sensors_has_its_sensors_alone() {
    fn check<const K: usize>() {
        let mut ring = ring::<K>(5);
        let known = |sensor: u8| (ring.plan().t_lag(sensor.into()), ring.is_enabled(sensor));
        assert_eq!(known(4), (Some(Micros::new(4 * APART)), true));
        assert_eq!((known(5), known(6), known(200)), ((None, false), (None, false), (None, false)));
        assert_eq!(ring.plan().min_refire(), Micros::new(WINDOW));
        let mut fired = Vec::new();
        while fired.len() < 20 {
            let now = ring.next_deadline();
            match ring.poll(now) {
                Some(RingEvent::Fire { sensor, .. }) => fired.push(sensor),
                Some(RingEvent::Reading(_)) => {}
                Some(RingEvent::PeriodEnded(_)) => break,
                None => panic!("{fired:?}, then nothing is due at {now:?}"),
            }
        }
        assert_eq!(fired, [0, 1, 2, 3, 4], "room for {K}");
    }
    check::<5>();
    check::<8>();
    check::<64>();
}
