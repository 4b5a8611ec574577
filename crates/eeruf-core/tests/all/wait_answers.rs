//! Answers of the search for waits beside its tables: how far apart a table keeps sensors, which pairs of waits differ
//! enough, that a question without an answer has no bound, and errors in a question.

use eeruf_core::search::wait::{Budget, MEMORY_WORDS, Objective, Problem, Search};
use eeruf_core::search::{Outcome, WaitProblem, WaitSearch};
use eeruf_core::{Criterion, Layout, Micros};

use super::common::Owned;
use super::common::naive;
use super::common::random::Random;

/// Three sensors that need not be apart in time.
fn three(criterion: Criterion, separation: u32) -> Owned {
    let (lag, conflicts) = (vec![0, 10, 20], vec![0; 3]);
    Owned { period: 40, lag, wait_max: 9, separation, interval: 0, conflicts, criterion }
}

// The separation of a table is the largest that nested loops find it to keep.
#[test]
fn table_separation_is_what_nested_loops_find() {
    let mut random = Random(7);
    for criterion in [Criterion::Exact, Criterion::Paper] {
        let owned = three(criterion, 0);
        let mut seen = [false; 5];
        for _ in 0..500 {
            let [a, b] = [(); 2].map(|()| [(); 3].map(|()| random.up_to(9)));
            let keeps =
                |separation: &u32| naive::holds(&Problem { separation: *separation, ..owned.problem() }, &a, &b);
            let most = (0..=9).rev().find(keeps).unwrap();
            assert_eq!(Search::new(owned.problem()).unwrap().separation_of(&a, &b), most, "{criterion:?} {a:?} {b:?}");
            seen[most as usize] = true;
        }
        assert!(seen[..3].iter().all(|&seen| seen), "{criterion:?} {seen:?}");
    }
    // One sensor is as far from the others as a wait can be.
    let alone = Owned { lag: vec![0], conflicts: vec![0], ..three(Criterion::Exact, 0) };
    assert_eq!(Search::new(alone.problem()).unwrap().separation_of(&[3], &[5]), 9);
}

// Pairs whose sums are alike differ by the exact criterion alone.
#[test]
fn pairs_of_equal_sums_differ_by_exact_criterion_alone() {
    // |d| is 0, 2 and 4; s is 8 each.
    let pairs = [(4, 4), (5, 3), (6, 2)];
    let count = |criterion, separation| {
        let owned = three(criterion, separation);
        let found = owned.search().assign(&pairs).unwrap().count(&mut Budget::unlimited());
        assert_eq!(found.outcome, Outcome::Exhausted);
        found.count
    };
    assert_eq!([count(Criterion::Exact, 2), count(Criterion::Exact, 3)], [6, 0]);
    assert_eq!([count(Criterion::Paper, 2), count(Criterion::Paper, 0)], [0, 6]);
    // |d| as before, s is 8, 6 and 4.
    let owned = three(Criterion::Paper, 2);
    let apart = [(4, 4), (4, 2), (4, 0)];
    assert_eq!(owned.search().assign(&apart).unwrap().count(&mut Budget::unlimited()).count, 6);
}

#[test]
fn room_for_too_few_sensors_is_refused_by_name() {
    let owned = three(Criterion::Exact, 2);
    let pairs = [(4, 4), (5, 3), (6, 2)];
    let assignment = owned.search().assign(&pairs).unwrap();
    let mut budget = Budget::unlimited();
    let (mut short, mut long) = ([0; 2], [0; 3]);
    let texts = [
        owned.search().assign(&pairs[..2]).unwrap_err().to_string(),
        assignment.first(&mut budget, &mut short, &mut long).unwrap_err().to_string(),
        assignment.first(&mut budget, &mut long, &mut short).unwrap_err().to_string(),
        assignment.best_interval(&mut budget, &mut short, &mut long).unwrap_err().to_string(),
    ];
    for (text, what) in texts.iter().zip(["pairs", "a", "b", "a"]) {
        assert!(text.contains(what) && text.contains('2') && text.contains('3'), "{what}: {text}");
    }
    assert_eq!(assignment.first(&mut budget, &mut long, &mut [0; 3]).unwrap(), Outcome::Found(()));
}

fn in_microseconds<'a>(period: Micros, t_lag: Option<&'a [Micros]>) -> WaitProblem<'a> {
    WaitProblem {
        sensors: 3,
        period,
        wait_max: Micros::from_millis(2),
        tick: Micros::from_millis(1),
        t_lag,
        t_delta: Micros::new(999),
        min_interval: Micros::ZERO,
        neighbours: 2,
        layout: Layout::Line(2),
        criterion: Criterion::Exact,
    }
}

// The best of nothing has no bound and a search that was ended has one.
#[test]
fn best_of_nothing_has_no_bound() {
    let mut memory = vec![0; MEMORY_WORDS];
    // |d| is at most 2 ms, and three sensors that are 2 ms apart need 0, 2 and 4.
    let problem = in_microseconds(Micros::from_millis(60), None);
    let search = WaitSearch::new(&problem).unwrap();
    let none = search.best::<3>(Objective::Interval, &mut memory, &mut Budget::unlimited()).unwrap();
    assert_eq!((none.schedule.is_none(), none.value, none.bound, none.proven), (true, None, None, true));
    let enough = WaitProblem { wait_max: Micros::from_millis(24), ..problem };
    let search = WaitSearch::new(&enough).unwrap();
    let ended = search.best::<3>(Objective::Interval, &mut memory, &mut Budget::nodes_at_most(1)).unwrap();
    assert!(ended.schedule.is_none() && ended.bound.is_some() && !ended.proven, "{ended:?}");
}

#[test]
fn a_time_that_is_no_whole_number_of_ticks_is_named() {
    let error = |problem: WaitProblem<'_>| WaitSearch::new(&problem).unwrap_err().to_string();
    let odd = error(in_microseconds(Micros::new(60_500), None));
    assert!(odd.contains("a lag of 30.25 ms; expected a whole number of ticks of 1 ms"), "{odd}");
    let none = error(WaitProblem { tick: Micros::ZERO, ..in_microseconds(Micros::from_millis(60), None) });
    assert!(none.contains("a tick of 0 us; expected 1 us or more"), "{none}");
}
