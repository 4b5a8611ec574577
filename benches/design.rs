//! Time of the shortest period: the instances of the theory's table, and those of it in finer ticks.

#![allow(missing_docs, reason = "criterion's macro writes a public function without any")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use eeruf_core::Layout;
use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::shortest;

fn table(c: &mut Criterion) {
    for (name, ticks) in [("design", 1), ("design, tick 0.1 ms", 10)] {
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        for sensors in [8, 12, 16, 24] {
            for ring in [false, true] {
                let layout = if ring { Layout::Ring(4) } else { Layout::Line(4) };
                let rows = layout.rows(sensors);
                for window in [15, 30, 45, 60] {
                    let problem = Problem::alike(&rows[..sensors], 2 * ticks, 15 * ticks, window * ticks);
                    let layout = if ring { "ring" } else { "line" };
                    group.bench_function(BenchmarkId::new(format!("{layout} {sensors}"), window), |b| {
                        b.iter(|| shortest(&problem, u64::MAX, &mut |_| true));
                    });
                }
            }
        }
    }
}

criterion_group!(benches, table);
criterion_main!(benches);
