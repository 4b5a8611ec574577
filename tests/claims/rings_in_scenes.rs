//! Rings of real machines, designed from their files, fire in scenes as they were designed: each sensor with the
//! module, window and tolerance that it has there.

use std::path::Path;

use eeruf_core::{Micros, ReadingKind};
use eeruf_design::{RingSpec, Search};
use eeruf_sim::{Method, Options, World, simulate};

/// Sensors around a hull of 1.6 m by 0.8 m: place and heading, in metres and degrees.
const CAR: [[f64; 3]; 12] = [
    [0.8, 0.35, 30.0],
    [0.82, 0.12, 6.0],
    [0.82, -0.12, -6.0],
    [0.8, -0.35, -30.0],
    [0.5, -0.4, -90.0],
    [-0.5, -0.4, -90.0],
    [-0.8, -0.35, -150.0],
    [-0.82, -0.12, -174.0],
    [-0.82, 0.12, 174.0],
    [-0.8, 0.35, 150.0],
    [-0.5, 0.4, 90.0],
    [0.5, 0.4, 90.0],
];

/// A scene in which the robot of a ring file stands, with its sensors at these places.
fn scene(spec: &RingSpec, modules: &[&str], places: &[[f64; 3]]) -> String {
    let design = spec.shortest(&Search::default(), &mut ()).unwrap().unwrap();
    let requirements = design.spec.problem().requirements;
    let list = |of: &dyn Fn(usize) -> Micros| {
        (0..spec.sensors).map(|sensor| of(sensor).as_micros().to_string()).collect::<Vec<_>>().join(", ")
    };
    let poses = places.iter().map(|[x, y, deg]| format!("{{ x_m = {x:?}, y_m = {y:?}, heading_deg = {deg:?} }}"));
    let modules = modules.iter().map(|module| format!("{module:?}"));
    let together: Vec<Vec<usize>> = spec.uneven.as_ref().map_or(vec![], |uneven| {
        let members = |set: &u64| (0..spec.sensors).filter(|sensor| set >> sensor & 1 == 1).collect();
        uneven.uneven().together.iter().map(members).collect()
    });
    format!(
        "seed = 2\nmax_order = 2\n[[wall]]\npoints_m = [[-2.5, -1.8], [2.6, -1.8], [2.6, 1.7], [-2.5, 1.7]]\n\
         closed = true\n[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nsensors = [{}]\nmodule = [{}]\nblanking_us = 900\n\
         t_delta_us = [{}]\nwindow_us = [{}]\ntogether = {together:?}\n[robot.schedule]\n{}",
        poses.collect::<Vec<_>>().join(", "),
        modules.collect::<Vec<_>>().join(", "),
        list(&|sensor| requirements.t_delta_of(sensor)),
        list(&|sensor| requirements.window_of(sensor)),
        design.schedule.to_toml()
    )
}

fn ring(name: &str) -> RingSpec {
    RingSpec::from_text(&std::fs::read_to_string(format!("rings/{name}.toml")).unwrap()).unwrap()
}

#[test]
fn a_car_with_two_makes_and_a_mower_fire_as_their_ring_files_say() {
    // The front of another make, as the file says.
    let car: Vec<_> = (0..12).map(|sensor| if sensor < 4 { "jsn-sr04t" } else { "hc-sr04" }).collect();
    let mower: Vec<_> = (0..12).map(|sensor| if sensor < 8 { "hc-sr04" } else { "ping" }).collect();
    for (name, modules) in [("car-12", car), ("mower-8-and-4", mower)] {
        let spec = ring(name);
        let text = scene(&spec, &modules, &CAR);
        let world = World::from_text(Path::new("scene.toml"), &text).unwrap();
        let robot = &world.robots()[0];
        assert_eq!((0..12).map(|sensor| robot.module_of(sensor).name).collect::<Vec<_>>(), modules);
        let readings = simulate(&world, Method::Eeruf, &Options::periods(200)).unwrap();
        assert!(readings.len() > 12 * 150, "{name}: {}", readings.len());
        let window = |sensor: u8| spec.problem().requirements.window_of(usize::from(sensor)).as_micros();
        for k in 0..readings.len() {
            let t_echo_us = readings.earliest_us[k];
            assert!(t_echo_us.is_nan() || t_echo_us <= f64::from(window(readings.sensor[k])), "{name}: {t_echo_us}");
        }
        let accepted = (0..readings.len()).filter(|&k| readings.kind[k] == ReadingKind::Accepted);
        let believed: std::collections::BTreeSet<_> = accepted.map(|k| readings.sensor[k]).collect();
        assert!(believed.len() >= 4, "{name}: {believed:?}");
    }
}
