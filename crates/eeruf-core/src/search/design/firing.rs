//! Firing times, and what they need or leave: arithmetic on times, without any search.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::problem::CheckedProblem;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

/// The firing times of all sensors in both phases, in ticks from the start of the phase, each below the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Firing {
    pub(crate) a: [u32; MAX_SENSORS],
    pub(crate) b: [u32; MAX_SENSORS],
    pub(crate) sensors: usize,
}

impl Firing {
    /// The times in phase a, sensor by sensor.
    #[must_use]
    pub fn fire_a(&self) -> &[u32] {
        self.a.get(..self.sensors).unwrap_or(&[])
    }

    /// The times in phase b, sensor by sensor.
    #[must_use]
    pub fn fire_b(&self) -> &[u32] {
        self.b.get(..self.sensors).unwrap_or(&[])
    }

    /// The same times in ticks of which `ticks` make one of these.
    pub(crate) fn in_fine_ticks(&self, ticks: u32) -> Self {
        Self { a: self.a.map(|time| time * ticks), b: self.b.map(|time| time * ticks), sensors: self.sensors }
    }

    /// `|d|` of sensor `x`, which is below `MAX_SENSORS`.
    pub(crate) fn size(&self, x: usize) -> i32 {
        self.a[x].abs_diff(self.b[x]) as i32
    }

    /// The smallest difference between two `|d|`, and with the stale-echo option twice the smallest `|d|`; `most` at
    /// most.
    pub(crate) fn separation(&self, problem: &CheckedProblem, most: i32) -> i32 {
        let mut sizes = [0; MAX_SENSORS];
        for x in 0..self.sensors {
            sizes[x] = self.size(x);
        }
        let sizes = &mut sizes[..self.sensors];
        sizes.sort_unstable();
        let own = if problem.least > 0 { 2 * sizes[0] } else { most };
        sizes.windows(2).map(|pair| pair[1] - pair[0]).fold(own.min(most), i32::min)
    }

    /// The smallest interval between firings of conflicting sensors, across the ends of the phases too; `most` at most.
    pub(crate) fn interval(&self, problem: &CheckedProblem, period: i32, most: i32) -> i32 {
        let mut least = most;
        for x in 0..self.sensors {
            for y in Members(problem.conflicts[x]) {
                let (ax, bx, ay, by) = (self.a[x] as i32, self.b[x] as i32, self.a[y] as i32, self.b[y] as i32);
                for gap in [(ax - ay).abs(), (bx - by).abs(), period + by - ax, period + ay - bx] {
                    least = least.min(gap);
                }
            }
        }
        least
    }

    /// The smallest time between two firings of one sensor.
    pub(crate) fn window(&self, period: i32) -> i32 {
        (0..self.sensors).map(|x| period - self.size(x)).fold(period, i32::min)
    }

    /// The shortest period at which these very times serve.
    pub(crate) fn period(&self, problem: &CheckedProblem) -> i32 {
        let mut period = 1;
        for x in 0..self.sensors {
            let (ax, bx) = (self.a[x] as i32, self.b[x] as i32);
            period = period.max(ax + 1).max(bx + 1).max(problem.window + self.size(x));
            for y in Members(problem.conflicts[x]) {
                period =
                    period.max(problem.interval + ax - self.b[y] as i32).max(problem.interval + bx - self.a[y] as i32);
            }
        }
        period
    }
}
