//! The search of the shortest period on several threads comes to the answer of one.

use std::ops::ControlFlow;

use eeruf_core::search::Progress;
use eeruf_core::search::design::{Explanation, Problem, memory_words, shortest};

use crate::common::naive::{self, Layout};
use crate::common::naive_period::{assert_serves, paper_12};

#[cfg(feature = "std")]
#[test]
fn one_two_and_three_threads_come_to_the_answer_of_none() {
    use eeruf_core::search::design::shortest_on_threads;
    for (sensors, layout, window, scale) in
        [(8, Layout::Ring, 30, 1), (12, Layout::Line, 45, 1), (12, Layout::Ring, 45, 10), (16, Layout::Line, 60, 1)]
    {
        let rows = naive::conflicts(layout, sensors, 4);
        let problem = Problem { sensors, window: window * scale, ..paper_12(&rows, scale) };
        for budget in [0, 100, 1000, 7777, u64::MAX] {
            let mut memory = vec![0; memory_words(sensors)];
            let alone = shortest(&problem, budget, &mut memory, &mut ()).unwrap();
            for threads in 1..=3 {
                assert_eq!(shortest_on_threads(&problem, budget, threads, &mut ()), Ok(alone), "{threads} threads");
            }
        }
    }
}

#[cfg(feature = "std")]
#[test]
fn threads_stop_when_the_control_says_so() {
    use eeruf_core::search::design::shortest_on_threads;
    let rows = naive::conflicts(Layout::Ring, 24, 5);
    let problem = Problem { sensors: 24, ..paper_12(&rows, 1) };
    let mut polls = 0;
    let mut control = |progress: &Progress| {
        assert!(progress.bound <= progress.best || progress.best.is_none());
        polls += 1;
        if polls < 5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let found = shortest_on_threads(&problem, u64::MAX, 2, &mut control).unwrap();
    assert_eq!(polls, 5);
    assert!(matches!(found.explanation, Explanation::BudgetSpent { bound } if bound == found.bound));
    assert_serves(&problem, found.period, &found.firing);
}
