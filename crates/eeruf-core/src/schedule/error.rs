//! Reasons why raw numbers do not make a schedule.

use core::fmt;

use super::limits::{MAX_PERIOD, MAX_PHASES, Phase};
use crate::time::Micros;

/// Reason why raw numbers do not make a [`Schedule`](crate::Schedule), or schedules do not make a ladder for
/// [`Adaptation`](crate::adaptation::Adaptation). `{:#}` counts from 0 where `{}` counts from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ScheduleError {
    /// No sensors, or more than fit.
    Sensors {
        /// The number given.
        sensors: usize,
        /// The number that fits.
        capacity: usize,
    },
    /// No phase, or more than eight.
    Phases {
        /// The number given.
        phases: usize,
    },
    /// A phase lists waits for more or fewer sensors than there are lags.
    Waits {
        /// The phase.
        phase: Phase,
        /// Number of waits in the phase.
        waits: usize,
        /// Number of sensors.
        sensors: usize,
    },
    /// The period is zero or beyond [`MAX_PERIOD`].
    Period {
        /// The period given.
        period: Micros,
    },
    /// A sensor would fire after its period has ended.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase.
        phase: Phase,
        /// `T_lag + T_wait`.
        t_fire: Micros,
        /// The period.
        period: Micros,
    },
    /// A scale with a zero denominator.
    Scale {
        /// The numerator.
        num: u32,
    },
    /// A ladder of schedules has no rung.
    NoRung,
    /// A rung of a ladder is not slower than the previous one.
    RungOrder {
        /// The rung.
        rung: usize,
        /// The period.
        period: Micros,
        /// The period of the previous rung.
        before: Micros,
    },
    /// A rung of a ladder does not have as many sensors as the first.
    RungSensors {
        /// The rung.
        rung: usize,
        /// Number of sensors of the rung.
        sensors: usize,
        /// Number of sensors of the first rung.
        expected: usize,
    },
}

impl ScheduleError {
    /// The kind of error as fixed text, for compile-time checks, which cannot print numbers.
    pub const fn as_str(&self) -> &'static str {
        match self {
            Self::Sensors { .. } => "a schedule has 1 to 64 sensors",
            Self::Phases { .. } => "a schedule has 1 to 8 phases",
            Self::Waits { .. } => "each phase needs one wait for each sensor",
            Self::Period { .. } => "a period is 1 us to 268 s",
            Self::Fire { .. } => "each sensor must fire inside its period: t_lag + t_wait < period",
            Self::Scale { .. } => "a scale needs a denominator above zero",
            Self::NoRung => "a ladder needs a schedule",
            Self::RungOrder { .. } => "each rung of a ladder needs a longer period than the one before",
            Self::RungSensors { .. } => "each rung of a ladder needs as many sensors as the first",
        }
    }
}

impl fmt::Display for ScheduleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = u8::from(!f.alternate());
        match *self {
            Self::Sensors { sensors, capacity } => write!(f, "{sensors} sensors; expected 1 to {capacity}"),
            Self::Phases { phases } => write!(f, "{phases} phases; expected 1 to {MAX_PHASES}"),
            Self::Waits { phase, waits, sensors } => {
                write!(f, "phase {phase} has {waits} waits; expected one for each of {sensors} sensors")
            }
            Self::Period { period } => write!(f, "a period of {period}; expected 1 us to {MAX_PERIOD}"),
            Self::Fire { sensor, phase, t_fire, period } => write!(
                f,
                "sensor {} fires {t_fire} into phase {phase}; expected less than the period of {period}",
                sensor + first
            ),
            Self::Scale { num } => write!(f, "a scale of {num}/0; expected a denominator above zero"),
            Self::NoRung => f.write_str("a ladder without schedules; expected at least one"),
            Self::RungOrder { rung, period, before } => write!(
                f,
                "rung {} has a period of {period}; expected more than the {before} before it",
                rung + usize::from(first)
            ),
            Self::RungSensors { rung, sensors, expected } => write!(
                f,
                "rung {} has {sensors} sensors; expected {expected} as in the first",
                rung + usize::from(first)
            ),
        }
    }
}

impl core::error::Error for ScheduleError {}
