//! The wait search at its limits: budgets, watchers, limits of counts, little memory, one sensor and sixty-four, and
//! bad input.

use std::ops::ControlFlow;

use crate::common::naive::{self, Layout};
use eeruf_core::Criterion;
use eeruf_core::search::wait::{Best, Budget, COUNT_WORDS, MEMORY_WORDS, Objective, Problem, Search, memory_words};
use eeruf_core::search::{Outcome, ProblemError, Progress};

const LAG: [u32; 6] = [0, 12, 24, 36, 0, 12];

fn six(conflicts: &[u64]) -> Problem<'_> {
    Problem { period: 48, lag: &LAG, wait_max: 6, separation: 1, interval: 8, conflicts, criterion: Criterion::Paper }
}

#[test]
fn a_spent_budget_says_so_and_proves_nothing() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let (mut a, mut b) = ([0; 6], [0; 6]);
    let mut memory = [0; MEMORY_WORDS];
    let mut budget = Budget::nodes_at_most(3);
    assert_eq!(search.first(&mut memory, &mut budget, &mut a, &mut b), Ok(Outcome::BudgetSpent));
    assert_eq!(budget.nodes(), 3);
    assert!(budget.spent());

    let counted = search.count(None, &mut [], &mut Budget::nodes_at_most(100));
    assert_eq!((counted.outcome, counted.nodes), (Outcome::BudgetSpent, 100));
    assert!(counted.count < 21_227_232);

    let best = search.best(Objective::Interval, &mut memory, &mut Budget::nodes_at_most(20), &mut a, &mut b);
    let Best { outcome, value, bound, nodes } = best.unwrap();
    assert_eq!((outcome, nodes), (Outcome::BudgetSpent, 20));
    assert!(value.is_none_or(|value| value <= 11) && bound >= 11);
}

#[test]
fn a_walk_goes_on_after_its_budget_was_spent() {
    let conflicts = naive::conflicts(Layout::Line, 3, 3);
    let problem = Problem {
        period: 30,
        lag: &[0, 10, 20],
        wait_max: 6,
        separation: 2,
        interval: 5,
        conflicts: &conflicts,
        criterion: Criterion::Paper,
    };
    let mut all = Search::new(problem).unwrap().enumerate();
    let (mut a, mut b) = ([0; 3], [0; 3]);
    let (mut seen, mut pauses) = (0, 0);
    loop {
        match all.next_into(&mut Budget::nodes_at_most(7), &mut a, &mut b).unwrap() {
            Outcome::Found(()) => seen += 1,
            Outcome::BudgetSpent => pauses += 1,
            Outcome::Exhausted => break,
        }
    }
    assert_eq!(seen, 3912);
    assert!(pauses > 0);
    // And stays at its end.
    assert_eq!(all.next_into(&mut Budget::unlimited(), &mut a, &mut b), Ok(Outcome::Exhausted));
}

#[test]
fn a_watcher_sees_every_so_many_nodes_and_can_cancel() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let mut seen = Vec::new();
    let mut watch = |progress: &Progress| {
        seen.push(progress.nodes);
        if progress.nodes < 5000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let mut budget = Budget::unlimited().watched(1000, &mut watch);
    let counted = search.count(None, &mut [0; 1000], &mut budget);
    assert_eq!(counted.outcome, Outcome::BudgetSpent);
    assert_eq!(seen, [1000, 2000, 3000, 4000, 5000]);
}

#[test]
fn a_limit_ends_a_count_early() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let mut memory = vec![0; COUNT_WORDS];
    let counted = search.count(Some(1000), &mut memory, &mut Budget::unlimited());
    assert_eq!(counted.outcome, Outcome::Found(()));
    assert!((1000..21_227_232).contains(&counted.count));
    let whole = search.count(Some(21_227_233), &mut memory, &mut Budget::unlimited());
    assert_eq!((whole.outcome, whole.count), (Outcome::Exhausted, 21_227_232));
}

#[test]
fn a_count_is_exact_whatever_the_memory_and_whatever_it_held() {
    let conflicts = naive::conflicts(Layout::Line, 6, 4);
    let problem = Problem { wait_max: 5, ..six(&conflicts) };
    let search = Search::new(problem).unwrap();
    let counts: Vec<_> = [0, 1, 50, 1000, 100_000]
        .map(|words| search.count(None, &mut vec![u32::MAX; words], &mut Budget::unlimited()))
        .to_vec();
    assert!(counts.iter().all(|counted| counted.count == counts[0].count && counted.outcome == Outcome::Exhausted));
    assert!(counts[4].nodes < counts[0].nodes, "memory saves nodes");
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
        let counted = Search::new(problem).unwrap().count(None, &mut [0; 500], &mut Budget::unlimited());
        assert_eq!(counted.count, naive::count(&problem), "{wait_max}");
    }
    for wait_max in [62, 63, 64, 65] {
        // An interval that leaves few tables: the walk over them is the judge.
        let search = Search::new(two(wait_max, 96)).unwrap();
        let counted = search.count(None, &mut [0; 500], &mut Budget::unlimited());
        let (mut a, mut b, mut seen) = ([0; 2], [0; 2], 0);
        let mut all = search.enumerate();
        while all.next_into(&mut Budget::unlimited(), &mut a, &mut b) == Ok(Outcome::Found(())) {
            assert!(naive::holds(search.problem(), &a, &b));
            seen += 1;
        }
        assert!(seen > 0);
        assert_eq!(counted.count, seen, "{wait_max}");
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
    let (mut a, mut b) = ([0; 64], [0; 64]);
    let search = Search::new(problem).unwrap();
    let best = search.best(Objective::Interval, &mut [0; MEMORY_WORDS], &mut Budget::unlimited(), &mut a, &mut b);
    // n I + D (K - 1) <= T_p.
    assert_eq!(best.unwrap().value, Some((1000 - 2 * 63) / 4));
    assert!(naive::holds(&Problem { interval: 218, ..problem }, &a, &b));
}

#[test]
fn a_single_sensor_is_never_too_close_to_anything() {
    let problem = Problem {
        period: 10,
        lag: &[0],
        wait_max: 9,
        separation: u32::MAX,
        interval: u32::MAX,
        conflicts: &[0],
        criterion: Criterion::Paper,
    };
    let search = Search::new(problem).unwrap();
    let (mut a, mut b) = ([0], [0]);
    let mut memory = [0; memory_words(1)];
    assert_eq!(search.first(&mut memory, &mut Budget::unlimited(), &mut a, &mut b), Ok(Outcome::Found(())));
    assert_eq!(search.count(None, &mut memory, &mut Budget::unlimited()).count, 100);
    for objective in [Objective::Interval, Objective::Separation] {
        let best = search.best(objective, &mut memory, &mut Budget::unlimited(), &mut a, &mut b).unwrap();
        assert_eq!((best.outcome, best.value), (Outcome::Found(()), Some(u32::MAX)));
    }
    let mut front = search.pareto(&mut memory);
    assert_eq!(front.next_into(&mut Budget::unlimited(), &mut a, &mut b).unwrap().0, Outcome::Found(()));
    assert_eq!(front.next_into(&mut Budget::unlimited(), &mut a, &mut b), Ok((Outcome::Exhausted, None)));
}

#[test]
fn a_count_beyond_every_number_stops_at_the_greatest() {
    let problem = Problem {
        period: 64,
        lag: &[0; 64],
        wait_max: 63,
        separation: 0,
        interval: 0,
        conflicts: &[0; 64],
        criterion: Criterion::Exact,
    };
    let counted = Search::new(problem).unwrap().count(None, &mut [0; 5000], &mut Budget::unlimited());
    assert_eq!((counted.outcome, counted.count), (Outcome::Found(()), u128::MAX));
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
    let line = |problem: Problem<'_>| Search::new(problem).unwrap_err().to_string();
    assert_eq!(line(Problem { lag: &[], ..good }), "0 sensors; expected 1 to 64");
    assert_eq!(line(Problem { lag: &[0; 65], ..good }), "65 sensors; expected 1 to 64");
    assert_eq!(line(Problem { period: 0, ..good }), "a period of 0 ticks; expected 1 to 134217728");
    assert_eq!(
        line(Problem { wait_max: 20, ..good }),
        "sensor 2 has lag 10 and waits up to 20 ticks; expected a sum below the period of 30"
    );
    assert_eq!(
        line(Problem { conflicts: &[0], ..good }),
        "1 rows of conflicts for 2 sensors; expected one row for each sensor"
    );
    assert_eq!(
        line(Problem { conflicts: &[1, 0], ..good }),
        "sensor 1 conflicts with itself; expected conflicts with other sensors only"
    );
    assert_eq!(
        line(Problem { conflicts: &[2, 0], ..good }),
        "sensor 1 conflicts with sensor 2, but not the other way round; expected both or neither"
    );
    let search = Search::new(good).unwrap();
    let mut short = [0; 2];
    let error = search.first(&mut short, &mut Budget::unlimited(), &mut [0; 2], &mut [0; 2]).unwrap_err();
    assert_eq!(error.to_string(), "2 words of memory; expected at least 16");
    assert_eq!(error, ProblemError::Memory { words: 2, needed: 16 });
    assert_eq!(
        search.assign(&[(7, 0), (0, 0)]).unwrap_err().to_string(),
        "pair 1 has a wait of 7 ticks; expected at most 6"
    );
}

#[test]
fn values_of_foreign_waits_are_measured_without_overflow() {
    let conflicts = naive::conflicts(Layout::Line, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let huge = [u32::MAX; 6];
    assert_eq!(search.smallest_interval(&huge, &huge), 0);
    assert_eq!(search.separation_of(&huge, &huge), 0);
    assert_eq!(search.smallest_interval(&[], &[]), 0);
}
