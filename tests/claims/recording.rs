//! A simulation under way, written into an MCAP file.

use std::collections::BTreeMap;
use std::sync::Arc;

use eeruf::Recording;
use eeruf_logs::{FiringLog, Options as ReadOptions, read_log};
use eeruf_sim::{
    Air, Faces, Method, Noise, Options, Physics, Pole, Pose, Robot, Scene, Simulation, Stop, Transducer, Vector, Wall,
    World,
};
use serde_json::Value;

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

// A recording has each reading once and poses where the robot was steered.
#[test]
fn recording_has_each_reading_once() {
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
    let report = read_log(&file, &ReadOptions { judged: true, ..ReadOptions::default() }, |report, reading| {
        *ranges.entry(report.sensors[reading.sensor].topic.ends_with("/accepted")).or_default() += 1;
    });
    assert_eq!((report.unwrap().damage, ranges[&false]), (vec![], logged.len()));
    assert!(ranges[&true] > 20, "{ranges:?}");

    let (mut poses, mut paths, mut scenes) = (0, 0, 0);
    for (time_s, topic, object) in messages(&file, "") {
        if !(topic.ends_with("/odom") || topic.ends_with("/paths") || topic == "/scene") {
            continue;
        }
        let was = simulation.moment_at(0, time_s).unwrap().pose;
        if topic.ends_with("/odom") {
            let position = &object["pose"]["pose"]["position"];
            let [x, y] = ["x", "y"].map(|name| position[name].as_f64().unwrap());
            assert!((Vector::new(x, y) - was.translation.vector).norm() < 1e-9, "{time_s} s: {object}");
            // Velocities are in the robot's own frame; where a step ends, it has the one before and the one after.
            let twist = &object["twist"]["twist"];
            let [ahead, left] = ["x", "y"].map(|name| twist["linear"][name].as_f64().unwrap());
            let velocity = was.rotation * Vector::new(ahead, left);
            let turn_rad_s = twist["angular"]["z"].as_f64().unwrap();
            let is_at = |time_s: f64| {
                let now = simulation.moment_at(0, time_s.clamp(0.0, simulation.time_s())).unwrap();
                (velocity - now.velocity).norm() < 1e-5 && (turn_rad_s - now.turn_rad_s).abs() < 1e-5
            };
            assert!(is_at(time_s - 1e-6) || is_at(time_s + 1e-6), "{time_s} s: {twist}");
            // One every 50 ms, from the beginning.
            assert!((time_s - 0.05 * f64::from(poses)).abs() < 1e-6, "{time_s} s");
            poses += 1;
        } else if topic.ends_with("/paths") {
            // An echo of the sensor's own begins where the sensor was when it fired; it has 0.3 m to the middle.
            let points = object["markers"][0]["points"].as_array().unwrap();
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

/// The messages of topics with this ending, with their times in seconds and their topics, in the file's order.
fn messages(file: &std::path::Path, ending: &str) -> Vec<(f64, String, Value)> {
    let all = crate::ros2::messages(file).into_iter().filter(|message| message.topic.ends_with(ending));
    all.map(|message| ((message.log_time - START_NS) as f64 * 1e-9, message.topic, message.value)).collect()
}

// A scene that is exchanged is drawn from then on and sound that was on its way where it was.
#[test]
fn exchanged_scene_is_drawn_from_then_on() {
    // A sensor that looks along the x axis, and a wall before it; the air too may be another.
    let wall_at = |x: f64, temperature_c: f64, poles: Vec<Pole>| {
        let wall = Wall::new(x, -5.0, x, 5.0).with_faces(Faces::Both);
        Scene::new(vec![wall], poles, Air { temperature_c, ..Air::default() }).unwrap()
    };
    let robot = Robot::with_sensors(Pose::identity(), vec![Pose::identity()], Transducer::POLAROID_6500);
    let world = World::new(wall_at(2.0, 20.0, vec![]), vec![robot], Noise::NONE).unwrap();
    let world = Arc::new(world.with_physics(Physics::PLAIN).unwrap());
    let mut simulation = Simulation::new(world, Method::Sequential, &Options::default(), Stop::default()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("moved.mcap");
    // Before the recording begins, between a firing and its echo, and just at a reading; from each on, where the wall
    // is.
    let mut walls = vec![];
    simulation.change_scene(wall_at(2.5, 20.0, vec![])).unwrap();
    let mut recording = Recording::create(&file, &simulation).unwrap();
    walls.push((0.0, 2.5));
    let mut add = |simulation: &mut Simulation, step_s: Option<f64>| {
        let readings = match step_s {
            Some(step_s) => simulation.step(step_s, |_| true).unwrap(),
            None => simulation.step_to_reading(1.0, |_| true).unwrap(),
        };
        recording.add(simulation, &readings).unwrap();
        readings.fired_s
    };
    let fired_s = add(&mut simulation, Some(1.0));
    let next_s = 2.0 * fired_s[fired_s.len() - 1] - fired_s[fired_s.len() - 2];
    let until_fired_s = (next_s - simulation.time_s()).max(0.0);
    add(&mut simulation, Some(until_fired_s + 0.005));
    simulation.change_scene(wall_at(3.0, 20.0, vec![Pole::new(0.0, 4.0, 0.2)])).unwrap();
    walls.push((simulation.time_s(), 3.0));
    add(&mut simulation, Some(1.0));
    let fired_s = add(&mut simulation, None)[0];
    // Twice without a step: only the last one counts.
    simulation.change_scene(wall_at(1.0, 20.0, vec![])).unwrap();
    simulation.change_scene(wall_at(1.5, 40.0, vec![])).unwrap();
    walls.push((simulation.time_s(), 1.5));
    assert!(simulation.time_s() > fired_s);
    for _ in 0..12 {
        add(&mut simulation, Some(1.7));
    }
    recording.finish().unwrap();

    let drawn: Vec<_> = messages(&file, "/scene")
        .into_iter()
        .map(|(time_s, _, message)| {
            let markers = message["markers"].as_array().unwrap();
            // All that was there before goes.
            assert_eq!((&markers[0]["action"], &markers[1]["ns"]), (&3.into(), &"walls".into()));
            let poles = markers.iter().filter(|marker| marker["ns"] == "poles").count();
            (time_s, markers[1]["points"][0]["x"].as_f64().unwrap(), poles)
        })
        .collect();
    assert_eq!(drawn.len(), walls.len(), "{drawn:?}");
    for ((time_s, x, poles), wall) in drawn.iter().zip(&walls) {
        assert!((time_s - wall.0).abs() < 1e-8 && *x == wall.1, "{drawn:?} {walls:?}");
        assert_eq!(*poles, usize::from(*x == 3.0));
    }
    let paths = messages(&file, "/paths");
    let mut crossed = 0;
    for (fired_s, _, message) in &paths {
        let wall = walls.iter().rfind(|(since_s, _)| since_s <= fired_s).unwrap().1;
        let touched = message["markers"][0]["points"][1]["x"].as_f64().unwrap();
        assert!((touched - wall).abs() < 1e-9, "fired at {fired_s} s: {touched} m, not {wall} m");
        // An echo from 2.5 m takes 14.6 ms, and the wall before the last stood at 3 m.
        let after = |since_s: f64| (0.0..0.0145).contains(&(since_s - fired_s));
        crossed += usize::from(walls.iter().any(|(since_s, _)| after(*since_s)));
    }
    assert!(paths.len() > 200 && crossed >= 1, "{crossed} of {}", paths.len());
    let mut ranges = vec![];
    let read = |_: &eeruf_logs::Report, reading: &eeruf_logs::LogReading| {
        ranges.push((reading.at_ns.unwrap(), reading.range_m));
    };
    read_log(&file, &ReadOptions::default(), read).unwrap();
    for (at_ns, range_m) in ranges {
        let fired_s = (at_ns - START_NS) as f64 * 1e-9;
        let wall = walls.iter().rfind(|(since_s, _)| *since_s <= fired_s).unwrap().1;
        assert!((range_m - wall).abs() < 0.01, "fired at {fired_s} s: {range_m} m, not {wall} m");
    }
}
