//! In which order counting places the sensors, one at each level.

use super::super::Problem;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// The sensors level by level, and who is near whom. Indices are sensors and levels, both below
/// `lag.len() <= MAX_SENSORS`.
pub(super) struct LevelOrder {
    /// Sensors in the order of the levels.
    pub(super) order: [u8; MAX_SENSORS],
    /// By sensor: those that can fire too close to it.
    pub(super) near: [u64; MAX_SENSORS],
    /// By level: the sensors to come, this level's included, that are near one placed before.
    pub(super) touched: [u64; MAX_SENSORS],
    /// By level: the sensors placed before.
    pub(super) placed: [u64; MAX_SENSORS],
    /// The greatest number of sensors touched at a level.
    pub(super) widest: usize,
}

impl LevelOrder {
    pub(super) fn new(problem: &Problem<'_>) -> Self {
        let mut order = Self {
            order: [0; MAX_SENSORS],
            near: [0; MAX_SENSORS],
            touched: [0; MAX_SENSORS],
            placed: [0; MAX_SENSORS],
            widest: 0,
        };
        order.find_near(problem);
        order.widest = order.order_levels(problem);
        order
    }

    /// Finds which conflicting sensors can fire too close at all.
    fn find_near(&mut self, problem: &Problem<'_>) {
        let Problem { period, lag, wait_max, interval, conflicts, .. } = *problem;
        for (i, &row) in conflicts.iter().enumerate() {
            for j in Members(row) {
                let apart = lag[i].abs_diff(lag[j]);
                if apart < wait_max + interval || period - apart < wait_max + interval {
                    self.near[i] |= 1 << j;
                }
            }
        }
    }

    /// Orders the sensors: few unfinished neighbours, and those without neighbours last. Returns the greatest number of
    /// sensors touched at a level.
    fn order_levels(&mut self, problem: &Problem<'_>) -> usize {
        let sensors = problem.lag.len();
        let (mut placed, mut touched, mut widest) = (0_u64, 0_u64, 0);
        for level in 0..sensors {
            (self.placed[level], self.touched[level]) = (placed, touched);
            widest = widest.max(touched.count_ones() as usize);
            let next = (0..sensors).filter(|i| placed >> i & 1 == 0).min_by_key(|&i| {
                let after = (touched | self.near[i]) & !placed & !(1 << i);
                (self.near[i] == 0, after.count_ones(), touched >> i & 1 == 0, i)
            });
            let Some(next) = next else { break };
            self.order[level] = next as u8;
            placed |= 1 << next;
            touched = (touched | self.near[next]) & !placed;
        }
        widest
    }
}
