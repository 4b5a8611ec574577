//! Robots whose sensors are modules of several makes.

use std::path::Path;

use eeruf_sim::modules::{HC_SR04, MB1242, Module, POLAROID_6500};
use eeruf_sim::*;

/// Two HC-SR04 in a box of 3 m by 2 m, one MB1242, which hears them, and a Polaroid, which does not.
const WORLD: &str = r#"
seed = 3
max_order = 3

[[wall]]
points_m = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]]

[[robot]]
pose = { x_m = 1.5, y_m = 0.9, heading_deg = 45.0 }
ring = { sensors = 4, spacing_deg = 20.0, radius_m = 0.2 }
module = ["hc-sr04", { like = "hc-sr04", sees_to_m = 2.5, hold_us = 130_000 }, "mb1242", "polaroid-6500"]
height_m = [0.2, 0.3, 0.4, 0.5]
"#;

fn read(text: &str) -> Result<World, String> {
    World::from_text(Path::new("w.toml"), text).map_err(|error| error.to_string())
}

#[test]
fn mixed_sensors_hear_whom_their_bands_allow() {
    let world = read(WORLD).unwrap();
    let heard = world.ring_paths(0, 3).unwrap();
    let paths = |from: usize, to: usize| heard.between(from, to).len();
    assert!(paths(1, 0) > 0 && paths(0, 2) > 0 && paths(2, 0) > 0 && paths(3, 3) > 0);
    // The second sensor needs a louder sound, since it sees no farther than 2.5 m.
    assert!(paths(0, 1) < paths(1, 0));
    for other in 0..3 {
        assert_eq!((paths(other, 3), paths(3, other)), (0, 0), "sensor {other}");
    }
    // All sensors fire at once: every sound that the simulation hears uses one of these paths.
    let readings = simulate(&world, Method::Simultaneous, &Options::periods(50)).unwrap();
    let crosstalk = (0..readings.len()).filter(|&k| readings.cause[k] == Cause::Crosstalk);
    let ends = crosstalk.map(|k| &readings.paths[readings.path[k] as usize]);
    let ends: Vec<_> = ends.map(|path| (path.emitter.sensor, path.receiver.sensor)).collect();
    assert!(ends.iter().any(|&(from, to)| from < 2 && to == 2), "{ends:?}");
    assert!(ends.iter().all(|&(from, to)| from != 3 && to != 3), "{ends:?}");
}

#[test]
fn each_sensor_is_deaf_for_as_long_as_its_module() {
    let world = read(WORLD).unwrap();
    let robot = &world.robots()[0];
    assert_eq!([0, 1, 2, 3].map(|sensor| robot.blanking_of(sensor).as_micros()), [117, 117, 1166, 2380]);
    assert_eq!(robot.blanking.as_micros(), 117);
    // A wall 0.25 m ahead is visible to some sensors and too near for others.
    let near = WORLD.replace("y_m = 0.9, heading_deg = 45.0", "y_m = 0.45, heading_deg = -90.0");
    let readings = simulate(&read(&near).unwrap(), Method::Sequential, &Options::periods(40)).unwrap();
    let nearest = |sensor: u8| {
        let own = (0..readings.len()).filter(|&k| readings.sensor[k] == sensor);
        own.map(|k| readings.earliest_us[k]).fold(f64::INFINITY, f64::min)
    };
    assert!(nearest(0) < 2_000.0 && nearest(1) < 2_000.0, "{} {}", nearest(0), nearest(1));
    assert!(nearest(3) >= 2_380.0, "{}", nearest(3));
    // The robot's own settings take precedence.
    let longer = read(&format!("{WORLD}blanking_us = [500, 600, 700, 800]\n")).unwrap();
    assert_eq!(longer.robots()[0].blanking_of(3).as_micros(), 800);
}

#[test]
fn a_mixed_robot_is_written_as_it_is_read() {
    let parts = WorldParts::from_text(Path::new("w.toml"), &format!("{WORLD}gain = \"linear\"\n")).unwrap();
    let modules = (0..4).map(|sensor| parts.robots[0].module_of(sensor)).collect::<Vec<_>>();
    let linear = |module: Module| Module { gain: GainProfile::Linear, ..module };
    assert_eq!([modules[0], modules[2], modules[3]], [HC_SR04, MB1242, POLAROID_6500].map(linear));
    assert_eq!((modules[1].sees_to_mm, modules[1].no_echo.hold_us()), (2_500, 130_000));
    let again = WorldParts::from_text(Path::new("again.toml"), &parts.to_toml()).unwrap();
    assert_eq!(again.robots, parts.robots);
    // Your own transducer is described by its figures.
    let quiet = Transducer { max_range_m: 3.0, ..Transducer::HC_SR04 };
    let robot = Robot::ring(Pose::translation(1.0, 1.0), 2, 0.3, 0.2, quiet);
    assert_eq!(robot.module_of(1), Module { sees_to_mm: 3_000, ..HC_SR04 });
}

#[test]
fn wrong_modules_of_robots_are_refused() {
    for (module, expected) in [
        ("[\"hc-sr04\"]", "robot 1: module: 1 modules; expected one for all, or one for each of 4 sensors"),
        ("\"bat\"", "module: no preset \"bat\"; expected polaroid-6500, hc-sr04"),
        ("{ like = \"ping\", beam = 3 }", "module: beam = 3; expected cut_at_90, continuous"),
    ] {
        let lines = WORLD
            .lines()
            .map(|line| if line.starts_with("module") { format!("module = {module}") } else { line.to_owned() });
        let error = read(&lines.collect::<Vec<_>>().join("\n")).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let error = read(&format!("{WORLD}gain = \"loud\"")).unwrap_err();
    assert!(
        error.ends_with("robot 1: module: gain = loud; expected constant, square_root, linear, stepped, polaroid_6500"),
        "{error}"
    );
    let error = read(&format!("{WORLD}blanking_us = [1, 2]")).unwrap_err();
    assert!(error.contains("2 values; expected one for all, or one for each of 4 sensors"), "{error}");
}
