//! Orders of firings, with which all that is required of a schedule is linear.

use crate::engine::problem::Merged;
use crate::engine::state::{State, event};

/// The decisions that leave a schedule no alternatives. Sensors are those of the merged problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Orders {
    /// For each phase numbers that ascend as those with a gap fire.
    pub(crate) firing: [Vec<i64>; 2],
    /// True where d is negative.
    pub(crate) negative: Vec<bool>,
    /// Those with smaller |d| first.
    pub(crate) ranks: Vec<usize>,
}

impl Orders {
    /// Those of a schedule.
    pub(crate) fn of(merged: &Merged, fire: &[Vec<u32>; 2]) -> Self {
        let firsts = (0..merged.count()).filter_map(|one| merged.of_sensor.iter().position(|&of| of == one));
        let firsts: Vec<usize> = firsts.collect();
        let firing = [0, 1].map(|phase: usize| firsts.iter().map(|&x| i64::from(fire[phase][x])).collect::<Vec<_>>());
        let d = |x: usize| firing[0][x] - firing[1][x];
        let negative = (0..merged.count()).map(|x| d(x) < 0).collect();
        let mut ranks: Vec<usize> = (0..merged.count()).collect();
        ranks.sort_by_key(|&x| d(x).abs());
        Self { firing, negative, ranks }
    }

    /// Those of a node with nothing left to branch on.
    pub(crate) fn at(state: &State) -> Self {
        let count = state.low.len();
        // Where those with a gap fire one after the other, so do their earliest times.
        let earliest = |phase| move |x| -i64::from(state.bounds.at(event(x, phase), 0));
        let firing = [0, 1].map(|phase| (0..count).map(earliest(phase)).collect());
        let negative = (0..count).map(|x| state.most(x, false) < 0).collect();
        let mut ranks: Vec<usize> = (0..count).collect();
        ranks.sort_by_key(|&x| state.below[x].count_ones());
        Self { firing, negative, ranks }
    }
}
