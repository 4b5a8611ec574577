//! Cost of a problem in nodes: larger neighbourhoods, and the same problem in finer ticks.

use crate::alike::{Alike, Layout, assert_serves, conflicts, paper_12};

/// A budget that suffices for all questions here, and ends a broken search too.
const BUDGET: u64 = 1_000_000;

// The half ring of twelve runs at 65 ms and also in microseconds.
#[test]
fn half_ring_of_twelve_runs_at_65_ms() {
    let rows = conflicts(Layout::Line, 12, 4);
    for scale in [1, 1000] {
        let problem = paper_12(&rows, scale);
        let found = problem.shortest(BUDGET);
        assert_eq!((found.period, found.bound), (65 * scale, 65 * scale));
        assert_serves(&problem, found.period, &found.fire);
    }
}

// A tick of a microsecond needs only a few more nodes than one of a millisecond.
#[test]
fn microsecond_ticks_need_few_more_nodes() {
    let rows = conflicts(Layout::Ring, 8, 4);
    for scale in [1, 100, 1000] {
        let problem = Alike { window: 30 * scale, ..paper_12(&rows, scale) };
        let found = problem.shortest(20_000);
        assert_eq!((found.period, found.bound), (65 * scale, 65 * scale));
        assert_serves(&problem, found.period, &found.fire);
    }
}

// Ticks of a tenth of a millisecond cost at most six times the nodes.
#[test]
fn tenth_ticks_cost_at_most_six_times_the_nodes() {
    let (mut coarse, mut fine) = (0, 0);
    for layout in [Layout::Line, Layout::Ring] {
        for sensors in [8, 12, 16, 24] {
            let rows = conflicts(layout, sensors, 4);
            for window in [15, 30, 45, 60] {
                let nodes = |scale| {
                    let problem = Alike { window: window * scale, ..paper_12(&rows, scale) };
                    let found = problem.shortest(BUDGET);
                    assert_eq!(found.bound, found.period);
                    assert_serves(&problem, found.period, &found.fire);
                    found.nodes
                };
                coarse += nodes(1);
                fine += nodes(10);
            }
        }
    }
    assert!(fine <= 6 * coarse, "{coarse} and {fine}");
}

#[test]
fn larger_neighbourhoods_are_proven_within_few_nodes() {
    for (sensors, neighbours, layout, separation, window, period) in [
        (8, 6, Layout::Line, 2, 15, 91),
        (12, 6, Layout::Line, 2, 15, 93),
        (12, 6, Layout::Ring, 2, 15, 96),
        (15, 5, Layout::Ring, 1, 30, 79),
        (10, 5, Layout::Blocks, 1, 15, 76),
    ] {
        let rows = conflicts(layout, sensors, neighbours);
        let problem = Alike { conflicts: &rows, separation, interval: 15, window, stale_echo: false };
        let found = problem.shortest(40_000);
        assert_eq!((found.period, found.bound), (period, period), "{problem:?}");
        assert_serves(&problem, found.period, &found.fire);
    }
}
