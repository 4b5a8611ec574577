//! What the wait search costs: the best interval over sensors and ticks, Table I rearranged, and counting against plain nested
//! loops in the same run (the last lines print the ratio).

#![allow(missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::time::Instant;

use common::naive::{Layout, conflicts};
use criterion::{Criterion, criterion_group};
use eeruf_core::search::wait::{self, COUNT_WORDS, Control, MEMORY_WORDS, Objective, WaitProblem, WaitSearch};

/// Sensors, period, longest wait, group of lags, separation, interval, neighbours, whether the paper's criterion, layout.
type Instance = (usize, u32, u32, usize, u32, u32, usize, bool, Layout);

const COUNTS: [Instance; 6] = [
    (4, 40, 9, 4, 2, 5, 4, true, Layout::Line),
    (4, 40, 9, 4, 2, 5, 4, false, Layout::Line),
    (4, 40, 9, 4, 2, 0, 4, true, Layout::Line),
    (6, 60, 10, 4, 2, 10, 4, true, Layout::Line),
    (6, 60, 10, 4, 2, 10, 4, false, Layout::Line),
    (6, 48, 6, 4, 1, 8, 4, true, Layout::Blocks),
];

fn with_problem<R>(instance: Instance, then: impl FnOnce(WaitProblem<'_>) -> R) -> R {
    let (sensors, period, wait_max, group, separation, interval, neighbours, paper, layout) = instance;
    let lag: Vec<u32> = (0..sensors).map(|i| (i % group) as u32 * period / group as u32).collect();
    let criterion = if paper { wait::Criterion::Paper } else { wait::Criterion::Exact };
    let conflicts = conflicts(layout, sensors, neighbours);
    then(WaitProblem { period, lag: &lag, wait_max, separation, interval, conflicts: &conflicts, criterion })
}

fn best_interval(c: &mut Criterion) {
    let mut memory = vec![0; MEMORY_WORDS];
    for (sensors, separation) in [(12, 2), (8, 1), (12, 1), (16, 1), (24, 1)] {
        for per_ms in [1, 2, 10] {
            let instance = (sensors, 100 * per_ms, 24 * per_ms, 4, separation * per_ms, 0, 4, false, Layout::Line);
            c.bench_function(
                &format!("best interval, {sensors} sensors, D = {separation} ms, {per_ms} ticks a ms"),
                |bench| {
                    with_problem(instance, |problem| {
                        let search = WaitSearch::new(problem).unwrap();
                        let (mut a, mut b) = ([0; 64], [0; 64]);
                        bench.iter(|| {
                            search
                                .best(Objective::Interval, &mut memory, &mut Control::unlimited(), &mut a, &mut b)
                                .unwrap()
                        });
                    });
                },
            );
        }
    }
}

fn rearrange(c: &mut Criterion) {
    let pairs: Vec<(u32, u32)> = (0..12).map(|k| (24, 2 * k)).collect();
    for layout in [Layout::Line, Layout::Ring, Layout::Blocks] {
        c.bench_function(&format!("Table I rearranged, best interval, {layout:?}"), |bench| {
            with_problem((12, 100, 24, 4, 2, 0, 4, true, layout), |problem| {
                let search = WaitSearch::new(problem).unwrap();
                let arrangements = search.rearrange(&pairs).unwrap();
                let (mut a, mut b) = ([0; 12], [0; 12]);
                bench.iter(|| arrangements.best_interval(&mut Control::unlimited(), &mut a, &mut b).unwrap());
            });
        });
    }
}

fn count(c: &mut Criterion) {
    let mut memory = vec![0; COUNT_WORDS];
    for instance in COUNTS {
        c.bench_function(&format!("count {instance:?}"), |bench| {
            with_problem(instance, |problem| {
                let search = WaitSearch::new(problem).unwrap();
                bench.iter(|| search.count(None, &mut memory, &mut Control::unlimited()));
            });
        });
    }
}

/// Plain nested loops as one would write them for speed: pairs in order, each checked against the sensors before it; the body of the
/// innermost loop counts.
fn nested_loops(problem: &WaitProblem<'_>) -> u64 {
    fn fits(p: &WaitProblem<'_>, k: usize, wait: &[(i32, i32)], a: i32, b: i32) -> bool {
        let period = p.period as i32;
        let (interval, separation) = (p.interval as i32, p.separation as i32);
        (0..k).all(|j| {
            let (c, e) = wait[j];
            let lag = p.lag[k] as i32 - p.lag[j] as i32;
            (p.conflicts[k] >> j & 1 == 0
                || (lag + a - c).abs() >= interval
                    && (lag + b - e).abs() >= interval
                    && period - (lag + a - e).abs() >= interval
                    && period - (lag + b - c).abs() >= interval)
                && ((a - b).abs() - (c - e).abs()).abs() >= separation
                && (p.criterion == wait::Criterion::Exact || (a + b - c - e).abs() >= separation)
        })
    }
    fn loops(p: &WaitProblem<'_>, k: usize, wait: &mut [(i32, i32)]) -> u64 {
        let (most, last) = (p.wait_max as i32, k + 1 == p.lag.len());
        let mut tables = 0;
        for a in 0..=most {
            for b in 0..=most {
                if fits(p, k, wait, a, b) {
                    wait[k] = (a, b);
                    tables += if last { 1 } else { loops(p, k + 1, wait) };
                }
            }
        }
        tables
    }
    loops(problem, 0, &mut [(0, 0); 64])
}

/// The least time of a few runs, in seconds.
fn time<R>(runs: usize, mut run: impl FnMut() -> R) -> (f64, R) {
    let mut once = || {
        let start = Instant::now();
        let result = black_box(run());
        (start.elapsed().as_secs_f64(), result)
    };
    (1..runs).fold(once(), |best, _| {
        let next = once();
        if next.0 < best.0 { next } else { best }
    })
}

fn ratios() {
    let mut memory = vec![0; COUNT_WORDS];
    for instance in COUNTS {
        with_problem(instance, |problem| {
            let search = WaitSearch::new(problem).unwrap();
            let (fast, counted) = time(20, || search.count(None, &mut memory, &mut Control::unlimited()).count);
            let (slow, naive) = time(1, || nested_loops(&problem));
            assert_eq!(counted, u128::from(naive));
            println!(
                "{instance:?}: {counted} tables, search {:.3} ms, nested loops {:.1} ms, ratio {:.0}",
                fast * 1e3,
                slow * 1e3,
                slow / fast
            );
        });
    }
}

criterion_group!(benches, best_interval, rearrange, count);

fn main() {
    // Under `cargo test` the benches only have to run.
    if !std::env::args().any(|arg| arg == "--test") {
        ratios();
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
