//! Edges that count as the echo of a firing, to the microsecond.

use eeruf_core::{
    Instant, Micros, Reading, ReadingKind, Ring, RingConfig, RingError, RingEvent, Schedule, ScheduledRing,
    SensorError,
    flow::{BeliefSettings, FlowRing, TurnSettings},
    plan::ScheduledFiring,
};

const BLANKING: u32 = 1_000;
const WINDOW: u32 = 30_000;

fn schedule() -> Schedule<2> {
    let ms = |times: [u32; 2]| times.map(Micros::from_millis);
    Schedule::from_firing(Micros::from_millis(100), [ms([10, 55]), ms([20, 60])]).unwrap()
}

fn ring(schedule: &Schedule<2>) -> ScheduledRing<'_, 2> {
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::new(WINDOW));
    Ring::unverified(schedule, config.with_blanking(Micros::new(BLANKING)), Instant::from_micros(u32::MAX)).unwrap()
}

/// Polls until sensor 0 fires; returns the instant.
fn fire(ring: &mut ScheduledRing<'_, 2>) -> Instant {
    for _ in 0..100 {
        let now = ring.next_deadline();
        if let Some(RingEvent::Fire { sensor: 0, .. }) = ring.poll(now) {
            return now;
        }
    }
    panic!("sensor 0 never fires");
}

/// Polls until a reading of sensor 0 is emitted; returns the instant and the reading.
fn reading(ring: &mut ScheduledRing<'_, 2>) -> (Instant, Reading) {
    for _ in 0..100 {
        let now = ring.next_deadline();
        match ring.poll(now) {
            Some(RingEvent::Reading(reading)) if reading.sensor == 0 => return (now, reading),
            _ => {}
        }
    }
    panic!("sensor 0 has no reading");
}

/// The first reading of a ring with edges this long after the firing: kind, echo time, and instant of emission.
fn heard(edges: &[u32]) -> (ReadingKind, Option<u32>, u32) {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    let fired = fire(&mut ring);
    for &edge in edges {
        ring.echo(0, fired + Micros::new(edge)).unwrap();
    }
    let (now, reading) = reading(&mut ring);
    (reading.kind, reading.t_echo.map(Micros::as_micros), now.since(fired).as_micros())
}

// An echo lies between the end of the blanking time and the end of the window both included.
#[test]
fn echo_lies_between_blanking_and_window_inclusive() {
    assert_eq!(heard(&[]), (ReadingKind::NoEcho, None, WINDOW));
    assert_eq!(heard(&[0]), (ReadingKind::TooEarly, Some(0), WINDOW));
    assert_eq!(heard(&[BLANKING - 1]), (ReadingKind::TooEarly, Some(BLANKING - 1), WINDOW));
    assert_eq!(heard(&[BLANKING]), (ReadingKind::First, Some(BLANKING), BLANKING));
    assert_eq!(heard(&[WINDOW]), (ReadingKind::First, Some(WINDOW), WINDOW));
    assert_eq!(heard(&[WINDOW + 1]), (ReadingKind::NoEcho, None, WINDOW));
}

#[test]
fn earliest_edge_in_window_is_the_echo() {
    assert_eq!(heard(&[9_000, 5_000, 7_000]), (ReadingKind::First, Some(5_000), 9_000));
    assert_eq!(heard(&[300, 5_000]), (ReadingKind::First, Some(5_000), 5_000));
    assert_eq!(heard(&[5_000, 300]), (ReadingKind::First, Some(5_000), 5_000));
    assert_eq!(heard(&[300, 200]), (ReadingKind::TooEarly, Some(300), WINDOW), "the first to come in");
}

#[test]
fn an_edge_from_before_the_firing_belongs_to_nothing() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    let fired = fire(&mut ring);
    ring.echo(0, Instant::from_micros(fired.as_micros().wrapping_sub(1))).unwrap();
    assert_eq!(reading(&mut ring).1.kind, ReadingKind::NoEcho);
}

// The first edge after the window is reported once and one within it comes too late for its poll.
#[test]
fn late_edge_is_reported_once() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    ring.set_silence(eeruf_core::Silence::Trusted);
    let fired = fire(&mut ring);
    assert_eq!(reading(&mut ring).1.kind, ReadingKind::NoEcho);
    // The window is closed, but the edge is not late either.
    ring.echo(0, fired + Micros::new(WINDOW)).unwrap();
    for late in [WINDOW + 1, WINDOW + 2] {
        ring.echo(0, fired + Micros::new(late)).unwrap();
    }
    let (now, got) = reading(&mut ring);
    assert_eq!((got.kind, got.t_echo), (ReadingKind::Late, Some(Micros::new(WINDOW + 1))));
    assert_eq!((got.period, now.since(fired)), (0, Micros::new(WINDOW + 1)));
    // The next reading is of the next firing: silence again, and the late edge does not break the run.
    let next = reading(&mut ring).1;
    assert_eq!((next.kind, next.period), (ReadingKind::Clear, 1));
}

#[test]
fn a_late_edge_is_reported_at_once_when_no_sensor_listens() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    let fired = fire(&mut ring);
    assert_eq!(reading(&mut ring).1.kind, ReadingKind::NoEcho);
    let late = fired + Micros::new(WINDOW + 10_000);
    ring.echo(0, late).unwrap();
    assert_eq!(ring.next_deadline(), late);
    assert_eq!(reading(&mut ring).1.kind, ReadingKind::Late);
}

#[test]
fn high_line_makes_its_firing_stuck() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    // A sensor that has not fired cannot be stuck.
    ring.stuck(0).unwrap();
    let fired = fire(&mut ring);
    ring.stuck(0).unwrap();
    ring.echo(0, fired + Micros::new(9_000)).unwrap();
    let stuck = reading(&mut ring).1;
    assert_eq!((stuck.kind, stuck.t_echo), (ReadingKind::Stuck, None));
    let fired = fire(&mut ring);
    ring.echo(0, fired + Micros::new(9_000)).unwrap();
    assert_eq!(reading(&mut ring).1.kind, ReadingKind::First, "compared with nothing");
}

#[test]
fn held_line_counts_as_silent_once_it_has_fallen() {
    use ReadingKind::{Clear, First, NoEcho};
    let schedule = schedule();
    let mut ring = ring(&schedule);
    let mut next = |holds: bool, falls_in_window: bool, falls_after: bool, echo_us: Option<u32>| {
        let fired = fire(&mut ring);
        if holds {
            ring.holds(0).unwrap();
        }
        if falls_in_window {
            ring.answered(0).unwrap();
        }
        if let Some(us) = echo_us {
            ring.echo(0, fired + Micros::new(us)).unwrap();
        }
        let kind = reading(&mut ring).1.kind;
        if falls_after {
            // Twice: it counts once.
            ring.answered(0).unwrap();
            ring.answered(0).unwrap();
        }
        kind
    };
    assert_eq!(next(false, false, false, Some(9_000)), First);
    // Until the line falls there is no silence, and the next echo is compared with none before it.
    assert_eq!(next(true, false, false, None), NoEcho);
    assert_eq!(next(true, false, false, Some(9_000)), First);
    assert_eq!([next(true, false, true, None), next(true, false, false, None)], [NoEcho; 2]);
    assert_eq!(next(true, true, false, None), Clear, "the second that has fallen");
    assert_eq!(next(true, false, false, None), Clear, "held: as before");
    assert_eq!(next(false, false, false, None), NoEcho, "silence without a witness");
}

#[test]
fn a_sensor_that_is_not_there_is_named_in_the_error() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    let now = ring.next_deadline();
    let expected: Result<(), SensorError> = Err(SensorError { sensor: 2, sensors: 2 });
    assert_eq!(ring.echo(2, now), expected);
    assert_eq!(ring.stuck(2), expected);
    assert_eq!(ring.holds(2), expected);
    assert_eq!(ring.disable(2), expected);
    assert_eq!(ring.enable(2), expected);
    assert_eq!(ring.fired(2, now), expected);
    assert!(ring.is_enabled(1) && !ring.is_enabled(2));
}

#[test]
fn nor_is_one_that_the_ring_has_room_for_but_does_not_have() {
    let ms = |time| Micros::from_millis(time);
    let waits: [&[Micros]; 2] = [&[ms(10), ms(55)], &[ms(20), ms(60)]];
    let schedule = Schedule::<4>::from_slices(ms(100), &[Micros::ZERO; 2], waits).unwrap();
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::new(WINDOW));
    let mut ring = Ring::<_, _, 4>::unverified(&schedule, config, Instant::from_micros(0)).unwrap();
    for sensor in [2, 3, 4, 255] {
        let now = ring.next_deadline();
        let expected: Result<(), SensorError> = Err(SensorError { sensor, sensors: 2 });
        assert_eq!(ring.echo(sensor, now), expected);
        assert_eq!(ring.stuck(sensor), expected);
        assert_eq!(ring.disable(sensor), expected);
        assert_eq!(ring.enable(sensor), expected);
        assert_eq!(ring.fired(sensor, now), expected);
    }
}

#[test]
fn a_reading_says_the_phase_and_the_period_of_its_firing() {
    let schedule = schedule();
    let mut ring = ring(&schedule);
    for period in 0..6 {
        let due = fire_of_0(&mut ring);
        let RingEvent::Fire { phase, .. } = ring.poll(due).unwrap() else { panic!("sensor 0 fires") };
        let reading = reading(&mut ring).1;
        assert_eq!((reading.phase, reading.phase.0, reading.period), (phase, (period % 2) as u8, period));
    }
}

/// Polls until sensor 0 is next to fire; returns the due instant.
fn fire_of_0(ring: &mut ScheduledRing<'_, 2>) -> Instant {
    for _ in 0..100 {
        let now = ring.next_deadline();
        if matches!(ring.clone().poll(now), Some(RingEvent::Fire { sensor: 0, .. })) {
            return now;
        }
        ring.poll(now);
    }
    panic!("sensor 0 never fires");
}

#[test]
fn echoes_of_one_poll_are_emitted_by_firing_order() {
    let ms = |times: [u32; 2]| times.map(Micros::from_millis);
    let schedule = Schedule::from_firing(Micros::from_millis(100), [ms([10, 15]), ms([15, 10])]).unwrap();
    let mut ring = ring(&schedule);
    for period in 0..4 {
        let mut fired = vec![];
        while fired.len() < 2 {
            let now = ring.next_deadline();
            if let Some(RingEvent::Fire { sensor, .. }) = ring.poll(now) {
                fired.push(sensor);
            }
        }
        let edge = ring.next_deadline();
        // Edges are reported in order of sensors, either of which may have fired first.
        for sensor in [0, 1] {
            ring.echo(sensor, edge).unwrap();
        }
        let read = [0, 1].map(|_| match ring.poll(edge) {
            Some(RingEvent::Reading(reading)) => reading.sensor,
            other => panic!("{other:?}"),
        });
        assert_eq!(read[..], fired, "period {period}");
    }
}

#[test]
fn several_echoes_are_heard_until_window_closes() {
    let schedule = schedule();
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::new(WINDOW)).with_echoes::<2>();
    let mut ring = Ring::<_, _, 2, 2>::unverified(&schedule, config, Instant::from_micros(0)).unwrap();
    // The first echo differs each time, the second is the same.
    let mut first = [4_000, 6_000, 8_000].into_iter();
    let (mut fired, mut read) = (Instant::from_micros(0), vec![]);
    while read.len() < 3 {
        let now = ring.next_deadline();
        match ring.poll(now) {
            Some(RingEvent::Fire { sensor: 0, .. }) => {
                fired = now;
                for edge in [first.next().unwrap(), 20_000] {
                    ring.echo(0, fired + Micros::new(edge)).unwrap();
                }
            }
            Some(RingEvent::Reading(reading)) if reading.sensor == 0 => {
                assert_eq!(now.since(fired), Micros::new(WINDOW));
                read.push((reading.kind, reading.t_echo.unwrap().as_micros()));
            }
            _ => {}
        }
    }
    let expected = [(ReadingKind::First, 4_000), (ReadingKind::Accepted, 20_000), (ReadingKind::Accepted, 20_000)];
    assert_eq!(read, expected);
}

/// Reasons why a ring and a flow ring of two sensors with room for `K` are refused, if they are.
fn refused<const K: usize>() -> [Option<RingError>; 2] {
    let (schedule, now) = (schedule(), Instant::from_micros(0));
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::new(WINDOW));
    let ring = Ring::<_, _, K>::with_plan(ScheduledFiring::new(&schedule, now), config, now);
    let in_turn = FlowRing::<K>::flow(
        2,
        TurnSettings::new(1),
        BeliefSettings::DEFAULT,
        RingConfig::new().with_window(Micros::new(WINDOW)),
        now,
    );
    [ring.err(), in_turn.err()]
}

#[test]
fn room_for_more_than_64_sensors_is_refused() {
    // With 256 a ring never found the sensor whose echo had come: `0..256 as u8` is empty.
    assert_eq!(refused::<64>(), [None; 2]);
    assert_eq!(refused::<65>(), [Some(RingError::Room { capacity: 65 }); 2]);
    assert_eq!(refused::<256>(), [Some(RingError::Room { capacity: 256 }); 2]);
    assert_eq!(RingError::Room { capacity: 256 }.to_string(), "room for 256 sensors; expected at most 64");
}
