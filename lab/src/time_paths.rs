//! Times the path finder on the scenes of the shared corpus and prints one JSON object. Per scene it gives the
//! microseconds of the core (images seen) and of the whole answer (sorted, with angles and amplitudes), on one thread,
//! as the best of many runs.

use eeruf_sim::{Limits, Paths, Point, Scene, Tracer};
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

pub(crate) fn main(_: &[String]) -> crate::Answer {
    let cases = corpus::corpus();
    let mut out = serde_json::Map::new();
    for case in cases["cases"].as_array().expect("cases") {
        let id = case["id"].as_str().expect("id");
        let (scene, source, receivers) = (corpus::scene(case), corpus::point(&case["source"]), corpus::receivers(case));
        for order in [4, 6] {
            out.insert(format!("{id}@{order}"), time(&scene, source, &receivers, order));
        }
    }
    println!("{}", serde_json::to_string_pretty(&out).expect("JSON"));
    Ok(())
}
