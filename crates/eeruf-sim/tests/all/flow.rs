//! Flow compared with one by one in rooms: properties that hold in any set of rooms.

use std::f64::consts::TAU;

use eeruf_core::{
    Micros,
    flow::{BeliefSettings, Votes},
};
use eeruf_sim::experiments::measure::RoomWay;
use eeruf_sim::experiments::rooms::{RoomKind, RoomPlan};
use eeruf_sim::modules::HC_SR04;
use eeruf_sim::*;

/// Shares of the time in percent, and echoes per second, of the first robot: means over rooms.
#[derive(Clone, Copy, Debug, Default)]
struct FlowFigures {
    right: f64,
    phantom: f64,
    echoes: f64,
}

/// Motion of the first robot: its speed in m/s, and its rate of turn in degrees/s.
type Moves = (f64, f64);

const STANDS: Moves = (0.0, 0.0);

fn way(name: &str) -> RoomWay {
    let ring = Robot::ring(Pose::identity(), 8, TAU / 8.0, 0.2, Transducer::HC_SR04).with_modules(vec![HC_SR04; 8]);
    let robot = Robot { window: Micros::new(23_311), ..ring };
    let way = RoomWay::all(&robot, None).into_iter().find(|way| way.name == name).unwrap();
    RoomWay { robot: Robot { odometry: false, ..way.robot }, ..way }
}

fn run(way: &RoomWay, kinds: &[RoomKind], rooms: u64, (speed_m_s, turn_deg_s): Moves) -> FlowFigures {
    let numbers: Vec<_> = kinds.iter().flat_map(|&kind| (20_000..20_000 + rooms).map(move |at| (kind, at))).collect();
    let found = sweep(&numbers, |&(kind, number)| {
        let plan = RoomPlan::random(kind, number, 0.25);
        let world = plan.world(&way.robot, speed_m_s).unwrap();
        let mut robots = world.robots().to_vec();
        if turn_deg_s != 0.0 {
            robots[0].motion = Motion::Constant { velocity: Vector::zeros(), turn_rad_s: turn_deg_s.to_radians() };
        }
        let world = World::new(plan.scene().unwrap(), robots, Noise::default()).unwrap();
        let world = world.with_seed(number).with_room(Some(Room::DEFAULT)).unwrap();
        let periods = 8_000_000 / way.robot.period.as_micros();
        let readings = simulate(&world, way.method, &Options { periods, ..way.options }).unwrap();
        let own: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
        let summary = Readings { sensors: way.robot.sensors.len(), ..readings.select(&own) }.summary();
        let BeliefShares { right, phantom, .. } = summary.belief;
        FlowFigures { right: 100.0 * right, phantom: 100.0 * phantom, echoes: summary.right_echoes_per_s }
    });
    let mean = |of: fn(&FlowFigures) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
    FlowFigures { right: mean(|it| it.right), phantom: mean(|it| it.phantom), echoes: mean(|it| it.echoes) }
}

/// Returns the kinds of rooms without another robot.
fn alone() -> Vec<RoomKind> {
    RoomKind::ALL.into_iter().filter(|&kind| kind != RoomKind::Meeting).collect()
}

#[test]
fn flow_standing_is_right_as_often_as_one_by_one_at_three_times_its_echoes() {
    let [one_by_one, flow] = ["sequential", "flow"].map(|name| run(&way(name), &alone(), 6, STANDS));
    // Flow needs two readings for its first belief, one part in 160 of these 8 s.
    assert!(flow.right > one_by_one.right - 1.0, "{flow:?} {one_by_one:?}");
    assert!(flow.echoes > 3.0 * one_by_one.echoes && flow.phantom < 0.1, "{flow:?} {one_by_one:?}");
}

#[test]
fn flow_driving_is_right_as_often_as_one_by_one_at_twice_its_echoes() {
    for speed_m_s in [0.5, 1.0] {
        let moves = (speed_m_s, 0.0);
        let [one_by_one, flow] = ["sequential", "flow"].map(|name| run(&way(name), &alone(), 6, moves));
        assert!(flow.right > one_by_one.right - 0.6, "{speed_m_s}: {flow:?} {one_by_one:?}");
        assert!(flow.echoes > 2.0 * one_by_one.echoes && flow.phantom < 0.5, "{speed_m_s}: {flow:?} {one_by_one:?}");
    }
}

#[test]
fn flow_turning_is_right_as_often_as_one_by_one_at_twice_its_echoes() {
    for turn_deg_s in [45.0, 90.0] {
        let moves = (0.0, turn_deg_s);
        let [one_by_one, flow] = ["sequential", "flow"].map(|name| run(&way(name), &alone(), 6, moves));
        assert!(flow.right > one_by_one.right - 0.5, "{turn_deg_s}: {flow:?} {one_by_one:?}");
        assert!(flow.echoes > 2.0 * one_by_one.echoes && flow.phantom < 0.6, "{turn_deg_s}: {flow:?} {one_by_one:?}");
    }
}

// Beside another robot, a ring that believes every echo believes the other robot's sound.
#[test]
fn flow_keeps_another_robots_sound_out_whether_it_stands_or_moves() {
    let mut every_echo = way("flow");
    every_echo.options.flow.belief = Some(BeliefSettings { votes: Votes::EveryEcho, ..BeliefSettings::DEFAULT });
    for moves in [STANDS, (0.5, 0.0), (0.0, 45.0)] {
        let run = |way: &RoomWay| run(way, &[RoomKind::Meeting], 16, moves);
        let [one_by_one, flow, every_echo] = [run(&way("sequential")), run(&way("flow")), run(&every_echo)];
        assert!(flow.phantom < 1.2 && 3.0 * flow.phantom < one_by_one.phantom, "{moves:?}: {flow:?} {one_by_one:?}");
        assert!(flow.echoes > 1.8 * one_by_one.echoes, "{moves:?}: {flow:?} {one_by_one:?}");
        assert!(flow.right > one_by_one.right - 0.5, "{moves:?}: {flow:?} {one_by_one:?}");
        assert!(every_echo.phantom > 3.0 * flow.phantom, "{moves:?}: {every_echo:?}");
    }
}

// A robot that expects others needs two echoes in a row even if the world has none, and therefore less quiet.
#[test]
fn flow_expects_others_where_its_robot_does() {
    let mut careful = way("flow");
    careful.robot.others = true;
    let [careful, eager] = [&careful, &way("flow")].map(|way| run(way, &alone(), 2, (0.5, 0.0)));
    assert!(careful.echoes > 1.3 * eager.echoes && careful.phantom <= eager.phantom, "{careful:?} {eager:?}");
    let mut careful = way("flow");
    careful.robot.others = true;
    let [careful, eager] = [&careful, &way("flow")].map(|way| run(way, &alone(), 1, STANDS));
    assert_eq!(careful.right.to_bits(), eager.right.to_bits());
}

#[test]
fn methods_that_are_gone_are_answered_by_name() {
    for (name, does) in [
        ("eeruf_hopping", "flow"),
        ("driving", "flow"),
        ("adaptive_hopping", "flow"),
        ("hopping_multi_echo", "flow_multi_echo"),
    ] {
        let error = name.parse::<Entry>().unwrap_err().to_string();
        assert_eq!(error, format!("method `{name}` is gone; `{does}` does it"));
        assert!(does.parse::<Entry>().is_ok());
    }
}
