//! Paths per second on the scenes of the shared corpus: the core alone (images seen), also for a source that moves, and
//! the whole answer.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use eeruf_sim::{Limits, Paths, Point, Tracer};
use std::{hint::black_box, time::Duration};

#[path = "../crates/eeruf-sim/tests/common/corpus.rs"]
mod corpus;

/// Places within a hundredth of the source's distance from the origin, in an order that jumps. Where a source
/// stands still the processor learns which way each branch goes: pillars40 then takes two thirds of the time.
fn places(source: Point) -> Vec<Point> {
    (0..512).map(|k| source * (1.0 + 0.02 * (f64::from(k * 197 % 512) / 512.0 - 0.5))).collect()
}

fn paths(criterion: &mut Criterion) {
    let cases = corpus::corpus();
    let mut group = criterion.benchmark_group("paths");
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for case in cases["cases"].as_array().expect("cases") {
        let id = case["id"].as_str().expect("id");
        let (scene, source, receivers) = (corpus::scene(case), corpus::point(&case["source"]), corpus::receivers(case));
        let limits = Limits::order(case["max_order"].as_u64().expect("max_order") as u32);
        let (mut tracer, mut found) = (Tracer::new(), Paths::default());
        tracer.trace(&scene, source, &receivers, limits, &mut found).expect("paths");
        group.throughput(Throughput::Elements(found.len() as u64));
        group.bench_function(format!("{id}/core"), |bencher| {
            bencher.iter(|| black_box(tracer.visible_images(&scene, black_box(source), &receivers, limits)));
        });
        let mut places = places(source).into_iter().cycle();
        group.bench_function(format!("{id}/core, moving"), |bencher| {
            bencher
                .iter(|| black_box(tracer.visible_images(&scene, places.next().unwrap_or(source), &receivers, limits)));
        });
        group.bench_function(format!("{id}/whole"), |bencher| {
            bencher.iter(|| black_box(tracer.trace(&scene, black_box(source), &receivers, limits, &mut found)));
        });
    }
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
