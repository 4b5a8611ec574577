//! The design search at the edges of what it takes: no sensors, 64 of them, and ticks that are too coarse or too fine.

use eeruf_core::search::design::{MAX_TICKS, Problem, memory_words, prefer, shortest};
use eeruf_core::search::{PeriodProblem, SearchError};
use eeruf_core::{Layout, Micros, Requirements};

use crate::common::naive;
use crate::common::naive_period::assert_serves;

fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

fn line_of_four(requirements: Requirements<'_>) -> PeriodProblem<'_> {
    PeriodProblem { sensors: 4, requirements, tick: ms(1) }
}

const NEEDS: Requirements<'static> = Requirements {
    min_interval: Micros::from_millis(15),
    window: Micros::from_millis(30),
    ..Requirements::new(Micros::new(999))
};

#[test]
fn the_largest_t_delta_is_found_whatever_t_delta_is_asked_for() {
    let mut memory = vec![0; memory_words(4)];
    let mut largest = |t_delta| {
        let problem = line_of_four(Requirements { t_delta, ..NEEDS });
        problem.largest_t_delta::<4>(ms(80), 100_000, &mut memory, &mut ()).unwrap().value
    };
    let found = largest(Micros::new(999));
    assert!(found > Some(Micros::new(999)));
    for t_delta in [Micros::ZERO, ms(100_000), Micros::MAX] {
        assert_eq!(largest(t_delta), found, "asked for {t_delta}");
    }
}

#[test]
fn the_largest_interval_is_found_whatever_interval_is_asked_for() {
    let mut memory = vec![0; memory_words(4)];
    let mut largest = |min_interval| {
        let problem = line_of_four(Requirements { min_interval, ..NEEDS });
        problem.largest_interval::<4>(ms(80), 100_000, &mut memory, &mut ()).unwrap().value
    };
    let found = largest(ms(15));
    assert!(found > Some(ms(15)));
    for min_interval in [Micros::ZERO, ms(100_000), Micros::MAX] {
        assert_eq!(largest(min_interval), found, "asked for {min_interval}");
    }
}

#[test]
fn slack_below_half_an_interval_is_not_half() {
    // Pairs of neighbours in a line, in two and a half intervals: there is one permutation for all only below that.
    for (sensors, interval, separation) in [(4, 2, 1), (4, 4, 2), (6, 4, 1)] {
        let rows = naive::conflicts(naive::Layout::Line, sensors, 2);
        let problem = Problem { sensors, conflicts: &rows, separation, interval, window: interval, stale_echo: false };
        let found = shortest(&problem, u64::MAX, &mut vec![0; memory_words(sensors)], &mut ()).unwrap();
        assert_eq!((found.period, found.bound), (5 * interval / 2, 5 * interval / 2), "{problem:?}");
        assert_serves(&problem, found.period, &found.firing);
    }
}

// An interval between neighbours that there are none of makes no search too long.
#[test]
fn interval_without_neighbours_makes_no_long_search() {
    let mut memory = vec![0; memory_words(64)];
    let requirements = Requirements { min_interval: ms(5_000), layout: Layout::Line(1), ..NEEDS };
    let problem = PeriodProblem { sensors: 64, requirements, tick: ms(1) };
    let alone = problem.shortest::<64>(2_000, &mut memory, &mut ()).unwrap().found;
    let none = Requirements { min_interval: Micros::ZERO, ..requirements };
    let free = PeriodProblem { requirements: none, ..problem };
    let free = free.shortest::<64>(2_000, &mut memory, &mut ()).unwrap().found;
    assert_eq!((alone.value, alone.bound), (free.value, free.bound));
    let rows = [0; 64];
    let largest =
        Problem { sensors: 64, conflicts: &rows, separation: 1, interval: u32::MAX, window: 10, stale_echo: false };
    assert!(shortest(&largest, 2_000, &mut memory, &mut ()).is_ok());
}

#[test]
fn a_search_that_is_too_long_gets_the_advice_that_helps() {
    let mut memory = vec![0; memory_words(12)];
    let mut error = |requirements, tick| {
        let problem = PeriodProblem { sensors: 12, requirements, tick };
        problem.shortest::<12>(1_000, &mut memory, &mut ()).unwrap_err()
    };
    // Each of the needs rounds up to a tick.
    let coarse = error(NEEDS, ms(30_000));
    assert!(matches!(coarse, SearchError::CoarseTick { .. }), "{coarse:?}");
    assert_eq!(
        coarse.to_string(),
        "in ticks of 30000 ms firing one by one already takes 750 s; expected at most 268435.456 ms, so use a finer \
         tick"
    );
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
fn no_sensors_need_memory_that_can_be_counted() {
    assert!(memory_words(0) < memory_words(1));
    assert!(eeruf_core::search::wait::memory_words(0) <= eeruf_core::search::wait::memory_words(1));
}

// The preferred schedule of 64 sensors is found up to the longest period.
#[test]
fn preferred_schedule_of_64_sensors_is_found() {
    let mut memory = vec![0; memory_words(64)];
    for (neighbours, window) in [(64, 10), (64, MAX_TICKS / 2), (2, MAX_TICKS / 2), (1, MAX_TICKS / 2)] {
        let rows = naive::conflicts(naive::Layout::Line, 64, neighbours);
        // As long as firing one by one may take.
        let (separation, interval) = (MAX_TICKS / 65 / 64, MAX_TICKS / 65 / 2);
        let problem = Problem { sensors: 64, conflicts: &rows, separation, interval, window, stale_echo: false };
        let found = shortest(&problem, 20, &mut memory, &mut ()).unwrap();
        let preferred = prefer(&problem, &found, 30, &mut memory, &mut ()).unwrap();
        assert!(preferred.separation.value >= separation && preferred.window.value >= window);
    }
}

// A period known to be the shortest is explained as by the search that proved it.
#[test]
fn known_shortest_period_is_explained_as_searched() {
    let mut memory = vec![0; memory_words(12)];
    let mut texts = Vec::new();
    for window in [15, 30, 45, 60] {
        let requirements = Requirements { window: ms(window), ..NEEDS };
        let problem = PeriodProblem { sensors: 12, requirements, tick: ms(1) };
        let designed = problem.shortest::<12>(1_000_000, &mut memory, &mut ()).unwrap();
        let why = problem.why_shortest(designed.found.value.unwrap()).unwrap();
        texts.push(why.in_ticks_of(problem.tick).to_string());
        assert_eq!(texts.last(), Some(&designed.explanation().to_string()));
        assert!(problem.why_shortest(Micros::new(500)).is_err(), "no whole number of ticks");
    }
    texts.dedup();
    assert!(texts.len() > 2, "{texts:?}");
}
