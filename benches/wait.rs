//! Cost of the wait search: the best interval over sensors and ticks, and counting against plain nested loops
//! in the same run (the first lines print the ratio).

#![allow(missing_docs)]

#[path = "../crates/eeruf-core/tests/all/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::time::Instant;

use common::Owned;
use common::naive::{Layout, Problem};
use common::tables::{Case, File};
use eeruf_benches::time;
use eeruf_core::search::{Budget, COUNT_WORDS, MEMORY_WORDS};

/// The counted problems: those of the shared tables with many solutions, and two that need more nodes.
fn counts() -> Vec<Case> {
    let mut cases: Vec<Case> = File::read().cases.into_iter().filter(|case| case.count > 100_000).collect();
    for (criterion, count) in [("paper", 93_184), ("exact", 6_092_216)] {
        cases.push(Case {
            sensors: 6,
            period: 60,
            wait_max: 10,
            group: 4,
            separation: 2,
            min_interval: 10,
            neighbours: 4,
            criterion: criterion.into(),
            layout: Layout::Line,
            count,
            best_interval: -1,
        });
    }
    cases
}

fn best_interval() {
    let mut memory = vec![0; MEMORY_WORDS];
    for (sensors, separation) in [(12, 2), (8, 1), (12, 1), (16, 1), (24, 1)] {
        for per_ms in [1, 2, 10] {
            let owned = Owned::paper(sensors, Layout::Line, separation, per_ms, eeruf_core::Criterion::Exact);
            let name = format!("best interval/{sensors} sensors, D {separation} ms, {per_ms} ticks a ms");
            time(&name, 1, || owned.search().best_interval::<64>(&mut memory, &mut Budget::unlimited()));
        }
    }
}

/// Plain nested loops as one would write them for speed: pairs in order, each checked against the sensors before it;
/// the body of the innermost loop counts.
fn nested_loops(problem: &Problem<'_>) -> u64 {
    fn fits(p: &Problem<'_>, k: usize, wait: &[(i32, i32)], a: i32, b: i32) -> bool {
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
                && (p.criterion == eeruf_core::Criterion::Exact || (a + b - c - e).abs() >= separation)
        })
    }
    fn loops(p: &Problem<'_>, k: usize, wait: &mut [(i32, i32)]) -> u64 {
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

/// Returns the shortest time of a few runs, in milliseconds.
fn least_ms<R>(runs: usize, mut run: impl FnMut() -> R) -> (f64, R) {
    let mut once = || {
        let start = Instant::now();
        let result = black_box(run());
        (1e3 * start.elapsed().as_secs_f64(), result)
    };
    (1..runs).fold(once(), |best, _| {
        let next = once();
        if next.0 < best.0 { next } else { best }
    })
}

fn ratios() {
    let mut memory = vec![0; COUNT_WORDS];
    for case in counts() {
        let owned = Owned::of(&case);
        let (fast, counted) = least_ms(20, || owned.search().count(None, &mut memory, &mut Budget::unlimited()).1);
        let (slow, naive) = least_ms(1, || nested_loops(&owned.problem()));
        assert_eq!((counted, u128::from(naive)), (case.count, case.count));
        let ratio = slow / fast;
        println!("{counted} tables: search {fast:.3} ms, nested loops {slow:.1} ms, ratio {ratio:.0}");
    }
}

fn main() {
    best_interval();
    // Under `cargo test`, which gives no such argument, the benches only have to run.
    if std::env::args().any(|arg| arg == "--bench") {
        ratios();
    }
}
