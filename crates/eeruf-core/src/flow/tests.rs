//! Cycles of a flow ring: order, gaps, the grid, and what sensors gain and give back.

extern crate std;

use super::*;
use crate::hopping::HoppingCode;
use crate::judge::{EchoTracker, Firing, Heard, Judge};
use crate::own_limits::{EachSensor, OwnLimits, SensorLimits};
use crate::plan::{Plan, check_plan};
use crate::reading::{ReadingKind, Verdict};
use crate::requirements::Requirements;
use crate::ring::RingEvent;
use crate::schedule::Phase;
use crate::time::Micros;
use crate::uneven::Uneven;
use std::vec::Vec;

const WINDOW: Micros = Micros::from_millis(36);

/// The most phases of a cycle in which sound of a robot with one step reads alike at a robot with another, within
/// `t_delta`, whatever their offset.
fn phases_alike(sensors: usize, [sends, hears]: [u8; 2]) -> usize {
    let code = |number| {
        let settings = FlowSettings::DEFAULT.with_fleet_number(number);
        HoppingCode::new(sensors, settings.tracker.votes, settings.step).unwrap()
    };
    let (sends, hears) = (code(sends), code(hears));
    let alike = |apart: u8| {
        let wait = |code: &HoppingCode, phase| code.wait(0, phase % code.phases()).as_micros() as i32;
        let mut reads: Vec<_> =
            (0..hears.phases()).map(|phase| wait(&sends, phase + apart) - wait(&hears, phase)).collect();
        reads.sort_unstable();
        let t_delta = FlowSettings::DEFAULT.tracker.t_delta.as_micros() as i32;
        let within = |from: &i32| reads.iter().filter(|read| (*from..=from + t_delta).contains(read)).count();
        reads.iter().map(within).max().unwrap()
    };
    (0..hears.phases()).map(alike).max().unwrap()
}

// Numbers 0 to 5, of which each two are tried; with the same number all phases agree.
#[test]
fn few_phases_of_unlike_fleet_numbers_read_alike() {
    for (sensors, most) in [(6, 4), (11, 4), (15, 5), (17, 6), (21, 7), (27, 9)] {
        let pairs = (0..6).flat_map(|one| (0..6).map(move |other| [one, other]));
        let found = pairs.filter(|[one, other]| one != other).map(|pair| phases_alike(sensors, pair)).max();
        assert_eq!(found, Some(most), "{sensors} sensors");
        assert!(phases_alike(sensors, [2, 8]) > 5, "a number counted from 0 again");
    }
}

fn listening() -> HoppingListening {
    HoppingListening::new(WINDOW).with_blanking(Micros::new(2_380))
}

fn plan<const K: usize>(sensors: usize) -> FlowPlan<K> {
    FlowPlan::new(sensors, FlowSettings::DEFAULT, listening(), Instant::from_micros(0)).unwrap()
}

/// A judge that believes an echo at 20 ms of each of eight sensors.
fn judge() -> impl Judge {
    let mut tracker = EchoTracker::<8>::new(FlowSettings::DEFAULT.tracker).unwrap();
    for (sensor, phase) in (0..8).flat_map(|sensor| (0..5).map(move |phase| (sensor, phase))) {
        tracker.push(sensor, &[Micros::from_millis(20)], Firing::new(Phase(phase))).unwrap();
    }
    tracker
}

/// Fires a cycle on time; `hears` gives each sensor's echo and the kind of its reading. Returns who fired when, after
/// the start of the cycle, and the cycle's length.
fn cycle<const K: usize, U: OwnLimits>(
    plan: &mut FlowPlan<K, U>,
    fired: &mut [Instant; K],
    expected_change_us: i32,
    hears: impl Fn(u8) -> (u32, ReadingKind),
) -> (Vec<(u8, u32)>, u32) {
    let (judge, start) = (judge(), plan.start);
    let mut seen = Vec::new();
    while let Some((sensor, _)) = plan.next_firing() {
        let now = plan.deadline();
        plan.fire(now);
        fired[usize::from(sensor)] = now;
        let firing = Firing { expected_change_us, ..plan.last_firing(sensor, 0) };
        seen.push((sensor, now.since(start).as_micros()));
        let (echo_us, kind) = hears(sensor);
        let echoes = [Micros::new(echo_us)];
        let heard = Heard { sensor, fired: now, echoes: &echoes, firing, t_delta: Micros::new(150) };
        let verdict = Verdict { kind, ..heard.unjudged(None) };
        plan.judged(&heard, &verdict, &judge);
    }
    let end = plan.deadline();
    plan.end_period(end);
    plan.begin_period(|sensor| fired[usize::from(sensor)]);
    (seen, end.since(start).as_micros())
}

const WELL: fn(u8) -> (u32, ReadingKind) = |_| (20_000, ReadingKind::Accepted);
const MASKED: fn(u8) -> (u32, ReadingKind) = |_| (6_000, ReadingKind::Rejected);

#[test]
fn flow_keeps_what_every_plan_promises() {
    for seed in 0..20 {
        let now = Instant::from_micros(u32::MAX - 1_000_000);
        check_plan(&mut FlowPlan::<12>::new(8, FlowSettings::DEFAULT, listening(), now).unwrap(), now, 3_000, seed)
            .unwrap();
    }
    for sensors in 1..=24 {
        let now = Instant::from_micros(0);
        check_plan(&mut plan::<24>(sensors), now, 1_000, 7).unwrap();
    }
}

#[test]
fn a_flow_ring_of_twelve_takes_916_bytes() {
    assert_eq!(size_of::<FlowRing<12>>(), 916);
}

// A ring that is believed fires each sensor once in the shortest cycle.
#[test]
fn believed_ring_fires_in_the_shortest_cycle() {
    let (mut plan, mut fired) = (plan::<8>(8), [Instant::from_micros(0); 8]);
    for _ in 0..20 {
        let (seen, length) = cycle(&mut plan, &mut fired, 0, WELL);
        // Neighbours never fire one after the other.
        assert_eq!(seen.iter().map(|(sensor, ..)| *sensor).collect::<Vec<_>>(), [0, 3, 6, 1, 4, 7, 2, 5]);
        // A multiple of the grid of 2,640 us.
        assert_eq!(length, 63_360);
    }
}

#[test]
fn firings_move_on_the_grid_by_the_code_whatever_gaps_are() {
    let (mut plan, mut fired) = (plan::<8>(8), [Instant::from_micros(0); 8]);
    let code = plan.code;
    for number in 0..60_u32 {
        let phase = plan.phase().0;
        let (seen, length) = cycle(&mut plan, &mut fired, 0, |sensor| {
            if (u32::from(sensor) + number) % 5 < 2 { MASKED(sensor) } else { WELL(sensor) }
        });
        assert_eq!(length % 2_640, 0);
        for (turn, (_, at)) in seen.into_iter().enumerate() {
            assert_eq!(at % 2_640, code.wait(turn, phase).as_micros(), "cycle {number}, turn {turn}");
        }
    }
}

/// The time before and after a sensor's firing in which nobody else fires, in microseconds.
fn silence(seen: &[(u8, u32)], length: u32, sensor: u8) -> (u32, u32) {
    let place = seen.iter().position(|&(other, _)| other == sensor).unwrap();
    let before = place.checked_sub(1).map_or(0, |before| seen[before].1);
    (seen[place].1 - before, seen.get(place + 1).map_or(length, |&(_, at)| at) - seen[place].1)
}

// A masked sensor gains quiet until nothing is heard of others and gives it back.
#[test]
fn masked_sensor_gains_quiet_and_gives_it_back() {
    let (mut plan, mut fired) = (plan::<8>(8), [Instant::from_micros(0); 8]);
    let masked = |sensor| if sensor == 4 { MASKED(sensor) } else { WELL(sensor) };
    for _ in 0..20 {
        cycle(&mut plan, &mut fired, 0, masked);
    }
    for _ in 0..10 {
        let (seen, length) = cycle(&mut plan, &mut fired, 0, masked);
        // 6 ms after its firing no later sensor has been heard, so that it needs silence before it, and as much after
        // it for its firings with nothing believed.
        let (before, after) = silence(&seen, length, 4);
        assert!(before > 36_000 && after > 33_620, "{before} {after}");
        assert!(length < 200_000, "{length}");
    }
    for _ in 0..40 {
        cycle(&mut plan, &mut fired, 0, WELL);
    }
    assert_eq!(plan.quiet(4), plan.quiet(0));
    assert_eq!(plan.quiet(8), None);
}

// A cycle ends within the longest for a robot that stands and sooner for one that moves.
#[test]
fn cycle_ends_in_time_for_standing_and_moving_robots() {
    let (mut plan, mut fired) = (plan::<12>(12), [Instant::from_micros(0); 12]);
    let mut lengths = (0..40).map(|_| cycle(&mut plan, &mut fired, 0, |_| (6_000, ReadingKind::Rejected)).1);
    let longest = lengths.by_ref().skip(10).max().unwrap();
    assert!((390_000..=400_000).contains(&longest), "{longest}");
    // 1 m/s: 580 us of change are a tenth of a second.
    let mut length = longest;
    for _ in 0..20 {
        let change = -(2.0 * f64::from(length) / 343.0) as i32;
        length = cycle(&mut plan, &mut fired, change, |_| (6_000, ReadingKind::Rejected)).1;
    }
    assert!((93_600..=100_000).contains(&length), "{length}");
}

#[test]
fn who_is_unserved_longest_gets_its_quiet_first() {
    let (mut plan, mut fired) = (plan::<12>(12), [Instant::from_micros(0); 12]);
    for slot in &mut plan.slots {
        (slot.before, slot.after) = (200, 200);
    }
    // All need more than there is; sensor 7 has been unserved for longest.
    let nothing = |sensor| if sensor == 7 { (20_000, ReadingKind::NoEcho) } else { WELL(sensor) };
    for _ in 0..6 {
        for slot in &mut plan.slots {
            (slot.before, slot.after) = (149, 149);
        }
        cycle(&mut plan, &mut fired, 0, nothing);
    }
    for slot in &mut plan.slots {
        (slot.before, slot.after) = (149, 149);
    }
    let (seen, length) = cycle(&mut plan, &mut fired, -1_000, nothing);
    let (before, after) = silence(&seen, length, 7);
    assert!(before > 36_000 && after > 33_620, "{before} {after}: {seen:?}");
}

#[test]
fn a_cycle_is_never_shorter_than_the_shortest() {
    for shortest in [60_000, 400_000, 1_000_000, 100_000_000] {
        let mut settings = FlowSettings::DEFAULT;
        settings.shortest_cycle = Micros::new(shortest);
        let mut plan = FlowPlan::<2>::new(2, settings, listening(), Instant::from_micros(0)).unwrap();
        let mut fired = [Instant::from_micros(0); 2];
        for _ in 0..5 {
            let (_, length) = cycle(&mut plan, &mut fired, 0, WELL);
            assert!((shortest..shortest + 1_680).contains(&length), "{shortest}: {length}");
        }
    }
}

#[test]
fn no_module_fires_again_before_it_has_rested() {
    let mut settings = FlowSettings::DEFAULT;
    settings.rest = Micros::from_millis(60);
    let now = Instant::from_micros(0);
    let mut plan = FlowPlan::<8>::new(8, settings, listening(), now).unwrap();
    assert_eq!(plan.min_refire(), settings.rest);
    let (mut fired, mut before) = ([now; 8], [None::<Instant>; 8]);
    let mut shortest = Micros::MAX;
    for number in 0..200_u32 {
        // Gaps change from cycle to cycle, so that sensors move to and fro in it.
        cycle(&mut plan, &mut fired, 0, |sensor| {
            if (u32::from(sensor) * 7 + number) % 11 < 4 { MASKED(sensor) } else { WELL(sensor) }
        });
        for (before, &fired) in before.iter_mut().zip(&fired) {
            shortest = before.replace(fired).map_or(shortest, |before| shortest.min(fired.since(before)));
        }
    }
    assert!(shortest >= settings.rest && shortest < Micros::from_millis(63), "{shortest}");
}

#[test]
fn a_cycle_that_is_planned_ahead_fires_at_the_same_instants() {
    let mut ahead = FlowSettings::DEFAULT;
    ahead.lead = Micros::from_millis(3);
    let now = Instant::from_micros(0);
    let [mut plan, mut early] =
        [FlowSettings::DEFAULT, ahead].map(|of| FlowPlan::<8>::new(8, of, listening(), now).unwrap());
    let (mut fired, mut fired_early) = ([now; 8], [now; 8]);
    for number in 0..50 {
        let hears = |sensor| if (u32::from(sensor) + number) % 5 < 2 { MASKED(sensor) } else { WELL(sensor) };
        let (seen, length) = cycle(&mut plan, &mut fired, 0, hears);
        // In whole units of quiet.
        assert_eq!(cycle(&mut early, &mut fired_early, 0, hears), (seen, length - 11 * 256));
    }
    assert_eq!(fired, fired_early);
}

fn limits<const K: usize>(together: &[u64]) -> EachSensor<K> {
    EachSensor::for_flow([SensorLimits { t_delta: Micros::new(150), window: WINDOW }; K], together)
}

#[test]
fn sensors_of_one_group_fire_at_one_instant() {
    let now = Instant::from_micros(0);
    let groups = [0b1_0001, 0b1000_1100];
    let mut plan =
        FlowPlan::<8, _>::with_limits(8, limits::<8>(&groups), FlowSettings::DEFAULT, listening(), now).unwrap();
    let mut fired = [now; 8];
    for number in 0..300_u32 {
        // 1 m/s now and then, so that gaps have to be shared out.
        let change = if number % 100 < 40 { -580 } else { 0 };
        let (seen, length) = cycle(&mut plan, &mut fired, change, |sensor| {
            if (u32::from(sensor) * 7 + number) % 11 < 5 { MASKED(sensor) } else { WELL(sensor) }
        });
        let order = seen.iter().map(|(sensor, _)| *sensor).collect::<Vec<_>>();
        assert_eq!(order, [0, 4, 6, 1, 2, 3, 7, 5]);
        for (place, pair) in seen.windows(2).enumerate() {
            let [(x, before), (y, after)] = pair else { unreachable!() };
            let together = groups.iter().any(|group| group >> x & group >> y & 1 == 1);
            // The least gap of 7.5 ms, less what waits bring closer.
            let apart = after - before;
            assert!(
                if together { apart == 0 } else { apart > 7_500 - 2_400 },
                "cycle {number}, place {place}: {seen:?}"
            );
        }
        assert!(seen.len() == 8 && length - seen[7].1 > 7_500 - 2_400, "{seen:?}");
    }
    // What one of them needs all get.
    let masked = |sensor| if sensor == 7 { MASKED(sensor) } else { WELL(sensor) };
    for _ in 0..30 {
        cycle(&mut plan, &mut fired, 0, masked);
    }
    let (seen, length) = cycle(&mut plan, &mut fired, 0, masked);
    let at = seen.iter().find(|(sensor, _)| *sensor == 2).unwrap().1;
    let before = seen.iter().map(|seen| seen.1).filter(|&other| other < at).max().unwrap_or(0);
    let after = seen.iter().map(|seen| seen.1).filter(|&other| other > at).min().unwrap_or(length);
    assert!(at - before > 36_000 && after - at > 33_620, "{seen:?}");
}

#[test]
fn flow_with_limits_keeps_what_plans_promise() {
    for groups in [&[][..], &[0b11][..], &[0b1010, 0b10_0101][..], &[0b11_1111][..]] {
        let now = Instant::from_micros(u32::MAX - 1_000_000);
        let mut plan =
            FlowPlan::<6, _>::with_limits(6, limits::<6>(groups), FlowSettings::DEFAULT, listening(), now).unwrap();
        check_plan(&mut plan, now, 3_000, 5).unwrap();
    }
}

/// The kinds of readings of three sensors that each hear something after these times, one after the other.
fn kinds_of(limits: EachSensor<3>, echoes_us: [&[u32]; 3], cycles: usize) -> [Vec<ReadingKind>; 3] {
    let now = Instant::from_micros(0);
    let mut ring = FlowRing::<3, 4, 1, _>::with_limits(3, limits, FlowSettings::DEFAULT, listening(), now).unwrap();
    let mut kinds = [Vec::new(), Vec::new(), Vec::new()];
    ring.set_silence(crate::Silence::Trusted);
    while kinds[2].len() < cycles {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let heard = echoes_us[usize::from(sensor)];
                    let after = heard[kinds[usize::from(sensor)].len() % heard.len()];
                    ring.echo(sensor, now + Micros::new(after)).unwrap();
                }
                RingEvent::Reading(reading) => kinds[usize::from(reading.sensor)].push(reading.kind),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    kinds
}

#[test]
fn each_sensor_has_its_own_window_and_t_delta() {
    let of = |t_delta, window| SensorLimits { t_delta: Micros::new(t_delta), window: Micros::new(window) };
    let echoes: [&[u32]; 3] = [&[12_000], &[12_000, 12_120], &[12_000, 12_120]];
    let own = EachSensor::for_flow([of(150, 10_000), of(150, 36_000), of(50, 36_000)], &[]);
    let [short, wide, narrow] = kinds_of(own, echoes, 40);
    // What comes after a window is late; silence is confirmed.
    assert!(short[8..].iter().all(|kind| *kind == ReadingKind::Clear), "{short:?}");
    assert!(wide[8..].iter().all(|kind| *kind == ReadingKind::Accepted), "{wide:?}");
    let alike = EachSensor::for_flow([of(150, 36_000); 3], &[]);
    let [far, _, agrees] = kinds_of(alike, echoes, 40);
    assert!(far[8..].iter().chain(&agrees[8..]).all(|kind| *kind == ReadingKind::Accepted), "{far:?} {agrees:?}");
    // 60 us from the middle of both, which neither supports.
    assert!(narrow.iter().all(|kind| *kind != ReadingKind::Accepted), "{narrow:?}");
}

#[test]
fn sensors_on_one_line_never_listen_at_once() {
    let windows = [30, 30, 12, 12, 36, 30].map(Micros::from_millis);
    let refire = [0, 0, 0, 70, 0, 0].map(Micros::from_millis);
    let uneven = Uneven { window: &windows, refire: &refire, shared_lines: &[0b11_0011], ..Uneven::NONE };
    let requirements = Requirements { window: WINDOW, uneven: Some(uneven), ..Requirements::new(Micros::new(150)) };
    let now = Instant::from_micros(0);
    let settings = FlowSettings::DEFAULT.keeping(6, &requirements).unwrap();
    assert_eq!(settings.rest, Micros::from_millis(70));
    let limits = FlowSettings::limits::<6>(6, &requirements).unwrap();
    let mut plan = FlowPlan::<6, _>::with_limits(6, limits, settings, listening(), now).unwrap();
    let (mut fired, mut last) = ([now; 6], None::<(Instant, u8)>);
    for number in 0..200_u32 {
        let change = if number % 50 < 20 { -2_000 } else { 0 };
        let (seen, _) = cycle(&mut plan, &mut fired, change, |sensor| {
            if (u32::from(sensor) + number) % 3 == 0 { MASKED(sensor) } else { WELL(sensor) }
        });
        for (sensor, at) in seen.into_iter().map(|(sensor, _)| (sensor, fired[usize::from(sensor)])) {
            if 0b11_0011 >> sensor & 1 == 0 {
                continue;
            }
            if let Some((before, other)) = last.replace((at, sensor)) {
                assert!(
                    at.since(before) > windows[usize::from(other)].saturating_add(Micros::new(1_000)),
                    "{other}, then {sensor}"
                );
            }
        }
    }
    let long = [Micros::from_millis(64); 6];
    let uneven = Uneven { window: &long, shared_lines: &[0b11], ..Uneven::NONE };
    let requirements = Requirements { uneven: Some(uneven), ..requirements };
    assert!(matches!(FlowSettings::DEFAULT.keeping(6, &requirements), Err(HoppingError::Window { .. })));
}

// What is allowed without a table does not make a table a verified one.
#[test]
fn a_table_refuses_the_limits_of_a_flow_ring() {
    let firing = [[0, 5, 40], [2, 12, 24]].map(|phase| phase.map(Micros::from_millis));
    let schedule = crate::Schedule::<3>::from_firing(Micros::from_millis(60), firing).unwrap();
    let (limits, now) = (limits::<3>(&[]), Instant::from_micros(0));
    let plan = crate::plan::ScheduledFiring::with_limits(&schedule, &limits, now);
    let config = RingConfig::new().with_t_delta(Micros::new(100)).with_window(Micros::from_millis(10));
    let ring = Ring::<_, crate::EchoFilter<3>, 3>::with_plan(plan, config, now);
    assert!(matches!(ring, Err(crate::RingError::TDelta { .. })));
}

#[test]
fn each_error_names_what_is_wrong() {
    let now = Instant::from_micros(0);
    let with = |change: fn(&mut FlowSettings)| {
        let mut settings = FlowSettings::DEFAULT;
        change(&mut settings);
        FlowPlan::<8>::new(8, settings, listening(), now).unwrap_err()
    };
    assert!(matches!(with(|of| of.step = Micros::new(150)), HoppingError::TDelta { .. }));
    assert!(matches!(with(|of| of.shortest_cycle = Micros::from_millis(38)), HoppingError::Period { .. }));
    let many = FlowPlan::<8>::new(9, FlowSettings::DEFAULT, listening(), now);
    assert!(matches!(many, Err(HoppingError::Sensors { sensors: 9, most: 8 })));
}
