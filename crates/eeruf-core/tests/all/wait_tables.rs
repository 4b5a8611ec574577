//! The shared counts and optima of small wait-time problems, and the facts about the paper's own pairs
//! (`docs/explanation/theory.md`, section 7.3). Plain nested loops and a slow, obvious checker judge what the searches
//! return.

use crate::common::Owned;
use crate::common::naive::{self, Layout};
use crate::common::tables::File;
use eeruf_core::Criterion;
use eeruf_core::search::Outcome;
use eeruf_core::search::wait::{Budget, COUNT_WORDS, MEMORY_WORDS, Objective, Problem, memory_words};

#[test]
fn every_count_of_the_shared_tables_comes_out() {
    let mut memory = vec![0; COUNT_WORDS];
    for case in File::read().cases {
        let owned = Owned::of(&case);
        let count = owned.search().count(None, &mut memory, &mut Budget::unlimited());
        assert_eq!((count.outcome, count.count), (Outcome::Exhausted, case.count), "{case:?}");
    }
}

#[test]
fn plain_nested_loops_agree_on_what_the_shared_tables_mean() {
    for case in File::read().cases.iter().filter(|case| case.count < 5_000) {
        let owned = Owned::of(case);
        assert_eq!(naive::count(&owned.problem()), case.count, "{case:?}");
    }
}

#[test]
fn the_walk_over_all_tables_visits_as_many_as_are_counted() {
    for case in File::read().cases.iter().filter(|case| case.count < 200_000) {
        let owned = Owned::of(case);
        let (mut a, mut b) = ([0; 64], [0; 64]);
        let mut all = owned.search().enumerate();
        let mut seen = 0;
        let mut budget = Budget::unlimited();
        while all.next_into(&mut budget, &mut a, &mut b).unwrap() == Outcome::Found(()) {
            assert!(naive::holds(&owned.problem(), &a, &b));
            seen += 1;
        }
        assert_eq!(seen, case.count, "{case:?}");
    }
}

#[test]
fn every_best_interval_of_the_shared_tables_comes_out_proven() {
    let mut memory = vec![0; MEMORY_WORDS];
    for case in File::read().cases {
        let owned = Owned::of(&case);
        let (mut a, mut b) = ([0; 64], [0; 64]);
        let best =
            owned.search().best(Objective::Interval, &mut memory, &mut Budget::unlimited(), &mut a, &mut b).unwrap();
        assert!(best.proven(), "{case:?}");
        let value = best.value.map_or(-1, i64::from);
        assert_eq!(value, case.best_interval, "{case:?} {best:?}");
        if value >= 0 {
            assert!(naive::holds(&Problem { interval: value as u32, ..owned.problem() }, &a, &b));
        }
    }
}

/// The best interval for the paper's lags, in ticks, after the checks that every result must pass.
fn best_interval(owned: &Owned) -> (u32, u64) {
    let sensors = owned.lag.len();
    let mut memory = vec![0; memory_words(sensors)];
    let (mut a, mut b) = (vec![0; sensors], vec![0; sensors]);
    let best = owned.search().best(Objective::Interval, &mut memory, &mut Budget::unlimited(), &mut a, &mut b).unwrap();
    let value = best.value.unwrap();
    assert_eq!((best.outcome, best.bound), (Outcome::Found(()), value));
    assert!(naive::holds(&Problem { interval: value, ..owned.problem() }, &a, &b));
    assert!(!naive::holds(&Problem { interval: value + 1, ..owned.problem() }, &a, &b));
    (value, best.nodes)
}

// Waits on a millisecond grid give nineteen milliseconds and finer grids half a millisecond more.
#[test]
fn millisecond_grid_gives_nineteen_milliseconds() {
    for criterion in [Criterion::Paper, Criterion::Exact] {
        for layout in [Layout::Line, Layout::Blocks] {
            for (per_ms, best) in [(1, 19), (2, 39), (10, 195)] {
                let found = best_interval(&Owned::paper(12, layout, 2, per_ms, criterion));
                println!("{criterion:?} {layout:?} {per_ms} {found:?}");
                assert_eq!(found.0, best, "{criterion:?} {layout:?} {per_ms}");
            }
        }
    }
}

#[test]
fn half_the_separation_gives_room_for_more_sensors() {
    for criterion in [Criterion::Paper, Criterion::Exact] {
        for (sensors, best) in [(8, 23), (12, 22), (16, 21), (24, 19)] {
            let found = best_interval(&Owned::paper(sensors, Layout::Line, 1, 1, criterion));
            println!("{criterion:?} {sensors} {found:?}");
            assert_eq!(found.0, best, "{criterion:?} {sensors}");
        }
    }
}

#[test]
fn the_rearrangements_of_table_i_come_out() {
    let facts = File::read().rearrangements_of_table_i;
    let pairs: Vec<(u32, u32)> = (0..12).map(|k| (24, 2 * k)).collect();
    for (layout, counts, best) in
        [(Layout::Line, facts.line, 19), (Layout::Ring, facts.ring, 17), (Layout::Blocks, facts.blocks, 19)]
    {
        let owned = Owned::paper(12, layout, 2, 1, Criterion::Paper);
        for (interval, count) in counts {
            let search = owned.search().with(2, interval);
            let found = search.assign(&pairs).unwrap().count(&mut Budget::unlimited());
            assert_eq!((found.outcome, found.count), (Outcome::Exhausted, count), "{layout:?} {interval}");
        }
        let (mut a, mut b) = ([0; 12], [0; 12]);
        let search = owned.search();
        let found = search.assign(&pairs).unwrap().best_interval(&mut Budget::unlimited(), &mut a, &mut b).unwrap();
        println!("{layout:?} {found:?}");
        assert_eq!((found.outcome, found.value, found.bound), (Outcome::Found(()), Some(best), best));
        if layout == Layout::Line {
            assert_eq!(b.to_vec(), facts.the_one_with_19_on_a_line.t_wait_b_ms);
        }
    }
}
