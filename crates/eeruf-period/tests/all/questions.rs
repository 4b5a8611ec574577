//! Further questions: why a period is not shorter, the largest `t_delta` at a given period, and the preferred schedule.

use eeruf_core::{Layout, Micros, Requirements};
use eeruf_period::{PeriodProblem, ToSpare};

/// A budget that suffices for all questions here, and ends a broken search too.
const BUDGET: u64 = 1_000_000;

const fn ms(ms: u32) -> Micros {
    Micros::from_millis(ms)
}

const NEEDS: Requirements<'static> =
    Requirements { min_interval: ms(15), window: ms(30), ..Requirements::new(Micros::new(999)) };

fn line_of_twelve(window: u32) -> PeriodProblem<'static> {
    PeriodProblem { sensors: 12, requirements: Requirements { window: ms(window), ..NEEDS }, tick: ms(1) }
}

fn reason(problem: &PeriodProblem<'_>) -> String {
    problem.shortest(BUDGET, &mut ()).unwrap().reason
}

#[test]
fn the_reason_names_what_to_relax() {
    assert_eq!(
        reason(&line_of_twelve(60)),
        "window and separation: 12 sensors need 12 refire times 2 ms apart, and the shortest must leave a window of \
         60 ms, which takes 82 ms; a shorter window, a smaller separation or fewer sensors would help, a shorter \
         interval would not"
    );
    assert_eq!(
        reason(&line_of_twelve(30)),
        "interval and separation together: 4 sensors that are all neighbours and fire 15 ms apart leave too little \
         time to tell 12 refire times 2 ms apart, which takes 65 ms; a shorter interval, a smaller separation or fewer \
         neighbours would help"
    );
    let four = PeriodProblem { sensors: 4, ..line_of_twelve(15) };
    assert_eq!(
        reason(&four),
        "interval: 4 sensors that are all neighbours must fire 15 ms apart, which takes 60 ms; a shorter interval or \
         fewer neighbours would help, a smaller separation would not"
    );
    let ring = |sensors, window| PeriodProblem {
        sensors,
        requirements: Requirements { layout: Layout::Ring(4), window: ms(window), ..NEEDS },
        tick: ms(1),
    };
    assert_eq!(
        reason(&ring(11, 30)),
        "interval and number of sensors: at most 2 of 11 sensors can fire within the same 15 ms, which takes 83 ms; a \
         shorter interval or fewer neighbours would help, a smaller separation would not"
    );
    assert_eq!(
        reason(&ring(8, 30)),
        "interval and separation together: no firing order of the sensors meets both within 64 ms, though 64 ms would \
         do for the sizes of the refire times (every order was searched)"
    );
}

// A period known to be the shortest is explained as by the search that proved it.
#[test]
fn known_shortest_period_is_explained_as_searched() {
    for window in [15, 30, 45, 60] {
        let problem = line_of_twelve(window);
        let found = problem.shortest(1_000_000, &mut ()).unwrap();
        assert_eq!(problem.why_shortest(&found.schedule), Ok(found.reason));
    }
}

#[test]
fn twelve_sensors_keep_2_ms_separation_at_82_ms() {
    let problem = line_of_twelve(60);
    for (period, separation) in [(81, 1), (82, 2), (100, 3)] {
        let largest = problem.largest_t_delta(ms(period), BUDGET, &mut ()).unwrap();
        let t_delta = Some(Micros::new((1000 * separation - 1) / 2));
        assert_eq!((largest.value, largest.bound, largest.proven), (t_delta, t_delta, true), "{period} ms");
        let requirements = Requirements { t_delta: largest.value.unwrap(), ..problem.requirements };
        assert!(largest.schedule.unwrap().verify(&requirements).ok());
    }
    let none = problem.largest_t_delta(ms(59), BUDGET, &mut ()).unwrap();
    assert_eq!((none.schedule, none.value, none.bound, none.proven), (None, None, None, true));
}

#[test]
fn the_largest_t_delta_is_found_whatever_t_delta_is_asked_for() {
    let largest = |t_delta| {
        let problem = PeriodProblem { sensors: 4, ..line_of_twelve(30) };
        let problem = PeriodProblem { requirements: Requirements { t_delta, ..NEEDS }, ..problem };
        problem.largest_t_delta(ms(80), 100_000, &mut ()).unwrap().value
    };
    let found = largest(Micros::new(999));
    assert!(found > Some(Micros::new(999)));
    for t_delta in [Micros::ZERO, ms(3_000)] {
        assert_eq!(largest(t_delta), found, "asked for {t_delta}");
    }
}

#[test]
fn the_preferred_schedule_has_as_much_to_spare_as_it_says() {
    let requirements = Requirements { stale_echo: true, window: ms(15), layout: Layout::Ring(3), ..NEEDS };
    let problem = PeriodProblem { sensors: 7, requirements, tick: ms(1) };
    let found = problem.shortest(BUDGET, &mut ()).unwrap();
    let (schedule, spare) = problem.prefer(&found.schedule, 30_000, &mut ()).unwrap();
    assert_eq!(schedule.period(), found.period());
    let ToSpare { t_delta, interval, refire, .. } = spare;
    assert!(t_delta > Micros::ZERO, "{spare:?}");
    let all = Requirements {
        t_delta: NEEDS.t_delta.saturating_add(t_delta),
        min_interval: NEEDS.min_interval.saturating_add(interval),
        window: requirements.window.saturating_add(refire),
        ..requirements
    };
    assert!(schedule.verify(&all).ok());
    let seen = problem.spare_of(&schedule);
    assert_eq!((seen.t_delta, seen.interval, seen.refire), (t_delta, interval, refire));
}
