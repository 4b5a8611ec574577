//! Pairs of features combined: limits of single sensors, many phases, several echoes, adaptation.

use eeruf_core::{
    EachSensor, Instant, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Uneven, VerifiedSchedule,
    adaptation::Adaptation,
    judge::Judge,
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

/// Echoes of a sensor's n-th firing: one that never repeats, a wall, and one beyond the short window.
fn echoes(sensor: u8, firing: u32) -> [Micros; 3] {
    let wall = if sensor == 0 { 30_000 } else { 10_000 };
    [Micros::new(3_000 + 2_500 * (firing % 3)), Micros::new(wall), Micros::new(wall + 10_000)]
}

/// The echo times accepted from a ring's first two sensors in ten seconds, if their first `heard` echoes arrive.
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

/// Checks that each accepted reading of the first two sensors is its wall.
fn are_walls(accepted: &[Vec<u32>; 2]) {
    for (times, wall) in accepted.iter().zip([30_000, 10_000]) {
        assert!(times.len() > 20 && times.iter().all(|&time| time == wall), "{times:?}");
    }
}

#[test]
fn limits_go_with_several_echoes() {
    let config = RingConfig::new().with_echoes::<3>();
    let mut ring = Ring::new(&CORNER, config, BEGIN).unwrap();
    // The second sensor hears nothing beyond its window; for the first, the earliest echo that repeats counts.
    are_walls(&accepted(&mut ring, 3, |_, _| ()));
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
    // All readings are rejected, so the ring slows down; each sensor listens as before.
    assert_eq!(ring.schedule().period(), Micros::from_millis(80));
    assert_eq!((ring.window_of(0), ring.window_of(1)), (Micros::from_millis(50), Micros::from_millis(12)));
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
