//! Paths per second on the scenes of the shared corpus: the core alone (images seen) and the whole answer.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use eeruf_sim::{Air, Faces, Limits, Paths, Point, Scene, Tracer, Wall};
use serde_json::Value;
use std::{hint::black_box, time::Duration};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

fn paths(criterion: &mut Criterion) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/critical-paths.json");
    let corpus: Value = serde_json::from_str(&std::fs::read_to_string(file).expect("the corpus")).expect("JSON");
    let mut group = criterion.benchmark_group("paths");
    group.warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    for case in corpus["cases"].as_array().expect("cases") {
        let id = case["id"].as_str().expect("id");
        let walls = case["walls"].as_array().expect("walls").iter().map(numbers);
        let mut walls: Vec<_> = walls.map(|w| Wall::new(w[0], w[1], w[2], w[3])).collect();
        numbers(&case["open"]).iter().for_each(|w| walls[*w as usize].faces = Faces::Open);
        numbers(&case["two_sided"]).iter().for_each(|w| walls[*w as usize].faces = Faces::Both);
        let scene = Scene::new(walls, vec![], Air::default()).expect("a scene of the corpus");
        let points = |list: &Value| -> Vec<Point> {
            list.as_array().expect("points").iter().map(numbers).map(|p| Point::new(p[0], p[1])).collect()
        };
        let receivers = points(&case["receivers"]);
        let source = numbers(&case["source"]);
        let source = Point::new(source[0], source[1]);
        let limits = Limits::order(case["max_order"].as_u64().expect("max_order") as u32);
        let (mut tracer, mut found) = (Tracer::new(), Paths::default());
        tracer.trace(&scene, source, &receivers, limits, &mut found).expect("paths");
        group.throughput(Throughput::Elements(found.len() as u64));
        group.bench_function(format!("{id}/core"), |bencher| {
            bencher.iter(|| black_box(tracer.sight(&scene, black_box(source), &receivers, limits)));
        });
        group.bench_function(format!("{id}/whole"), |bencher| {
            bencher.iter(|| black_box(tracer.trace(&scene, black_box(source), &receivers, limits, &mut found)));
        });
    }
    group.finish();
}

criterion_group!(benches, paths);
criterion_main!(benches);
