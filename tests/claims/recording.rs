//! A simulation under way, written into an MCAP file.

use std::collections::BTreeMap;
use std::sync::Arc;

use eeruf::Recording;
use eeruf_logs::{FiringLog, Options as ReadOptions, read_log};
use eeruf_sim::{
    Air, Faces, Method, Noise, Options, Pose, Robot, Scene, Simulation, Stop, Transducer, Vector, Wall, World,
};

const START_NS: u64 = 946_684_800_000_000_000;

/// A robot in a room of 6 by 6 m, before its first step.
fn simulation() -> Simulation {
    let room = Wall::polyline(&[[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0], [-3.0, -3.0]]);
    let room = room.map(|wall| wall.with_faces(Faces::Both)).collect();
    let start = Pose::new(Vector::new(-1.0, 0.5), 0.3);
    let robot = Robot::ring(start, 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    let world = World::new(Scene::new(room, vec![], Air::default()).unwrap(), vec![robot], Noise::default()).unwrap();
    Simulation::new(Arc::new(world), Method::Eeruf, &Options::default(), Stop::default()).unwrap()
}

#[test]
fn a_recording_has_each_reading_once_and_poses_where_the_robot_was_steered() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drive.mcap");
    let mut simulation = simulation();
    let mut recording = Recording::create(&file, &simulation).unwrap();
    let mut heard = vec![];
    // Steps of a third of a period, and one of many.
    for step in 0..60 {
        simulation.set_velocity(0, 0.3 + 0.1 * f64::from(step % 3), 0.5 - 0.02 * f64::from(step)).unwrap();
        let readings = simulation.step(if step == 40 { 1.3 } else { 0.02 }, |_| true).unwrap();
        recording.add(&simulation, &readings).unwrap();
        heard.extend((0..readings.len()).map(|k| (readings.fired_s[k], readings.sensor[k], readings.earliest_us[k])));
    }
    recording.finish().unwrap();

    heard.sort_by(|one, other| one.0.total_cmp(&other.0));
    let log = FiringLog::read(&file).unwrap();
    let logged: Vec<_> = log.firings.iter().map(|firing| (firing.sensor, firing.t_echo_us)).collect();
    let us = |echo: f64| (!echo.is_nan()).then_some(echo as u32);
    assert_eq!(logged, heard.iter().map(|&(_, sensor, echo)| (sensor, us(echo))).collect::<Vec<_>>());
    assert!(logged.len() > 300 && log.damage.is_none());
    let mut ranges = BTreeMap::<bool, usize>::new();
    let report = read_log(&file, &ReadOptions::default(), |sensors, reading| {
        *ranges.entry(sensors[reading.sensor].topic.ends_with("/accepted")).or_default() += 1;
    });
    assert_eq!((report.unwrap().damage, ranges[&false]), (vec![], logged.len()));
    assert!(ranges[&true] > 20, "{ranges:?}");

    let bytes = std::fs::read(&file).unwrap();
    let (mut poses, mut paths, mut scenes) = (0, 0, 0);
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let topic = message.channel.topic.as_str();
        if !(topic.ends_with("/pose") || topic.ends_with("/paths") || topic == "/scene") {
            continue;
        }
        let object: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let time_s = (message.log_time - START_NS) as f64 * 1e-9;
        let was = simulation.moment_at(0, time_s).unwrap().pose;
        if topic.ends_with("/pose") {
            let position = &object["pose"]["position"];
            let [x, y] = ["x", "y"].map(|name| position[name].as_f64().unwrap());
            assert!((Vector::new(x, y) - was.translation.vector).norm() < 1e-9, "{time_s} s: {object}");
            // One every 50 ms, from the beginning.
            assert!((time_s - 0.05 * f64::from(poses)).abs() < 1e-6, "{time_s} s");
            poses += 1;
        } else if topic.ends_with("/paths") {
            // An echo of the sensor's own begins where the sensor was when it fired; it has 0.3 m to the middle.
            let points = object["entities"][0]["lines"][0]["points"].as_array().unwrap();
            let [x, y] = ["x", "y"].map(|name| points[0][name].as_f64().unwrap());
            let off = ((Vector::new(x, y) - was.translation.vector).norm() - 0.3).abs();
            // Foreign sound was sent at another time.
            assert!(off < 0.05, "{time_s} s: {off} m");
            paths += 1;
        } else {
            scenes += 1;
        }
    }
    assert_eq!((poses, scenes), (1 + (simulation.time_s() / 0.05).floor() as u32, 1));
    assert!(paths > 200, "{paths}");
}
