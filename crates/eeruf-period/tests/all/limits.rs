//! Limits of the search: budgets, a control that stops it, one and sixty-four sensors, ticks that are too coarse or too
//! fine, bad input.

use std::ops::ControlFlow;

use crate::alike::{Alike, Layout as Rows, assert_serves, conflicts, paper_12};
use eeruf_core::search::{Progress, SearchError};
use eeruf_core::{Criterion, Layout, Micros, Requirements};
use eeruf_period::PeriodProblem;

/// A budget that suffices for all questions here, and ends a broken search too.
const BUDGET: u64 = 1_000_000;

const NEEDS: Requirements<'static> = Requirements {
    min_interval: Micros::from_millis(15),
    window: Micros::from_millis(30),
    ..Requirements::new(Micros::new(999))
};

fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

fn ring_of_24() -> PeriodProblem<'static> {
    let requirements = Requirements { layout: Layout::Ring(4), window: ms(15), ..NEEDS };
    PeriodProblem { sensors: 24, requirements, tick: ms(1) }
}

#[test]
fn the_same_question_gets_the_same_answer() {
    let rows = conflicts(Rows::Ring, 12, 4);
    let problem = paper_12(&rows, 1);
    assert_eq!(problem.shortest(BUDGET), problem.shortest(BUDGET));
}

#[test]
fn a_small_budget_leaves_a_schedule_and_an_honest_bound() {
    let problem = ring_of_24();
    for budget in [0, 1, 10, 100, 1000] {
        let found = problem.shortest(budget, &mut ()).unwrap();
        assert!(found.bound <= ms(70) && found.period() >= ms(70) && found.nodes <= budget, "{budget}: {found:?}");
        assert!(found.reason.starts_with("the search, which ended early"), "{}", found.reason);
        assert!(found.schedule.verify(&problem.requirements).ok());
    }
}

#[test]
fn the_control_sees_progress_and_can_stop() {
    let mut polls = Vec::new();
    let mut control = |progress: &Progress| {
        polls.push(*progress);
        if polls.len() < 3 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let problem = ring_of_24();
    let found = problem.shortest(BUDGET, &mut control).unwrap();
    assert_eq!(polls.len(), 3);
    assert!(polls.windows(2).all(|pair| pair[0].nodes < pair[1].nodes));
    assert!(!found.proven() && found.schedule.verify(&problem.requirements).ok());
}

#[test]
fn absurd_input_gets_an_error_that_names_it() {
    let good = PeriodProblem { sensors: 2, requirements: NEEDS, tick: ms(1) };
    let paper = Requirements { criterion: Criterion::Paper, ..NEEDS };
    for (problem, words) in [
        (PeriodProblem { sensors: 0, ..good }, "0 sensors; expected 1 to 64"),
        (PeriodProblem { sensors: 65, ..good }, "65 sensors; expected 1 to 64"),
        (PeriodProblem { tick: Micros::ZERO, ..good }, "a tick of 0 us; expected 1 us or more"),
        (
            PeriodProblem { requirements: paper, ..good },
            "criterion paper for free firing times; expected criterion exact, as there are no waits",
        ),
    ] {
        assert_eq!(problem.shortest(1, &mut ()).unwrap_err().to_string(), words);
    }
    let error = |period| good.decide(period, None, 1, &mut ()).unwrap_err().to_string();
    assert_eq!(error(Micros::ZERO), "a period of 0 ticks; expected 1 to 16777216");
    assert_eq!(error(Micros::new(500)), "the period of 500 us; expected a whole number of ticks of 1 ms");
}

#[test]
fn a_search_that_is_too_long_gets_the_advice_that_helps() {
    let error = |requirements, tick| {
        let problem = PeriodProblem { sensors: 12, requirements, tick };
        problem.shortest(1_000, &mut ()).unwrap_err()
    };
    // Each of the needs rounds up to a tick.
    let coarse = error(NEEDS, ms(30_000));
    assert!(matches!(coarse, SearchError::CoarseTick { .. }), "{coarse:?}");
    assert!(coarse.to_string().ends_with("so use a finer tick"), "{coarse}");
    // Too many ticks, but not too long.
    let long = Requirements { min_interval: ms(8_000), ..NEEDS };
    assert!(error(long, Micros::new(1)).to_string().ends_with("so use a coarser tick"));
    assert!(!matches!(error(long, ms(30_000)), SearchError::TooLong { .. }));
    // Too long in any ticks.
    let endless = Requirements { min_interval: ms(100_000), ..NEEDS };
    for tick in [Micros::new(1), ms(1), ms(30_000)] {
        let error = error(endless, tick);
        assert!(matches!(error, SearchError::TooLong { .. }), "{error:?}");
        assert!(error.to_string().ends_with("so a shorter interval or window, or a smaller t_delta"), "{error}");
    }
}

#[test]
fn one_sensor_fires_as_often_as_its_window_allows() {
    let alone = Alike { conflicts: &[0], separation: 5, interval: 9, window: 7, stale_echo: false };
    assert_eq!(alone.shortest(1000).period, 7);
    let found = Alike { stale_echo: true, ..alone }.shortest(1000);
    assert_eq!((found.period, found.bound), (10, 10));
}

#[test]
fn sixty_four_sensors_in_one_clique_fire_one_after_the_other() {
    let rows = conflicts(Rows::Blocks, 64, 64);
    let problem = Alike { conflicts: &rows, separation: 1, interval: 10, window: 10, stale_echo: false };
    let found = problem.shortest(2_000);
    assert!(found.bound >= 640 && found.period <= 64 * 11 + 1);
    assert_serves(&problem, found.period, &found.fire);
}

// An interval between neighbours does not make a search too long if there are no neighbours.
#[test]
fn interval_without_neighbours_makes_no_long_search() {
    let requirements = Requirements { layout: Layout::Line(1), ..NEEDS };
    let problem = PeriodProblem { sensors: 64, requirements, tick: ms(1) };
    let alone = problem.shortest(2_000, &mut ()).unwrap();
    let none = Requirements { min_interval: Micros::ZERO, ..requirements };
    let free = PeriodProblem { requirements: none, ..problem }.shortest(2_000, &mut ()).unwrap();
    assert_eq!((alone.period(), alone.bound), (free.period(), free.bound));
    let endless = Requirements { min_interval: ms(100_000), ..requirements };
    assert!(PeriodProblem { requirements: endless, ..problem }.shortest(2_000, &mut ()).is_ok());
}

#[test]
fn slack_below_half_an_interval_is_not_half() {
    // Pairs of neighbours in a line, in two and a half intervals: there is one permutation for all only below that.
    for (sensors, interval, separation) in [(4, 2, 1), (4, 4, 2), (6, 4, 1)] {
        let rows = conflicts(Rows::Line, sensors, 2);
        let problem = Alike { conflicts: &rows, separation, interval, window: interval, stale_echo: false };
        let found = problem.shortest(BUDGET);
        assert_eq!((found.period, found.bound), (5 * interval / 2, 5 * interval / 2), "{problem:?}");
        assert_serves(&problem, found.period, &found.fire);
    }
}
