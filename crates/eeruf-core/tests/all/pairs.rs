//! Features two by two: limits per sensor, many phases, several echoes, adaptation.

use eeruf_core::{
    EachSensor, EchoFilter, Instant, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Uneven,
    VerifiedSchedule,
    adaptation::Adaptation,
    hopping::{
        HoppingCode, HoppingError, HoppingListening, HoppingPlan, HoppingRing, HoppingSchedule, HoppingSettings,
    },
    judge::{Judge, TrackerSettings},
    plan::{Plan, ScheduledFiring},
    schedule,
    tables::TABLE_I_D,
};

const BEGIN: Instant = Instant::from_micros(0);

/// The first sensor listens for 50 ms, the second for 12.
const LIMITS: Requirements<'static> = Requirements {
    window: Micros::from_millis(50),
    uneven: Some(Uneven {
        window: &[Micros::from_millis(50), Micros::from_millis(12)],
        t_delta: &[Micros::new(999), Micros::new(1_400)],
        ..Uneven::NONE
    }),
    ..Requirements::new(Micros::new(999))
};

static CORNER: VerifiedSchedule<2, 2, EachSensor<2>> = schedule! {
    period_us: 60_000,
    t_fire_a_us: [0, 20_000],
    t_fire_b_us: [0, 23_000],
    each_meets: LIMITS,
};

/// Echoes of a sensor's firing by its number: one that never repeats, a wall, and one beyond the short window.
fn echoes(sensor: u8, firing: u32) -> [Micros; 3] {
    let wall = if sensor == 0 { 30_000 } else { 10_000 };
    [Micros::new(3_000 + 2_500 * (firing % 3)), Micros::new(wall), Micros::new(wall + 10_000)]
}

/// The echo times that a ring accepts of its first two sensors in ten seconds, if the first `heard` echoes come.
fn accepted<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    ring: &mut Ring<P, J, K, E, H>,
    heard: usize,
    mut ended: impl FnMut(&mut Ring<P, J, K, E, H>, &RingEvent),
) -> [Vec<u32>; 2] {
    let (mut accepted, mut firings) = ([vec![], vec![]], [0; 64]);
    loop {
        let now = ring.next_deadline();
        if now.since(BEGIN) > Micros::from_millis(10_000) {
            return accepted;
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    firings[usize::from(sensor)] += 1;
                    for echo in &echoes(sensor, firings[usize::from(sensor)])[..heard] {
                        ring.echo(sensor, now + *echo).unwrap();
                    }
                }
                RingEvent::Reading(reading) if reading.kind == ReadingKind::Accepted && reading.sensor < 2 => {
                    accepted[usize::from(reading.sensor)].push(reading.t_echo.unwrap().as_micros());
                }
                _ => {}
            }
            ended(ring, &event);
        }
    }
}

/// All that was accepted of the first sensor is its wall, and so of the second.
fn are_walls(accepted: &[Vec<u32>; 2]) {
    for (times, wall) in accepted.iter().zip([30_000, 10_000]) {
        assert!(times.len() > 20 && times.iter().all(|&time| time == wall), "{times:?}");
    }
}

#[test]
fn limits_go_with_several_echoes() {
    let config = RingConfig::new().with_echoes::<3>();
    let mut ring = Ring::new(&CORNER, config, BEGIN).unwrap();
    // Beyond the second sensor's window nothing is heard; of the first the earliest that repeats counts.
    are_walls(&accepted(&mut ring, 3, |_, _| ()));
}

#[test]
fn many_phases_go_with_several_echoes_and_with_limits() {
    let code = HoppingCode::shortest(2, 5, Micros::new(2_801)).unwrap();
    let lags = [0, 20_000].map(Micros::new);
    let schedule = HoppingSchedule::<2>::new(code, Micros::from_millis(70), lags).unwrap();
    let limits = schedule.limits(&LIMITS).unwrap();
    let listening = HoppingListening::new(Micros::from_millis(50));
    let settings = HoppingSettings::DRIVING.with_tracker(
        TrackerSettings::BALANCED
            .with_t_delta(Micros::new(1_400))
            .with_near(Micros::new(1_400))
            .with_tentative_votes(0),
    );
    let plan = || HoppingPlan::with_limits(&schedule, limits, settings, listening, 1, BEGIN).unwrap();
    let config = RingConfig::new().with_window(listening.window).with_echoes::<3>();
    let filter = EchoFilter::<2, 3>::new(Micros::new(1_400), 2).unwrap();
    let mut ring = Ring::<_, _, 2, 3, 8>::judged_by(plan(), filter, config, BEGIN).unwrap();
    are_walls(&accepted(&mut ring, 3, |_, _| ()));
    // By votes, of all of them too.
    let mut ring = HoppingRing::<2, 8, 3, _>::with_limits(&schedule, limits, settings, listening, 1, BEGIN).unwrap();
    are_walls(&accepted(&mut ring, 3, |_, _| ()));
    // By votes, of one echo: the wall is masked by what comes first.
    let mut ring = HoppingRing::<2, 4, 1, _>::with_limits(&schedule, limits, settings, listening, 1, BEGIN).unwrap();
    assert_eq!((ring.window_of(0), ring.window_of(1)), (Micros::from_millis(50), Micros::from_millis(12)));
    assert_eq!((ring.t_delta_of(0), ring.t_delta_of(1)), (Micros::new(999), Micros::new(1_400)));
    let first = accepted(&mut ring, 1, |_, _| ());
    assert!(first.iter().flatten().all(|time| [3_000, 5_500, 8_000].contains(time)), "{first:?}");
}

// What any sensor or pair keeps between firings passes before a ring that restarts fires again.
#[test]
fn restart_of_hopping_ring_keeps_the_longest_gap() {
    let code = HoppingCode::shortest(2, 5, Micros::new(2_801)).unwrap();
    let lags = [0, 20_000].map(Micros::new);
    let schedule = HoppingSchedule::<2>::new(code, Micros::from_millis(70), lags).unwrap();
    let limits = schedule.limits(&LIMITS).unwrap();
    let listening = HoppingListening::new(Micros::from_millis(50));
    let settings = HoppingSettings::DRIVING.with_tracker(TrackerSettings::BALANCED);
    let next_firing = |after_ms: u32| {
        let mut ring =
            HoppingRing::<2, 4, 1, _>::with_limits(&schedule, limits, settings, listening, 1, BEGIN).unwrap();
        let fires = |event: Option<RingEvent>| matches!(event, Some(RingEvent::Fire { .. }));
        let first = ring.next_deadline();
        assert!(fires(ring.poll(first)));
        ring.restart(first + Micros::from_millis(after_ms));
        loop {
            let now = ring.next_deadline();
            while let Some(event) = ring.poll(now) {
                if fires(Some(event)) {
                    return now.since(first);
                }
            }
        }
    };
    assert_eq!(next_firing(1), Micros::from_millis(50));
    assert_eq!(next_firing(49), Micros::from_millis(50));
    assert_eq!(next_firing(63), Micros::from_millis(63));
}

#[test]
fn limits_go_with_adaptation() {
    let slower = schedule! {
        period_us: 80_000,
        t_fire_a_us: [0, 20_000],
        t_fire_b_us: [0, 23_000],
        each_meets: LIMITS,
    };
    let rungs = [CORNER, slower];
    let mut adaptation = Adaptation::new(&rungs).unwrap();
    let mut ring: Ring<ScheduledFiring<'_, 2, 2, &EachSensor<2>>, _, 2> =
        Ring::new(&rungs[0], RingConfig::new(), BEGIN).unwrap();
    accepted(&mut ring, 1, |ring, event| {
        if let RingEvent::PeriodEnded(stats) = event {
            adaptation.adapt(stats, |schedule| ring.change_schedule(schedule)).unwrap();
        }
    });
    // All is rejected, so that it fires more slowly, and each sensor listens as before.
    assert_eq!(ring.schedule().period(), Micros::from_millis(80));
    assert_eq!((ring.window_of(0), ring.window_of(1)), (Micros::from_millis(50), Micros::from_millis(12)));
}

// A ring that hops goes to a longer period with the same code, and back, and believes no sound of another sensor.
#[test]
fn many_phases_go_with_adaptation() {
    let code = HoppingCode::new(4, 2, Micros::new(301)).unwrap();
    let rung = |ms| HoppingSchedule::<4>::spread(code, Micros::from_millis(ms)).unwrap();
    let rungs = [rung(45), rung(60), rung(90)];
    let mut adaptation = Adaptation::hopping(&rungs).unwrap();
    // What the sensor of foreign sound has rejected is no reason to slow down.
    adaptation.calm_permille = 300;
    let listening = HoppingListening::new(Micros::from_millis(36));
    let mut ring = HoppingRing::<4>::hopping(&rungs[0], HoppingSettings::BALANCED, listening, 1, BEGIN).unwrap();
    let (mut periods, mut fired, mut firings) = (vec![], [BEGIN; 4], 0);
    // For ten seconds something else each time, then a wall; and sound of sensor 0 along one path, for sensor 2.
    let noisy = |now: Instant| now.since(BEGIN) < Micros::from_millis(10_000);
    while ring.next_deadline().since(BEGIN) < Micros::from_millis(60_000) {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    firings += 1;
                    let own = now.since(fired[usize::from(sensor)]);
                    assert!(firings <= 4 || own >= listening.window, "{sensor} {now:?}");
                    fired[usize::from(sensor)] = now;
                    let other = Micros::new(5_000 + 1_700 * (firings * 7 % 16));
                    let wall = if noisy(now) { other } else { Micros::new(20_000) };
                    if sensor != 2 {
                        ring.echo(sensor, now + wall).unwrap();
                    }
                    let path = Micros::new(31_000).saturating_sub(now.since(fired[0]));
                    if sensor == 2 && !noisy(now) && firings > 4 && path > Micros::ZERO {
                        ring.echo(sensor, now + path).unwrap();
                    }
                }
                RingEvent::Reading(reading) => {
                    let is_foreign = reading.sensor == 2 && reading.kind == ReadingKind::Accepted;
                    assert!(!is_foreign, "{reading:?}");
                }
                RingEvent::PeriodEnded(stats) => {
                    let changed = adaptation.adapt(&stats, |schedule| ring.change_hopping(schedule)).unwrap();
                    if changed {
                        periods.push(rungs[adaptation.rung()].period().as_micros() / 1000);
                        let lags = (0..4).map(|sensor| ring.plan().t_lag(sensor));
                        assert!(lags.eq((0..4).map(|sensor| rungs[adaptation.rung()].t_lag(sensor))));
                    }
                }
            }
        }
    }
    assert_eq!(periods, [60, 90, 60, 45]);
    // Another code, and a period for which the ring listens too long, are refused, and change nothing.
    let other =
        HoppingSchedule::<4>::spread(HoppingCode::new(4, 2, Micros::new(302)).unwrap(), Micros::from_millis(60));
    assert_eq!(ring.change_hopping(&other.unwrap()), Err(HoppingError::OtherCode));
    assert!(matches!(ring.change_hopping(&rung(36)), Err(HoppingError::Period { .. })));
    assert_eq!(ring.plan().t_lag(3), rungs[0].t_lag(3));
}

#[test]
fn several_echoes_go_with_adaptation() {
    let requirements = Requirements::new(Micros::new(599));
    let rungs = [TABLE_I_D.scaled(3, 5).unwrap(), TABLE_I_D].map(|table| table.verified(&requirements).unwrap());
    let run = |heard| {
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        let config = RingConfig::new().with_window(Micros::from_millis(40)).with_echoes::<3>();
        let mut ring: Ring<ScheduledFiring<'_, 12>, _, 12, 3> = Ring::new(&rungs[0], config, BEGIN).unwrap();
        let accepted = accepted(&mut ring, heard, |ring, event| {
            if let RingEvent::PeriodEnded(stats) = event {
                adaptation.adapt(stats, |schedule| ring.change_schedule(schedule)).unwrap();
            }
        });
        (accepted, ring.schedule().period())
    };
    // One echo that never repeats makes it slower; with the wall behind it nothing is rejected.
    let (_, period) = run(1);
    assert_eq!(period, Micros::from_millis(100));
    let (accepted, period) = run(2);
    assert_eq!(period, Micros::from_millis(60));
    are_walls(&accepted);
}
