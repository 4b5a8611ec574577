//! The paper's wait-time problem: constant lags, and for each sensor two waits on a grid of ticks.
//!
//! Sensor `i` fires at `t_lag + t_wait_a` in phase a and at `T_p + t_lag + t_wait_b` in phase b, and so on with a cycle
//! of `2 T_p` (Sec. 3.1). A table of waits `(a_i, b_i)` solves the problem when
//!
//! ```text
//! | |d_x| - |d_y| | >= D   with d = a - b      for all x != y      both criteria, (13a) and (13b)
//! |  s_x  -  s_y  | >= D   with s = a + b      for all x != y      Criterion::Paper alone
//! firings of conflicting sensors lie at least I apart on the circle of 2 T_p, in every phase and over every border
//! ```
//!
//! All times are whole ticks, whatever a tick is; `D = 2 t_delta + 1 tick`, as near-identical is `<= t_delta`.
//!
//! | question | method | how |
//! |---|---|---|
//! | is there one? | [`Search::first`] | ranks of `|d|` over difference constraints: the tick does not matter |
//! | the best interval or separation, and the front of both | [`Search::best`], [`Search::pareto`] | the same, by bisection |
//! | every one | [`Search::all`] | depth first over the values, in lexicographic order |
//! | how many? | [`Search::count`] | depth first with a memory of what was counted before |
//! | these pairs, over any sensors | [`Search::rearrange`] | depth first over the pairs |
//!
//! Nothing here allocates, recurses, reads a clock or depends on chance. The caller lends memory: [`MEMORY_WORDS`] says how
//! much is enough for all but counting, and counting is exact with any amount, faster with more. What the searches
//! keep on the stack is below 8 KiB (64 KiB in counting) at any size: twelve sensors are decided in 16 KiB of RAM, all told.
//!
//! ```
//! use eeruf_core::Criterion;
//! use eeruf_core::search::wait::{Control, Finish, Objective, Problem, Search, memory_words};
//!
//! // Four sensors that all conflict, lags 0, 25, 50, 75 and waits up to 24 ms; t_delta just below 1 ms, so D = 2 ms.
//! let problem = Problem {
//!     period: 100,
//!     lag: &[0, 25, 50, 75],
//!     wait_max: 24,
//!     separation: 2,
//!     interval: 15,
//!     conflicts: &[0b1110, 0b1101, 0b1011, 0b0111],
//!     criterion: Criterion::Paper,
//! };
//! let search = Search::new(problem).unwrap();
//! let (mut a, mut b) = ([0; 4], [0; 4]);
//! let best = search
//!     .best(Objective::Interval, &mut [0; memory_words(4)], &mut Control::unlimited(), &mut a, &mut b)
//!     .unwrap();
//! // n I + D (K - 1) <= T_p: 23 ms, with 2 ms to spare.
//! assert_eq!((best.finish, best.value), (Finish::Found, Some(23)));
//! assert_eq!(search.smallest_interval(&a, &b), 23);
//! ```

mod all;
mod best;
mod control;
mod count;
mod decide;
mod least;
mod memo;
mod options;
mod rearrange;

use core::fmt;

use crate::conditions::Criterion;
use crate::schedule::MAX_SENSORS;

pub use all::All;
pub use best::{Best, Objective, Pareto, ParetoPoint};
pub use control::{Control, Progress};
pub use count::{COUNT_WORDS, Count};
pub use decide::memory_words;
pub use rearrange::Rearrange;

/// Words of memory that suffice for every search here with up to [`MAX_SENSORS`] sensors; [`memory_words`] tells it for fewer.
pub const MEMORY_WORDS: usize = memory_words(MAX_SENSORS);

/// The longest period, in ticks: sums of a few times then stay far inside 32 bits.
pub const MAX_PERIOD: u32 = 1 << 27;

/// The three ways in which a search ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Finish {
    /// A table was found (the best one, where one was asked for, if the result says proven).
    Found,
    /// All possibilities were looked at or excluded: a proof that there is none (or none left).
    Exhausted,
    /// The budget of nodes was spent, or the caller cancelled: nothing is proven.
    BudgetSpent,
}

/// The wait-time problem, all times in ticks.
#[derive(Debug, Clone, Copy)]
pub struct Problem<'a> {
    /// The period `T_p`.
    pub period: u32,
    /// The lag of each sensor; its length is the number of sensors.
    pub lag: &'a [u32],
    /// The longest wait: waits are 0 ..= `wait_max`.
    pub wait_max: u32,
    /// The separation `D`.
    pub separation: u32,
    /// The smallest interval `I` between firings of two conflicting sensors.
    pub interval: u32,
    /// Row `i` has bit `j` set when sensors `i` and `j` conflict; symmetric, diagonal clear.
    pub conflicts: &'a [u64],
    /// Which reading of (13a) and (13b) holds.
    pub criterion: Criterion,
}

impl Problem<'_> {
    /// Whether the values `|d|` cannot lie `D` apart, which needs `D (K - 1) <= wait_max`, or two sensors cannot fire `I` apart, of which
    /// one fires before and after the other on the circle of `2 T_p`.
    fn is_beyond_capacity(&self) -> bool {
        let packed = u64::from(self.separation) * (self.lag.len() as u64).saturating_sub(1);
        let conflict = self.conflicts.iter().any(|&row| row != 0);
        packed > u64::from(self.wait_max) || conflict && self.interval > self.period
    }
}

/// Why a problem or a call is not well formed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProblemError {
    /// The number of sensors is zero or above [`MAX_SENSORS`].
    Sensors {
        /// The number given.
        sensors: usize,
    },
    /// The period is zero or above [`MAX_PERIOD`].
    Period {
        /// The period given, in ticks.
        period: u32,
    },
    /// A sensor could fire after its period has ended.
    OutsidePeriod {
        /// The sensor, counted from 0.
        sensor: usize,
        /// Its lag in ticks.
        lag: u32,
        /// The longest wait in ticks.
        wait_max: u32,
        /// The period in ticks.
        period: u32,
    },
    /// There is not one row of conflicts for each sensor.
    ConflictRows {
        /// Rows given.
        rows: usize,
        /// Sensors, so rows expected.
        sensors: usize,
    },
    /// A sensor conflicts with itself, with a sensor that does not exist, or only in one direction.
    Conflict {
        /// The sensor whose row says so, counted from 0.
        x: usize,
        /// The sensor named by it, counted from 0.
        y: usize,
    },
    /// A slice lent or given by the caller is too short.
    Short {
        /// What it is.
        what: &'static str,
        /// Its length.
        given: usize,
        /// The length needed.
        needed: usize,
    },
    /// A pair of waits to rearrange lies above `wait_max`.
    Pair {
        /// The index of the pair, counted from 0.
        pair: usize,
        /// The longer of its waits, in ticks.
        wait: u32,
        /// The longest wait allowed, in ticks.
        wait_max: u32,
    },
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Sensors { sensors } => write!(f, "{sensors} sensors; between 1 and {MAX_SENSORS} are expected"),
            Self::Period { period } => write!(f, "period of {period} ticks; between 1 and {MAX_PERIOD} are expected"),
            Self::OutsidePeriod { sensor, lag, wait_max, period } => write!(
                f,
                "sensor {} has lag {lag} and waits up to {wait_max} ticks; their sum must be below the period of {period}",
                sensor + 1
            ),
            Self::ConflictRows { rows, sensors } => {
                write!(f, "{rows} rows of conflicts; one for each of {sensors} sensors is expected")
            }
            Self::Conflict { x, y } if x == y => {
                write!(f, "sensor {} conflicts with itself", x + 1)
            }
            Self::Conflict { x, y } => {
                write!(
                    f,
                    "sensor {} conflicts with sensor {}, which does not exist or does not conflict with it",
                    x + 1,
                    y + 1
                )
            }
            Self::Short { what, given, needed } => write!(f, "{what} has length {given}; at least {needed} is needed"),
            Self::Pair { pair, wait, wait_max } => {
                write!(f, "pair {} has a wait of {wait} ticks; at most {wait_max} is allowed", pair + 1)
            }
        }
    }
}

impl core::error::Error for ProblemError {}

/// A checked [`Problem`], ready to be asked.
#[derive(Debug, Clone, Copy)]
pub struct Search<'a> {
    problem: Problem<'a>,
}

impl<'a> Search<'a> {
    /// Checks the problem.
    ///
    /// # Errors
    /// [`ProblemError`] for a number of sensors, period, lag or conflict outside its range. An infeasible problem is not an
    /// error: the searches prove it.
    pub fn new(problem: Problem<'a>) -> Result<Self, ProblemError> {
        let Problem { period, lag, wait_max, conflicts, .. } = problem;
        let sensors = lag.len();
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(ProblemError::Sensors { sensors });
        }
        if period == 0 || period > MAX_PERIOD {
            return Err(ProblemError::Period { period });
        }
        for (sensor, &lag) in lag.iter().enumerate() {
            if u64::from(lag) + u64::from(wait_max) >= u64::from(period) {
                return Err(ProblemError::OutsidePeriod { sensor, lag, wait_max, period });
            }
        }
        if conflicts.len() != sensors {
            return Err(ProblemError::ConflictRows { rows: conflicts.len(), sensors });
        }
        for (x, &row) in conflicts.iter().enumerate() {
            for y in Bits(row) {
                let back = conflicts.get(y).is_some_and(|row| row >> x & 1 == 1);
                if x == y || !back {
                    return Err(ProblemError::Conflict { x, y });
                }
            }
        }
        Ok(Self { problem })
    }

    /// The problem as given.
    #[must_use]
    pub const fn problem(&self) -> &Problem<'a> {
        &self.problem
    }

    /// The number of sensors `K`.
    #[must_use]
    pub const fn sensors(&self) -> usize {
        self.problem.lag.len()
    }

    /// The same problem with another separation and interval.
    #[must_use]
    pub const fn with(&self, separation: u32, interval: u32) -> Self {
        Self { problem: Problem { separation, interval, ..self.problem } }
    }

    /// The smallest interval between firings of conflicting sensors for these waits, in ticks, at most the period (which it
    /// is when nothing conflicts). Zero if there are fewer waits than sensors.
    #[must_use]
    pub fn smallest_interval(&self, a: &[u32], b: &[u32]) -> u32 {
        let Problem { period, lag, conflicts, .. } = self.problem;
        let mut smallest = period;
        for (i, &row) in conflicts.iter().enumerate() {
            for j in Bits(row).take_while(|&j| j < i) {
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
    #[must_use]
    pub fn separation_of(&self, a: &[u32], b: &[u32]) -> u32 {
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

    fn needs(what: &'static str, given: usize, needed: usize) -> Result<(), ProblemError> {
        if given < needed { Err(ProblemError::Short { what, given, needed }) } else { Ok(()) }
    }
}

/// The least distance between a firing of x and one of y on the circle of two periods; `x` and `y` are the firing times within
/// phase a and phase b.
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

/// The set bits of a row, lowest first.
struct Bits(u64);

impl Iterator for Bits {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let bit = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(bit)
    }
}
