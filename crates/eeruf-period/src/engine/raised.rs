//! Few limits below those of most sensors: schedules of the ring that most ask for, and a proof by it and by cases.
//!
//! Raise these limits to what most have. The raised problem often has symmetries that the problem lacks, and its
//! schedules are schedules of the problem. Where only windows were raised it serves for proofs too: a schedule of the
//! problem is one of the raised problem, or some `|d|` is too large for what its sensor's window was raised to, which
//! says much of where it lies. Of gaps that says too little: eight cases for a pair cost more than they save.

use crate::engine::descent::Case;
use crate::engine::problem::{Merged, Problem, most_common};

/// The most windows and pairs to raise: beyond, a search of the problem itself takes no longer.
const MOST: usize = 8;

/// A problem with limits raised.
pub(crate) struct Raised {
    pub(crate) problem: Problem,
    /// The sensors whose windows were raised, and what to; `None` where more was raised.
    windows: Option<(Vec<usize>, u32)>,
}

impl Raised {
    /// The problem with windows and gaps raised to what most have. `None` if none or many are lower.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let [windows, _, gaps] = problem.limits();
        let (window, gap) = (most_common(&windows)?.0, most_common(&gaps).map_or(0, |(gap, _)| gap));
        let sensors: Vec<usize> = (0..problem.sensors()).filter(|&x| problem.window[x] < window).collect();
        let raised = Problem {
            window: problem.window.iter().map(|&own| own.max(window)).collect(),
            gaps: problem.gaps.iter().map(|&(x, y, to, from)| (x, y, to.max(gap), from.max(gap))).collect(),
            ..problem.clone()
        };
        let pairs = raised.gaps.iter().zip(&problem.gaps).filter(|(to, from)| to != from).count();
        let count = sensors.len() + pairs;
        let windows = (pairs == 0).then_some((sensors, window));
        (1..=MOST).contains(&count).then_some(Self { problem: raised, windows })
    }

    /// Returns true if it serves for proofs.
    pub(crate) fn has_cases(&self) -> bool {
        self.windows.is_some()
    }

    /// The cases in which a schedule of this period is none of the raised problem. `None` where they say too little.
    pub(crate) fn cases(&self, merged: &Merged, period: u32) -> Option<Vec<Case>> {
        let (sensors, window) = self.windows.as_ref()?;
        let least = (period + 1) as i32 - *window as i32;
        Some(sensors.iter().map(|&sensor| Case::Wide { x: merged.of_sensor[sensor], least }).collect())
    }
}
