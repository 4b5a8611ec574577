//! Parts that the tests and benches of the searches share: problems that own their parts, slow judges and the shared
//! tables.

#![allow(dead_code, missing_docs, unreachable_pub)]

pub mod naive;
pub mod random;
pub mod tables;

use eeruf_core::Criterion;
use eeruf_core::search::wait::{Problem, Search};
use naive::Layout;
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

    /// The paper's ring: lags in groups of four, all times in ticks of which a millisecond has `per_ms`.
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

    pub fn search(&self) -> Search<'_> {
        Search::new(self.problem()).unwrap()
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
