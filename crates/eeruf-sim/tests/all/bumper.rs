//! Modules side by side on a bumper, all fired at once, which hear each other directly along it.

use std::path::Path;

use eeruf_sim::*;

/// Reads one of the two field cases: two modules 10 cm apart before a wall.
fn field_case(name: &str) -> World {
    World::from_toml(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/field-cases").join(name)).unwrap()
}

/// Returns the share of wrong readings in per cent, with this beam and mounting. The outer sensors are turned inwards
/// by an angle; a third sensor between the two is optional.
fn wrong_percent(beam: Beam, coupling_db: Option<f64>, turned_deg: f64, sensors: usize) -> f64 {
    let flat = field_case("bumper-flat.toml");
    let robot = &flat.robots()[0];
    let mut places: Vec<_> = robot.sensors.clone();
    if sensors == 3 {
        places.insert(1, Pose::identity());
    }
    for place in &mut places {
        let inwards = -place.translation.y.signum() * turned_deg.to_radians();
        let turned = if place.translation.y == 0.0 { 0.0 } else { inwards };
        *place = Pose::new(place.translation.vector, turned);
    }
    let transducer = Transducer { beam, ..robot.transducer };
    let robot = Robot { sensors: places, transducer, coupling_db, ..robot.clone() };
    let walls = flat.scene().walls().to_vec();
    let scene = Scene::new(walls, vec![], flat.scene().air()).unwrap();
    let world = World::new(scene, vec![robot], flat.noise()).and_then(|world| world.with_max_order(flat.max_order()));
    let readings = simulate(&world.unwrap(), Method::Simultaneous, &Options::periods(400)).unwrap();
    100.0 * readings.summary().wrong_of_all
}

#[test]
fn the_cut_beam_makes_a_step_of_a_twentieth_of_a_degree() {
    assert_eq!(wrong_percent(Beam::CutAt90, None, 0.0, 2), 0.0);
    assert_eq!(wrong_percent(Beam::CutAt90, None, 0.05, 2), 100.0);
}

#[test]
fn hc_sr04_has_a_continuous_beam_unless_a_scene_says_otherwise() {
    let wrong = ["bumper-flat.toml", "bumper-turned-in.toml"].map(|name| {
        let world = field_case(name);
        assert_eq!(world.robots()[0].transducer.beam, Beam::Continuous);
        let readings = simulate(&world, Method::Simultaneous, &Options::periods(400)).unwrap();
        100.0 * readings.summary().wrong_of_all
    });
    assert!((wrong[0] - wrong[1]).abs() < 10.0, "{wrong:?}");
}

#[test]
fn a_tenth_of_a_degree_changes_little_under_a_continuous_beam() {
    for sensors in [2, 3] {
        for coupling_db in [None, Some(-60.0), Some(-40.0)] {
            let wrong = [0.0, 0.05, 0.1, -0.1].map(|deg| wrong_percent(Beam::Continuous, coupling_db, deg, sensors));
            println!("{sensors} modules, {coupling_db:?} dB: {wrong:?} % wrong");
            let (least, most) = wrong.iter().fold((100.0f64, 0.0f64), |(a, b), &w| (a.min(w), b.max(w)));
            assert!(most - least < 10.0, "{sensors} {coupling_db:?}: {wrong:?}");
        }
    }
}

// A stated mounting decides the level between neighbours straight along it.
#[test]
fn stated_mounting_decides_coupling() {
    // This is just audible at 10 cm: 4 m and back lose 18.1 dB to spreading and 10.5 dB to the air, 10 cm gain 20 dB.
    let heard_db = 20.0 * Transducer::HC_SR04.detection_floor(Air::default()).log10() - 20.0
        + 0.1 * Air::default().absorption_db_per_m(40e3);
    for (over_db, expected) in [(-12.0, 0.0), (12.0, 100.0)] {
        let wrong = wrong_percent(Beam::CutAt90, Some(heard_db + over_db), 0.0, 2);
        assert!((wrong - expected).abs() < 1.0, "{over_db}: {wrong}");
    }
    let world = field_case("bumper-flat.toml");
    let refused = |coupling_db| {
        let robot = Robot { coupling_db: Some(coupling_db), ..world.robots()[0].clone() };
        World::new(Scene::new(vec![], vec![], Air::default()).unwrap(), vec![robot], Noise::NONE).unwrap_err()
    };
    assert_eq!(refused(3.0).to_string(), "robot 1: coupling_db is 3; expected -200 to 0");
    assert_eq!(refused(f64::NAN).to_string(), "robot 1: coupling_db is NaN; expected -200 to 0");
}
