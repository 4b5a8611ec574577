//! Needs of the sensors, in ticks, and the check that the numbers are valid.

use crate::schedule::MAX_SENSORS;
use crate::search::common::{ProblemError, check_conflicts};

/// The longest time the search computes with, in ticks (67 s of 1 us), so that sums of a few times fit 32 bits.
pub const MAX_TICKS: u32 = 1 << 26;

/// Needs of the sensors. All times are in ticks of the caller's choice.
///
/// With the firing times `a` and `b` of a sensor in the two phases, each in `0..period`, and `d = a - b`:
///
/// ```text
/// | |d_x| - |d_y| | >= separation                  for all sensors x != y (criterion exact, Eqs. (10a), (10b))
/// 2 |d_x|           >= separation                  if stale_echo
/// period - |d_x|    >= window                      between two firings of one sensor
/// |t - u|           >= interval                    between firings t, u of conflicting sensors, across phases too
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Problem<'a> {
    /// The number of sensors K, `1..=64`.
    pub sensors: usize,
    /// Row x has bit y set if sensors x and y must not fire close together; symmetric, without x itself.
    pub conflicts: &'a [u64],
    /// D, the smallest distance between two values `|d|`: `2 t_delta + 1 tick`; at least 1.
    pub separation: u32,
    /// I, the smallest time between firings of two conflicting sensors.
    pub interval: u32,
    /// R, the smallest time between two firings of the same sensor: its listening window.
    pub window: u32,
    /// True if a sensor's own echo of the period before must be rejected too.
    pub stale_echo: bool,
}

impl<'a> Problem<'a> {
    /// Checks that the numbers make sense.
    ///
    /// # Errors
    /// The first thing found that does not; see [`ProblemError`].
    pub fn check(&self) -> Result<(), ProblemError> {
        check_conflicts(self.sensors, self.conflicts)?;
        if self.separation == 0 {
            return Err(ProblemError::NoSeparation);
        }
        let period = one_by_one(self);
        if period > u64::from(MAX_TICKS) {
            return Err(ProblemError::TooLong { period, most: MAX_TICKS });
        }
        Ok(())
    }

    /// The interval, where there are two sensors that it lies between.
    fn interval_that_counts(&self) -> u32 {
        if self.conflicts.iter().all(|&row| row == 0) { 0 } else { self.interval }
    }

    /// The checked problem, or what is wrong with it.
    pub(crate) fn checked(&self) -> Result<CheckedProblem, ProblemError> {
        self.check()?;
        let mut conflicts = [0; MAX_SENSORS];
        for (row, &given) in conflicts.iter_mut().zip(self.conflicts) {
            *row = given;
        }
        // `check` bounds all of them by MAX_TICKS.
        Ok(CheckedProblem {
            sensors: self.sensors,
            conflicts,
            separation: self.separation as i32,
            interval: self.interval_that_counts() as i32,
            window: self.window as i32,
            least: if self.stale_echo { self.separation.div_ceil(2) as i32 } else { 0 },
        })
    }
}

/// A period at which firing one by one always works: sensor i at `i I` in phase b and at `i (I + D)` in phase a.
pub(crate) fn one_by_one(problem: &Problem<'_>) -> u64 {
    let k = problem.sensors.min(MAX_SENSORS) as u64;
    let (d, i) = (u64::from(problem.separation), u64::from(problem.interval_that_counts()));
    (k * (d + i) + d).max(u64::from(problem.window) + k * d)
}

/// A checked [`Problem`] with signed times, small enough that sums of a few cannot overflow.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct CheckedProblem {
    pub(crate) sensors: usize,
    pub(crate) conflicts: [u64; MAX_SENSORS],
    pub(crate) separation: i32,
    pub(crate) interval: i32,
    pub(crate) window: i32,
    /// The smallest `|d|` allowed: half the separation with the stale-echo option, otherwise 0.
    pub(crate) least: i32,
}

impl CheckedProblem {
    pub(crate) fn conflict(&self, x: usize, y: usize) -> bool {
        self.conflicts[x] >> y & 1 == 1
    }

    /// The same problem in coarser ticks, with their length, if all its times are multiples of that.
    pub(crate) fn in_coarse_ticks(&self) -> Option<(Self, i32)> {
        let ticks = [self.interval, self.window, self.least].iter().fold(self.separation, |a, &b| common_divisor(a, b));
        let coarse = Self {
            separation: self.separation / ticks,
            interval: self.interval / ticks,
            window: self.window / ticks,
            least: self.least / ticks,
            ..*self
        };
        (ticks > 1).then_some((coarse, ticks))
    }

    /// The set of all sensors.
    pub(crate) fn all(&self) -> u64 {
        u64::MAX >> (MAX_SENSORS - self.sensors)
    }
}

/// The largest number that divides both; `a` is above 0.
pub(crate) fn common_divisor(a: i32, b: i32) -> i32 {
    let (mut a, mut b) = (a, b);
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The period of a query, in signed ticks.
pub(crate) fn check_period(period: u32) -> Result<i32, ProblemError> {
    if period == 0 || period > MAX_TICKS {
        Err(ProblemError::Period { period, most: MAX_TICKS })
    } else {
        Ok(period as i32)
    }
}
