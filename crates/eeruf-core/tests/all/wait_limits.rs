//! The wait search at its limits: budgets, watchers, limits of counts, little memory, one sensor and sixty-four, and
//! bad input.

use std::ops::ControlFlow;

use crate::common::naive::{self, Layout, Problem};
use crate::common::{holds, search, us, waits};
use eeruf_core::search::{
    Budget, COUNT_WORDS, Found, FrontTable, MEMORY_WORDS, Outcome, Progress, SearchError, WaitProblem, WaitSearch,
    memory_words,
};
use eeruf_core::{Criterion, Micros, Schedule};

const LAG: [u32; 6] = [0, 12, 24, 36, 0, 12];

fn six(conflicts: &[u64]) -> Problem<'_> {
    Problem { period: 48, lag: &LAG, wait_max: 6, separation: 1, interval: 8, conflicts, criterion: Criterion::Paper }
}

#[test]
fn a_spent_budget_says_so_and_proves_nothing() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = search(&six(&conflicts)).unwrap();
    let mut memory = [0; MEMORY_WORDS];
    let mut budget = Budget::nodes_at_most(3);
    assert_eq!(search.first::<6>(&mut memory, &mut budget), Ok(Outcome::BudgetSpent));
    assert_eq!(budget.nodes(), 3);
    assert!(budget.spent());

    let mut budget = Budget::nodes_at_most(100);
    let (outcome, count) = search.count(None, &mut [], &mut budget);
    assert_eq!((outcome, budget.nodes()), (Outcome::BudgetSpent, 100));
    assert!(count < 21_227_232);

    let best = search.best_interval::<6>(&mut memory, &mut Budget::nodes_at_most(20));
    let Found { value, bound, proven, nodes, .. } = best.unwrap();
    assert_eq!((proven, nodes), (false, 20));
    assert!(value.is_none_or(|value| value <= us(11)) && bound >= Some(us(11)));
}

/// Three sensors that all conflict.
const THREE: Problem<'static> = Problem {
    period: 30,
    lag: &[0, 10, 20],
    wait_max: 6,
    separation: 2,
    interval: 5,
    conflicts: &[0b110, 0b101, 0b011],
    criterion: Criterion::Paper,
};

#[test]
fn a_walk_goes_on_after_its_budget_was_spent() {
    let search = search(&THREE).unwrap();
    let (mut seen, mut pauses, mut before, mut nodes) = (0, 0, None::<Schedule<3>>, 1);
    loop {
        match search.next_table(before.as_ref(), &mut Budget::nodes_at_most(nodes)).unwrap() {
            Outcome::Found(table) => (seen, before, nodes) = (seen + 1, Some(table), 1),
            Outcome::BudgetSpent => (pauses, nodes) = (pauses + 1, 2 * nodes),
            Outcome::Exhausted => break,
        }
    }
    assert_eq!(seen, 3912);
    assert!(pauses > 0);
    // It then stays at its end.
    assert_eq!(search.next_table(before.as_ref(), &mut Budget::unlimited()), Ok(Outcome::Exhausted));
}

// After waits that are not a table of the problem comes the first greater table.
#[test]
fn walk_goes_on_from_what_is_no_table() {
    let wide = search(&Problem { separation: 1, interval: 1, wait_max: 8, ..THREE }).unwrap();
    let search = search(&THREE).unwrap();
    let in_order = |table: &Schedule<3>| {
        let [a, b] = waits(table);
        [a[0], b[0], a[1], b[1], a[2], b[2]]
    };
    let next = |search: &WaitSearch, after: Option<&Schedule<3>>| {
        let next = search.next_table(after, &mut Budget::unlimited()).unwrap();
        if let Outcome::Found(table) = next { Some(table) } else { None }
    };
    let (mut foreign, mut expected, mut skipped) = (next(&wide, None), next(&search, None), 0);
    while let Some(table) = foreign {
        while expected.is_some_and(|expected| in_order(&expected) <= in_order(&table)) {
            expected = next(&search, expected.as_ref());
        }
        assert_eq!(next(&search, Some(&table)), expected, "after {table:?}");
        skipped += u32::from(!holds(&THREE, &table));
        foreign = next(&wide, Some(&table));
    }
    assert!(skipped > 1000, "{skipped}");
}

#[test]
fn a_watcher_sees_every_so_many_nodes_and_can_cancel() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = search(&six(&conflicts)).unwrap();
    let mut seen = Vec::new();
    let mut watch = |progress: &Progress| {
        seen.push(progress.nodes);
        if progress.nodes < 5000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let mut budget = Budget::unlimited().watched(1000, &mut watch);
    let counted = search.count(None, &mut [0; 1000], &mut budget);
    assert_eq!(counted.0, Outcome::BudgetSpent);
    assert_eq!(seen, [1000, 2000, 3000, 4000, 5000]);
}

#[test]
fn a_limit_ends_a_count_early() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = search(&six(&conflicts)).unwrap();
    let mut memory = vec![0; COUNT_WORDS];
    let (outcome, count) = search.count(Some(1000), &mut memory, &mut Budget::unlimited());
    assert_eq!(outcome, Outcome::Found(()));
    assert!((1000..21_227_232).contains(&count));
    let whole = search.count(Some(21_227_233), &mut memory, &mut Budget::unlimited());
    assert_eq!(whole, (Outcome::Exhausted, 21_227_232));
}

#[test]
fn a_count_is_exact_whatever_the_memory_and_whatever_it_held() {
    let conflicts = naive::conflicts(Layout::Line, 6, 4);
    let problem = Problem { wait_max: 5, ..six(&conflicts) };
    let search = search(&problem).unwrap();
    let counts: Vec<_> = [0, 1, 50, 1000, 100_000]
        .map(|words| {
            let mut budget = Budget::unlimited();
            (search.count(None, &mut vec![u32::MAX; words], &mut budget), budget.nodes())
        })
        .to_vec();
    assert!(counts.iter().all(|&(counted, _)| counted == counts[0].0 && counted.0 == Outcome::Exhausted));
    assert!(counts[4].1 < counts[0].1, "memory saves nodes");
}

/// Two sensors whose waits range to `wait_max`.
fn two(wait_max: u32, interval: u32) -> Problem<'static> {
    Problem {
        period: 200,
        lag: &[0, 60],
        wait_max,
        separation: 3,
        interval,
        conflicts: &[2, 1],
        criterion: Criterion::Paper,
    }
}

#[test]
fn waits_beyond_the_words_of_the_count_are_counted_all_the_same() {
    // 16 ticks leave the sets of pairs, 32 the half words, 64 the words.
    for wait_max in [14, 15, 16, 31, 32] {
        let problem = two(wait_max, 55);
        let counted = search(&problem).unwrap().count(None, &mut [0; 500], &mut Budget::unlimited());
        assert_eq!(counted.1, naive::count(&problem), "{wait_max}");
    }
    for wait_max in [62, 63, 64, 65] {
        // An interval that leaves few tables: the walk over them is the judge.
        let problem = two(wait_max, 96);
        let search = search(&problem).unwrap();
        let counted = search.count(None, &mut [0; 500], &mut Budget::unlimited());
        let (mut seen, mut before) = (0, None::<Schedule<2>>);
        while let Ok(Outcome::Found(table)) = search.next_table(before.as_ref(), &mut Budget::unlimited()) {
            assert!(holds(&problem, &table));
            seen += 1;
            before = Some(table);
        }
        assert!(seen > 0);
        assert_eq!(counted.1, seen, "{wait_max}");
    }
}

#[test]
fn sixty_four_sensors_have_a_best_interval() {
    let lag: Vec<u32> = (0..64).map(|i| i % 4 * 250).collect();
    let conflicts = naive::conflicts(Layout::Line, 64, 4);
    let problem = Problem {
        period: 1000,
        lag: &lag,
        wait_max: 240,
        separation: 2,
        interval: 0,
        conflicts: &conflicts,
        criterion: Criterion::Exact,
    };
    let search = search(&problem).unwrap();
    let best = search.best_interval::<64>(&mut [0; MEMORY_WORDS], &mut Budget::unlimited()).unwrap();
    // n I + D (K - 1) <= T_p.
    assert_eq!(best.value, Some(us((1000 - 2 * 63) / 4)));
    assert!(holds(&Problem { interval: 218, ..problem }, &best.schedule.unwrap()));
}

#[test]
fn bad_input_gets_one_clear_line() {
    let good = Problem {
        period: 30,
        lag: &[0, 10],
        wait_max: 6,
        separation: 2,
        interval: 5,
        conflicts: &[2, 1],
        criterion: Criterion::Paper,
    };
    let line = |problem: Problem<'_>| search(&problem).unwrap_err().to_string();
    assert_eq!(line(Problem { lag: &[], ..good }), "0 sensors; expected 1 to 64");
    assert_eq!(line(Problem { lag: &[0; 65], ..good }), "65 sensors; expected 1 to 64");
    assert_eq!(line(Problem { period: 0, ..good }), "a period of 0 ticks; expected 1 to 134217728");
    let late = search(&Problem { wait_max: 20, ..good }).unwrap_err();
    let texts = [late.to_string(), format!("{late:#}")];
    for (text, sensor) in texts.iter().zip([2, 1]) {
        let expected = "has lag 10 and waits up to 20 ticks; expected a sum below the period of 30";
        assert_eq!(*text, format!("sensor {sensor} {expected}"));
    }
    assert_eq!(
        line(Problem { conflicts: &[4, 0], ..good }),
        "sensors 1 and 3 as neighbours; expected two different ones of 2"
    );
    let lags = WaitProblem {
        sensors: 3,
        period: us(30),
        wait_max: us(6),
        tick: us(1),
        t_lag: Some(&[Micros::ZERO; 2]),
        t_delta: us(1),
        min_interval: us(5),
        neighbours: 1,
        layout: eeruf_core::Layout::Line(2),
        criterion: Criterion::Paper,
    };
    let error = WaitSearch::new(&lags).unwrap_err();
    assert_eq!(error.to_string(), "2 lags; expected one for each of 3 sensors");
    let search = search(&good).unwrap();
    let error = search.first::<2>(&mut [0; 2], &mut Budget::unlimited()).unwrap_err();
    assert_eq!(error.to_string(), "2 words of memory; expected at least 16");
    assert_eq!(error, SearchError::Memory { words: 2, needed: 16 });
    let narrow: Result<Outcome<Schedule<1>>, _> = search.first(&mut [0; 16], &mut Budget::unlimited());
    assert!(matches!(narrow, Err(SearchError::Schedule(_))), "{narrow:?}");
}

// A single sensor has no distance to another: one table is its whole front.
#[test]
fn front_of_single_sensor_is_one_table() {
    let alone = Problem {
        period: 10,
        lag: &[0],
        wait_max: 9,
        separation: 2,
        interval: 3,
        conflicts: &[0],
        criterion: Criterion::Paper,
    };
    let search = search(&alone).unwrap();
    let next = |after: Option<&FrontTable<1>>| {
        search.next_on_front(after, &mut [0; memory_words(1)], &mut Budget::unlimited()).unwrap()
    };
    let Outcome::Found(only) = next(None) else { panic!("no table") };
    assert!(holds(&alone, &only.schedule));
    assert_eq!(next(Some(&only)), Outcome::Exhausted);
}
