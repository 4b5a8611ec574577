//! Parts that the tests of the searches share: owned problems, slow judges and the shared tables.

#![allow(dead_code, missing_docs, unreachable_pub)]

pub mod naive;
pub mod random;
pub mod tables;

use eeruf_core::search::{SearchError, WaitProblem, WaitSearch};
use eeruf_core::{Criterion, Micros, Phase, Schedule};
use naive::{Layout, Problem};
use tables::Case;

/// Owned parts of a problem.
#[derive(Debug, Clone)]
pub struct Owned {
    pub lag: Vec<u32>,
    pub conflicts: Vec<u64>,
    pub period: u32,
    pub wait_max: u32,
    pub separation: u32,
    pub interval: u32,
    pub criterion: Criterion,
}

impl Owned {
    pub fn of(case: &Case) -> Self {
        let lag = (0..case.sensors).map(|i| (i % case.group) as u32 * case.period / case.group as u32).collect();
        Self {
            lag,
            conflicts: naive::conflicts(case.layout, case.sensors, case.neighbours),
            period: case.period,
            wait_max: case.wait_max,
            separation: case.separation,
            interval: case.min_interval,
            criterion: if case.criterion == "paper" { Criterion::Paper } else { Criterion::Exact },
        }
    }

    /// The paper's ring: lags in groups of four, all times in ticks, `per_ms` to a millisecond.
    pub fn paper(sensors: usize, layout: Layout, separation: u32, per_ms: u32, criterion: Criterion) -> Self {
        Self {
            lag: (0..sensors).map(|i| (i % 4) as u32 * 25 * per_ms).collect(),
            conflicts: naive::conflicts(layout, sensors, 4),
            period: 100 * per_ms,
            wait_max: 24 * per_ms,
            separation: separation * per_ms,
            interval: 0,
            criterion,
        }
    }

    pub fn search(&self) -> WaitSearch {
        search(&self.problem()).unwrap()
    }

    pub fn problem(&self) -> Problem<'_> {
        Problem {
            period: self.period,
            lag: &self.lag,
            wait_max: self.wait_max,
            separation: self.separation,
            interval: self.interval,
            conflicts: &self.conflicts,
            criterion: self.criterion,
        }
    }
}

/// A tick of 2 us: D ticks are then the separation of a `t_delta` of D - 1 us, which needs 2 D - 1 us.
pub const TICK: Micros = Micros::new(2);

pub fn us(ticks: u32) -> Micros {
    Micros::new(TICK.as_micros() * ticks)
}

/// The search for a problem in microseconds.
pub fn search(problem: &Problem<'_>) -> Result<WaitSearch, SearchError> {
    let lag: Vec<_> = problem.lag.iter().map(|&ticks| us(ticks)).collect();
    WaitSearch::new(&WaitProblem {
        sensors: problem.lag.len(),
        period: us(problem.period),
        wait_max: us(problem.wait_max),
        tick: TICK,
        t_lag: Some(&lag),
        t_delta: Micros::new(problem.separation - 1),
        min_interval: us(problem.interval),
        neighbours: 1,
        layout: eeruf_core::Layout::Graph(problem.conflicts),
        criterion: problem.criterion,
    })
}

/// The waits of a schedule in ticks, of phase a and of phase b.
pub fn waits<const K: usize>(schedule: &Schedule<K>) -> [Vec<u32>; 2] {
    [Phase::A, Phase::B].map(|phase| schedule.t_wait(phase).iter().map(|&wait| ticks(wait)).collect())
}

/// A time in ticks.
pub fn ticks(time: Micros) -> u32 {
    time.as_micros() / TICK.as_micros()
}

/// The separation in ticks for the largest `t_delta`.
pub fn separation(t_delta: Micros) -> u32 {
    t_delta.as_micros() + 1
}

/// Judges a schedule in ticks.
pub fn holds<const K: usize>(problem: &Problem<'_>, schedule: &Schedule<K>) -> bool {
    let [a, b] = waits(schedule);
    naive::holds(problem, &a, &b)
}
