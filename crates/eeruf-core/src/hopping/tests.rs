//! Firings of a hopping ring, and its refusals.

extern crate std;

mod planning;

use super::*;
use crate::plan::{Plan, check_plan};
use crate::ring::RingEvent;
use crate::time::Micros;
use std::string::ToString;
use std::vec::Vec;

const PERIOD: Micros = Micros::from_millis(60);
const WINDOW: Micros = Micros::from_millis(36);

fn schedule() -> HoppingSchedule<8> {
    HoppingSchedule::spread(HoppingCode::new(8, 2, Micros::new(240)).unwrap(), PERIOD).unwrap()
}

fn ring(settings: HoppingSettings) -> HoppingRing<8> {
    let listening = HoppingListening { blanking: Micros::new(2380), ..HoppingListening::new(WINDOW) };
    HoppingRing::hopping(&schedule(), settings, listening, 7, Instant::from_micros(0)).unwrap()
}

/// The firings of some periods, on time, as (instant in microseconds, sensor, whether alone); `hears` says after how
/// long a firing has an echo.
fn fire(ring: &mut HoppingRing<8>, periods: u32, hears: impl Fn(u8, usize) -> Option<u32>) -> Vec<(u32, u8, bool)> {
    let (mut fired, mut ended) = (Vec::new(), 0);
    while ended < periods {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    fired.push((now.as_micros(), sensor, ring.plan().solo().is_some()));
                    if let Some(echo) = hears(sensor, fired.len()) {
                        ring.echo(sensor, now + Micros::new(echo)).unwrap();
                    }
                }
                RingEvent::Reading(_) => {}
                RingEvent::PeriodEnded(_) => {
                    ended += 1;
                    // What fires at the same instant belongs to the next period.
                    if ended == periods {
                        break;
                    }
                }
            }
        }
    }
    fired
}

// A paused ring keeps silent and believes nothing from before when it goes on.
#[test]
fn paused_ring_is_silent_and_forgets() {
    let mut ring = ring(HoppingSettings::BALANCED);
    let wall = |_, _| Some(9_000);
    fire(&mut ring, 40, wall);
    assert!((0..8).all(|sensor| ring.judge().confirmed(sensor).is_some()));
    ring.pause();
    assert_eq!(fire(&mut ring, 5, wall), []);
    ring.resume();
    assert!((0..8).all(|sensor| ring.judge().confirmed(sensor).is_none()));
    assert!(!fire(&mut ring, 2, wall).is_empty());
}

// Any two phases move any path by at least a step for every number of sensors.
#[test]
fn any_two_phases_move_any_path_by_a_step() {
    for sensors in 1..=64 {
        for code in [HoppingCode::new(sensors, 2, Micros::new(1)), HoppingCode::shortest(sensors, 2, Micros::new(1))] {
            let code = code.unwrap();
            let phases = i32::from(code.phases());
            let wait = |sensor: usize, phase: i32| code.wait(sensor, phase.rem_euclid(phases) as u8).as_micros() as i32;
            // Residues: the least distance between values whose residues differ is one step.
            for (x, y) in [(0, sensors - 1), (sensors / 2, 0), (sensors - 1, sensors / 3)] {
                for j in -1..=2 {
                    // With Welch's sequence one sensor does j periods later what the jth before it does.
                    if code.is_welch() && (y as i32 - x as i32 - j) % phases == 0 {
                        continue;
                    }
                    let moved = |m: i32| wait(x, m - j) - wait(y, m);
                    let mut places: Vec<_> = (0..phases).map(moved).collect();
                    places.sort_unstable();
                    assert!(x == y || places.windows(2).all(|pair| pair[1] > pair[0]), "{sensors}: {x} {y} {j}");
                }
            }
        }
    }
}

#[test]
fn shortest_code_has_the_latest_early_refire() {
    for sensors in 1..=64 {
        let code = HoppingCode::shortest(sensors, 2, Micros::new(1)).unwrap();
        assert!(usize::from(code.phases()) >= sensors);
        let mut most = 0;
        for sensor in 0..sensors {
            for phase in 0..code.phases() {
                let wait = |phase| code.wait(sensor, phase).as_micros() as i32;
                most = most.max(wait(phase) - wait((phase + 1) % code.phases()));
            }
        }
        assert_eq!(code.longest_drop(), Micros::new(most as u32), "{sensors}");
        // What each sensor's waits change by from phase to phase sums to 0 over a cycle, and no two sensors' changes
        // are less than a step apart: one of K sensors fires K - 1 steps early.
        assert_eq!(most as usize, sensors - 1);
        let welch = HoppingCode::new(sensors, 2, Micros::new(1)).unwrap();
        let drop = |phase| welch.wait(0, phase).saturating_sub(welch.wait(0, (phase + 1) % welch.phases()));
        assert_eq!(Some(welch.longest_drop()), (0..welch.phases()).map(drop).max(), "{sensors}");
    }
}

#[test]
fn schedules_are_equal_whatever_stands_beyond_sensors() {
    let code = HoppingCode::new(2, 2, Micros::new(240)).unwrap();
    let spread = HoppingSchedule::<8>::spread(code, PERIOD).unwrap();
    let lags = core::array::from_fn(|sensor| spread.t_lag(sensor).unwrap_or(Micros::new(7)));
    assert_eq!(HoppingSchedule::new(code, PERIOD, lags).unwrap(), spread);
}

// A ring that sees fires each sensor once a period as the schedule says.
#[test]
fn seeing_ring_fires_each_sensor_once_a_period() {
    let fired = fire(&mut ring(HoppingSettings::BALANCED), 40, |_, _| Some(12_000));
    let (phases, period) = (10, PERIOD.as_micros());
    for &(at, sensor, solo) in &fired {
        let phase = (at / period % phases) as u8;
        assert_eq!((at % period, solo), (schedule().t_fire(phase, sensor.into()).unwrap().as_micros(), false));
    }
    assert_eq!(fired.len(), 40 * 8);
}

// A blind sensor gets solo periods in which all is silent before and after.
#[test]
fn blind_sensor_gets_silent_solo_periods() {
    // Sensor 2 hears something else each time.
    let hears = |sensor, firing: usize| Some(if sensor == 2 { 5000 + (firing as u32 * 7919) % 20_000 } else { 12_000 });
    let settings = HoppingSettings { solo_rate: 255, solo_spacing: 2, ..HoppingSettings::BALANCED };
    let fired = fire(&mut ring(settings), 200, hears);
    let solos: Vec<_> = fired.iter().enumerate().filter(|(_, firing)| firing.2).collect();
    assert!(solos.len() > 10 && solos.iter().all(|(_, (_, sensor, _))| *sensor == 2), "{}", solos.len());
    let silence = WINDOW.as_micros();
    for (place, (at, ..)) in solos {
        assert!(at - fired[place - 1].0 > silence);
        assert!(fired.get(place + 1).is_none_or(|next| next.0 - at > silence));
    }
}

#[test]
fn new_lags_keep_windows_and_intervals() {
    let interval = Micros::from_millis(8);
    let settings =
        HoppingSettings { shift_interval: interval, shift_after: 5, shift_spacing: 2, ..HoppingSettings::BALANCED };
    let lags = core::array::from_fn(|sensor| Micros::new(14_400 * (sensor as u32 % 4)));
    let apart = HoppingSchedule::<8>::new(*schedule().code(), PERIOD, lags).unwrap();
    let listening = HoppingListening::new(WINDOW);
    let mut hopping = HoppingRing::hopping(&apart, settings, listening, 7, Instant::from_micros(0)).unwrap();
    let before: Vec<_> = (0..8).map(|sensor| hopping.plan().t_lag(sensor)).collect();
    let fired = fire(&mut hopping, 500, |_, firing| Some(3000 + (firing as u32 * 7919) % 30_000));
    let after: Vec<_> = (0..8).map(|sensor| hopping.plan().t_lag(sensor)).collect();
    assert!(before.iter().zip(&after).filter(|(before, after)| before != after).count() > 4);
    for (place, &(at, sensor, _)) in fired.iter().enumerate() {
        for &(next, other, _) in fired[place + 1..].iter().take(8) {
            let apart = next - at;
            assert!(other != sensor || apart >= WINDOW.as_micros());
            let neighbours = other != sensor && other.abs_diff(sensor) < 4;
            assert!(!neighbours || apart >= interval.as_micros(), "{sensor} {other} at {at}: {apart}");
        }
    }
}

#[test]
fn the_same_seed_and_echoes_give_the_same_firings() {
    let run = || fire(&mut ring(HoppingSettings::QUICK), 300, |_, firing| Some(3000 + (firing as u32 * 7919) % 30_000));
    assert_eq!(run(), run());
}

#[test]
fn hopping_keeps_what_every_plan_promises() {
    for seed in 0..40 {
        let reach = if seed % 2 == 0 { WINDOW } else { Micros::from_millis(90) };
        let listening = HoppingListening { blanking: Micros::new(2380), reach, ..HoppingListening::new(WINDOW) };
        let near = Micros::from_millis(1);
        let shifting = HoppingSettings { shift_after: 5, shift_interval: near, ..HoppingSettings::BALANCED };
        let hurried = HoppingSettings { solo_rate: 255, solo_spacing: 2, shift_spacing: 2, ..shifting };
        for settings in [shifting, hurried] {
            // The clock wraps on the way.
            let now = Instant::from_micros(u32::MAX - 500_000);
            let mut plan = HoppingPlan::new(&schedule(), settings, listening, seed, now).unwrap();
            check_plan(&mut plan, now, 2_000, seed).unwrap();
            assert!(plan.t_lag(3) != schedule().t_lag(3), "no lag was drawn");
        }
    }
}

#[test]
fn a_disabled_sensor_is_left_out_at_once_and_comes_back() {
    let mut ring = ring(HoppingSettings::BALANCED);
    ring.disable(3).unwrap();
    assert!(fire(&mut ring, 5, |_, _| Some(12_000)).iter().all(|&(_, sensor, _)| sensor != 3));
    ring.enable(3).unwrap();
    assert!(fire(&mut ring, 5, |_, _| Some(12_000)).iter().any(|&(_, sensor, _)| sensor == 3));
}

#[test]
fn a_clock_that_jumps_restarts_the_ring_and_does_not_hang_it() {
    let mut ring = ring(HoppingSettings::BALANCED);
    fire(&mut ring, 20, |_, _| Some(12_000));
    for jump in [1 << 31, 3_000_000_000, 90_000_000, u32::MAX - 5] {
        let now = Instant::from_micros(jump);
        let mut events = 0;
        while ring.poll(now).is_some() {
            events += 1;
        }
        assert!(events < 200 && ring.next_deadline().since(now) <= Micros::from_millis(300), "{jump}: {events}");
        let fired = fire(&mut ring, 6, |_, _| Some(12_000));
        let times = |sensor| fired.iter().filter(|firing| firing.1 == sensor).count();
        assert!((0..8).all(|sensor| times(sensor) >= 3), "{jump}");
    }
}

#[test]
fn each_error_names_what_is_wrong_and_what_is_expected() {
    let step = Micros::new(240);
    let text = |error: HoppingError| error.to_string();
    assert_eq!(text(HoppingCode::new(65, 2, step).unwrap_err()), "65 sensors; expected 1 to 64");
    assert_eq!(text(HoppingCode::new(8, 68, step).unwrap_err()), "68 phases; expected 2 to 67");
    assert_eq!(text(HoppingCode::new(8, 2, Micros::ZERO).unwrap_err()), "a step of 0 us; expected 1 us to 65.535 ms");
    assert_eq!(
        text(HoppingCode::of(8, 9, 1, step).unwrap_err()),
        "9 phases; expected a prime that is no less than the sensors, such as 11, or one less than a prime \
         and above the sensors"
    );
    assert_eq!(
        text(HoppingCode::of(8, 11, 11, step).unwrap_err()),
        "a first multiplier of 11; expected less than 11, the number of phases"
    );
    let code = HoppingCode::new(8, 2, step).unwrap();
    let late = HoppingSchedule::new(code, PERIOD, [Micros::from_millis(58); 8]).unwrap_err();
    assert_eq!(text(late), "a lag of 58 ms for sensor 1; expected at most 57.839 ms");
    let short = HoppingSchedule::<8>::spread(code, Micros::from_millis(37)).unwrap();
    let listening = HoppingListening::new(WINDOW);
    let new = |schedule, settings| HoppingRing::<8>::hopping(schedule, settings, listening, 1, Instant::from_micros(0));
    let error = new(&short, HoppingSettings::BALANCED).unwrap_err();
    assert_eq!(text(error), "a period of 37 ms; expected 37.2 ms to 268435.456 ms");
    let few = HoppingSchedule::<8>::spread(HoppingCode::new(2, 2, step).unwrap(), PERIOD).unwrap();
    let error = new(&few, HoppingSettings::BALANCED).unwrap_err();
    assert_eq!(text(error), "5 votes to confirm an echo; expected at most 4, the phases of the code");
    let tracker = crate::judge::TrackerSettings { t_delta: step, ..crate::judge::TrackerSettings::BALANCED };
    let error = new(&schedule(), HoppingSettings { tracker, ..HoppingSettings::BALANCED }).unwrap_err();
    assert_eq!(text(error), "a t_delta of 240 us; expected less than 240 us, by which the code moves crosstalk");
}

// A code has the phases asked for up to 67 and a step of 16 bits.
#[test]
fn code_has_up_to_67_phases_and_a_step_of_16_bits() {
    let code = |phases, step| HoppingCode::new(2, phases, Micros::new(step)).map(|code| (code.phases(), code.width()));
    assert_eq!(code(13, 240), Ok((16, Micros::new(15 * 240))));
    assert_eq!(code(67, 65_535), Ok((66, Micros::new(65 * 65_535))));
    assert_eq!(code(68, 1), Err(HoppingError::Phases { phases: 68 }));
    for step in [65_536, 70_000].map(Micros::new) {
        assert_eq!(HoppingCode::new(2, 2, step), Err(HoppingError::Step { step }));
    }
}

// Lags and period are scaled to the nearest microsecond, the code stays.
#[test]
fn scaled_schedule_keeps_its_code() {
    let code = HoppingCode::new(3, 2, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::<4>::new(code, Micros::new(60_001), [0, 1, 30_001, 0].map(Micros::new)).unwrap();
    let scaled = schedule.scaled(3, 2).unwrap();
    assert_eq!((scaled.code(), scaled.period()), (&code, Micros::new(90_002)));
    assert_eq!([0, 1, 2, 3].map(|x| scaled.t_lag(x).map(Micros::as_micros)), [Some(0), Some(2), Some(45_002), None]);
    for (num, den) in [(1, 1_000), (u32::MAX, 1), (1, 0)] {
        assert!(matches!(schedule.scaled(num, den), Err(HoppingError::Period { .. })), "{num}/{den}");
    }
}
