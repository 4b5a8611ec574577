use super::*;

/// Examines sensors that fire at these times, in microseconds, and have these readings, 300 times each.
fn examine(sensors: usize, pattern: Pattern, reads: impl Fn(u64, usize) -> (u64, Option<f64>)) -> Examination {
    let mut doctor = Doctor::new(343.2);
    (0..300).for_each(|round| (0..sensors).for_each(|sensor| push(&mut doctor, sensor, reads(round, sensor))));
    let firing = FiringPattern { pattern, period_us: Some(60_000), gap_us: Some(40_000), ..FiringPattern::default() };
    doctor.examine(&firing, &(0..sensors).map(|sensor| format!("s{sensor}")).collect::<Vec<_>>())
}

fn push(doctor: &mut Doctor, sensor: usize, (at_us, echo_us): (u64, Option<f64>)) {
    doctor.push(&LogReading {
        sensor,
        at_ns: Some(1000 * at_us),
        radiation: 0,
        field_of_view_rad: 0.0,
        min_range_m: 0.0,
        max_range_m: 0.0,
        range_m: echo_us.map_or(f64::INFINITY, |us| 0.5e-6 * 343.2 * us),
        variance: None,
    });
}

/// Noise of up to 20 us, the same in each run.
fn noise(round: u64, sensor: usize) -> f64 {
    let mixed = (round * 64 + sensor as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((mixed ^ (mixed >> 31)) >> 40) as f64 / f64::from(1 << 24) * 40.0 - 20.0
}

#[test]
fn alternating_lags_show_foreign_sound_standing_and_driving() {
    // Sensor 1 fires 10 ms after sensor 0, or 13 ms.
    let at = |round: u64, sensor: usize| 60_000 * round + sensor as u64 * (10_000 + 3000 * (round % 2));
    for driving_us in [0.0, 30.0] {
        let own = |round: u64, sensor: usize| 9000.0 + driving_us * round as f64 + noise(round, sensor);
        let healthy = examine(2, Pattern::Alternating, |round, sensor| (at(round, sensor), Some(own(round, sensor))));
        assert_eq!((healthy.verdict, healthy.fooled), (LogVerdict::NoneSeen, vec![]), "{driving_us}");
        // Sound of sensor 0 that takes 16 ms reaches sensor 1 after 6 or 3 ms.
        let foreign = examine(2, Pattern::Alternating, |round, sensor| {
            let heard = 6000.0 - 3000.0 * (round % 2) as f64 + driving_us * round as f64 + noise(round, sensor);
            (at(round, sensor), Some(if sensor == 1 { heard } else { own(round, sensor) }))
        });
        assert_eq!((foreign.verdict, foreign.fooled), (LogVerdict::Crosstalk, vec![1]), "{driving_us}");
        assert!(foreign.reasons[0].starts_with("s1: 100 % of the readings depend on which of two lags"));
    }
}

#[test]
fn robot_that_drives_up_to_a_wall_and_back_hears_no_other() {
    // At 1.5 m/s; from one firing to the next it is 57 or 63 ms, so that the echo changes more in one class.
    let at = |round: u64, sensor: usize| 60_000 * round + sensor as u64 * (10_000 + 3000 * (round % 2));
    let found = examine(2, Pattern::Alternating, |round, sensor| {
        let since_us = at(round, sensor) % 3_600_000;
        let driven_us = since_us.min(3_600_000 - since_us);
        let far_us = 20_000.0 - (2.0 * 1.5 / 343.2) * driven_us as f64;
        (at(round, sensor), Some(far_us + noise(round, sensor)))
    });
    assert_eq!((found.verdict, found.fooled), (LogVerdict::NoneSeen, vec![]), "{:?}", found.reasons);
}

#[test]
fn echo_that_fades_at_random_is_no_crosstalk() {
    let at = |round: u64, sensor: usize| 60_000 * round + sensor as u64 * (10_000 + 3000 * (round % 2));
    let fades = |round: u64, sensor: usize| noise(round * 7 + 3, sensor) > 5.0;
    let found = examine(2, Pattern::Alternating, |round, sensor| {
        let echo = if fades(round, sensor) { 12_000.0 } else { 9000.0 };
        (at(round, sensor), Some(echo + noise(round, sensor)))
    });
    assert_eq!((found.verdict, found.notes.len()), (LogVerdict::NoneSeen, 2), "{found:?}");
    assert!(found.notes[0].starts_with("s0: jumps ") && found.notes[0].contains("between 9.0 and 12.0 ms"));
}

#[test]
fn two_sensors_that_read_one_path_both_ways_are_a_pair() {
    // Sensor 1 fires 2 ms after sensor 0; the path between them takes 12 to 15 ms: 0 reads it after that, 1 2 ms less.
    let at = |round: u64, sensor: usize| 60_000 * round + 2000 * sensor as u64;
    let path = |round: u64| 12_000.0 + 10.0 * round as f64;
    let own = |round: u64, sensor: usize| 9000.0 + 2500.0 * sensor as f64 + 8.0 * round as f64;
    let found = examine(2, Pattern::ConstantLags, |round, sensor| {
        let lag = if sensor == 0 { 2000.0 } else { -2000.0 };
        let heard = if round < 60 { path(round) + lag } else { own(round, sensor) };
        (at(round, sensor), Some(heard + noise(round, sensor)))
    });
    assert_eq!(
        (found.verdict, &found.pairs[..], &found.fooled[..]),
        (LogVerdict::Crosstalk, &[(0, 1)][..], &[0, 1][..])
    );
    // A wall that both see: their difference drifts through the same value.
    let wall = examine(2, Pattern::ConstantLags, |round, sensor| {
        let turned = if sensor == 1 { 14.0 * round as f64 - 6000.0 } else { 0.0 };
        (at(round, sensor), Some(9000.0 + 8.0 * round as f64 + turned + noise(round, sensor)))
    });
    assert_eq!((wall.verdict, wall.pairs), (LogVerdict::CannotTell, vec![]));
    assert!(wall.record.is_some_and(|record| record.contains("lags that change")));
}

#[test]
fn a_log_that_would_not_show_crosstalk_cannot_tell() {
    let steady = |round: u64, sensor: usize| (60_000 * round, Some(9000.0 + noise(round, sensor)));
    for pattern in [Pattern::AtOnce, Pattern::ConstantLags, Pattern::Unknown, Pattern::Several] {
        let found = examine(2, pattern, steady);
        assert_eq!((found.verdict, found.record.is_some()), (LogVerdict::CannotTell, true), "{pattern:?}");
    }
    assert_eq!(examine(2, Pattern::InTurn, steady).verdict, LogVerdict::NoneSeen);
}

#[test]
fn single_sensors_are_noted_for_what_strikes() {
    let note = |echo: &dyn Fn(u64) -> Option<f64>| {
        // Every second period is longer by 1 ms.
        let found = examine(1, Pattern::Unknown, |round, _| (60_000 * round + 1000 * (round / 2 % 2), echo(round)));
        found.notes.first().cloned().unwrap_or_default()
    };
    assert_eq!(note(&|round| Some(9000.0 + noise(round, 0))), "");
    assert!(note(&|_| None).contains("no echo at all"));
    assert!(note(&|round| Some(583.0 * (10 + round % 5) as f64)).contains("steps of 583 us"));
    assert!(note(&|round| Some(9000.0 + 400.0 * noise(round, 0))).contains("scatters"));
    // The echo of the firing before comes 60 ms, 61 ms or 59 ms after that.
    let at = |round: u64| (60_000 * round + 1000 * (round / 2 % 2)) as f64;
    let stale = |round: u64| (round > 0).then(|| 65_000.0 - (at(round) - at(round - 1)) + noise(round, 0) / 4.0);
    assert!(note(&stale).contains("stale echo"), "{}", note(&stale));
}

// Four modules that measure by themselves and are read in turn every 40 ms: the times are not those of firing.
#[test]
fn ranges_refute_times_that_are_those_of_reading() {
    let mut told = 0;
    for seed in 0..20_u64 {
        let random = |n: u64, from: f64, to: f64| from + (to - from) * (noise(1000 + 100 * seed + n, 3) + 20.0) / 40.0;
        let period = |module: usize| random(module as u64, 48_800.0, 49_600.0);
        let phase = |module: usize| random(10 + module as u64, 0.0, 49_000.0);
        let own = |module: usize| random(20 + module as u64, 3_500.0, 20_000.0);
        let at = |round: u64, module: usize| 200_000 + 160_000 * round + 40_000 * module as u64;
        let mut wrong = 0;
        let hears = |round: u64, module: usize| {
            let before = at(round, module) as f64 - phase(module);
            let fired = phase(module) + ((before / period(module)).floor() - 1.0) * period(module);
            // Every one hears the next.
            let next = (module + 1) % 4;
            let travel = random(30 + module as u64, 3_000.0, 23_000.0);
            let after = (travel + phase(next) - fired).rem_euclid(period(next));
            if (800.0..own(module)).contains(&after) { after } else { own(module) }
        };
        (0..300).for_each(|round| (0..4).for_each(|x| wrong += usize::from(hears(round, x) != own(x))));
        let polled = examine(4, Pattern::InTurn, |round, module| {
            (at(round, module), Some(hears(round, module) + 0.5 * noise(round, module)))
        });
        if wrong > 60 {
            told += 1;
            assert_ne!(polled.verdict, LogVerdict::NoneSeen, "{seed}: {wrong} wrong: {:?}", polled.reasons);
        }
        let healthy = examine(4, Pattern::InTurn, |round, module| {
            // A wall that comes nearer, and goes again.
            let way = if seed % 2 == 0 { 0.0 } else { 60.0 * (round % 100).abs_diff(50) as f64 };
            (at(round, module), Some(own(module) + way + noise(round, module)))
        });
        assert_eq!(healthy.verdict, LogVerdict::NoneSeen, "{seed}: {:?}", healthy.reasons);
    }
    assert!(told > 15, "{told}");
}

// Sensor 0 is silent in every third round.
#[test]
fn rounds_without_a_sensor_are_a_pause_test() {
    let examined = |hears: bool| {
        let mut doctor = Doctor::new(343.2);
        for round in 0..600_u64 {
            let fires = round % 3 > 0;
            if fires {
                push(&mut doctor, 0, (60_000 * round, Some(9000.0 + noise(round, 0))));
            }
            let heard = if fires && hears { 5000.0 } else { 8000.0 };
            push(&mut doctor, 1, (60_000 * round + 5_000, Some(heard + noise(round, 1))));
        }
        doctor.examine(&FiringPattern::default(), &["a".to_owned(), "b".to_owned()])
    };
    let found = examined(true);
    assert_eq!((found.verdict, &found.fooled[..], found.suspects[0].by), (LogVerdict::Crosstalk, &[1][..], Some(0)));
    assert_eq!((examined(false).verdict, examined(false).suspects), (LogVerdict::CannotTell, vec![]));
}

// Both fire at one time; a quarter of the readings of sensor 1 is anywhere, always or only where sensor 0 fires.
#[test]
fn noise_in_silent_rounds_is_a_sensors_own() {
    let examined = |is_foreign: bool| {
        let mut doctor = Doctor::new(343.2);
        for round in 0..3000_u64 {
            let fires = round % 3 > 0;
            let is_odd = noise(round * round, 5) > 10.0 && (fires || !is_foreign);
            let heard = if is_odd { 4000.0 + 100.0 * noise(round * round * 3, 7) } else { 9000.0 + noise(round, 1) };
            push(&mut doctor, 1, (60_000 * round, Some(heard)));
            if fires {
                push(&mut doctor, 0, (60_000 * round, Some(7000.0 + noise(round, 0))));
            }
        }
        doctor.examine(&FiringPattern::default(), &["a".to_owned(), "b".to_owned()])
    };
    let own = examined(false);
    assert_eq!((own.verdict, &own.suspects[..]), (LogVerdict::CannotTell, &[][..]));
    assert!(own.reasons.iter().any(|reason| reason.ends_with(": noise of its own")), "{:?}", own.reasons);
    let foreign = examined(true);
    assert_eq!((foreign.verdict, &foreign.fooled[..]), (LogVerdict::Crosstalk, &[1][..]), "{:?}", foreign.reasons);
}

// The lags alternate by 300 us, which a scatter of 150 us hides.
#[test]
fn scatter_that_hides_the_lags_is_said() {
    let at = |round: u64, sensor: usize| 60_000 * round + sensor as u64 * (10_000 + 300 * (round % 2));
    let with = |times: f64| {
        examine(2, Pattern::Alternating, |round, sensor| {
            (at(round, sensor), Some(9000.0 + times * noise(round * round, sensor)))
        })
    };
    assert_eq!(with(1.0).verdict, LogVerdict::NoneSeen);
    let blurred = with(12.0);
    assert!(blurred.verdict == LogVerdict::CannotTell && blurred.reasons[0].contains("scatter"), "{blurred:?}");
}

// Four sensors 28 to 32 ms after one another, by chance. Sound of sensor 2 takes 36 ms to sensor 3, or that of sensor 3
// comes to sensor 2 in the next round.
#[test]
fn sender_is_named_by_the_lag_that_readings_move_against() {
    let chance = |round: u64, sensor: usize| (noise(round * round, sensor) * 100.0 + 2000.0) as u64;
    let at = |round: u64, sensor: usize| {
        130_000 * round + (0..=sensor).map(|before| 28_000 + chance(round, before)).sum::<u64>()
    };
    for (sender, fooled, takes_us, driving_us) in
        [(2, 3, 36_000.0, 0.0), (2, 3, 36_000.0, 40.0), (3, 2, 106_000.0, 0.0), (3, 2, 106_000.0, 40.0)]
    {
        let examined = |hears: bool| {
            examine(4, Pattern::InTurn, |round, sensor| {
                let turn = 30 + 7 * sensor as u64;
                let own = 9000.0 + 1500.0 * sensor as f64 + driving_us * (round % turn).abs_diff(turn / 2) as f64;
                let sent = at(if sender < fooled { round } else { round.saturating_sub(1) }, sender);
                let heard = sent as f64 + takes_us - at(round, sensor) as f64;
                let is_heard = hears && sensor == fooled && (500.0..own).contains(&heard);
                (at(round, sensor), Some(if is_heard { heard } else { own } + noise(round, sensor)))
            })
        };
        let (found, healthy) = (examined(true), examined(false));
        assert_eq!((found.verdict, &found.fooled[..]), (LogVerdict::Crosstalk, &[fooled][..]), "{found:?}");
        assert_eq!(found.suspects.iter().map(|of| of.by).collect::<Vec<_>>(), [Some(sender)], "{found:?}");
        assert!(found.reasons.iter().any(|of| of.contains(&format!("the sound of s{sender};"))), "{found:?}");
        assert_eq!((healthy.verdict, healthy.suspects), (LogVerdict::NoneSeen, vec![]), "{:?}", healthy.reasons);
    }
}
