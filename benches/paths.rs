//! Paths per second on the scenes of the shared corpus: the core alone (images seen), also for a source that moves, and
//! the whole answer.

use eeruf_benches::time;
use eeruf_sim::{Limits, Paths, Point, Tracer};
use std::hint::black_box;

#[path = "../crates/eeruf-sim/tests/common/corpus.rs"]
mod corpus;

/// Places within a hundredth of the source's distance from the origin, in an order that jumps. If a source
/// stands still, the processor learns which way each branch goes, and pillars40 takes two thirds of the time.
fn places(source: Point) -> Vec<Point> {
    (0..512).map(|k| source * (1.0 + 0.02 * (f64::from(k * 197 % 512) / 512.0 - 0.5))).collect()
}

fn main() {
    let cases = corpus::corpus();
    for case in cases["cases"].as_array().expect("cases") {
        let id = case["id"].as_str().expect("id");
        let (scene, source, receivers) = (corpus::scene(case), corpus::point(&case["source"]), corpus::receivers(case));
        let limits = Limits::order(case["max_order"].as_u64().expect("max_order") as u32);
        let (mut tracer, mut found) = (Tracer::new(), Paths::default());
        tracer.trace(&scene, source, &receivers, limits, &mut found).expect("paths");
        let count = found.len();
        time(&format!("{id}/core"), count, || tracer.visible_images(&scene, black_box(source), &receivers, limits));
        let mut places = places(source).into_iter().cycle();
        time(&format!("{id}/core, moving"), count, || {
            tracer.visible_images(&scene, places.next().unwrap_or(source), &receivers, limits)
        });
        time(&format!("{id}/whole"), count, || tracer.trace(&scene, black_box(source), &receivers, limits, &mut found));
    }
}
