//! The shared corpus `tests/data/critical-paths.json`: every scene and closed form, path for path.

use eeruf_sim::{
    Air, Beam, Bounce, Limits, Material, Paths, Piston, Point, Scene, Tracer, Vector, Wall, alhazen, reception,
    reception_along, rigid_cylinder_form,
};
use serde_json::Value;

use crate::corpus_reader::{corpus, numbers, point, receivers, rows, scene};

/// One path of the corpus: length, order, and sequence (absent for degenerate cases).
type Expected = (f64, u32, Option<Vec<Bounce>>);

fn expected(paths: &Value) -> Vec<Expected> {
    let bounce = |v: &Value| match v.as_str() {
        Some(pole) => Bounce::Pole(pole[1..].parse().unwrap()),
        None => Bounce::Wall(v.as_u64().unwrap() as u32),
    };
    let sequence = |v: &Value| v.as_array().map(|list| list.iter().map(bounce).collect());
    let row = |v: &Value| (v[0].as_f64().unwrap(), v[1].as_u64().unwrap() as u32, sequence(&v[2]));
    paths.as_array().unwrap().iter().map(row).collect()
}

fn assert_same(id: &str, receiver: usize, found: &Paths, without_direct: bool, mut expected: Vec<Expected>) -> usize {
    let mut ours: Vec<_> = found
        .of(receiver as u32)
        .filter(|&k| !(without_direct && found.order[k] == 0))
        .map(|k| (found.length_m[k], found.order[k], found.bounces(k).to_vec()))
        .collect();
    assert_eq!(ours.len(), expected.len(), "{id}, receiver {receiver}: {ours:?} against {expected:?}");
    assert!(ours.is_sorted_by(|a, b| a.0 <= b.0), "{id}: sorted by length");
    // Equal lengths may come in any order: compare by sequence if there is one, otherwise by length and order.
    if expected.iter().all(|e| e.2.is_some()) {
        ours.sort_by(|a, b| a.2.cmp(&b.2));
        expected.sort_by(|a, b| a.2.cmp(&b.2));
    } else {
        let key = |length: f64, order: u32| ((length * 1e8).round() as u64, order);
        ours.sort_by_key(|o| key(o.0, o.1));
        expected.sort_by_key(|e| key(e.0, e.1));
    }
    for (o, e) in ours.iter().zip(&expected) {
        assert!((o.0 - e.0).abs() <= 1e-9, "{id}, receiver {receiver}: {o:?} against {e:?}");
        assert_eq!(o.1, e.1, "{id}, receiver {receiver}");
        if let Some(sequence) = &e.2 {
            assert_eq!(&o.2, sequence, "{id}, receiver {receiver}");
        }
    }
    ours.len()
}

#[test]
fn every_scene_of_the_corpus_has_exactly_its_paths() {
    let corpus = corpus();
    let mut total = 0;
    for case in corpus["cases"].as_array().unwrap() {
        let (id, scene, receivers) = (case["id"].as_str().unwrap(), scene(case), receivers(case));
        let max_order = case["max_order"].as_u64().unwrap() as u32;
        for order in 0..=max_order {
            let found = scene.paths(point(&case["source"]), &receivers, order, f64::INFINITY).unwrap();
            for (receiver, paths) in case["paths"].as_array().unwrap().iter().enumerate() {
                let mut truth = expected(paths);
                truth.retain(|path| path.1 <= order);
                let same = assert_same(id, receiver, &found, false, truth);
                total += if order == max_order { same } else { 0 };
            }
        }
    }
    assert_eq!(total, 3959);
}

#[test]
fn every_closed_form_of_the_corpus_is_met() {
    let corpus = corpus();
    let mut seen = 0;
    for case in corpus["closed_form"].as_array().unwrap() {
        let id = case["id"].as_str().unwrap();
        if case["walls"].is_null() {
            continue; // moving receivers have a test of their own
        }
        let (scene, receivers) = (scene(case), receivers(case));
        let max_order = case["max_order"].as_u64().unwrap() as u32;
        let found = scene.paths(point(&case["source"]), &receivers, max_order, f64::INFINITY).unwrap();
        let without_direct = case["exclude_order0"].as_bool().unwrap_or(false);
        if case["receivers"].is_null() {
            assert_same(id, 0, &found, without_direct, expected(&case["paths"]));
        } else {
            for (receiver, paths) in case["paths"].as_array().unwrap().iter().enumerate() {
                assert_same(id, receiver, &found, without_direct, expected(paths));
            }
        }
        if case["kind"] == "pole" {
            let pole = &scene.poles()[0];
            let hit = alhazen(point(&case["source"]), receivers[0], pole.centre, pole.radius_m).unwrap();
            assert!((hit.point - point(&case["hit"])).norm() < 1e-9, "{id}");
            assert!((hit.incidence_rad - case["incidence_rad"].as_f64().unwrap()).abs() < 1e-9, "{id}");
        }
        seen += 1;
    }
    assert_eq!(seen, 16);
}

#[test]
fn amplitudes_and_directions_of_the_corpus_are_met() {
    let corpus = corpus();
    let mut compared = 0;
    for case in corpus["cases"].as_array().unwrap().iter().filter(|case| !case["amplitude"].is_null()) {
        let acoustics = &case["amplitude"];
        let number = |key: &str| acoustics[key].as_f64().unwrap();
        let reflecting = Material::flat(number("reflection"));
        let bare = scene(case);
        let walls = bare.walls().iter().map(|wall| wall.with_material(reflecting)).collect();
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        assert!((scene.air().absorption_db_per_m(49_400.0) - number("alpha_db_per_m")).abs() < 1e-6);
        let piston = Piston { ka: number("ka"), floor: 0.0, beam: Beam::CutAt90 };
        let source_axis = number("source_axis_deg").to_radians();
        let limits = Limits::order(case["max_order"].as_u64().unwrap() as u32);
        let mut found = Paths::default();
        Tracer::at(49_400.0).trace(&scene, point(&case["source"]), &receivers(case), limits, &mut found).unwrap();
        for (receiver, axis) in numbers(&acoustics["receiver_axis_deg"]).iter().enumerate() {
            let values = rows(&acoustics["values"][receiver]);
            let ours = found.of(receiver as u32);
            assert_eq!(ours.len(), values.len());
            for (k, value) in ours.zip(values) {
                let near = |a: f64, b: f64| (a - b).sin().abs() < 1e-8 && (a - b).cos() > 0.0;
                assert!(near(found.departure_rad[k], value[0]) && near(found.arrival_rad[k], value[1]), "path {k}");
                let patterns = piston.pattern(found.departure_rad[k] - source_axis)
                    * piston.pattern(found.arrival_rad[k] - axis.to_radians());
                let amplitude = patterns * found.amplitude[k];
                assert!(
                    (amplitude - value[2]).abs() <= 1e-6 * value[2] + 1e-12,
                    "path {k}: {amplitude} against {}",
                    value[2]
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 168);
}

#[test]
fn moving_receivers_of_the_corpus_are_reached_in_time() {
    let corpus = corpus();
    let mut seen = 0;
    for case in corpus["closed_form"].as_array().unwrap().iter().filter(|case| case["kind"] == "moving_receiver") {
        let number = |key: &str| case[key].as_f64().unwrap();
        let (source, receiver, velocity) =
            (point(&case["source"]), point(&case["receiver"]), numbers(&case["receiver_velocity"]));
        let velocity = Vector::new(velocity[0], velocity[1]);
        let image = Point::new(source.x, 2.0 * number("wall_y") - source.y);
        let met = reception(image, receiver, velocity, number("c")).unwrap();
        assert!((met.time_s - number("arrival_time")).abs() < 1e-14);
        assert!((met.length_m - number("path_length")).abs() < 1e-11);
        // The path finder must give the same result.
        let wall = Wall::new(50.0, number("wall_y"), -50.0, number("wall_y"));
        let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
        let paths = scene.paths(source, &[receiver], 1, f64::INFINITY).unwrap();
        let k = paths.len() - 1;
        let met = reception_along(paths.length_m[k], paths.arrival_rad[k], velocity, number("c")).unwrap();
        assert!((met.time_s - number("arrival_time")).abs() < 1e-14);
        seen += 1;
    }
    assert_eq!(seen, 2);
}

#[test]
fn physics_values_of_the_corpus_are_met() {
    let corpus = corpus();
    for value in corpus["physics"].as_array().unwrap() {
        let number = |key: &str| value[key].as_f64().unwrap();
        let name = value["name"].as_str().unwrap();
        let ours = match name.split(' ').next().unwrap() {
            "air_absorption_iso9613_1" => {
                let air = Air {
                    temperature_c: number("temp_c"),
                    humidity_percent: number("rh_percent"),
                    pressure_kpa: number("pressure_kpa"),
                };
                air.absorption_db_per_m(number("f_hz"))
            }
            "speed_of_sound_343.2*sqrt(T/293.15)" => Air::at(number("temp_c")).speed_of_sound(),
            "piston_2J1x/x_abs" => {
                Piston { ka: number("ka"), floor: 0.0, beam: Beam::CutAt90 }.pattern(number("theta_deg").to_radians())
            }
            "piston_angle_at_db_deg" => Piston { ka: number("ka"), floor: 0.0, beam: Beam::CutAt90 }
                .angle_at_db(number("db"))
                .unwrap()
                .to_degrees(),
            "rigid_cylinder_form" => rigid_cylinder_form(number("ka"), number("phi_rad")),
            other => panic!("a physics value that is not tested: {other}"),
        };
        let expected = number("value");
        assert!((ours / expected - 1.0).abs() <= number("rtol"), "{name}: {ours} against {expected}");
    }
}
