//! The wait search at its limits: budgets, watchers, limits of counts, little memory, one sensor and sixty-four, and bad input.

mod common;

use common::naive::{self, Layout};
use eeruf_core::Criterion;
use eeruf_core::search::wait::{
    Best, COUNT_WORDS, Control, Finish, MEMORY_WORDS, Objective, Problem, ProblemError, Progress, Search, memory_words,
};

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
    let mut control = Control::nodes_at_most(3);
    assert_eq!(search.first(&mut memory, &mut control, &mut a, &mut b), Ok(Finish::BudgetSpent));
    assert_eq!(control.nodes(), 3);
    assert!(control.spent());

    let counted = search.count(None, &mut [], &mut Control::nodes_at_most(100));
    assert_eq!((counted.finish, counted.nodes), (Finish::BudgetSpent, 100));
    assert!(counted.count < 21_227_232);

    let best = search.best(Objective::Interval, &mut memory, &mut Control::nodes_at_most(20), &mut a, &mut b);
    let Best { finish, value, bound, nodes } = best.unwrap();
    assert_eq!((finish, nodes), (Finish::BudgetSpent, 20));
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
    let mut all = Search::new(problem).unwrap().all();
    let (mut a, mut b) = ([0; 3], [0; 3]);
    let (mut seen, mut pauses) = (0, 0);
    loop {
        match all.next_into(&mut Control::nodes_at_most(7), &mut a, &mut b).unwrap() {
            Finish::Found => seen += 1,
            Finish::BudgetSpent => pauses += 1,
            Finish::Exhausted => break,
        }
    }
    assert_eq!(seen, 3912);
    assert!(pauses > 0);
    // And stays at its end.
    assert_eq!(all.next_into(&mut Control::unlimited(), &mut a, &mut b), Ok(Finish::Exhausted));
}

#[test]
fn a_watcher_sees_every_so_many_nodes_and_can_cancel() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let mut seen = Vec::new();
    let mut watch = |progress: Progress| {
        seen.push(progress.nodes);
        progress.nodes < 5000
    };
    let mut control = Control::unlimited().watched(1000, &mut watch);
    let counted = search.count(None, &mut [0; 1000], &mut control);
    assert_eq!(counted.finish, Finish::BudgetSpent);
    assert_eq!(seen, [1000, 2000, 3000, 4000, 5000]);
}

#[test]
fn a_limit_ends_a_count_early() {
    let conflicts = naive::conflicts(Layout::Blocks, 6, 4);
    let search = Search::new(six(&conflicts)).unwrap();
    let mut memory = vec![0; COUNT_WORDS];
    let counted = search.count(Some(1000), &mut memory, &mut Control::unlimited());
    assert_eq!(counted.finish, Finish::Found);
    assert!((1000..21_227_232).contains(&counted.count));
    let whole = search.count(Some(21_227_233), &mut memory, &mut Control::unlimited());
    assert_eq!((whole.finish, whole.count), (Finish::Exhausted, 21_227_232));
}

#[test]
fn a_count_is_exact_whatever_the_memory_and_whatever_it_held() {
    let conflicts = naive::conflicts(Layout::Line, 6, 4);
    let problem = Problem { wait_max: 5, ..six(&conflicts) };
    let search = Search::new(problem).unwrap();
    let counts: Vec<_> = [0, 1, 50, 1000, 100_000]
        .map(|words| search.count(None, &mut vec![u32::MAX; words], &mut Control::unlimited()))
        .to_vec();
    assert!(counts.iter().all(|counted| counted.count == counts[0].count && counted.finish == Finish::Exhausted));
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
        let counted = Search::new(problem).unwrap().count(None, &mut [0; 500], &mut Control::unlimited());
        assert_eq!(counted.count, naive::count(&problem), "{wait_max}");
    }
    for wait_max in [62, 63, 64, 65] {
        // An interval that leaves few tables: the walk over them is the judge.
        let search = Search::new(two(wait_max, 96)).unwrap();
        let counted = search.count(None, &mut [0; 500], &mut Control::unlimited());
        let (mut a, mut b, mut seen) = ([0; 2], [0; 2], 0);
        let mut all = search.all();
        while all.next_into(&mut Control::unlimited(), &mut a, &mut b) == Ok(Finish::Found) {
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
    let best = search.best(Objective::Interval, &mut [0; MEMORY_WORDS], &mut Control::unlimited(), &mut a, &mut b);
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
    assert_eq!(search.first(&mut memory, &mut Control::unlimited(), &mut a, &mut b), Ok(Finish::Found));
    assert_eq!(search.count(None, &mut memory, &mut Control::unlimited()).count, 100);
    for objective in [Objective::Interval, Objective::Separation] {
        let best = search.best(objective, &mut memory, &mut Control::unlimited(), &mut a, &mut b).unwrap();
        assert_eq!((best.finish, best.value), (Finish::Found, Some(u32::MAX)));
    }
    let mut front = search.pareto(&mut memory);
    assert_eq!(front.next_into(&mut Control::unlimited(), &mut a, &mut b).unwrap().0, Finish::Found);
    assert_eq!(front.next_into(&mut Control::unlimited(), &mut a, &mut b), Ok((Finish::Exhausted, None)));
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
    let counted = Search::new(problem).unwrap().count(None, &mut [0; 5000], &mut Control::unlimited());
    assert_eq!((counted.finish, counted.count), (Finish::Found, u128::MAX));
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
    assert_eq!(line(Problem { lag: &[], ..good }), "0 sensors; between 1 and 64 are expected");
    assert_eq!(line(Problem { lag: &[0; 65], ..good }), "65 sensors; between 1 and 64 are expected");
    assert_eq!(line(Problem { period: 0, ..good }), "period of 0 ticks; between 1 and 134217728 are expected");
    assert_eq!(
        line(Problem { wait_max: 20, ..good }),
        "sensor 2 has lag 10 and waits up to 20 ticks; their sum must be below the period of 30"
    );
    assert_eq!(line(Problem { conflicts: &[0], ..good }), "1 rows of conflicts; one for each of 2 sensors is expected");
    assert_eq!(line(Problem { conflicts: &[1, 0], ..good }), "sensor 1 conflicts with itself");
    assert_eq!(
        line(Problem { conflicts: &[2, 0], ..good }),
        "sensor 1 conflicts with sensor 2, which does not exist or does not conflict with it"
    );
    let search = Search::new(good).unwrap();
    let mut short = [0; 2];
    let error = search.first(&mut short, &mut Control::unlimited(), &mut [0; 2], &mut [0; 2]).unwrap_err();
    assert_eq!(error.to_string(), "memory has length 2; at least 16 is needed");
    assert_eq!(error, ProblemError::Short { what: "memory", given: 2, needed: 16 });
    assert_eq!(
        search.rearrange(&[(7, 0), (0, 0)]).unwrap_err().to_string(),
        "pair 1 has a wait of 7 ticks; at most 6 is allowed"
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
