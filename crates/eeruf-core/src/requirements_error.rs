//! [`RequirementsError`]: requirements that do not fit a ring.

use core::fmt;

use crate::schedule::MAX_SENSORS;

/// Reason why a [`Layout`](crate::Layout) or an [`Uneven`](crate::Uneven) does not fit a ring. Sensors are counted from
/// 0 here and printed from 1; `{:#}` counts from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RequirementsError {
    /// A pair of neighbours names a sensor out of range, or the same sensor twice.
    Neighbours {
        /// The two sensors, from 0.
        pair: (usize, usize),
        /// Number of sensors.
        sensors: usize,
    },
    /// The number of values differs from the number of sensors.
    Length {
        /// The name of the values.
        what: &'static str,
        /// Number of values.
        given: usize,
        /// Number of sensors.
        sensors: usize,
    },
    /// A pair names a sensor out of range, or the same sensor twice.
    Pair {
        /// The pair, from 0.
        pair: (usize, usize),
        /// Number of sensors.
        sensors: usize,
    },
    /// A pair has two intervals.
    PairTwice {
        /// The pair, from 0.
        pair: (usize, usize),
    },
    /// A set holds a sensor out of range, or fewer than two.
    Set {
        /// The name of the set.
        what: &'static str,
        /// The set, bit x for sensor x.
        set: u64,
        /// Number of sensors.
        sensors: usize,
    },
    /// A sensor belongs to two groups that fire together.
    TwoGroups {
        /// The sensor, from 0.
        sensor: u8,
    },
}

/// Text of the error; `{:#}` counts sensors from 0 where `{}` counts from 1.
impl fmt::Display for RequirementsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = usize::from(!f.alternate());
        match *self {
            Self::Neighbours { pair: (x, y), sensors } => {
                let (x, y) = (x.saturating_add(first), y.saturating_add(first));
                write!(f, "sensors {x} and {y} as neighbours; expected two different ones of {sensors}")
            }
            Self::Length { what, given, sensors } => {
                write!(f, "{what}: {given} values; expected one for each of {sensors} sensors")
            }
            Self::Pair { pair: (x, y), sensors } => {
                write!(
                    f,
                    "intervals: sensors {} and {}; expected two different ones of {sensors}",
                    x + first,
                    y + first
                )
            }
            Self::PairTwice { pair: (x, y) } => {
                write!(f, "intervals: sensors {} and {} twice; expected each pair once", x + first, y + first)
            }
            Self::Set { what, set, sensors } => {
                write!(f, "{what}: sensors")?;
                for sensor in (0..MAX_SENSORS).filter(|sensor| set >> sensor & 1 == 1) {
                    write!(f, " {}", sensor + first)?;
                }
                write!(f, "; expected two or more different ones of {sensors}")
            }
            Self::TwoGroups { sensor } => {
                write!(f, "together: sensor {} is in two groups; expected one", usize::from(sensor) + first)
            }
        }
    }
}

impl core::error::Error for RequirementsError {}
