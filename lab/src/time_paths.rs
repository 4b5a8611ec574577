//! Times the path finder on the scenes of the shared corpus and prints one JSON object. Per scene it gives the
//! microseconds of the core (images seen) and of the whole answer (sorted, with angles and amplitudes), on one thread,
//! as the best of many runs. An argument names the only scene to time.

use eeruf_sim::{Air, Limits, Paths, Point, Scene, Tracer, Wall};
use serde_json::{Value, json};
use std::time::Instant;

use crate::corpus;

fn best_us(mut run: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    let begin = Instant::now();
    while begin.elapsed().as_millis() < 400 {
        let start = Instant::now();
        for _ in 0..10 {
            run();
        }
        best = best.min(start.elapsed().as_secs_f64() * 1e5);
    }
    best
}

fn time(scene: &Scene, source: Point, receivers: &[Point], order: u32) -> Value {
    let (mut tracer, mut paths) = (Tracer::new(), Paths::default());
    let limits = Limits::order(order);
    let whole = best_us(|| {
        tracer.trace(scene, source, receivers, limits, &mut paths).expect("a scene of the corpus");
    });
    let core = best_us(|| {
        tracer.visible_images(scene, source, receivers, limits).expect("a scene of the corpus");
    });
    json!({"order": order, "core_us": core, "whole_us": whole, "paths": paths.len(), "beams": tracer.beams(),
           "paths_per_s": paths.len() as f64 / core * 1e6})
}

/// Makes a star of many walls: a polygon whose corners lie between two circles, by a plain generator.
fn star(walls: usize) -> Vec<Wall> {
    let mut state = 12345u64;
    let mut radius = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        20.0 * (0.8 + 0.4 * (state >> 33) as f64 / (1u64 << 31) as f64)
    };
    let corner: Vec<_> = (0..walls)
        .map(|k| {
            let (sin, cos) = libm::sincos(k as f64 / walls as f64 * std::f64::consts::TAU);
            let r = radius();
            [r * cos, r * sin]
        })
        .collect();
    (0..walls)
        .map(|k| Wall::new(corner[k][0], corner[k][1], corner[(k + 1) % walls][0], corner[(k + 1) % walls][1]))
        .collect()
}

/// Makes a hall with square pillars on a grid.
fn pillars(per_side: usize) -> Vec<Wall> {
    let size = 2.0 * per_side as f64;
    let mut walls: Vec<_> = Wall::polyline(&[[0.0, 0.0], [size, 0.0], [size, size], [0.0, size], [0.0, 0.0]]).collect();
    for k in 0..per_side * per_side {
        let (x, y) = (1.0 + 2.0 * (k % per_side) as f64, 1.0 + 2.0 * (k / per_side) as f64);
        let a = 0.2 + 0.001 * (k % 37) as f64;
        walls.extend(Wall::polyline(&[[x - a, y], [x, y + a], [x + a, y], [x, y - a], [x - a, y]]));
    }
    walls
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let only = arguments.first();
    let skip = |id: &str| only.is_some_and(|only| only != id);
    let cases = corpus::corpus();
    let mut out = serde_json::Map::new();
    for case in cases["cases"].as_array().expect("cases") {
        let id = case["id"].as_str().expect("id");
        if skip(id) {
            continue;
        }
        let (scene, source, receivers) = (corpus::scene(case), corpus::point(&case["source"]), corpus::receivers(case));
        for order in [4, 6] {
            out.insert(format!("{id}@{order}"), time(&scene, source, &receivers, order));
        }
    }
    for (id, walls) in [("star1000", star(1000)), ("pillars1024", pillars(16))] {
        if skip(id) {
            continue;
        }
        let start = Instant::now();
        let scene = Scene::new(walls, vec![], Air::default()).expect("a scene");
        let build_us = start.elapsed().as_secs_f64() * 1e6;
        let receivers: Vec<_> = (0..8).map(|k| Point::new(10.1 + 0.3 * f64::from(k), 10.13)).collect();
        let source = if id == "star1000" { Point::new(1.0, 2.0) } else { Point::new(10.03, 10.12) };
        let mut timing = time(&scene, source, &receivers, 6);
        timing["build_us"] = json!(build_us);
        out.insert(format!("{id}@6"), timing);
    }
    println!("{}", serde_json::to_string_pretty(&out).expect("JSON"));
    Ok(())
}
