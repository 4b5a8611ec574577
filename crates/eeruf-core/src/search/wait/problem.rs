//! The wait-time problem in ticks, and measures of its solutions.

use crate::requirements::Criterion;
use crate::search::Members;

/// Longest period, in ticks: sums of several times stay far within 32 bits.
pub(crate) const MAX_PERIOD: u32 = 1 << 27;

/// The wait-time problem, all times in ticks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem<'a> {
    /// The period `T_p`.
    pub(crate) period: u32,
    /// The lag of each sensor; its length is the number of sensors.
    pub(crate) lag: &'a [u32],
    /// The longest wait: waits are 0 ..= `wait_max`.
    pub(crate) wait_max: u32,
    /// The separation `D`.
    pub(crate) separation: u32,
    /// The smallest interval `I` between firings of two conflicting sensors.
    pub(crate) interval: u32,
    /// Row `i` has bit `j` set when sensors `i` and `j` conflict; symmetric, diagonal clear.
    pub(crate) conflicts: &'a [u64],
    /// The interpretation of (13a) and (13b) that applies.
    pub(crate) criterion: Criterion,
}

impl Problem<'_> {
    /// Returns true if the values `|d|` cannot lie `D` apart, which needs `D (K - 1) <= wait_max`, or if two sensors
    /// cannot fire `I` apart, each before and after the other on the circle of `2 T_p`.
    pub(super) fn is_beyond_capacity(&self) -> bool {
        let packed = u64::from(self.separation) * (self.lag.len() as u64).saturating_sub(1);
        let conflict = self.conflicts.iter().any(|&row| row != 0);
        packed > u64::from(self.wait_max) || conflict && self.interval > self.period
    }
}

/// A checked [`Problem`], ready to be searched.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Search<'a> {
    pub(super) problem: Problem<'a>,
}

impl<'a> Search<'a> {
    /// Makes a search of a checked problem: 1 to 64 sensors with symmetric conflicts, waits up to `wait_max` that end
    /// within the period, and a period of at most [`MAX_PERIOD`].
    pub(crate) const fn new(problem: Problem<'a>) -> Self {
        Self { problem }
    }

    /// The problem as given.
    pub(super) const fn problem(&self) -> &Problem<'a> {
        &self.problem
    }

    /// The number of sensors `K`.
    pub(super) const fn sensors(&self) -> usize {
        self.problem.lag.len()
    }

    /// Returns the problem with another separation and interval.
    pub(crate) const fn with(&self, separation: u32, interval: u32) -> Self {
        Self { problem: Problem { separation, interval, ..self.problem } }
    }

    /// The smallest interval between firings of conflicting sensors for these waits, in ticks, at most the period,
    /// which it is if nothing conflicts. Zero if there are fewer waits than sensors.
    pub(super) fn smallest_interval(&self, a: &[u32], b: &[u32]) -> u32 {
        let Problem { period, lag, conflicts, .. } = self.problem;
        let mut smallest = period;
        for (i, &row) in conflicts.iter().enumerate() {
            for j in Members(row).take_while(|&j| j < i) {
                let time = |wait: &[u32], k: usize| Some(lag.get(k)?.saturating_add(*wait.get(k)?));
                let (Some(ai), Some(bi), Some(aj), Some(bj)) = (time(a, i), time(b, i), time(a, j), time(b, j)) else {
                    return 0;
                };
                smallest = smallest.min(gap(period, [ai, bi], [aj, bj]));
            }
        }
        smallest
    }

    /// The least distance between the values `|d|` (and, by [`Criterion::Paper`], between the values `s`) of any two
    /// sensors, in ticks; `wait_max` for a single sensor.
    pub(super) fn separation_of(&self, a: &[u32], b: &[u32]) -> u32 {
        let mut least = self.problem.wait_max;
        for i in 0..self.sensors().min(a.len()).min(b.len()) {
            for j in 0..i {
                // Indices below the lengths of both slices.
                least = least.min(a[i].abs_diff(b[i]).abs_diff(a[j].abs_diff(b[j])));
                if self.problem.criterion == Criterion::Paper {
                    let s = |k: usize| a[k].saturating_add(b[k]);
                    least = least.min(s(i).abs_diff(s(j)));
                }
            }
        }
        least
    }
}

/// The least distance between a firing of x and one of y on the circle of two periods; `x` and `y` are the firing times
/// within phase a and phase b.
const fn gap(period: u32, x: [u32; 2], y: [u32; 2]) -> u32 {
    let same = {
        let (a, b) = (x[0].abs_diff(y[0]), x[1].abs_diff(y[1]));
        if a < b { a } else { b }
    };
    // Firing times lie within their period, so opposite phases are period -+ difference apart.
    let opposite = {
        let (a, b) = (period.saturating_sub(x[0].abs_diff(y[1])), period.saturating_sub(x[1].abs_diff(y[0])));
        if a < b { a } else { b }
    };
    if same < opposite { same } else { opposite }
}
