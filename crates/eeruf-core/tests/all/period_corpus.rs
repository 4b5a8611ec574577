//! The shortest periods of the shared corpus come out of the search, proven, with schedules that a slow and obvious
//! judge accepts.

use std::sync::OnceLock;

use eeruf_core::search::design::{Problem, memory_words, shortest};
use serde::Deserialize;

use crate::common::naive::{self, Layout};
use crate::common::naive_period::{assert_serves, check};

#[derive(Deserialize)]
struct Corpus {
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    sensors: usize,
    layout: Layout,
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
        serde_json::from_str(include_str!("../../../../tests/data/shortest-periods.json"))
            .expect("the corpus is valid JSON")
    })
}

#[test]
fn the_schedules_of_the_corpus_serve() {
    for case in &corpus().cases {
        let rows = naive::conflicts(case.layout, case.sensors, case.neighbours);
        let problem = problem_of(case, &rows);
        assert_eq!(check(&problem, case.period, &case.fire_a, &case.fire_b), Ok(()));
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
        let rows = naive::conflicts(case.layout, case.sensors, case.neighbours);
        let problem = problem_of(case, &rows);
        let mut memory = vec![0; memory_words(case.sensors)];
        let found = shortest(&problem, u64::MAX, &mut memory, &mut ()).expect("the corpus makes sense");
        assert_eq!((found.period, found.bound), (case.period, case.period), "{problem:?}");
        assert_serves(&problem, found.period, &found.firing);
    }
}
