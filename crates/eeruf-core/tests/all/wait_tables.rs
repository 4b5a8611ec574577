//! The shared counts and optima of small wait-time problems, and the facts about the paper's own pairs
//! (`docs/explanation/theory.md`, section 5.2). Plain nested loops and a slow, obvious checker judge the results.

use crate::common::naive::{self, Layout, Problem};
use crate::common::tables::File;
use crate::common::{Owned, holds, ticks, us};
use eeruf_core::search::{Budget, COUNT_WORDS, Found, MEMORY_WORDS, Outcome, memory_words};
use eeruf_core::{Criterion, Schedule};

#[test]
fn every_count_of_the_shared_tables_comes_out() {
    let mut memory = vec![0; COUNT_WORDS];
    for case in File::read().cases {
        let owned = Owned::of(&case);
        let count = owned.search().count(None, &mut memory, &mut Budget::unlimited());
        assert_eq!(count, (Outcome::Exhausted, case.count), "{case:?}");
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
        let search = owned.search();
        let (mut seen, mut before) = (0, None::<Schedule<64>>);
        let mut budget = Budget::unlimited();
        while let Outcome::Found(table) = search.next_table(before.as_ref(), &mut budget).unwrap() {
            assert!(holds(&owned.problem(), &table));
            seen += 1;
            before = Some(table);
        }
        assert_eq!(seen, case.count, "{case:?}");
    }
}

#[test]
fn every_best_interval_of_the_shared_tables_comes_out_proven() {
    let mut memory = vec![0; MEMORY_WORDS];
    for case in File::read().cases {
        let owned = Owned::of(&case);
        let best: Found<64> = owned.search().best_interval(&mut memory, &mut Budget::unlimited()).unwrap();
        assert!(best.proven, "{case:?}");
        let value = u32::try_from(case.best_interval).ok();
        assert_eq!(best.value, value.map(us), "{case:?} {best:?}");
        if let (Some(interval), Some(table)) = (value, &best.schedule) {
            assert!(holds(&Problem { interval, ..owned.problem() }, table));
        }
    }
}

/// The best interval for the paper's lags, in ticks, after every result passed the checks.
fn best_interval(owned: &Owned) -> (u32, u64) {
    let sensors = owned.lag.len();
    let mut memory = vec![0; memory_words(sensors)];
    let best: Found<64> = owned.search().best_interval(&mut memory, &mut Budget::unlimited()).unwrap();
    let (interval, table) = (ticks(best.value.unwrap()), best.schedule.unwrap());
    assert_eq!((best.proven, best.bound), (true, best.value));
    assert!(holds(&Problem { interval, ..owned.problem() }, &table));
    assert!(!holds(&Problem { interval: interval + 1, ..owned.problem() }, &table));
    (interval, best.nodes)
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

/// Visits all assignments of the paper's pairs of waits (24 ms in phase a; 0, 2, .. 22 ms in phase b) to sensors by
/// backtracking; `b` holds the waits of the sensors so far.
fn rearrange(problem: &Problem<'_>, b: &mut Vec<u32>, see: &mut dyn FnMut(&[u32])) {
    if b.len() == problem.lag.len() {
        return see(b);
    }
    for wait in (0..problem.lag.len() as u32).map(|k| 2 * k) {
        let (k, twice) = (b.len(), b.contains(&wait));
        b.push(wait);
        if !twice && (0..k).all(|y| naive::pair_holds(problem, k, y, &[24; 12], b)) {
            rearrange(problem, b, see);
        }
        b.pop();
    }
}

#[test]
fn the_rearrangements_of_table_i_come_out() {
    let facts = File::read().rearrangements_of_table_i;
    for (layout, counts, best) in
        [(Layout::Line, facts.line, 19), (Layout::Ring, facts.ring, 17), (Layout::Blocks, facts.blocks, 19)]
    {
        for (interval, expected) in counts.into_iter().chain([(best + 1, 0)]) {
            let owned = Owned { interval, ..Owned::paper(12, layout, 2, 1, Criterion::Paper) };
            let (mut count, mut last) = (0, Vec::new());
            rearrange(&owned.problem(), &mut Vec::new(), &mut |b| (count, last) = (count + 1, b.to_vec()));
            assert_eq!(count, expected, "{layout:?} {interval}");
            if layout == Layout::Line && interval == 19 {
                assert_eq!(last, facts.the_one_with_19_on_a_line.t_wait_b_ms);
            }
        }
    }
}
