//! The search of the shortest period at its limits: budgets, a control that stops it, memory, one sensor and
//! sixty-four, bad input.

use std::ops::ControlFlow;

use eeruf_core::search::design::{
    Explanation, MAX_TICKS, Problem, decide, maximize_separation, memory_words, shortest,
};
use eeruf_core::search::{ProblemError, Progress};

use crate::common::naive::{self, Layout};
use crate::common::naive_period::{assert_serves, paper_12};

#[test]
fn twelve_sensors_need_at_most_64_kib() {
    assert!(4 * memory_words(12) + 8 * 1024 <= 64 * 1024, "{} words", memory_words(12));
}

#[test]
fn the_same_question_gets_the_same_answer() {
    let rows = naive::conflicts(Layout::Ring, 12, 4);
    let problem = paper_12(&rows, 1);
    let answers: Vec<_> = [0, 7]
        .iter()
        .map(|&fill| shortest(&problem, u64::MAX, &mut vec![fill; memory_words(12) + fill as usize], &mut ()).unwrap())
        .collect();
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn a_small_budget_leaves_a_schedule_and_an_honest_bound() {
    let rows = naive::conflicts(Layout::Ring, 24, 4);
    let problem = Problem { sensors: 24, conflicts: &rows, separation: 2, interval: 15, window: 15, stale_echo: false };
    let mut memory = vec![0; memory_words(24)];
    for budget in [0, 1, 10, 100, 1000] {
        let found = shortest(&problem, budget, &mut memory, &mut ()).unwrap();
        assert!(found.bound <= 70 && found.period >= 70 && found.nodes <= budget);
        assert!(matches!(found.explanation, Explanation::BudgetSpent { bound } if bound == found.bound));
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn the_control_sees_progress_and_can_stop() {
    let rows = naive::conflicts(Layout::Ring, 24, 4);
    let problem = Problem { sensors: 24, window: 15, ..paper_12(&rows, 1) };
    let mut memory = vec![0; memory_words(24)];
    let mut polls = Vec::new();
    let mut control = |progress: &Progress| {
        polls.push(*progress);
        if polls.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let found = shortest(&problem, u64::MAX, &mut memory, &mut control).unwrap();
    assert_eq!(polls.len(), 3);
    assert!(polls.windows(2).all(|pair| pair[0].nodes < pair[1].nodes));
    assert!(!found.proven());
    assert_serves(&problem, found.period, &found.firing);
}

#[test]
fn absurd_input_gets_an_error_that_names_it() {
    let mut memory = vec![0; memory_words(2)];
    let good = Problem { sensors: 2, conflicts: &[2, 1], separation: 1, interval: 1, window: 1, stale_echo: false };
    let mut error = |problem: Problem<'_>| shortest(&problem, 1, &mut memory, &mut ()).unwrap_err();
    for (problem, expected, words) in [
        (Problem { sensors: 0, ..good }, ProblemError::Sensors(0), "0 sensors; expected 1 to 64"),
        (Problem { sensors: 65, ..good }, ProblemError::Sensors(65), "65 sensors; expected 1 to 64"),
        (
            Problem { conflicts: &[2], ..good },
            ProblemError::Rows { rows: 1, sensors: 2 },
            "1 rows of conflicts for 2 sensors; expected one row for each sensor",
        ),
        (
            Problem { conflicts: &[2, 0], ..good },
            ProblemError::OneSided { sensor: 0, other: 1 },
            "sensor 1 conflicts with sensor 2, but not the other way round; expected both or neither",
        ),
        (
            Problem { conflicts: &[1, 0], ..good },
            ProblemError::SelfConflict(0),
            "sensor 1 conflicts with itself; expected conflicts with other sensors only",
        ),
        (
            Problem { conflicts: &[4, 0], ..good },
            ProblemError::UnknownSensor { sensor: 0, other: 2 },
            "sensor 1 conflicts with sensor 3, which does not exist",
        ),
        (
            Problem { separation: 0, ..good },
            ProblemError::NoSeparation,
            "a separation of 0 ticks; expected at least 1 tick",
        ),
        (
            Problem { window: u32::MAX, ..good },
            ProblemError::TooLong { period: u64::from(u32::MAX) + 2, most: MAX_TICKS },
            "firing one by one already takes 4294967297 ticks; expected at most 67108864, so use a coarser tick",
        ),
    ] {
        let found = error(problem);
        assert_eq!(found, expected);
        assert_eq!(found.to_string(), words);
    }
    assert_eq!(
        shortest(&good, 1, &mut [0; 4], &mut ()).unwrap_err(),
        ProblemError::Memory { words: 4, needed: memory_words(2) }
    );
    assert_eq!(
        decide(&good, 0, 1, &mut memory, &mut ()).unwrap_err(),
        ProblemError::Period { period: 0, most: MAX_TICKS }
    );
}

#[test]
fn one_sensor_fires_as_often_as_its_window_allows() {
    let problem = Problem { sensors: 1, conflicts: &[0], separation: 5, interval: 9, window: 7, stale_echo: false };
    let mut memory = vec![0; memory_words(1)];
    assert_eq!(shortest(&problem, 1000, &mut memory, &mut ()).unwrap().period, 7);
    let stale = Problem { stale_echo: true, ..problem };
    let found = shortest(&stale, 1000, &mut memory, &mut ()).unwrap();
    assert_eq!((found.period, found.proven()), (10, true));
    // Twice |d| can exceed the period.
    let alone = Problem { window: 1, ..stale };
    let largest = maximize_separation(&alone, 9, 1000, &mut memory, &mut ()).unwrap();
    assert_eq!((largest.found.map(|(value, _)| value), largest.bound), (Some(16), Some(16)));
}

#[test]
fn sixty_four_sensors_in_one_clique_fire_one_after_the_other() {
    let rows = naive::conflicts(Layout::Blocks, 64, 64);
    let problem = Problem { sensors: 64, conflicts: &rows, separation: 1, interval: 10, window: 10, stale_echo: false };
    let mut memory = vec![0; memory_words(64)];
    let found = shortest(&problem, 2_000, &mut memory, &mut ()).unwrap();
    assert!(found.bound >= 640 && found.period <= 64 * 11 + 1);
    assert_serves(&problem, found.period, &found.firing);
}
