//! The shared corpus `tests/data/critical-paths.json`: every scene and closed form, path for path.

use eeruf_sim::{Air, Bounce, Faces, Paths, Point, Pole, Scene, Wall, alhazen};
use serde_json::Value;

fn corpus() -> Value {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/data/critical-paths.json"
    );
    serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .map(|list| list.iter().map(|v| v.as_f64().unwrap()).collect())
        .unwrap_or_default()
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    value
        .as_array()
        .map(|list| list.iter().map(numbers).collect())
        .unwrap_or_default()
}

fn point(value: &Value) -> Point {
    let at = numbers(value);
    Point::new(at[0], at[1])
}

fn scene(case: &Value) -> Scene {
    let mut walls: Vec<_> = rows(&case["walls"])
        .iter()
        .map(|w| Wall::new(w[0], w[1], w[2], w[3]))
        .collect();
    for open in numbers(&case["open"]) {
        walls[open as usize].faces = Faces::Open;
    }
    for panel in numbers(&case["two_sided"]) {
        walls[panel as usize].faces = Faces::Both;
    }
    let poles = rows(&case["poles"])
        .iter()
        .map(|p| Pole::new(p[0], p[1], p[2]))
        .collect();
    Scene::new(walls, poles, Air::default()).unwrap()
}

fn receivers(case: &Value) -> Vec<Point> {
    match case["receivers"].as_array() {
        Some(list) => list.iter().map(point).collect(),
        None => vec![point(&case["receiver"])],
    }
}

/// One path as the corpus writes it: length, order, sequence (absent where the case is degenerate).
type Expected = (f64, u32, Option<Vec<Bounce>>);

fn expected(paths: &Value) -> Vec<Expected> {
    let bounce = |v: &Value| match v.as_str() {
        Some(pole) => Bounce::Pole(pole[1..].parse().unwrap()),
        None => Bounce::Wall(v.as_u64().unwrap() as u32),
    };
    let sequence = |v: &Value| v.as_array().map(|list| list.iter().map(bounce).collect());
    let row = |v: &Value| {
        (
            v[0].as_f64().unwrap(),
            v[1].as_u64().unwrap() as u32,
            sequence(&v[2]),
        )
    };
    paths.as_array().unwrap().iter().map(row).collect()
}

fn assert_same(
    id: &str,
    receiver: usize,
    found: &Paths,
    without_direct: bool,
    mut expected: Vec<Expected>,
) -> usize {
    let mut ours: Vec<_> = found
        .of(receiver as u32)
        .filter(|&k| !(without_direct && found.order[k] == 0))
        .map(|k| (found.length_m[k], found.order[k], found.bounces(k).to_vec()))
        .collect();
    assert_eq!(
        ours.len(),
        expected.len(),
        "{id}, receiver {receiver}: {ours:?} against {expected:?}"
    );
    assert!(
        ours.is_sorted_by(|a, b| a.0 <= b.0),
        "{id}: sorted by length"
    );
    // Equal lengths may come in any order: compare by sequence where there is one, by length and order where not.
    if expected.iter().all(|e| e.2.is_some()) {
        ours.sort_by(|a, b| a.2.cmp(&b.2));
        expected.sort_by(|a, b| a.2.cmp(&b.2));
    } else {
        let key = |length: f64, order: u32| ((length * 1e8).round() as u64, order);
        ours.sort_by_key(|o| key(o.0, o.1));
        expected.sort_by_key(|e| key(e.0, e.1));
    }
    for (o, e) in ours.iter().zip(&expected) {
        assert!(
            (o.0 - e.0).abs() <= 1e-9,
            "{id}, receiver {receiver}: {o:?} against {e:?}"
        );
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
            let found = scene
                .paths(point(&case["source"]), &receivers, order, f64::INFINITY)
                .unwrap();
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
        let found = scene
            .paths(point(&case["source"]), &receivers, max_order, f64::INFINITY)
            .unwrap();
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
            let hit = alhazen(
                point(&case["source"]),
                receivers[0],
                pole.centre,
                pole.radius_m,
            )
            .unwrap();
            assert!((hit.point - point(&case["hit"])).norm() < 1e-9, "{id}");
            assert!(
                (hit.incidence_rad - case["incidence_rad"].as_f64().unwrap()).abs() < 1e-9,
                "{id}"
            );
        }
        seen += 1;
    }
    assert_eq!(seen, 16);
}
