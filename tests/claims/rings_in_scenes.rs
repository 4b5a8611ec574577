//! Rings of real machines, designed from their files, fire in scenes as designed: each sensor has its module, window
//! and tolerance.

use std::path::Path;

use eeruf_core::{Micros, ReadingKind};
use eeruf_design::{Effort, RingSpec, robot_ring};
use eeruf_files::emit::Emit as _;
use eeruf_sim::{Method, Options, World, simulate};

use crate::common::{Scratch, eeruf, json};

const ROOM: &str = "seed = 2\nmax_order = 2\n[[wall]]\nclosed = true\n\
                    points_m = [[-2.5, -1.8], [2.6, -1.8], [2.6, 1.7], [-2.5, 1.7]]\n";

/// A scene in which the robot of a ring file stands, with more keys of the robot.
pub(crate) fn scene(ring: &str, more: &str) -> Result<World, String> {
    let text = format!("{ROOM}[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = {ring:?}\n{more}\n");
    World::from_text_with(Path::new("rings/scene.toml"), &text, robot_ring).map_err(|error| error.to_string())
}

// A car with two makes and a mower fire as their ring files say.
#[test]
fn car_and_mower_fire_as_their_ring_files_say() {
    let mower: Vec<_> = (0..12).map(|sensor| if sensor < 8 { "hc-sr04" } else { "ping" }).collect();
    for (name, modules) in [("car-12", vec!["jsn-sr04t"; 12]), ("mower-8-and-4", mower)] {
        let text = std::fs::read_to_string(format!("rings/{name}.toml")).unwrap();
        let spec = RingSpec::from_text(&text).unwrap();
        let design = spec.shortest(&Effort::default(), &mut ()).unwrap();
        let schedule = format!("[robot.schedule]\n{}", design.schedule.to_toml());
        let more = format!("blanking_us = 900\n{schedule}");
        let world = scene(&format!("{name}.toml"), &more).unwrap();
        let robot = &world.robots()[0];
        assert_eq!((0..12).map(|sensor| robot.module_of(sensor).name).collect::<Vec<_>>(), modules);
        // What design asked of the schedule, driving as fast as the file says.
        let requirements = design.spec.problem().requirements;
        for (sensor, limits) in robot.limits.iter().enumerate() {
            assert_eq!(limits.window, requirements.window_of(sensor), "{name}");
            let off = limits.t_delta.abs_diff(requirements.t_delta_of(sensor));
            assert!(off <= Micros::new(2), "{name}: {} {}", limits.t_delta, requirements.t_delta_of(sensor));
        }
        let together = requirements.uneven.map_or(vec![], |uneven| uneven.together.to_vec());
        assert_eq!(robot.together, together);
        let readings = simulate(&world, Method::Eeruf, &Options::periods(200)).unwrap();
        assert!(readings.len() > 12 * 150, "{name}: {}", readings.len());
        for k in 0..readings.len() {
            let (t_echo_us, window) = (readings.earliest_us[k], robot.limits[usize::from(readings.sensor[k])].window);
            assert!(t_echo_us.is_nan() || t_echo_us <= f64::from(window.as_micros()), "{name}: {t_echo_us}");
        }
        let accepted = (0..readings.len()).filter(|&k| readings.kind[k] == ReadingKind::Accepted);
        let believed: std::collections::BTreeSet<_> = accepted.map(|k| readings.sensor[k]).collect();
        assert!(believed.len() >= 4, "{name}: {believed:?}");
    }
}

// Each sensor of a car listens for its own window also where it reports several echoes, or its ring adapts.
#[test]
fn limits_of_a_car_go_with_echoes_and_adaptation() {
    let car = format!("{}/rings/car-12.toml", env!("CARGO_MANIFEST_DIR"));
    let spec = RingSpec::from_text(&std::fs::read_to_string(&car).unwrap()).unwrap();
    let asked = spec.problem().requirements;
    let table = eeruf(&["design", &car, "--period-only", "--emit", "toml"]).out;
    let robot = format!("[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = {car:?}\n[robot.schedule]\n{table}");
    let (folder, file) = Scratch::new("scene.toml", &format!("{ROOM}{robot}"));
    let log = folder.path().join("log.csv");
    for method in ["eeruf", "multi_echo", "adaptive", "adaptive_multi_echo"] {
        let arguments =
            ["study", file.to_str().unwrap(), "--periods", "300", "--method", method, "--json", "--quiet", "--log"];
        let study = json(&[&arguments[..], &[log.to_str().unwrap()]].concat());
        let accepted = study["methods"][method]["accepted"].as_u64().unwrap();
        let text = std::fs::read_to_string(&log).unwrap();
        let mut longest = [0; 12];
        for row in text.lines().skip(2) {
            let row: Vec<_> = row.split(',').collect();
            let sensor: usize = row[0].parse().unwrap();
            longest[sensor] = longest[sensor].max(row[4].parse().unwrap_or(0));
        }
        assert!(accepted > 200, "{method}: {accepted}");
        for (sensor, longest) in longest.into_iter().enumerate() {
            let window = asked.window_of(sensor).as_micros();
            assert!(longest > 0 && longest <= window, "{method}, sensor {sensor}: {longest} of {window}");
        }
    }
}

#[test]
fn two_arrays_of_a_ring_file_fire_side_by_side() {
    let arrays = "firing = { arrays = [[0, 1, 2, 3, 4, 5, 6, 7], [8, 9, 10, 11, 12, 13, 14, 15]] }";
    let world = scene("../tests/data/pioneer-16.toml", &format!("{arrays}\nneighbours = 2")).unwrap();
    let robot = &world.robots()[0];
    assert_eq!((robot.sensors.len(), robot.neighbours, robot.window), (16, 2, Micros::new(29_138)));
    assert!((robot.sensors[8].translation.x + 0.155).abs() < 1e-12);
    assert!((robot.sensors[15].rotation.angle().to_degrees() - 90.0).abs() < 1e-9);
    let readings = simulate(&world, Method::Arrays, &Options::periods(50)).unwrap();
    let mut fired: Vec<_> = (0..readings.len()).map(|k| (readings.fired_s[k], readings.sensor[k])).collect();
    fired.sort_by(|a, b| a.0.total_cmp(&b.0));
    for array in [0..8, 8..16_u8] {
        let order: Vec<_> = fired.iter().map(|(_, sensor)| *sensor).filter(|sensor| array.contains(sensor)).collect();
        assert!(order.len() > 100 && order.iter().zip(array.clone().cycle()).all(|(a, b)| *a == b), "{order:?}");
    }
    // A round of one array is not that of the other.
    let rounds = [0, 8].map(|first| fired.iter().filter(|(_, sensor)| *sensor == first).count());
    assert!(rounds[0] != rounds[1], "{rounds:?}");
}

#[test]
fn what_a_ring_file_leaves_open_is_asked_for() {
    let refused = |ring: &str, more: &str| scene(ring, more).unwrap_err();
    let error = refused("paper-12.toml", "");
    assert_eq!(
        error,
        "rings/scene.toml, line 8: robot 1: paper-12.toml: it does not say where sensors stand; expected poses or \
         spacing_deg and radius_m in it, or sensors beside it"
    );
    let error = refused("car-12.toml", "sensors = [{ x_m = 0, y_m = 0 }]");
    assert!(error.contains("car-12.toml: 1 places of sensors; expected 12, as many as it has"), "{error}");
    assert!(refused("none.toml", "").starts_with("rings/none.toml: "));
    let error = refused("table-i-d.toml", "");
    assert!(error.starts_with("rings/table-i-d.toml, line ") && error.contains("unknown key"), "{error}");
    let text = format!("{ROOM}[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = \"car-12.toml\"\n");
    let error = World::from_text(Path::new("rings/scene.toml"), &text).unwrap_err().to_string();
    assert!(error.starts_with("rings/car-12.toml: a ring file, which this reader of scenes does not know"), "{error}");
    for (wrong, expected) in [
        ("poses = [{ x_m = 0, y_m = 0 }]", "poses: 1 place; expected 2, one a sensor"),
        ("spacing_deg = 20", "expected either poses, or spacing_deg and radius_m"),
    ] {
        let text = format!("sensors = 2\nt_delta_us = 9\nmin_interval_us = 0\nwindow_us = 9\n{wrong}");
        let error = robot_ring(Path::new("ring.toml"), &text);
        assert!(error.unwrap_err().message().contains(expected), "{wrong}");
    }
}

// A scene's robot stands as high as its ring file or the URDF beside it says, unless the scene says otherwise.
#[test]
fn scenes_take_places_and_heights_of_ring_files() {
    let (_scratch, urdf) = Scratch::new(
        "robot.urdf",
        "<robot name='r'><link name='base_footprint'/><link name='base_link'/><link name='a'/><link name='b'/>\
         <joint name='up' type='fixed'><parent link='base_footprint'/><child link='base_link'/><origin xyz='0 0 0.1'/>\
         </joint><joint name='to a' type='fixed'><parent link='base_link'/><child link='a'/><origin xyz='0.2 0.1 0.3'/>\
         </joint><joint name='to b' type='fixed'><parent link='base_link'/><child link='b'/>\
         <origin xyz='0.2 -0.1 0.5' rpy='0 0 -0.5'/></joint></robot>",
    );
    let folder = urdf.parent().unwrap();
    let ring = "sensors = 2\nmodule = \"ping\"\nurdf = \"robot.urdf\"\nlinks = [\"a\", \"b\"]\n";
    std::fs::write(folder.join("ring.toml"), ring).unwrap();
    let world = |more: &str| {
        let text = format!("{ROOM}[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = \"ring.toml\"\n{more}\n");
        World::from_text_with(&folder.join("scene.toml"), &text, robot_ring)
    };
    let heights = |more: &str| {
        let world = world(more).unwrap_or_else(|error| panic!("{error}"));
        [0, 1].map(|sensor| (100.0 * world.robots()[0].height_m(sensor)).round())
    };
    assert_eq!(heights(""), [40.0, 60.0]);
    assert_eq!(heights("height_m = 0.25"), [25.0, 25.0]);
    assert_eq!(heights("sensors = [{ x_m = 0, y_m = 0 }, { x_m = 0, y_m = 0.1 }]"), [30.0, 30.0]);
    let world_of_urdf = world("").unwrap();
    let sensors = &world_of_urdf.robots()[0].sensors;
    assert!((sensors[1].translation.y + 0.1).abs() + (sensors[1].rotation.angle() + 0.5).abs() < 1e-12);
    std::fs::write(folder.join("ring.toml"), ring.replace("\"b\"", "\"c\"")).unwrap();
    let error = world("").unwrap_err().to_string();
    assert!(error.contains("ring.toml, line 4: links: no `c` in ") && !error.contains("scene.toml"), "{error}");
}
