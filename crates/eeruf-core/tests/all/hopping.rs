//! The promise of a hopping ring: one path of fixed length is never believed, whatever the lateness, with solo periods
//! and with lags that change. The world here is as naive as can be: sound leaves when a sensor fires and arrives a
//! fixed time later.

use eeruf_core::{
    Instant, MAX_PERIOD, Micros, Phase, ReadingKind, Requirements, Ring, RingEvent, Tally,
    flow::{FlowRing, FlowSettings},
    hopping::{HoppingCode, HoppingError, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
    judge::Judge,
    phases::PhaseTable,
    plan::Plan,
};
use proptest::prelude::*;

use crate::common::random::Random;

const SENSORS: usize = 8;
const BLANKING: u32 = 2380;
const WINDOW: u32 = 36_000;

/// Sound from one sensor to another, in microseconds.
#[derive(Clone, Copy, Debug)]
struct Path {
    from: u8,
    to: u8,
    length: u32,
}

/// Lateness of polls: up to `each` microseconds, and now and then a stall.
#[derive(Clone, Copy, Debug)]
struct Late {
    each: u32,
    stall: u32,
}

/// The kinds of all readings of the receivers of these paths; nobody hears anything else.
fn readings(
    paths: &[Path],
    step: u32,
    settings: HoppingSettings,
    late: Late,
    seed: u64,
    periods: u32,
) -> Vec<ReadingKind> {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(step)).unwrap();
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(60_000)).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
    let start = Instant::from_micros(0);
    let ring = HoppingRing::<SENSORS>::hopping(&schedule, settings, listening, seed as u32, start).unwrap();
    readings_of(ring, paths, late, seed, periods)
}

/// The same of any ring.
fn readings_of<P: Plan, J: Judge>(
    mut ring: Ring<P, J, SENSORS, 1, 1>,
    paths: &[Path],
    late: Late,
    seed: u64,
    periods: u32,
) -> Vec<ReadingKind> {
    let mut random = Random(seed);
    let (mut kinds, mut arrivals, mut ended) = (Vec::new(), Vec::<(u32, u8)>::new(), 0);
    while ended < periods {
        let stall = if random.up_to(39) == 0 { random.up_to(late.stall) } else { 0 };
        let now = ring.next_deadline().as_micros() + random.up_to(late.each) + stall;
        arrivals.sort_unstable();
        while let Some(&(at, to)) = arrivals.first().filter(|arrival| arrival.0 <= now) {
            ring.echo(to, Instant::from_micros(at)).unwrap();
            arrivals.remove(0);
        }
        while let Some(event) = ring.poll(Instant::from_micros(now)) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let heard = paths.iter().filter(|path| path.from == sensor);
                    arrivals.extend(heard.map(|path| (now + path.length, path.to)));
                }
                RingEvent::Reading(reading) if paths.iter().any(|path| path.to == reading.sensor) => {
                    kinds.push(reading.kind);
                }
                RingEvent::Reading(_) => {}
                RingEvent::PeriodEnded(_) => ended += 1,
            }
        }
    }
    kinds
}

fn accepted_or_tentative(kinds: &[ReadingKind]) -> usize {
    kinds.iter().filter(|kind| matches!(kind, ReadingKind::Accepted | ReadingKind::Tentative)).count()
}

fn settings() -> impl Strategy<Value = HoppingSettings> {
    let named = prop_oneof![
        Just(HoppingSettings::BALANCED),
        Just(HoppingSettings::QUICK),
        Just(HoppingSettings::DRIVING),
        Just(HoppingSettings::MAPS),
    ];
    (named, 0..128_u8, 1..6_u8, prop_oneof![Just(0_u8), 1..6_u8], 1..12_u8).prop_map(
        |(named, solo_rate, solo_spacing, shift_after, shift_spacing)| {
            let solo = named.with_solo_rate(solo_rate).with_solo_spacing(solo_spacing);
            solo.with_shift_after(shift_after).with_shift_spacing(shift_spacing)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, ..ProptestConfig::default() })]

    #[test]
    fn one_fixed_path_is_never_believed(
        from in 0..8_u8,
        further in 1..8_u8,
        length in 0..=WINDOW,
        settings in settings(),
        each in prop_oneof![Just(0_u32), 0..100_u32, 0..2000_u32],
        stall in prop_oneof![Just(0_u32), 0..3000_u32, 0..200_000_u32],
        seed in any::<u64>(),
    ) {
        let path = Path { from, to: (from + further) % 8, length };
        let kinds = readings(&[path], 240, settings, Late { each, stall }, seed, 150);
        prop_assert!(kinds.len() > 20);
        prop_assert_eq!(accepted_or_tentative(&kinds), 0);
    }

    #[test]
    fn flow_never_believes_one_path_whatever_the_lateness(
        from in 0..8_u8,
        further in 1..8_u8,
        length in 0..=WINDOW,
        each in prop_oneof![Just(0_u32), 0..100_u32, 0..2000_u32],
        stall in prop_oneof![Just(0_u32), 0..3000_u32, 0..200_000_u32],
        seed in any::<u64>(),
    ) {
        let path = Path { from, to: (from + further) % 8, length };
        let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
        let start = Instant::from_micros(0);
        let ring = FlowRing::<SENSORS>::flow(SENSORS, FlowSettings::DEFAULT, listening, start).unwrap();
        let kinds = readings_of(ring, &[path], Late { each, stall }, seed, 150);
        prop_assert!(kinds.len() > 20);
        prop_assert_eq!(accepted_or_tentative(&kinds), 0);
    }
}

// A step within t delta of the lateness is what the promise needs.
#[test]
fn step_within_t_delta_of_lateness_is_needed() {
    // With a step that leaves a margin of 1 us, a path is not believed either, since readings that lateness has moved
    // do not count; but then hardly any reading counts.
    let late = Late { each: 60, stall: 0 };
    for seed in 0..20 {
        let path = Path { from: 0, to: 1, length: 20_000 };
        assert_eq!(accepted_or_tentative(&readings(&[path], 151, HoppingSettings::QUICK, late, seed, 200)), 0);
    }
}

// Two or three paths that agree by accident are not confirmed and hardly ever tentative.
#[test]
fn paths_that_agree_by_accident_are_not_confirmed() {
    let (mut random, mut kinds) = (Random(7), Vec::new());
    for world in 0..300 {
        let mut path = |from| Path { from, to: 0, length: BLANKING + random.up_to(WINDOW - BLANKING) };
        let paths = [path(1), path(2), path(5)];
        let settings = if world % 2 == 0 { HoppingSettings::BALANCED } else { HoppingSettings::QUICK };
        kinds.extend(readings(&paths[..2 + world % 2], 240, settings, Late { each: 40, stall: 0 }, world as u64, 110));
    }
    let of = |kind| kinds.iter().filter(|&&heard| heard == kind).count();
    assert_eq!(of(ReadingKind::Accepted), 0);
    // With votes that need not be close they would be: C(11, 2) 2 T_delta / S of the cycles.
    assert!(of(ReadingKind::Tentative) * 500 < kinds.len(), "{}", of(ReadingKind::Tentative));
}

#[test]
fn an_echo_of_ones_own_is_believed_nearly_always() {
    let own = Path { from: 3, to: 3, length: 12_000 };
    for late in [Late { each: 0, stall: 0 }, Late { each: 40, stall: 0 }, Late { each: 40, stall: 5000 }] {
        let kinds = readings(&[own], 240, HoppingSettings::BALANCED, late, 1, 400);
        assert!(
            accepted_or_tentative(&kinds) * 10 > kinds.len() * 9,
            "{late:?}: {} of {}",
            accepted_or_tentative(&kinds),
            kinds.len()
        );
    }
}

// A reading has the phase and period of its firing and a period counts the readings it gave.
#[test]
fn reading_has_phase_and_period_of_its_firing() {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(60_000)).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
    let start = Instant::from_micros(0);
    let mut ring = HoppingRing::<SENSORS>::hopping(&schedule, HoppingSettings::BALANCED, listening, 1, start).unwrap();
    let (mut fired, mut given, mut late) = ([None; SENSORS], Tally::<u8>::default(), 0);
    let (mut periods, mut phases, mut edges) = (0, Vec::new(), Vec::<(Instant, u8)>::new());
    while periods < 60 {
        let now = ring.next_deadline();
        edges.sort_unstable_by_key(|&(at, _)| at.since(start));
        while let Some(&(at, sensor)) = edges.first().filter(|edge| now.has_reached(edge.0)) {
            ring.echo(sensor, at).unwrap();
            edges.remove(0);
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, phase, .. } => {
                    fired[usize::from(sensor)] = Some((phase, periods));
                    // Now and then after the window.
                    let length = if periods % 5 == 4 { WINDOW + 9000 } else { 9000 };
                    edges.push((now + Micros::new(length + u32::from(sensor)), sensor));
                }
                RingEvent::Reading(reading) => {
                    assert_eq!(
                        Some((reading.phase, reading.period)),
                        fired[usize::from(reading.sensor)],
                        "{reading:?}"
                    );
                    late += u32::from(reading.kind == ReadingKind::Late);
                    given.count(reading.kind);
                }
                RingEvent::PeriodEnded(stats) => {
                    assert_eq!(stats.tally, core::mem::take(&mut given), "period {periods}");
                    phases.push(stats.phase);
                    periods += 1;
                }
            }
        }
    }
    assert!(late > 0, "no reading was late");
    let first = usize::from(phases[0].0);
    let wanted = (first..).map(|phase| Phase((phase % usize::from(code.phases())) as u8));
    assert!(phases.iter().copied().eq(wanted.take(phases.len())), "{phases:?}");
}

// A period counts late edges of both kinds before and after the window was closed.
#[test]
fn period_counts_late_edges_of_both_kinds() {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(60_000)).unwrap();
    let start = Instant::from_micros(0);
    let listening = HoppingListening::new(Micros::new(WINDOW));
    let mut ring = HoppingRing::<SENSORS>::hopping(&schedule, HoppingSettings::BALANCED, listening, 1, start).unwrap();
    let (mut late, mut given, mut periods) = (0, 0, 0);
    while periods < 20 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor: 0, .. } => {
                    // Two after the window, which has not been polled for: they are counted and make no reading.
                    ring.echo(0, now + Micros::new(WINDOW + 1)).unwrap();
                    ring.echo(0, now + Micros::new(WINDOW + 2)).unwrap();
                    late += 2;
                }
                // And one after its reading.
                RingEvent::Reading(reading) if reading.sensor == 0 && reading.kind != ReadingKind::Late => {
                    ring.echo(0, now + Micros::new(1)).unwrap();
                }
                RingEvent::Reading(reading) => {
                    let is_late = u32::from(reading.kind == ReadingKind::Late);
                    (late, given) = (late + is_late, given + is_late);
                }
                RingEvent::Fire { .. } => {}
                RingEvent::PeriodEnded(stats) => {
                    assert_eq!(stats.tally.of(ReadingKind::Late), core::mem::take(&mut late), "period {periods}");
                    periods += 1;
                }
            }
        }
    }
    assert!(given > 10, "{given}");
}

// A sensor rests for its window also after a firing that was late past the periods end.
#[test]
fn sensor_rests_after_a_firing_late_past_the_period() {
    let code = HoppingCode::new(SENSORS, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<SENSORS>::spread(code, Micros::new(60_000)).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW)).with_blanking(Micros::new(BLANKING));
    // Lags that move come to lie at the very end of the period.
    let settings = HoppingSettings::BALANCED.with_shift_after(1).with_shift_spacing(1);
    for seed in 0..60 {
        let mut random = Random(seed);
        let start = Instant::from_micros(0);
        let mut ring = HoppingRing::<SENSORS>::hopping(&schedule, settings, listening, seed as u32, start).unwrap();
        let (mut fired, mut periods, mut last_fired) = ([None; SENSORS], 0, None);
        while periods < 400 {
            let now = ring.next_deadline() + Micros::new(random.up_to(999));
            while let Some(event) = ring.poll(now) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        // The trigger may come after the poll, and the caller says so.
                        let at = now + Micros::new(if seed % 2 == 0 { random.up_to(900) } else { 0 });
                        ring.fired(sensor, at).unwrap();
                        let last: &mut Option<Instant> = &mut fired[usize::from(sensor)];
                        let rested = last.replace(at).map(|last| at.since(last));
                        assert!(rested.is_none_or(|rested| rested >= Micros::new(WINDOW)), "{sensor}: {rested:?}");
                        if ring.plan().solo().is_some() {
                            let silent = last_fired.map(|last| at.since(last));
                            assert!(silent.is_none_or(|silent| silent >= Micros::new(WINDOW)), "{sensor}: {silent:?}");
                        }
                        last_fired = Some(at);
                        // What hardly ever fits.
                        ring.echo(sensor, at + Micros::new(3000 + random.up_to(30_000))).unwrap();
                    }
                    RingEvent::Reading(_) => {}
                    RingEvent::PeriodEnded(_) => periods += 1,
                }
            }
        }
    }
}

#[test]
fn a_schedule_takes_what_just_fits_and_nothing_more() {
    let us = Micros::new;
    let code = HoppingCode::new(3, 2, us(240)).unwrap();
    let width = code.width().as_micros();
    let least = HoppingSchedule::<3>::new(code, us(width + 1), [Micros::ZERO; 3]).unwrap();
    assert_eq!(least.longest_lag(), Micros::ZERO);
    let short = HoppingSchedule::<3>::new(code, us(width), [Micros::ZERO; 3]).unwrap_err();
    assert_eq!(short, HoppingError::Period { period: us(width), least: us(width + 1) });
    let most = HoppingSchedule::<3>::new(code, MAX_PERIOD, [us(MAX_PERIOD.as_micros() - width - 1); 3]).unwrap();
    assert_eq!(most.t_lag(2), Some(most.longest_lag()));
    let longer = HoppingSchedule::<3>::new(code, MAX_PERIOD, [us(0), us(0), us(MAX_PERIOD.as_micros() - width)]);
    let (lag, most) = (us(MAX_PERIOD.as_micros() - width), most.longest_lag());
    assert_eq!(longer, Err(HoppingError::Lag { sensor: 2, lag, most }));
    let long = us(MAX_PERIOD.as_micros() + 1);
    assert!(matches!(HoppingSchedule::<3>::new(code, long, [us(0); 3]), Err(HoppingError::Period { .. })));
    let narrow = HoppingSchedule::<2>::new(code, us(60_000), [us(0); 2]);
    assert_eq!(narrow, Err(HoppingError::Sensors { sensors: 3, most: 2 }));
    // Evenly, and nobody is beyond the last sensor.
    let even = HoppingSchedule::<4>::spread(code, us(60_000)).unwrap();
    let third = (60_000 - width) / 3;
    let lags = [0, third, 2 * third].map(|lag| Some(us(lag)));
    assert_eq!(([0, 1, 2].map(|sensor| even.t_lag(sensor)), even.t_lag(3)), (lags, None));
    // 2 to the third is 3 modulo 5: two steps.
    assert_eq!((even.t_fire(1, 2), even.t_fire(1, 3)), (Some(us(2 * third + 480)), None));
}

// The table of a schedule says when each sensor fires over and over again.
#[test]
fn table_says_when_each_sensor_fires() {
    let code = HoppingCode::new(3, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<4>::spread(code, Micros::new(30_000)).unwrap();
    // More phases than a byte counts.
    let table = schedule.table::<300>();
    for (phase, row) in table.iter().enumerate() {
        let first = phase % usize::from(code.phases());
        for (sensor, &t_fire) in row.iter().enumerate() {
            let says = schedule.t_fire(first as u8, sensor).unwrap_or(Micros::ZERO);
            assert_eq!((t_fire, table[first][sensor]), (says, says), "{phase} {sensor}");
        }
    }
    assert!(table[1][2] != Micros::ZERO);
}

#[test]
fn proven_separation_is_what_trying_phases_finds() {
    // Sound is heard for many periods: paths read with two ages.
    let window = Micros::new(800);
    let requirements =
        Requirements { window, audible: Some(Micros::new(20_000)), ..Requirements::new(Micros::new(100)) };
    // No path is heard in two phases.
    let short = Requirements { window: Micros::new(200), ..Requirements::new(Micros::new(100)) };
    let mut least = Micros::MAX;
    let codes = (2..=4).flat_map(|sensors| [HoppingCode::new, HoppingCode::shortest].map(|of| (sensors, of)));
    for (sensors, of) in codes {
        let code = of(sensors, 2, Micros::new(240)).unwrap();
        let two_ages = 2 * code.width().as_micros() + 240;
        for period in [two_ages - 1, two_ages, two_ages + 500] {
            let schedule = HoppingSchedule::<4>::spread(code, Micros::new(period)).unwrap();
            let table = schedule.table::<67>();
            let cycle = PhaseTable::new(schedule.period(), &table[..code.phases().into()]).with_sensors(sensors);
            let tried = cycle.separation(&requirements).map(|separation| separation.value);
            let says = schedule.verify(&requirements).separation().map(|separation| separation.value);
            assert_eq!(says, tried, "{sensors} sensors, {period} us");
            if !code.is_welch() {
                least = says.map_or(least, |says| says.min(least));
            }
            // From there on it is proven, whatever is heard.
            let says = schedule.verify(&short).separation().map(|separation| separation.value);
            assert_eq!(says, (period >= two_ages).then_some(code.step()), "{sensors} sensors, {period} us");
        }
    }
    assert_eq!(least, Micros::new(239), "no path that reads with two ages was tried");
    let alone = HoppingSchedule::<1>::spread(HoppingCode::new(1, 2, Micros::new(240)).unwrap(), Micros::new(9_000));
    assert!(alone.unwrap().verify(&requirements).separation().is_none());
}

/// Judges one path of this length by a ring with such a window and a period of half a minute.
fn accepted_of_one_path(window: u32) -> Result<usize, HoppingError> {
    let code = HoppingCode::new(2, 5, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<2>::new(code, Micros::from_millis(30_000), [Micros::ZERO; 2]).unwrap();
    let listening = HoppingListening::new(Micros::new(window));
    let mut ring =
        HoppingRing::<2>::hopping(&schedule, HoppingSettings::DRIVING, listening, 1, Instant::from_micros(0))?;
    let (mut kinds, mut arrivals) = (Vec::new(), Vec::<Instant>::new());
    while kinds.len() < 60 {
        let now = ring.next_deadline();
        arrivals.retain(|&at| {
            let has_come = now.has_reached(at);
            if has_come {
                ring.echo(1, at).unwrap();
            }
            !has_come
        });
        while let Some(event) = ring.poll(now) {
            match event {
                // The code is 1.2 ms wide: the path is heard in all phases.
                RingEvent::Fire { sensor: 0, .. } => arrivals.push(now + Micros::new(window - 1_200)),
                RingEvent::Reading(reading) if reading.sensor == 1 => kinds.push(reading.kind),
                _ => {}
            }
        }
    }
    assert!(kinds.iter().all(|&kind| kind != ReadingKind::NoEcho), "{kinds:?}");
    Ok(accepted_or_tentative(&kinds))
}

#[test]
fn windows_too_long_for_the_tracker_are_refused() {
    // It keeps echo times in 24 bits, and all later ones read alike: 59 of 60 readings of this path were believed with
    // a window of 20 s.
    let most = HoppingListening::MAX_WINDOW;
    assert_eq!(accepted_of_one_path(most.as_micros()), Ok(0));
    for window in [20_000_000, most.as_micros() + 1] {
        let error = HoppingError::Window { window: Micros::new(window), most };
        assert_eq!(accepted_of_one_path(window), Err(error));
    }
    let error = HoppingError::Window { window: Micros::from_millis(20_000), most };
    assert_eq!(error.to_string(), "a listening window of 20000 ms; expected at most 16711.679 ms");
    assert!(error.as_str().contains("window"), "{}", error.as_str());
}

#[test]
fn a_clock_that_steps_back_delays_no_reading() {
    // Two of eight sensors fire at the same instant in phase 0, and by different clocks where the clock steps back.
    let code = HoppingCode::of(SENSORS, 11, 1, Micros::new(240)).unwrap();
    let lags = std::array::from_fn(|sensor| Micros::new(14_400 * (sensor as u32 % 4)));
    let schedule = HoppingSchedule::<SENSORS>::new(code, Micros::new(60_000), lags).unwrap();
    let listening = HoppingListening::new(Micros::new(WINDOW));
    for seed in 0..20 {
        let (mut random, start) = (Random(seed + 1), Instant::from_micros((seed as u32).wrapping_mul(0xf000_0000)));
        let settings = if seed % 2 == 0 { HoppingSettings::DRIVING } else { HoppingSettings::BALANCED };
        let mut ring = HoppingRing::<SENSORS>::hopping(&schedule, settings, listening, 1, start).unwrap();
        let (mut fired, mut periods, mut latest) = ([start; SENSORS], 0, Micros::ZERO);
        while periods < 200 {
            // Within 3 us after it is due: the next poll may come sooner by the clock.
            let now = ring.next_deadline() + Micros::new(random.up_to(3));
            match ring.poll(now) {
                Some(RingEvent::Fire { sensor, .. }) => fired[usize::from(sensor)] = now,
                Some(RingEvent::Reading(reading)) => {
                    let after = now.since(fired[usize::from(reading.sensor)]);
                    assert!(after >= Micros::new(WINDOW), "{after}");
                    latest = latest.max(after.saturating_sub(Micros::new(WINDOW)));
                }
                Some(RingEvent::PeriodEnded(_)) => periods += 1,
                None => {}
            }
        }
        assert!(latest <= Micros::new(6), "seed {seed}: a reading comes {latest} after its window has closed");
    }
}
