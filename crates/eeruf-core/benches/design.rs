//! How long the shortest period takes: the instances of the theory's table, and those of it in finer ticks.

#![allow(
    missing_docs,
    reason = "criterion's macro writes a public function without any"
)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use eeruf_core::search::design::{Problem, memory_words, shortest};

fn conflicts(sensors: usize, ring: bool) -> Vec<u64> {
    let gap = |x: usize, y: usize| {
        if ring {
            x.abs_diff(y).min(sensors - x.abs_diff(y))
        } else {
            x.abs_diff(y)
        }
    };
    (0..sensors)
        .map(|x| {
            (0..sensors)
                .filter(|&y| x != y && gap(x, y) < 4)
                .map(|y| 1 << y)
                .sum()
        })
        .collect()
}

fn table(c: &mut Criterion) {
    for (name, ticks) in [("design", 1), ("design, tick 0.1 ms", 10)] {
        let mut group = c.benchmark_group(name);
        group.sample_size(10);
        for sensors in [8, 12, 16, 24] {
            for ring in [false, true] {
                let rows = conflicts(sensors, ring);
                let mut memory = vec![0; memory_words(sensors)];
                for window in [15, 30, 45, 60] {
                    let problem = Problem {
                        sensors,
                        conflicts: &rows,
                        separation: 2 * ticks,
                        interval: 15 * ticks,
                        window: window * ticks,
                        stale_echo: false,
                    };
                    let layout = if ring { "ring" } else { "line" };
                    group.bench_function(
                        BenchmarkId::new(format!("{layout} {sensors}"), window),
                        |b| {
                            b.iter(|| shortest(&problem, u64::MAX, &mut memory, &mut ()));
                        },
                    );
                }
            }
        }
    }
}

criterion_group!(benches, table);
criterion_main!(benches);
