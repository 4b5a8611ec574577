//! Reader of the shared corpus of critical paths, for the tests, the bench and the timing example.
#![allow(dead_code, unreachable_pub, reason = "each of them uses its own part")]

use eeruf_sim::{Air, Faces, Point, Pole, Scene, Wall};
use serde_json::Value;

pub fn corpus() -> Value {
    serde_json::from_str(include_str!("../../../../tests/data/critical-paths.json")).unwrap()
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().map(|v| v.as_f64().unwrap()).collect()).unwrap_or_default()
}

pub fn rows(value: &Value) -> Vec<Vec<f64>> {
    value.as_array().map(|list| list.iter().map(numbers).collect()).unwrap_or_default()
}

pub fn point(value: &Value) -> Point {
    let at = numbers(value);
    Point::new(at[0], at[1])
}

pub fn scene(case: &Value) -> Scene {
    let mut walls: Vec<_> = rows(&case["walls"]).iter().map(|w| Wall::new(w[0], w[1], w[2], w[3])).collect();
    for open in numbers(&case["open"]) {
        walls[open as usize].faces = Faces::Open;
    }
    for panel in numbers(&case["two_sided"]) {
        walls[panel as usize].faces = Faces::Both;
    }
    let poles = rows(&case["poles"]).iter().map(|p| Pole::new(p[0], p[1], p[2])).collect();
    Scene::new(walls, poles, Air::default()).unwrap()
}

pub fn receivers(case: &Value) -> Vec<Point> {
    match case["receivers"].as_array() {
        Some(list) => list.iter().map(point).collect(),
        None => vec![point(&case["receiver"])],
    }
}
