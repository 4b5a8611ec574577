//! Running rings of sensors that are not all alike.

use eeruf_core::{
    EachSensor, EchoFilter, Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingError, RingEvent,
    Schedule, Uneven, VerifiedSchedule,
    adaptation::Adaptation,
    plan::{ScheduledFiring, check_plan},
    tables::TABLE_I_D,
};

use crate::common::random::Random;

const fn ms<const K: usize>(times: [u32; K]) -> [Micros; K] {
    let mut micros = [Micros::ZERO; K];
    let mut at = 0;
    while at < K {
        micros[at] = Micros::from_millis(times[at]);
        at += 1;
    }
    micros
}

/// Two sensors that look far and compare coarsely, and two that look near; two of the four fire together.
fn corners() -> VerifiedSchedule<4, 2, EachSensor<4>> {
    let schedule = Schedule::from_firing(Micros::from_millis(60), [ms([0, 5, 40, 40]), ms([2, 12, 24, 24])])
        .expect("it lies within");
    let requirements = Requirements {
        layout: Layout::Line(1),
        uneven: Some(Uneven {
            window: &ms([50, 12, 30, 9]),
            t_delta: &[Micros::new(1_500), Micros::new(2_400), Micros::new(900), Micros::new(400)],
            shared_lines: &[0b1010],
            together: &[0b1100],
            ..Uneven::NONE
        }),
        ..Requirements::new(Micros::new(99))
    };
    schedule.verified_each(&requirements).expect("it keeps all")
}

#[test]
fn each_sensor_listens_and_compares_as_it_was_verified_for() {
    let schedule = corners();
    let filter = |sensor: usize| EchoFilter::<1>::new(schedule.limits_of(sensor as u8).unwrap().t_delta, 2).unwrap();
    let mut filters: [EchoFilter<1>; 4] = core::array::from_fn(filter);
    let mut ring: Ring<_, _, 4> = Ring::new(&schedule, RingConfig::new(), Instant::from_micros(0)).unwrap();
    ring.set_silence(eeruf_core::Silence::Trusted);
    let mut random = Random(3);
    // The last firing of each, and the echo that it will hear.
    let mut firings: [Option<(Instant, Option<u32>)>; 4] = [None; 4];
    let mut edges: [Option<Instant>; 4] = [None; 4];
    let mut seen = [0; 4];
    let (mut accepted, mut rejected, mut late) = (0, 0, 0);
    while seen.iter().sum::<u32>() < 20_000 {
        let mut now = ring.next_deadline();
        // An edge is reported when it comes, if that is sooner.
        for sensor in 0..4_u8 {
            let edge = edges[usize::from(sensor)].filter(|&edge| now.has_reached(edge));
            now = edge.unwrap_or(now);
        }
        for sensor in 0..4_u8 {
            if edges[usize::from(sensor)] == Some(now) {
                edges[usize::from(sensor)] = None;
                ring.echo(sensor, now).unwrap();
            }
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let window = schedule.limits_of(sensor).unwrap().window.as_micros();
                    assert_eq!(ring.window_of(sensor).as_micros(), window);
                    // Near the wall seen before, far from it, or beyond the window.
                    let echo = match random.up_to(5) {
                        0 => None,
                        1 => Some(random.up_to(window + 2_000)),
                        _ => Some(window - 2_500 + random.up_to(2_501)),
                    };
                    firings[usize::from(sensor)] = Some((now, echo));
                    edges[usize::from(sensor)] = echo.map(|echo| now + Micros::new(echo));
                }
                RingEvent::Reading(reading) => {
                    let sensor = usize::from(reading.sensor);
                    if reading.kind == ReadingKind::Late {
                        assert!(reading.t_echo > Some(schedule.limits_of(reading.sensor).unwrap().window));
                        late += 1;
                        continue;
                    }
                    let (fired, echo) = firings[sensor].take().expect("it has fired");
                    let window = schedule.limits_of(reading.sensor).unwrap().window;
                    let heard = echo.filter(|&echo| echo <= window.as_micros());
                    assert_eq!(now.since(fired), heard.map_or(window, Micros::new), "sensor {sensor}");
                    let expected = filters[sensor].push(0, heard.map(Micros::new)).unwrap();
                    assert_eq!((reading.kind, reading.t_echo), (expected.kind, expected.t_echo), "sensor {sensor}");
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                    rejected += u32::from(reading.kind == ReadingKind::Rejected);
                    seen[sensor] += 1;
                }
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    assert!(
        late > 100 && accepted > 2_000 && rejected > 2_000 && seen.iter().all(|&seen| seen > 4_000),
        "{accepted} {rejected} {late}"
    );
}

#[test]
fn where_all_are_alike_an_uneven_ring_does_what_a_ring_does() {
    let alike = Requirements {
        min_interval: Micros::from_millis(15),
        window: Micros::from_millis(30),
        ..Requirements::new(Micros::new(499))
    };
    let even = TABLE_I_D.verified(&alike).unwrap();
    let windows = [Micros::from_millis(30); 12];
    let each = Uneven { window: &windows, ..Uneven::NONE };
    let uneven = TABLE_I_D.verified_each(&Requirements { uneven: Some(each), ..alike }).unwrap();
    let begin = Instant::from_micros(u32::MAX - 3_000_000);
    let mut one: Ring<_, _, 12> = Ring::new(&even, RingConfig::new(), begin).unwrap();
    let mut other: Ring<_, _, 12> = Ring::new(&uneven, RingConfig::new(), begin).unwrap();
    let mut random = Random(11);
    for poll in 0..20_000 {
        assert_eq!(one.next_deadline(), other.next_deadline());
        let late = if random.up_to(9) == 0 { random.up_to(1_500) } else { 0 };
        let now = one.next_deadline() + Micros::new(late);
        let (sensor, at) =
            (random.up_to(11) as u8, Instant::from_micros(now.as_micros().wrapping_sub(random.up_to(40_000))));
        assert_eq!(one.echo(sensor, at), other.echo(sensor, at));
        match random.up_to(199) {
            0 => (one.restart(now), other.restart(now)),
            1 => (one.pause(), other.pause()),
            2..=9 => (one.resume(), other.resume()),
            _ => ((), ()),
        };
        loop {
            let event = one.poll(now);
            assert_eq!(event, other.poll(now), "poll {poll}");
            match event {
                Some(RingEvent::Fire { sensor, .. }) if random.up_to(9) == 0 => {
                    let at = now + Micros::new(random.up_to(40));
                    assert_eq!(one.fired(sensor, at), other.fired(sensor, at));
                }
                None => break,
                _ => {}
            }
        }
    }
}

#[test]
fn a_ring_takes_less_than_was_verified_and_not_more() {
    let schedule = corners();
    let at = Instant::from_micros(0);
    let ring = |config| {
        Ring::<_, _, 4>::new(&schedule, config, at).map(|ring| {
            (0..4).map(|x| (ring.window_of(x).as_micros() / 1000, ring.t_delta_of(x).as_micros())).collect::<Vec<_>>()
        })
    };
    let config = RingConfig::new();
    assert_eq!(ring(config), Ok(vec![(50, 1_500), (12, 2_400), (30, 900), (9, 400)]));
    let less = config.with_window(Micros::from_millis(20)).with_t_delta(Micros::new(1_000));
    assert_eq!(ring(less), Ok(vec![(20, 1_000), (12, 1_000), (20, 900), (9, 400)]));
    let (window, verified) = (Micros::from_millis(51), Micros::from_millis(50));
    assert_eq!(ring(config.with_window(window)), Err(RingError::VerifiedWindow { window, verified }));
    let (t_delta, verified) = (Micros::new(2_401), Micros::new(2_400));
    assert_eq!(ring(config.with_t_delta(t_delta)), Err(RingError::TDelta { t_delta, verified }));
    // The sensor with the shortest window would never hear anything.
    let (blanking, window) = (Micros::from_millis(9), Micros::from_millis(9));
    assert_eq!(ring(config.with_blanking(blanking)), Err(RingError::Blanking { blanking, window }));
}

#[test]
fn a_plan_with_limits_keeps_what_every_plan_promises() {
    let schedule = corners();
    for seed in 0..20_u32 {
        let now = Instant::from_micros(seed.wrapping_mul(400_000_000));
        check_plan(&mut ScheduledFiring::verified(&schedule, now), now, 20_000, seed).unwrap();
    }
}

// An uneven ring is on time while its closest pair tolerates the lateness.
#[test]
fn uneven_ring_is_on_time_within_its_slack() {
    // Sensors 1 and 2 are 5 ms apart and compare by 2.4 ms, twice; a quarter of the 199 us left over, each period.
    let schedule = corners();
    for (late, on_time) in [(49, true), (50, false)] {
        let mut ring: Ring<_, _, 4> = Ring::new(&schedule, RingConfig::new(), Instant::from_micros(0)).unwrap();
        let (mut kinds, mut periods, mut was_on_time) = (Vec::new(), 0, true);
        while periods < 6 {
            // The first firing of the fifth period comes late.
            let is_late = periods == 4 && kinds.len() == 16;
            let now = ring.next_deadline() + Micros::new(if is_late { late } else { 0 });
            while let Some(event) = ring.poll(now) {
                match event {
                    RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(5)).unwrap(),
                    RingEvent::Reading(reading) => kinds.push(reading.kind),
                    RingEvent::PeriodEnded(_) => periods += 1,
                }
            }
            was_on_time &= ring.is_on_time();
        }
        assert_eq!(was_on_time, on_time, "late by {late} us");
        // There is no other sound, so all but each sensor's first reading are accepted.
        let accepted = kinds.iter().filter(|&&kind| kind == ReadingKind::Accepted).count();
        assert_eq!(accepted, kinds.len() - 4, "late by {late} us: {kinds:?}");
    }
}

/// Four sensors on shared lines, two of them with longer windows; the first listens beyond the next firing of any.
fn farther() -> VerifiedSchedule<4, 2, EachSensor<4>> {
    let schedule = Schedule::from_firing(Micros::from_millis(80), [ms([62, 20, 44, 4]), ms([58, 10, 26, 30])])
        .expect("it lies within");
    let requirements = Requirements {
        layout: Layout::Line(1),
        uneven: Some(Uneven {
            window: &ms([70, 20, 60, 16]),
            t_delta: &[Micros::new(1_900), Micros::new(1_200), Micros::new(1_500), Micros::new(300)],
            shared_lines: &[0b1010],
            ..Uneven::NONE
        }),
        ..Requirements::new(Micros::new(99))
    };
    schedule.verified_each(&requirements).expect("it keeps all")
}

// Between two uneven schedules, no sensor fires sooner or listens longer than both allow.
#[test]
fn change_between_uneven_schedules_keeps_both_limits() {
    let schedules = [corners(), farther()];
    let limits = |of: usize, sensor: usize| schedules[of].limits_of(sensor as u8).unwrap();
    // No more than either allows, so that it can change between them.
    let config = RingConfig::new().with_window(Micros::from_millis(50)).with_t_delta(Micros::new(1_900));
    let mut ring: Ring<_, _, 4> = Ring::new(&schedules[0], config, Instant::from_micros(u32::MAX - 500_000)).unwrap();
    let mut random = Random(5);
    // The schedules of the current period and the one before; when each sensor fired, by which schedule, and until when
    // it listened.
    let (mut present, mut before) = (0, 0);
    let mut fired: [Option<(Instant, usize)>; 4] = [None; 4];
    let (mut changes, mut cut, mut accepted, mut asked) = (0, 0, 0, None);
    while changes < 400 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let x = usize::from(sensor);
                    for y in [x, x ^ 2].into_iter().filter(|&y| y == x || x % 2 == 1) {
                        let (at, by) =
                            fired[y].unwrap_or((Instant::from_micros(now.as_micros().wrapping_sub(999_999)), 0));
                        assert!(now.since(at) >= limits(by, y).window, "{x} {} after {y}", now.since(at));
                    }
                    fired[x] = Some((now, present));
                    let least =
                        |of: fn(eeruf_core::SensorLimits) -> Micros| of(limits(present, x)).min(of(limits(before, x)));
                    assert_eq!(ring.window_of(sensor), least(|limits| limits.window).min(Micros::from_millis(50)));
                    assert_eq!(ring.t_delta_of(sensor), least(|limits| limits.t_delta).min(Micros::new(1_900)));
                    if random.up_to(1) == 0 {
                        ring.echo(sensor, now + Micros::from_millis(8)).unwrap();
                    }
                }
                RingEvent::Reading(reading) => {
                    let (at, by) = fired[usize::from(reading.sensor)].unwrap();
                    let window = limits(by, reading.sensor.into()).window.min(Micros::from_millis(50));
                    if reading.t_echo.is_none() && now.since(at) < window {
                        // Its window was cut at the end of the period, or it fired in the first after a change.
                        assert_ne!((present, before), (by, by));
                        cut += 1;
                    }
                    assert!(now.since(at) <= window || before != present, "{reading:?}");
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                }
                RingEvent::PeriodEnded(_) => {
                    before = present;
                    if let Some(next) = asked.take() {
                        (present, changes) = (next, changes + 1);
                    }
                    assert_eq!(*ring.schedule(), *schedules[present]);
                    if random.up_to(3) == 0 {
                        ring.change_schedule(&schedules[1 - present]).unwrap();
                        asked = Some(1 - present);
                    }
                }
            }
        }
    }
    assert!(cut > 50 && accepted > 100, "{cut} {accepted}");
}

// A change to an uneven schedule that allows less is refused and the ring goes on.
#[test]
fn change_to_less_permissive_schedule_is_refused() {
    let schedules = [corners(), farther()];
    let at = Instant::from_micros(0);
    let mut ring: Ring<_, _, 4> = Ring::new(&schedules[1], RingConfig::new(), at).unwrap();
    let (window, verified) = (Micros::from_millis(70), Micros::from_millis(50));
    assert_eq!(ring.change_schedule(&schedules[0]), Err(RingError::VerifiedWindow { window, verified }));
    ring.set_window(verified).unwrap();
    ring.set_blanking(Micros::from_millis(10)).unwrap();
    // The sensor with the shortest window would never hear anything.
    let (blanking, window) = (Micros::from_millis(10), Micros::from_millis(9));
    assert_eq!(ring.change_schedule(&schedules[0]), Err(RingError::Blanking { blanking, window }));
    ring.set_blanking(Micros::ZERO).unwrap();
    ring.change_schedule(&schedules[0]).unwrap();
    // The new schedule's limits hold from then on.
    let (window, verified) = (Micros::from_millis(51), Micros::from_millis(50));
    assert_eq!(ring.set_window(window), Err(RingError::VerifiedWindow { window, verified }));
    assert_eq!(*ring.schedule(), *schedules[1]);
}

// A ring changes between sensors that are alike and sensors that are not.
#[test]
fn ring_changes_between_even_and_uneven_schedules() {
    let uneven = corners();
    let schedule = Schedule::from_firing(Micros::from_millis(70), [ms([0, 16, 32, 48]), ms([4, 26, 47, 50])]).unwrap();
    let alike = Requirements { window: Micros::from_millis(50), ..Requirements::new(Micros::new(999)) };
    let even = schedule.verified(&alike).unwrap();
    let (even, own): (_, EachSensor<4>) = (even.schedule(), EachSensor::NONE);
    let config = RingConfig::new().with_window(Micros::from_millis(50)).with_t_delta(Micros::new(999));
    let plan = ScheduledFiring::with_limits(even, &own, Instant::from_micros(0));
    let mut ring: Ring<_, _, 4> = Ring::with_plan(plan, config, Instant::from_micros(0)).unwrap();
    let mut lengths = Vec::new();
    let mut readings = 0;
    for period in 0..40 {
        let each = (uneven.schedule(), uneven.own_limits());
        let (next, limits) = if period % 8 < 4 { (even, &own) } else { each };
        ring.change_to(next, limits).unwrap();
        loop {
            let now = ring.next_deadline();
            match ring.poll(now) {
                Some(RingEvent::Fire { sensor, .. }) => ring.echo(sensor, now + Micros::from_millis(8)).unwrap(),
                Some(RingEvent::Reading(reading)) => {
                    assert_ne!(reading.kind, ReadingKind::Rejected, "{reading:?}");
                    assert_eq!(reading.t_echo, Some(Micros::from_millis(8)));
                    readings += 1;
                }
                Some(RingEvent::PeriodEnded(_)) => break,
                None => {}
            }
        }
        lengths.push((ring.window_of(3).as_micros() / 1_000, ring.t_delta_of(3).as_micros()));
    }
    // The period after a change keeps the limits of both schedules, the one after it its own alone.
    assert_eq!(lengths[2..6], [(50, 999), (50, 999), (9, 400), (9, 400)]);
    assert_eq!(lengths[7..10], [(9, 400), (9, 400), (50, 999)]);
    assert!(readings >= 156, "{readings}");
}

#[test]
fn a_ladder_takes_rungs_for_sensors_that_are_not_alike() {
    let rungs = [corners(), farther()];
    let mut adaptation = Adaptation::new(&rungs).unwrap();
    (adaptation.window, adaptation.noisy_permille) = (2, 0);
    let config = RingConfig::new().with_window(Micros::from_millis(50)).with_t_delta(Micros::new(1_900));
    let mut ring: Ring<_, _, 4> = Ring::new(&rungs[0], config, Instant::from_micros(0)).unwrap();
    let mut random = Random(9);
    for _ in 0..2_000 {
        let now = ring.next_deadline();
        match ring.poll(now) {
            // Nothing agrees.
            Some(RingEvent::Fire { sensor, .. }) => {
                ring.echo(sensor, now + Micros::new(1_000 + random.up_to(7_000))).unwrap();
            }
            Some(RingEvent::PeriodEnded(stats)) => {
                adaptation.adapt(&stats, |schedule| ring.change_schedule(schedule)).unwrap();
            }
            _ => {}
        }
    }
    assert_eq!((*ring.schedule(), ring.window_of(0)), (*rungs[1].schedule(), Micros::from_millis(50)));
    assert_eq!(ring.t_delta_of(3), Micros::new(300));
}
