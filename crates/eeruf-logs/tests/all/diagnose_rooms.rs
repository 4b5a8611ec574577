//! `diagnose` on logs of the simulator: rings in alcoves and other rooms, without faults and with one fault.

use eeruf_logs::{Finding, Firing, FiringLog, Settings, Symptom, diagnose};
use eeruf_sim::experiments::rooms::{RoomKind, RoomPlan};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Cause, FaultKind, Method, Motion, Noise, Options, Physics, Readings, Vector, World, simulate};

/// A place and its number.
#[derive(Clone, Copy, Debug)]
enum Place {
    Alcove(u64),
    /// An alcove out of which the robot backs.
    BacksOut(u64),
    Room(u64),
}

use Place::{Alcove as InAlcove, BacksOut, Room as InRoom};

/// Faults that the diagnosis finds in such a log.
fn found(place: Place, fault: Option<(FaultKind, &[u8])>) -> Vec<Finding> {
    diagnose(&log_of(place, fault), &Settings::default()).faults
}

/// The log of a ring that fires by flow for 1,000 periods of 60 ms, some sensors of which have a fault.
fn log_of(place: Place, fault: Option<(FaultKind, &[u8])>) -> FiringLog {
    const ROOMS: [RoomKind; 6] =
        [RoomKind::Corridor, RoomKind::Office, RoomKind::Hall, RoomKind::Clutter, RoomKind::Garage, RoomKind::Aisle];
    let (InAlcove(number) | BacksOut(number) | InRoom(number)) = place;
    let alcove = Alcove::random(number);
    let mut robot = alcove.robot();
    if matches!(place, BacksOut(_)) {
        robot.motion = Motion::Constant { velocity: Vector::new(0.0, -0.015), turn_rad_s: 0.04 };
    }
    let world = match place {
        InAlcove(_) | BacksOut(_) => {
            let scene = alcove.scene().unwrap();
            World::new(scene, vec![robot], Noise::default()).unwrap().with_seed(number)
        }
        InRoom(_) => {
            let kind = ROOMS[(number % ROOMS.len() as u64) as usize];
            RoomPlan::random(kind, number, robot.radius_m()).world(&robot, 0.0).unwrap()
        }
    };
    let faults = fault.map(|(kind, sensors)| eeruf_sim::Fault::new(kind).of_sensors(sensors));
    let world = world.with_physics(Physics::PLAIN).unwrap().with_faults(faults.into_iter().collect()).unwrap();
    let options =
        Options { seed: Some(number), ..Options::periods(if matches!(place, BacksOut(_)) { 333 } else { 1000 }) };
    let readings = simulate(&world, Method::Flow, &options).unwrap();
    FiringLog::new("simulation", (0..readings.len()).map(|k| firing(&readings, k)).collect())
}

fn firing(readings: &Readings, k: usize) -> Firing {
    Firing {
        sensor: readings.sensor[k],
        fired_us: (1e6 * readings.fired_s[k]).round() as i64,
        period: readings.period[k],
        phase: readings.phase[k],
        t_echo_us: (!readings.earliest_us[k].is_nan()).then(|| readings.earliest_us[k] as u32),
        reading: Some(readings.kind[k]),
        g_us_ms: None,
    }
}

// The alcoves are ones that were not used for tuning.
#[test]
fn senders_in_a_log_of_flow_are_named() {
    let (mut foreign, mut right, mut named) = (0, 0, 0);
    for number in 20_000..20_012 {
        let alcove = Alcove::random(number);
        let world = World::new(alcove.scene().unwrap(), vec![alcove.robot()], Noise::default()).unwrap();
        let world = world.with_seed(number).with_physics(Physics::PLAIN).unwrap();
        let readings = simulate(&world, Method::Flow, &Options::periods(1000)).unwrap();
        let mut order: Vec<usize> = (0..readings.len()).collect();
        order.sort_by_key(|&k| firing(&readings, k).fired_us);
        let log = FiringLog::new("simulation", order.iter().map(|&k| firing(&readings, k)).collect());
        let found = diagnose(&log, &Settings::default());
        assert!(!found.moved, "{number}");
        for (&k, name) in order.iter().zip(&found.named) {
            let sender = readings.path_of(k).map(|path| path.emitter.sensor);
            let is_foreign = readings.cause[k] == Cause::Crosstalk;
            foreign += u32::from(is_foreign);
            if let Some(name) = name.filter(|name| name.sender != readings.sensor[k]) {
                named += 1;
                right += u32::from(is_foreign && sender == Some(name.sender));
            }
        }
    }
    let (share, sure) = (f64::from(right) / f64::from(foreign), f64::from(right) / f64::from(named));
    assert!(foreign > 3_000 && share > 0.67 && sure > 0.99, "{foreign} foreign: {share} named, {sure} right");
}

// Random gaps never repeat, so the motion shows in the ranges alone.
#[test]
fn robot_that_drives_is_known_by_its_ranges_and_by_its_log() {
    for (place, moves) in [(InAlcove(20_001), false), (InRoom(20_002), false), (BacksOut(20_003), true)] {
        let log = log_of(place, None);
        assert_eq!(diagnose(&log, &Settings::default()).moved, moves, "{place:?}");
        let mut said = log.clone();
        said.firings.iter_mut().for_each(|firing| firing.g_us_ms = Some(1.0));
        assert!(diagnose(&said, &Settings::default()).moved, "{place:?}");
    }
}

// In each of these a rule that looks at one sensor alone sees a fault: a sensor faces a doorway, hears a wall at its
// threshold, or hears others along paths too faint to be found.
#[test]
fn healthy_rings_have_no_fault() {
    for place in [1004, 1041].map(InAlcove) {
        assert_eq!(found(place, None), [], "{place:?}");
    }
    for place in [1005, 1015, 1033, 1036, 1050, 1054, 1060, 1095].map(InRoom) {
        assert_eq!(found(place, None), [], "{place:?}");
    }
}

// If too few paths lead back in time, the log cannot tell, and the diagnosis says so.
#[test]
fn a_cut_echo_line_is_deaf_or_the_log_cannot_tell() {
    let cut = [(InAlcove(1000), 4), (InAlcove(1001), 6), (InAlcove(1008), 6), (InAlcove(1027), 4), (InAlcove(1039), 1)];
    let mut deaf = 0;
    for (place, sensor) in cut {
        let found = diagnose(&log_of(place, Some((FaultKind::Cut, &[sensor]))), &Settings::default());
        let named: Vec<_> = found.faults.iter().map(|of| (of.sensor, of.symptom)).collect();
        deaf += named.len();
        let said =
            if named.is_empty() { found.silent() == [sensor] } else { named == [(sensor.into(), Symptom::Deaf)] };
        assert!(said, "{place:?}: {named:?}");
    }
    assert!(deaf >= 1, "{deaf}");
}

#[test]
fn healthy_rings_that_drive_have_no_fault() {
    for number in 300..304 {
        assert_eq!(found(BacksOut(number), None), [], "{number}");
    }
}
