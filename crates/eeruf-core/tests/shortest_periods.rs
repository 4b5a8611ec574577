//! The shortest periods of the shared corpus come out of the search, proven, with schedules that a slow and obvious judge accepts; on tiny
//! problems the search agrees with plain nested loops.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use eeruf_core::search::design::{
    Answer, Bound, Effect, Firing, Problem, ProblemError, Progress, Reason, decide, largest_interval,
    largest_separation, memory_words, prefer, relaxations, shortest,
};
use proptest::prelude::*;
use serde::Deserialize;

#[derive(Deserialize)]
struct Corpus {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    sensors: usize,
    layout: String,
    neighbours: usize,
    min_interval: u32,
    separation: u32,
    window: u32,
    stale_echo: bool,
    period: u32,
    fire_a: Vec<u32>,
    fire_b: Vec<u32>,
}

fn corpus() -> &'static Corpus {
    static CORPUS: OnceLock<Corpus> = OnceLock::new();
    CORPUS.get_or_init(|| {
        serde_json::from_str(include_str!("../../../tests/data/shortest-periods.json"))
            .expect("the corpus is valid JSON")
    })
}

/// Which sensors conflict, by asking for each pair.
fn conflicts(sensors: usize, neighbours: usize, layout: &str) -> Vec<u64> {
    let conflict = |x: usize, y: usize| match layout {
        "line" => x.abs_diff(y) < neighbours,
        "ring" => x.abs_diff(y).min(sensors - x.abs_diff(y)) < neighbours,
        "blocks" => x / neighbours == y / neighbours,
        _ => panic!("unknown layout {layout}"),
    };
    (0..sensors).map(|x| (0..sensors).filter(|&y| x != y && conflict(x, y)).map(|y| 1 << y).sum()).collect()
}

/// What is wrong with a schedule: each need is checked as it is written, pair by pair.
fn judge(problem: &Problem<'_>, period: u32, a: &[u32], b: &[u32]) -> Result<(), String> {
    let k = problem.sensors;
    if a.len() != k || b.len() != k {
        return Err(format!("{} and {} times for {k} sensors", a.len(), b.len()));
    }
    let t = i64::from(period);
    let (a, b): (Vec<i64>, Vec<i64>) = (a.iter().map(|&t| t.into()).collect(), b.iter().map(|&t| t.into()).collect());
    for x in 0..k {
        let d = (a[x] - b[x]).abs();
        if a[x] >= t
            || b[x] >= t
            || t - d < problem.window.into()
            || (problem.stale_echo && 2 * d < problem.separation.into())
        {
            return Err(format!("sensor {x}: {} {}", a[x], b[x]));
        }
        for y in 0..x {
            let other = (a[y] - b[y]).abs();
            if (d - other).abs() < problem.separation.into() {
                return Err(format!("sensors {x} and {y} are separated by {}", (d - other).abs()));
            }
            if problem.conflicts[x] >> y & 1 == 1 {
                // All firings of both sensors on the circle of two periods.
                for u in [a[x], t + b[x]] {
                    for v in [a[y], t + b[y]] {
                        let gap = (u - v).rem_euclid(2 * t).min((v - u).rem_euclid(2 * t));
                        if gap < problem.interval.into() {
                            return Err(format!("sensors {x} and {y} fire {gap} apart"));
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

fn assert_serves(problem: &Problem<'_>, period: u32, firing: &Firing) {
    assert_eq!(judge(problem, period, firing.fire_a(), firing.fire_b()), Ok(()), "{problem:?} at {period}");
}

/// Whether any schedule exists, by trying all times of one sensor after the other.
fn nested_loops(problem: &Problem<'_>, period: u32) -> bool {
    fn place(problem: &Problem<'_>, period: u32, a: &mut Vec<u32>, b: &mut Vec<u32>) -> bool {
        let k = a.len();
        if k > 0 {
            let rows: Vec<u64> = problem.conflicts[..k].iter().map(|row| row & ((1 << k) - 1)).collect();
            let part = Problem { sensors: k, conflicts: &rows, ..*problem };
            if judge(&part, period, a, b).is_err() {
                return false;
            }
        }
        if k == problem.sensors {
            return true;
        }
        for ta in 0..period {
            for tb in 0..period {
                a.push(ta);
                b.push(tb);
                let done = place(problem, period, a, b);
                a.pop();
                b.pop();
                if done {
                    return true;
                }
            }
        }
        false
    }
    place(problem, period, &mut Vec::new(), &mut Vec::new())
}

#[test]
fn the_schedules_of_the_corpus_serve() {
    for case in &corpus().cases {
        let rows = conflicts(case.sensors, case.neighbours, &case.layout);
        let problem = problem_of(case, &rows);
        assert_eq!(judge(&problem, case.period, &case.fire_a, &case.fire_b), Ok(()));
    }
}

fn problem_of<'a>(case: &Case, rows: &'a [u64]) -> Problem<'a> {
    Problem {
        sensors: case.sensors,
        conflicts: rows,
        separation: case.separation,
        interval: case.min_interval,
        window: case.window,
        stale_echo: case.stale_echo,
    }
}

#[test]
fn every_shortest_period_of_the_corpus_is_found_and_proven() {
    for case in &corpus().cases {
        let rows = conflicts(case.sensors, case.neighbours, &case.layout);
        let problem = problem_of(case, &rows);
        let mut memory = vec![0; memory_words(case.sensors)];
        let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).expect("the corpus makes sense");
        assert_eq!((found.period, found.bound), (case.period, case.period), "{problem:?}");
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn twelve_sensors_need_at_most_64_kib() {
    assert!(4 * memory_words(12) + 8 * 1024 <= 64 * 1024, "{} words", memory_words(12));
}

/// The paper's half ring of 12: 2 ms separation, 15 ms interval, 30 ms window, in ticks of `1 ms / scale`.
fn paper_12(rows: &[u64], scale: u32) -> Problem<'_> {
    Problem {
        sensors: 12,
        conflicts: rows,
        separation: 2 * scale,
        interval: 15 * scale,
        window: 30 * scale,
        stale_echo: false,
    }
}

#[test]
fn the_half_ring_of_twelve_runs_at_65_ms_and_also_in_microseconds() {
    let rows = conflicts(12, 4, "line");
    let mut memory = vec![0; memory_words(12)];
    for scale in [1, 1000] {
        let problem = paper_12(&rows, scale);
        let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
        assert_eq!((found.period, found.proven()), (65 * scale, true));
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn larger_neighbourhoods_are_proven_within_few_nodes() {
    for (sensors, neighbours, layout, separation, window, period) in [
        (8, 6, "line", 2, 15, 91),
        (12, 6, "line", 2, 15, 93),
        (12, 6, "ring", 2, 15, 96),
        (16, 8, "line", 2, 15, 122),
        (16, 8, "ring", 2, 60, 128),
        (15, 5, "ring", 1, 30, 79),
        (10, 5, "blocks", 1, 15, 76),
    ] {
        let rows = conflicts(sensors, neighbours, layout);
        let problem = Problem { sensors, conflicts: &rows, separation, interval: 15, window, stale_echo: false };
        let mut memory = vec![0; memory_words(sensors)];
        let found = shortest(&problem, 40_000, &mut memory, &mut ()).unwrap();
        assert_eq!((found.period, found.bound), (period, period), "{problem:?}");
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn a_tick_of_a_microsecond_needs_little_more_nodes_than_one_of_a_millisecond() {
    let rows = conflicts(8, 4, "ring");
    let mut memory = vec![0; memory_words(8)];
    for scale in [1, 100, 1000] {
        let problem = Problem { sensors: 8, window: 30 * scale, ..paper_12(&rows, scale) };
        let found = shortest(&problem, 20_000, &mut memory, &mut ()).unwrap();
        assert_eq!((found.period, found.bound), (65 * scale, 65 * scale));
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn ticks_of_a_tenth_of_a_millisecond_cost_at_most_three_times_the_nodes() {
    for layout in ["line", "ring"] {
        for sensors in [8, 12, 16, 24] {
            let rows = conflicts(sensors, 4, layout);
            let mut memory = vec![0; memory_words(sensors)];
            for window in [15, 30, 45, 60] {
                let mut nodes = |scale| {
                    let problem = Problem { sensors, window: window * scale, ..paper_12(&rows, scale) };
                    let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
                    assert!(found.proven());
                    assert_serves(&problem, found.period, &found.firing);
                    found.nodes
                };
                let (coarse, fine) = (nodes(1), nodes(10));
                assert!(fine <= 3 * coarse, "{layout} {sensors} {window}: {coarse} and {fine}");
            }
        }
    }
}

#[test]
fn a_bound_beyond_half_an_interval_to_spare_is_met_in_any_tick() {
    // With 67.5 ms sensors may begin to change places; 68, 69.5 and 70 ms are proven without a search for all that.
    for (sensors, layout, window, tenths) in
        [(24, "line", 15, 680), (16, "ring", 30, 680), (12, "line", 45, 695), (12, "ring", 45, 700)]
    {
        let rows = conflicts(sensors, 4, layout);
        let mut memory = vec![0; memory_words(sensors)];
        for scale in [10, 100, 1000] {
            let problem = Problem { sensors, window: window * scale, ..paper_12(&rows, scale) };
            let found = shortest(&problem, 2_000, &mut memory, &mut ()).unwrap();
            assert_eq!((found.period, found.bound), (tenths * scale / 10, tenths * scale / 10), "{layout} {sensors}");
            assert!(matches!(found.reason, Reason::Bound(Bound::Classes { .. })));
        }
    }
}

#[test]
fn the_same_question_gets_the_same_answer() {
    let rows = conflicts(12, 4, "ring");
    let problem = paper_12(&rows, 1);
    let answers: Vec<_> = [0, 7]
        .iter()
        .map(|&fill| shortest(&problem, u64::MAX, &mut vec![fill; memory_words(12) + fill as usize], &mut ()).unwrap())
        .collect();
    assert_eq!(answers[0], answers[1]);
}

#[cfg(feature = "std")]
#[test]
fn one_two_and_three_threads_come_to_the_answer_of_none() {
    use eeruf_core::search::design::shortest_on_threads;
    for (sensors, layout, window, scale) in
        [(8, "ring", 30, 1), (12, "line", 45, 1), (12, "ring", 45, 10), (16, "line", 60, 1)]
    {
        let rows = conflicts(sensors, 4, layout);
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
    let rows = conflicts(24, 5, "ring");
    let problem = Problem { sensors: 24, ..paper_12(&rows, 1) };
    let mut polls = 0;
    let mut control = |progress: &Progress| {
        assert!(progress.bound <= progress.best || progress.best == 0);
        polls += 1;
        if polls < 5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let found = shortest_on_threads(&problem, u64::MAX, 2, &mut control).unwrap();
    assert_eq!(polls, 5);
    assert!(matches!(found.reason, Reason::BudgetSpent { bound } if bound == found.bound));
    assert_serves(&problem, found.period, &found.firing);
}

#[test]
fn a_small_budget_leaves_a_schedule_and_an_honest_bound() {
    let rows = conflicts(24, 4, "ring");
    let problem = Problem { sensors: 24, conflicts: &rows, separation: 2, interval: 15, window: 15, stale_echo: false };
    let mut memory = vec![0; memory_words(24)];
    for budget in [0, 1, 10, 100, 1000] {
        let found = shortest(&problem, budget, &mut memory, &mut ()).unwrap();
        assert!(found.bound <= 70 && found.period >= 70 && found.nodes <= budget);
        assert!(matches!(found.reason, Reason::BudgetSpent { bound } if bound == found.bound));
        assert_serves(&problem, found.period, &found.firing);
    }
}

#[test]
fn the_control_sees_progress_and_can_stop() {
    let rows = conflicts(24, 4, "ring");
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
fn the_reason_names_what_to_relax() {
    let rows = conflicts(12, 4, "line");
    let mut memory = vec![0; memory_words(12)];
    let wide = Problem { window: 60, ..paper_12(&rows, 1) };
    let found = shortest(&wide, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(found.reason, Reason::Bound(Bound::Capacity { .. })));
    assert_eq!(
        found.reason.to_string(),
        "window and separation: 12 sensors need 12 refire times 2 ticks apart, and the shortest must leave a window of 60 ticks, which takes 82 \
         ticks; a shorter window, a smaller separation or fewer sensors would help, a shorter interval would not"
    );
    let relaxed = relaxations(&wide, 82, 100_000, &mut memory, &mut ()).unwrap();
    assert_eq!(
        (relaxed.separation, relaxed.interval, relaxed.window),
        (Effect::Shorter, Effect::None, Effect::Shorter)
    );

    let narrow = paper_12(&rows, 1);
    let found = shortest(&narrow, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(found.reason, Reason::Bound(Bound::Classes { clique: 4, sensors: 12, period: 65, .. })));
    assert_eq!(
        found.reason.to_string(),
        "interval and separation together: 4 sensors that are all neighbours and fire 15 ticks apart leave too little time to tell 12 refire \
         times 2 ticks apart, which takes 65 ticks; a shorter interval, a smaller separation or fewer neighbours would help"
    );
    let rows_8 = conflicts(8, 4, "ring");
    let ring = Problem { sensors: 8, ..paper_12(&rows_8, 1) };
    let searched = shortest(&ring, u64::MAX, &mut memory, &mut ()).unwrap();
    assert!(matches!(searched.reason, Reason::Exhausted { period: 64, .. }));
    let relaxed = relaxations(&narrow, 65, 1_000_000, &mut memory, &mut ()).unwrap();
    assert_eq!((relaxed.interval, relaxed.window), (Effect::Shorter, Effect::None));
}

#[test]
fn at_100_ms_with_the_paper_s_refire_times_the_half_ring_could_keep_20_ms() {
    // |d| of at most 24 ms, as in the paper's tables, is a window of 76 ms. With the paper's lags it is 19 ms; here lags are free.
    let rows = conflicts(12, 4, "line");
    let problem = Problem { window: 76, ..paper_12(&rows, 1) };
    let mut memory = vec![0; memory_words(12)];
    let largest = largest_interval(&problem, 100, u64::MAX, &mut memory, &mut ()).unwrap();
    let (interval, firing) = largest.found.unwrap();
    assert_eq!((interval, largest.bound), (20, Some(20)));
    assert_serves(&Problem { interval, ..problem }, 100, &firing);
}

#[test]
fn at_82_ms_the_largest_separation_of_twelve_sensors_with_a_60_ms_window_is_2_ms() {
    let rows = conflicts(12, 4, "line");
    let problem = Problem { window: 60, ..paper_12(&rows, 1) };
    let mut memory = vec![0; memory_words(12)];
    for (period, separation) in [(81, 1), (82, 2), (100, 3)] {
        let largest = largest_separation(&problem, period, u64::MAX, &mut memory, &mut ()).unwrap();
        let (value, firing) = largest.found.unwrap();
        assert_eq!((value, largest.bound), (separation, Some(separation)));
        assert_serves(&Problem { separation, ..problem }, period, &firing);
    }
}

#[test]
fn the_preferred_schedule_is_no_worse_and_still_serves() {
    let rows = conflicts(8, 4, "line");
    let problem =
        Problem { sensors: 8, conflicts: &rows, separation: 20, interval: 150, window: 600, stale_echo: true };
    let mut memory = vec![0; memory_words(8)];
    let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
    let preferred = prefer(&problem, &found, 30_000, &mut memory, &mut ()).unwrap();
    let (separation, interval, window) = (preferred.separation.value, preferred.interval.value, preferred.window.value);
    assert!(separation >= 20 && interval >= 150 && window >= 600);
    assert_serves(&Problem { separation, interval, window, ..problem }, found.period, &preferred.firing);
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
            ProblemError::TooLong { period: u64::from(u32::MAX) + 2 },
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
    assert_eq!(decide(&good, 0, 1, &mut memory, &mut ()).unwrap_err(), ProblemError::Period(0));
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
    let largest = largest_separation(&alone, 9, 1000, &mut memory, &mut ()).unwrap();
    assert_eq!((largest.found.map(|(value, _)| value), largest.bound), (Some(16), Some(16)));
}

#[test]
fn sixty_four_sensors_in_one_clique_fire_one_after_the_other() {
    let rows = conflicts(64, 64, "blocks");
    let problem = Problem { sensors: 64, conflicts: &rows, separation: 1, interval: 10, window: 10, stale_echo: false };
    let mut memory = vec![0; memory_words(64)];
    let found = shortest(&problem, 2_000, &mut memory, &mut ()).unwrap();
    assert!(found.bound >= 640 && found.period <= 64 * 11 + 1);
    assert_serves(&problem, found.period, &found.firing);
}

prop_compose! {
    /// Any conflicts between up to four sensors, with small needs.
    fn tiny()(sensors in 1..=4usize, pairs in any::<u64>(), separation in 1..=3u32, interval in 0..=4u32, window in 0..=8u32,
              stale_echo in any::<bool>(), layout in 0..4) -> (Vec<u64>, u32, u32, u32, bool) {
        let rows = match layout {
            0 => conflicts(sensors, 2, "line"),
            1 => conflicts(sensors, 2, "ring"),
            2 => conflicts(sensors, 2, "blocks"),
            _ => {
                let mut rows = vec![0; sensors];
                for x in 0..sensors {
                    for y in 0..x {
                        if pairs >> (x * 4 + y) & 1 == 1 {
                            rows[x] |= 1 << y;
                            rows[y] |= 1 << x;
                        }
                    }
                }
                rows
            }
        };
        (rows, separation, interval, window, stale_echo)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_search_agrees_with_nested_loops_on_tiny_problems((rows, separation, interval, window, stale_echo) in tiny(), period in 1..=9u32) {
        let problem = Problem { sensors: rows.len(), conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(rows.len())];
        match decide(&problem, period, u64::MAX, &mut memory, &mut ()).unwrap().answer {
            Answer::Found(firing) => prop_assert_eq!(judge(&problem, period, firing.fire_a(), firing.fire_b()), Ok(())),
            Answer::Exhausted => prop_assert!(!nested_loops(&problem, period)),
            Answer::BudgetSpent => prop_assert!(false, "no budget was set"),
        }
    }

    #[test]
    fn the_shortest_period_of_tiny_problems_is_where_nested_loops_begin_to_succeed((rows, separation, interval, window, stale_echo) in tiny()) {
        let problem = Problem { sensors: rows.len(), conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(rows.len())];
        let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).unwrap();
        prop_assert!(found.proven());
        prop_assert_eq!(judge(&problem, found.period, found.firing.fire_a(), found.firing.fire_b()), Ok(()));
        // What nested loops manage.
        if found.period > 1 && u64::from(found.period - 1).pow(2 * rows.len() as u32) < 2_000_000 {
            prop_assert!(!nested_loops(&problem, found.period - 1));
        }
    }

    #[test]
    fn larger_problems_get_schedules_that_serve_and_bounds_in_order(
        sensors in 5..=9usize, seed in any::<u64>(), separation in 1..=4u32, interval in 0..=12u32, window in 0..=60u32, stale_echo in any::<bool>(),
    ) {
        let mut rows = vec![0u64; sensors];
        for x in 0..sensors {
            for y in 0..x {
                if seed.rotate_left((x * 11 + y * 7) as u32) & 3 == 0 {
                    rows[x] |= 1 << y;
                    rows[y] |= 1 << x;
                }
            }
        }
        let problem = Problem { sensors, conflicts: &rows, separation, interval, window, stale_echo };
        let mut memory = vec![0; memory_words(sensors)];
        let found = shortest(&problem, 3_000, &mut memory, &mut ()).unwrap();
        prop_assert!(found.bound <= found.period);
        prop_assert_eq!(judge(&problem, found.period, found.firing.fire_a(), found.firing.fire_b()), Ok(()));
    }
}
