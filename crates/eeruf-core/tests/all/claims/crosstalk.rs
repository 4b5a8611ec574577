//! The promise of the method: if the conditions hold, no crosstalk passes twice in a row, whatever its path, and a true
//! echo always passes.

use std::collections::VecDeque;

use eeruf_core::{Instant, Micros, Phase, ReadingKind, Requirements, Ring, RingConfig, RingEvent, Schedule};
use proptest::prelude::*;

prop_compose! {
    /// A schedule that meets Exact with stale echoes for a `t_delta` at its limit; everything else is random.
    fn verified_schedule()(sensors in 2..=8_usize, separation in 2..3000_u32, slack in 1..60_000_u32)(
        gaps in prop::collection::vec(0..separation, sensors),
        signs in prop::collection::vec(any::<bool>(), sensors),
        order in Just((0..sensors).collect::<Vec<_>>()).prop_shuffle(),
        places in prop::collection::vec(0.0..1.0_f64, sensors),
        separation in Just(separation),
        slack in Just(slack),
    ) -> (Schedule<64>, Micros) {
        let sensors = order.len();
        let mut sizes = vec![0; sensors];
        let mut size = separation.div_ceil(2);
        for (&x, gap) in order.iter().zip(&gaps) {
            sizes[x] = size + gap;
            size += gap + separation;
        }
        let period = size + slack;
        let (mut a, mut b) = (vec![], vec![]);
        for ((&size, sign), place) in sizes.iter().zip(&signs).zip(&places) {
            let early = Micros::new((f64::from(period - 1 - size) * place) as u32);
            let late = Micros::new(early.as_micros() + size);
            let (in_a, in_b) = if *sign { (late, early) } else { (early, late) };
            a.push(in_a);
            b.push(in_b);
        }
        let schedule =
            Schedule::from_slices(Micros::new(period), &vec![Micros::ZERO; sensors], [&a, &b]).unwrap();
        let asked = Requirements { stale_echo: true, ..Requirements::new(Micros::ZERO) };
        // Shorter than the window too, as a ring requires.
        let shorter = Micros::new(schedule.min_refire().as_micros().saturating_sub(1));
        let t_delta = schedule.verify(&asked).max_t_delta().unwrap().min(shorter);
        (schedule, t_delta)
    }
}

/// Readings of a `receiver` that hears only `emitter`, over one path, for some periods. The caller is sometimes late,
/// by `stalls`.
fn readings_of_crosstalk(
    schedule: &Schedule<64>,
    config: RingConfig,
    start: Instant,
    (emitter, receiver): (u8, u8),
    path: Micros,
    stalls: &[(u32, Micros)],
) -> Vec<ReadingKind> {
    let mut ring = Ring::unverified(schedule, config, start).unwrap();
    let mut arrivals = VecDeque::new();
    let mut kinds = vec![];
    let mut now = start;
    let mut polls = 0;
    for _ in 0..40 * schedule.sensors() {
        polls += 1;
        let deadline = ring.next_deadline();
        if deadline.has_reached(now) {
            now = deadline;
        }
        for (poll, stall) in stalls {
            if *poll == polls {
                now += *stall;
            }
        }
        while let Some(&at) = arrivals.front().filter(|at| now.has_reached(**at)) {
            arrivals.pop_front();
            ring.echo(receiver, at).unwrap();
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } if sensor == emitter => arrivals.push_back(now + path),
                RingEvent::Reading(reading) if reading.sensor == receiver => kinds.push(reading.kind),
                _ => {}
            }
        }
    }
    kinds
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn crosstalk_of_any_path_length_is_never_accepted(
        (schedule, t_delta) in verified_schedule(),
        pair in any::<(prop::sample::Index, prop::sample::Index)>(),
        periods in 0.0..6.0_f64,
        start: u32,
    ) {
        let (emitter, receiver) = (pair.0.index(schedule.sensors()) as u8, pair.1.index(schedule.sensors()) as u8);
        let period = schedule.period().as_micros();
        let path = if emitter == receiver {
            // A sensor hears its own stale echo. If it is two periods old, two phases cannot tell it from a true one.
            let least = schedule.min_refire().as_micros() + 1;
            Micros::new(least + (f64::from(2 * period - 1 - least) * periods / 6.0) as u32)
        } else {
            Micros::new((periods * f64::from(period)) as u32)
        };
        let config = RingConfig::new().with_t_delta(t_delta).with_window(schedule.min_refire());
        let start = Instant::from_micros(start);
        let kinds = readings_of_crosstalk(&schedule, config, start, (emitter, receiver), path, &[]);
        prop_assert!(!kinds.contains(&ReadingKind::Accepted), "{kinds:?}");
    }

    // Crosstalk that dies within a period is not accepted after a stall either.
    #[test]
    fn short_crosstalk_is_not_accepted_after_a_stall(
        (schedule, t_delta) in verified_schedule(),
        pair in any::<(prop::sample::Index, prop::sample::Index)>(),
        periods in 0.0..1.0_f64,
        stalls in prop::collection::vec((1..200_u32, 1.0..40.0_f64), 0..3),
    ) {
        let (emitter, receiver) = (pair.0.index(schedule.sensors()) as u8, pair.1.index(schedule.sensors()) as u8);
        prop_assume!(emitter != receiver);
        let path = Micros::new((periods * f64::from(schedule.min_refire().as_micros())) as u32);
        let config = RingConfig::new().with_t_delta(t_delta).with_window(schedule.min_refire());
        let stalls: Vec<_> = stalls
            .into_iter()
            .map(|(poll, times)| (poll, Micros::new((times * f64::from(t_delta.as_micros() + 1)) as u32)))
            .collect();
        let kinds =
            readings_of_crosstalk(&schedule, config, Instant::default(), (emitter, receiver), path, &stalls);
        prop_assert!(!kinds.contains(&ReadingKind::Accepted), "{kinds:?}");
    }

    // A true echo that moves less than `t_delta` per reading is always accepted.
    #[test]
    fn slow_true_echo_is_always_accepted(
        (schedule, t_delta) in verified_schedule(),
        steps in prop::collection::vec(-1.0..=1.0_f64, 20),
        consecutive in 2..=8_u8,
    ) {
        let window = schedule.min_refire();
        // Else sound that was sent two periods apart could explain it.
        let t_delta = t_delta.min(Micros::new((window.as_micros() - 1) / 2));
        let config = RingConfig::new().with_t_delta(t_delta).with_window(window).with_consecutive(consecutive);
        let mut ring = Ring::unverified(&schedule, config, Instant::default()).unwrap();
        let mut t_echo = vec![f64::from(window.as_micros()) / 2.0; schedule.sensors()];
        let mut readings = vec![0; schedule.sensors()];
        for _ in 0..30 * schedule.sensors() {
            let now = ring.next_deadline();
            while let Some(event) = ring.poll(now) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        let t_echo = &mut t_echo[usize::from(sensor)];
                        let step = steps[readings[usize::from(sensor)] % steps.len()] * f64::from(t_delta.as_micros());
                        *t_echo = (*t_echo + step.trunc()).clamp(0.0, f64::from(window.as_micros()));
                        ring.echo(sensor, now + Micros::new(*t_echo as u32)).unwrap();
                    }
                    RingEvent::Reading(reading) => {
                        let readings = &mut readings[usize::from(reading.sensor)];
                        *readings += 1;
                        let expected = match *readings {
                            1 => ReadingKind::First,
                            n if n < usize::from(consecutive) => ReadingKind::Repeated,
                            _ => ReadingKind::Accepted,
                        };
                        prop_assert_eq!(reading.kind, expected);
                    }
                    RingEvent::PeriodEnded(_) => {}
                }
            }
        }
        prop_assert!(readings.iter().all(|&readings| readings >= 10));
    }
}

#[test]
fn constant_waits_repeat_crosstalk_so_that_it_is_ambiguous() {
    // The negative control: nothing alternates, so only the firings tell crosstalk from a wall.
    let schedule = Schedule::<64>::from_slices(
        Micros::from_millis(60),
        &[Micros::ZERO, Micros::from_millis(15)],
        [&[Micros::ZERO; 2], &[Micros::ZERO; 2]],
    )
    .unwrap();
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::from_millis(36));
    let path = Micros::from_millis(25);
    let kinds = readings_of_crosstalk(&schedule, config, Instant::default(), (0, 1), path, &[]);
    assert_eq!(kinds[0], ReadingKind::First);
    assert!(kinds.len() > 8 && kinds[1..].iter().all(|&kind| kind == ReadingKind::Ambiguous), "{kinds:?}");

    let alternating = Schedule::<64>::from_slices(
        Micros::from_millis(60),
        schedule.t_lag(),
        [&[Micros::from_millis(4); 2], &[Micros::from_millis(2), Micros::ZERO]],
    )
    .unwrap();
    assert_eq!(alternating.t_wait(Phase::A).len(), 2);
    let kinds = readings_of_crosstalk(&alternating, config, Instant::default(), (0, 1), path, &[]);
    assert!(kinds.len() > 8 && kinds[1..].iter().all(|&kind| kind == ReadingKind::Rejected), "{kinds:?}");
}
