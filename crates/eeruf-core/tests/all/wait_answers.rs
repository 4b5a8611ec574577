//! Answers of the search for waits that are not tables: no bound without an answer, and errors in a question.

use eeruf_core::search::{Budget, MEMORY_WORDS, WaitProblem, WaitSearch};
use eeruf_core::{Criterion, Layout, Micros};

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

// Without any table there is no bound; a search that was stopped has one.
#[test]
fn best_of_nothing_has_no_bound() {
    let mut memory = vec![0; MEMORY_WORDS];
    // |d| is at most 2 ms, and three sensors that are 2 ms apart need 0, 2 and 4.
    let problem = in_microseconds(Micros::from_millis(60), None);
    let search = WaitSearch::new(&problem).unwrap();
    let none = search.best_interval::<3>(&mut memory, &mut Budget::unlimited()).unwrap();
    assert_eq!((none.schedule.is_none(), none.value, none.bound, none.proven), (true, None, None, true));
    let enough = WaitProblem { wait_max: Micros::from_millis(24), ..problem };
    let search = WaitSearch::new(&enough).unwrap();
    let ended = search.best_interval::<3>(&mut memory, &mut Budget::nodes_at_most(1)).unwrap();
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
