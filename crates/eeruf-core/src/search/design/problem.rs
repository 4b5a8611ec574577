//! What the sensors need, in ticks, and the check that the numbers make sense.
//!
//! Indices: `check` compares every row and every member of a row with the number of sensors before it looks there.

use core::fmt;

use crate::schedule::MAX_SENSORS;

/// The longest time the search computes with, in ticks (67 s of 1 us).
pub const MAX_TICKS: u32 = 1 << 26;

/// What the sensors need. All times are in ticks of the caller's choice.
///
/// With the firing times `a` and `b` of a sensor in the two phases, each in `0..period`, and `d = a - b`:
///
/// ```text
/// | |d_x| - |d_y| | >= separation                  for all sensors x != y (criterion exact, THEORY section 1)
/// 2 |d_x|           >= separation                  if stale_echo
/// period - |d_x|    >= window                      between two firings of one sensor
/// |t - u|           >= interval                    between firings t, u of conflicting sensors, also across the end of a phase
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
    /// Whether a sensor's own echo of the period before must be rejected too.
    pub stale_echo: bool,
}

/// Why a [`Problem`] or a question about it makes no sense. Sensors are counted from 0 here and printed from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProblemError {
    /// The number of sensors is 0 or above [`MAX_SENSORS`].
    Sensors(usize),
    /// There is not one row of conflicts for each sensor.
    Rows {
        /// Rows given.
        rows: usize,
        /// Sensors of the problem.
        sensors: usize,
    },
    /// A sensor conflicts with a sensor that does not exist.
    UnknownSensor {
        /// The row.
        sensor: usize,
        /// The bit.
        other: usize,
    },
    /// A sensor conflicts with itself.
    SelfConflict(usize),
    /// x conflicts with y, but y not with x.
    OneSided {
        /// x.
        sensor: usize,
        /// y.
        other: usize,
    },
    /// The separation is 0: near-identical readings differ by at most `t_delta`, so different ones by at least one tick.
    NoSeparation,
    /// The times are too long for the search: even firing one by one takes more than [`MAX_TICKS`].
    TooLong {
        /// The period of firing one by one, in ticks.
        period: u64,
    },
    /// The period asked about is 0 or above [`MAX_TICKS`].
    Period(u32),
    /// The memory lent is too small.
    Memory {
        /// Words lent.
        words: usize,
        /// Words needed, see [`memory_words`](super::memory_words).
        needed: usize,
    },
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Sensors(sensors) => write!(f, "{sensors} sensors; expected 1 to {MAX_SENSORS}"),
            Self::Rows { rows, sensors } => {
                write!(f, "{rows} rows of conflicts for {sensors} sensors; expected one row for each sensor")
            }
            Self::UnknownSensor { sensor, other } => {
                write!(f, "sensor {} conflicts with sensor {}, which does not exist", sensor + 1, other + 1)
            }
            Self::SelfConflict(sensor) => {
                write!(f, "sensor {} conflicts with itself; expected conflicts with other sensors only", sensor + 1)
            }
            Self::OneSided { sensor, other } => write!(
                f,
                "sensor {} conflicts with sensor {}, but not the other way round; expected both or neither",
                sensor + 1,
                other + 1
            ),
            Self::NoSeparation => f.write_str("a separation of 0 ticks; expected at least 1 tick"),
            Self::TooLong { period } => {
                write!(
                    f,
                    "firing one by one already takes {period} ticks; expected at most {MAX_TICKS}, so use a coarser tick"
                )
            }
            Self::Period(period) => {
                write!(f, "a period of {period} ticks; expected 1 to {MAX_TICKS}")
            }
            Self::Memory { words, needed } => {
                write!(f, "{words} words of memory; expected at least {needed}")
            }
        }
    }
}

impl core::error::Error for ProblemError {}

impl<'a> Problem<'a> {
    /// Checks that the numbers make sense.
    ///
    /// # Errors
    /// The first thing found that does not; see [`ProblemError`].
    pub fn check(&self) -> Result<(), ProblemError> {
        let sensors = self.sensors;
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(ProblemError::Sensors(sensors));
        }
        if self.conflicts.len() != sensors {
            return Err(ProblemError::Rows { rows: self.conflicts.len(), sensors });
        }
        for (sensor, &row) in self.conflicts.iter().enumerate() {
            for other in Sensors(row) {
                if other >= sensors {
                    return Err(ProblemError::UnknownSensor { sensor, other });
                }
                if other == sensor {
                    return Err(ProblemError::SelfConflict(sensor));
                }
                if self.conflicts[other] >> sensor & 1 == 0 {
                    return Err(ProblemError::OneSided { sensor, other });
                }
            }
        }
        if self.separation == 0 {
            return Err(ProblemError::NoSeparation);
        }
        let period = one_by_one(sensors, self.separation, self.interval, self.window);
        if period > u64::from(MAX_TICKS) {
            return Err(ProblemError::TooLong { period });
        }
        Ok(())
    }

    /// The checked problem, or what is wrong with it.
    pub(crate) fn needs(&self) -> Result<Needs, ProblemError> {
        self.check()?;
        let mut conflicts = [0; MAX_SENSORS];
        for (row, &given) in conflicts.iter_mut().zip(self.conflicts) {
            *row = given;
        }
        // `check` bounds all of them by MAX_TICKS.
        Ok(Needs {
            sensors: self.sensors,
            conflicts,
            separation: self.separation as i32,
            interval: self.interval as i32,
            window: self.window as i32,
            least: if self.stale_echo { self.separation.div_ceil(2) as i32 } else { 0 },
        })
    }
}

/// A period at which firing one by one always works: see [`schedule::one_by_one`](super::schedule::one_by_one).
pub(crate) fn one_by_one(sensors: usize, separation: u32, interval: u32, window: u32) -> u64 {
    let (k, d, i) = (sensors as u64, u64::from(separation), u64::from(interval));
    (k * (d + i) + d).max(u64::from(window) + k * d)
}

/// A checked [`Problem`] with signed times, of which sums of a few cannot overflow.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Needs {
    pub(crate) sensors: usize,
    pub(crate) conflicts: [u64; MAX_SENSORS],
    pub(crate) separation: i32,
    pub(crate) interval: i32,
    pub(crate) window: i32,
    /// The smallest `|d|` allowed: half the separation with the stale-echo option, otherwise 0.
    pub(crate) least: i32,
}

impl Needs {
    pub(crate) fn conflict(&self, x: usize, y: usize) -> bool {
        self.conflicts[x] >> y & 1 == 1
    }

    /// The same needs in coarser ticks, with their length, if all are multiples of that.
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

/// Goes through the members of a bit set of sensors, lowest first.
#[derive(Clone, Copy)]
pub(crate) struct Sensors(pub(crate) u64);

impl Iterator for Sensors {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if self.0 == 0 {
            return None;
        }
        let sensor = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(sensor)
    }
}
