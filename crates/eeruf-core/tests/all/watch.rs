//! Functions for firmware while a ring runs: the state in front of each sensor, blind sensors, pauses.

use eeruf_core::tables::PAPER_12;
use eeruf_core::{
    Instant, Micros, Phase, Reading, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, SensorError, Silence,
    judge::Explanation,
    watch::{Doubt, SensorState, SensorWatch},
};

fn at(us: u32) -> Instant {
    Instant::from_micros(us)
}

fn ring(start: u32) -> ScheduledRing<'static, 12> {
    let mut ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), at(start)).unwrap();
    ring.set_silence(Silence::Trusted);
    ring
}

/// Runs for several periods; `echo(sensor, period)` is the echo that each sensor hears. Returns the end of the run, and
/// the sensors that became blind.
fn run(
    ring: &mut ScheduledRing<'_, 12>,
    watch: &mut SensorWatch<12>,
    periods: u32,
    echo: impl Fn(u8, u32) -> Option<u32>,
) -> (Instant, Vec<(u32, u8)>) {
    let (mut period, mut blind) = (0, vec![]);
    loop {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            if let RingEvent::Fire { sensor, .. } = event {
                if let Some(echo) = echo(sensor, period) {
                    ring.echo(sensor, now + Micros::new(echo)).unwrap();
                }
            }
            blind.extend(watch.observe(&event, now).map(|blind| (period, blind)));
            if let RingEvent::PeriodEnded(_) = event {
                period += 1;
                if period == periods {
                    return (now, blind);
                }
            }
        }
    }
}

#[test]
fn state_is_as_old_as_its_confirmation_through_a_wrap() {
    let start = u32::MAX - 3_000_000;
    let (mut ring, mut watch) = (ring(start), SensorWatch::<12>::new(0, at(start)));
    let nothing = SensorState::Unknown { since: Micros::ZERO, why: Doubt::NoFiring };
    assert_eq!(watch.state(4, at(start)), Ok(nothing));
    assert_eq!(watch.state(12, at(start)), Err(SensorError { sensor: 12, sensors: 12 }));
    // An echo until period 20, and then silence: confirmed clear.
    let (now, blind) = run(&mut ring, &mut watch, 20, |_, period| Some(9_000 + period));
    assert_eq!(blind, []);
    for sensor in 0..12 {
        let Ok(SensorState::Obstacle { t_echo, age }) = watch.state(sensor, now) else { panic!("sensor {sensor}") };
        assert!((9_018..=9_019).contains(&t_echo.as_micros()) && age < Micros::from_millis(130), "{t_echo} {age}");
    }
    let (now, _) = run(&mut ring, &mut watch, 5, |_, _| None);
    assert!(matches!(watch.state(0, now), Ok(SensorState::Clear { age }) if age < Micros::from_millis(130)));
    // A sensor that no longer fires: its state gets older, and after a turn of the clock it is half a turn old.
    ring.disable(0).unwrap();
    let (now, _) = run(&mut ring, &mut watch, 50_000, |_, _| None);
    assert_eq!(watch.state(0, now), Ok(SensorState::Clear { age: Micros::new(1 << 31) }));
    assert_eq!(size_of::<SensorWatch<12>>(), 12 * 16 + 8, "as its documentation says");
}

// Each reading updates what is known of the space in front of its sensor.
#[test]
fn each_reading_updates_the_state_before_its_sensor() {
    use ReadingKind::*;
    let mut watch = SensorWatch::<1>::new(0, at(0));
    let ms = Micros::from_millis;
    let obstacle = |age| SensorState::Obstacle { t_echo: Micros::new(9_000), age };
    let unknown = |since, why| SensorState::Unknown { since, why };
    let steps = [
        (First, unknown(Micros::ZERO, Doubt::Unsure)),
        (Rejected, unknown(ms(100), Doubt::Rejected)),
        (Accepted, obstacle(Micros::ZERO)),
        // One unconfirming reading leaves the obstacle, two end it.
        (Rejected, obstacle(ms(100))),
        (Accepted, obstacle(Micros::ZERO)),
        (NoEcho, obstacle(ms(100))),
        (Clear, SensorState::Clear { age: Micros::ZERO }),
        // The first echo ends what was clear.
        (First, unknown(Micros::ZERO, Doubt::Unsure)),
        (Tentative, obstacle(Micros::ZERO)),
        (Late, obstacle(ms(100))),
        (Ambiguous, obstacle(ms(200))),
        (Ambiguous, unknown(Micros::ZERO, Doubt::Ambiguous(Explanation::Sensor(3)))),
        (TooEarly, SensorState::TooClose { age: Micros::ZERO }),
        (Unanswered, SensorState::Unanswered { since: Micros::ZERO }),
        (Stuck, SensorState::Unanswered { since: ms(100) }),
        (NoEcho, unknown(Micros::ZERO, Doubt::Unsure)),
        (Clear, SensorState::Clear { age: Micros::ZERO }),
        (Unanswered, SensorState::Unanswered { since: Micros::ZERO }),
    ];
    // The first reading is not the last firing's: nothing has been known since the beginning.
    for (step, (kind, expected)) in (0..).zip(steps) {
        let now = at(100_000 * step);
        let reading = Reading {
            sensor: 0,
            phase: Phase::A,
            period: step,
            kind,
            t_echo: Some(Micros::new(9_000)),
            previous: None,
            age: None,
            explained_by: (kind == Ambiguous).then_some(Explanation::Sensor(3)),
        };
        watch.observe(&RingEvent::Reading(reading), now);
        assert_eq!(watch.state(0, now), Ok(expected), "after reading {step}, {kind}");
    }
}

// A sensor is blind if nothing is accepted for this many firings with an echo, and is named once.
#[test]
fn blind_sensor_is_named_once() {
    let (mut ring, mut watch) = (ring(0), SensorWatch::<12>::new(20, at(0)));
    // Sensor 4 hears a different echo each time, sensor 5 sometimes nothing, all others a wall.
    let echo = |sensor, period| match sensor {
        3 => Some(5_000 + 2_000 * (period % 10)),
        4 if period % 10 == 0 => None,
        4 => Some(5_000 + 2_000 * (period % 9)),
        _ => Some(9_000),
    };
    let (now, blind) = run(&mut ring, &mut watch, 100, echo);
    let named: Vec<_> = blind.iter().map(|&(_, sensor)| sensor).collect();
    assert_eq!(named, [3, 4]);
    assert!((19..=21).contains(&blind[0].0) && (21..=24).contains(&blind[1].0), "{blind:?}");
    assert!(matches!(watch.state(3, now), Ok(SensorState::Unknown { .. })));
    // Once something was accepted it may be named again.
    let (_, blind) = run(&mut ring, &mut watch, 5, |_, _| Some(9_000));
    assert_eq!(blind, []);
    let (_, blind) = run(&mut ring, &mut watch, 50, echo);
    assert_eq!(blind.len(), 2);
}

// A paused ring fires nothing, ends its readings and goes on after the pause.
#[test]
fn paused_ring_ends_readings_and_goes_on() {
    let mut ring = ring(0);
    let mut watch = SensorWatch::<12>::new(0, at(0));
    run(&mut ring, &mut watch, 10, |_, _| Some(9_000));
    // In the middle of a period, with readings pending.
    let mut fired = 0;
    while fired < 5 {
        let now = ring.next_deadline();
        if let Some(RingEvent::Fire { sensor, .. }) = ring.poll(now) {
            ring.echo(sensor, now + Micros::new(9_000)).unwrap();
            fired += 1;
        }
    }
    ring.pause();
    let (mut readings, mut ended) = (0, 0);
    while ended < 5 {
        match ring.poll(ring.next_deadline()) {
            Some(RingEvent::Fire { .. }) => panic!("fires in a pause"),
            Some(RingEvent::Reading(_)) => readings += 1,
            Some(RingEvent::PeriodEnded(_)) => ended += 1,
            None => {}
        }
    }
    assert!((1..=5).contains(&readings));
    // Enabling and disabling is no end of a pause.
    ring.disable(3).unwrap();
    ring.enable(3).unwrap();
    assert!(ring.is_enabled(3));
    let due = ring.next_deadline();
    assert!(matches!(ring.poll(due), Some(RingEvent::PeriodEnded(_))));
    ring.resume();
    let mut kinds = [const { vec![] }; 12];
    while kinds.iter().map(Vec::len).sum::<usize>() < 36 {
        let now = ring.next_deadline();
        match ring.poll(now) {
            Some(RingEvent::Fire { sensor, .. }) => ring.echo(sensor, now + Micros::new(9_000)).unwrap(),
            Some(RingEvent::Reading(reading)) => kinds[usize::from(reading.sensor)].push(reading.kind),
            _ => {}
        }
    }
    for kinds in kinds {
        assert_eq!(kinds[..2], [ReadingKind::First, ReadingKind::Accepted]);
    }
}

#[test]
fn a_larger_t_delta_takes_hold_at_once() {
    let mut ring = Ring::new(&PAPER_12, RingConfig::new().with_t_delta(Micros::new(100)), at(0)).unwrap();
    let mut watch = SensorWatch::<12>::new(0, at(0));
    let moving = |_, period: u32| Some(9_000 + 400 * period);
    run(&mut ring, &mut watch, 10, moving);
    assert!(matches!(watch.state(0, at(0)), Ok(SensorState::Unknown { .. })));
    ring.set_t_delta(Micros::new(500)).unwrap();
    let mut kinds = vec![];
    let mut now = at(0);
    let mut heard = [13_000; 12];
    while kinds.len() < 40 {
        now = ring.next_deadline();
        match ring.poll(now) {
            Some(RingEvent::Fire { sensor, .. }) => {
                heard[usize::from(sensor)] += 400;
                ring.echo(sensor, now + Micros::new(heard[usize::from(sensor)])).unwrap();
            }
            Some(RingEvent::Reading(reading)) => kinds.push(reading.kind),
            _ => {}
        }
    }
    assert!(now != at(0), "it goes on");
    // Readings of the firings in progress, and the first after the pause.
    assert!(kinds[26..].iter().all(|kind| *kind == ReadingKind::Accepted), "{kinds:?}");
}

#[test]
fn another_window_counts_at_once_for_firings_that_are_under_way() {
    let mut ring = ring(0);
    let first = ring.next_deadline();
    assert!(matches!(ring.poll(first), Some(RingEvent::Fire { .. })));
    while ring.poll(first).is_some() {}
    ring.set_window(Micros::from_millis(10)).unwrap();
    assert_eq!(ring.next_deadline(), first + Micros::from_millis(10));
    let reading = ring.poll(first + Micros::from_millis(10));
    assert!(matches!(reading, Some(RingEvent::Reading(reading)) if reading.kind == ReadingKind::NoEcho), "{reading:?}");
    ring.set_blanking(Micros::from_millis(2)).unwrap();
    let second = ring.next_deadline();
    assert!(matches!(ring.poll(second), Some(RingEvent::Reading(_) | RingEvent::Fire { .. })));
    assert_eq!((ring.window(), ring.blanking()), (Micros::from_millis(10), Micros::from_millis(2)));
}

#[test]
fn confirmed_silence_ends_a_count_of_rejected_echoes() {
    let reading = |kind| {
        let t_echo = (kind != ReadingKind::Clear).then_some(Micros::new(9_000));
        RingEvent::Reading(Reading {
            sensor: 0,
            phase: Phase(0),
            period: 0,
            kind,
            t_echo,
            previous: None,
            age: None,
            explained_by: None,
        })
    };
    let mut watch = SensorWatch::<1>::new(3, at(0));
    let mut observe = |kind| watch.observe(&reading(kind), at(0)).is_some();
    let seen = [ReadingKind::Rejected, ReadingKind::Rejected, ReadingKind::Clear].map(&mut observe);
    assert_eq!(seen, [false; 3]);
    assert_eq!([ReadingKind::Rejected; 4].map(observe), [false, false, true, false]);
    // As many as can be counted, and more.
    let mut watch = SensorWatch::<1>::new(255, at(0));
    let blind: Vec<_> =
        (0..600).filter(|_| watch.observe(&reading(ReadingKind::Rejected), at(1_500_000)).is_some()).collect();
    assert_eq!(blind, [254]);
}

// Without a driver, silence is free space only if the settings say so or something shows that the sensor listened.
#[test]
fn silence_without_a_witness_is_never_free_space() {
    for (silence, witness) in [
        (None, false),
        (Some(Silence::NeverFree), true),
        (Some(Silence::NeedsAnswer), false),
        (Some(Silence::NeedsAnswer), true),
        (Some(Silence::Trusted), false),
    ] {
        let mut ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), at(0)).unwrap();
        silence.into_iter().for_each(|silence| ring.set_silence(silence));
        let (mut watch, mut kinds, mut now) = (SensorWatch::<12>::new(0, at(0)), vec![], at(0));
        while kinds.len() < 120 {
            now = ring.next_deadline();
            while let Some(event) = ring.poll(now) {
                watch.observe(&event, now);
                match event {
                    RingEvent::Fire { sensor, .. } if witness => ring.measured(sensor, None).unwrap(),
                    RingEvent::Reading(reading) => kinds.push(reading.kind),
                    _ => {}
                }
            }
        }
        let state = watch.state(0, now).unwrap();
        let (first, later) = match (silence, witness) {
            (Some(Silence::Trusted), _) | (_, true) => (ReadingKind::NoEcho, ReadingKind::Clear),
            (Some(Silence::NeedsAnswer), false) => (ReadingKind::Unanswered, ReadingKind::Unanswered),
            _ => (ReadingKind::NoEcho, ReadingKind::NoEcho),
        };
        let of = |kind| kinds.iter().filter(|&&each| each == kind).count();
        assert!(kinds[0] == first && of(later) >= 108 && of(first) + of(later) >= 120, "{silence:?} {kinds:?}");
        let as_said = match later {
            ReadingKind::Clear => matches!(state, SensorState::Clear { .. }),
            ReadingKind::Unanswered => matches!(state, SensorState::Unanswered { .. }),
            _ => matches!(state, SensorState::Unknown { why: Doubt::NoWitness, .. }),
        };
        assert!(as_said, "{silence:?} {state:?}");
    }
}

// After 72 minutes the 32-bit clock shows 25 seconds: a state from before the restart would look recent.
#[test]
fn nothing_is_known_after_a_restart() {
    let (mut ring, mut watch) = (ring(0), SensorWatch::<12>::new(0, at(0)));
    let (now, _) = run(&mut ring, &mut watch, 5, |_, _| None);
    let later = now + Micros::from_millis(72 * 60_000 - 4_294_967);
    ring.restart(later);
    watch.restart(later);
    for sensor in 0..12 {
        let unknown = SensorState::Unknown { since: Micros::ZERO, why: Doubt::NoFiring };
        assert_eq!(watch.state(sensor, later), Ok(unknown));
    }
}

// After such a jump the ring restarts by itself, and its next event is the first that the watch gets.
#[test]
fn nothing_is_known_after_the_clock_has_jumped_back() {
    for (back_us, is_forgotten) in [(900_000, false), (1_100_000, true), (25_000_000, true), (2_000_000_000, true)] {
        let (mut ring, mut watch) = (ring(60_000_000), SensorWatch::<12>::new(0, at(60_000_000)));
        let (now, _) = run(&mut ring, &mut watch, 5, |_, _| Some(9_000));
        assert!(matches!(watch.state(0, now), Ok(SensorState::Obstacle { .. })), "{:?}", watch.state(0, now));
        let mut jumped = at(now.as_micros().wrapping_sub(back_us));
        let event = std::iter::from_fn(|| {
            let event = ring.poll(jumped);
            if event.is_none() {
                jumped = ring.next_deadline();
            }
            Some(event)
        });
        let event = event.take(3).flatten().next().expect("an event");
        watch.observe(&event, jumped);
        let is_unknown = matches!(watch.state(0, jumped), Ok(SensorState::Unknown { why: Doubt::NoFiring, .. }));
        assert_eq!(is_unknown, is_forgotten, "{back_us} us: {:?}", watch.state(0, jumped));
    }
}
