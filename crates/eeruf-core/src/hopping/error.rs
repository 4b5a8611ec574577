//! [`HoppingError`]: why a ring cannot hop as asked.

use core::fmt;

use crate::ring_error::RingError;
use crate::time::Micros;

/// Why a ring cannot hop as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum HoppingError {
    /// A code for no sensors, or for more than 64 or than the ring has room for.
    Sensors {
        /// The number asked for.
        sensors: usize,
        /// The most that there can be.
        most: usize,
    },
    /// A code with too few or too many phases.
    Phases {
        /// The number asked for.
        phases: u8,
    },
    /// A number of phases that is neither a prime, no less than the sensors, nor one less than a prime and above them.
    NotPrime {
        /// The number asked for.
        phases: u8,
        /// The next number that would do.
        next: u8,
    },
    /// The multiplier of sensor 0 is not below the number of phases.
    Multiplier {
        /// The multiplier asked for.
        first_multiplier: u8,
        /// Number of phases.
        phases: u8,
    },
    /// A step of 0, or of more than 65,535 us.
    Step {
        /// The step asked for.
        step: Micros,
    },
    /// Crosstalk that moves by one step would still support a track.
    TDelta {
        /// The tracker's `t_delta`.
        t_delta: Micros,
        /// The step of the code.
        step: Micros,
    },
    /// An echo would never be confirmed: each phase gives one vote.
    Votes {
        /// The tracker's `votes`.
        votes: u8,
        /// Number of phases of the code.
        phases: u8,
    },
    /// The period is too short for code and window, or longer than [`MAX_PERIOD`](crate::MAX_PERIOD).
    Period {
        /// The period asked for.
        period: Micros,
        /// The least that it may be.
        least: Micros,
    },
    /// Sensors would listen for longer than the tracker tells echoes apart.
    Window {
        /// The window asked for.
        window: Micros,
        /// The longest: [`HoppingListening::MAX_WINDOW`](super::HoppingListening::MAX_WINDOW).
        most: Micros,
    },
    /// With this lag a sensor would fire after its period has ended.
    Lag {
        /// The sensor, from 0.
        sensor: u8,
        /// Its lag.
        lag: Micros,
        /// The longest lag that leaves room for the code.
        most: Micros,
    },
    /// Redrawn lags do not keep the limits of single sensors and pairs.
    Shift {
        /// After how many readings that do not fit.
        shift_after: u8,
    },
    /// A ring in use changes to a schedule of another code.
    OtherCode,
    /// Settings by which the ring listens, or its tracker weighs readings.
    Ring(RingError),
}

impl From<RingError> for HoppingError {
    fn from(error: RingError) -> Self {
        Self::Ring(error)
    }
}

impl HoppingError {
    /// The kind of error as fixed text, for compile-time checks, which cannot print numbers.
    pub const fn as_str(&self) -> &'static str {
        match self {
            Self::Sensors { .. } => "a hopping schedule has 1 to 64 sensors, no more than it has room for",
            Self::Phases { .. } => "a code has 2 to 67 phases",
            Self::NotPrime { .. } => {
                "the number of phases must be a prime, no less than the sensors, or one less and above them"
            }
            Self::Multiplier { .. } => "the first multiplier must be less than the number of phases",
            Self::Step { .. } => "a step is 1 us to 65.535 ms",
            Self::TDelta { .. } => "t_delta must be less than the step",
            Self::Votes { .. } => "the tracker's votes must be no more than the phases",
            Self::Period { .. } => "the period must be longer than the code is wide, and no longer than 268 s",
            Self::Window { .. } => "a listening window is at most 16711.679 ms",
            Self::Lag { .. } => "each sensor must fire inside its period",
            Self::Shift { .. } => "lags stay where sensors have limits of their own",
            Self::OtherCode => "a ring in use keeps its code",
            Self::Ring(RingError::Setting { .. }) => "a setting of the tracker is out of its range",
            Self::Ring(_) => "the ring cannot listen like that",
        }
    }
}

impl fmt::Display for HoppingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = u8::from(!f.alternate());
        match *self {
            Self::Sensors { sensors, most } => write!(f, "{sensors} sensors; expected 1 to {most}"),
            Self::Phases { phases } => write!(f, "{phases} phases; expected 2 to 67"),
            Self::NotPrime { phases, next } => {
                write!(
                    f,
                    "{phases} phases; expected a prime that is no less than the sensors, such as {next}, or one less \
                     than a prime and above the sensors"
                )
            }
            Self::Multiplier { first_multiplier, phases } => {
                write!(f, "a first multiplier of {first_multiplier}; expected less than {phases}, the number of phases")
            }
            Self::Step { step } => write!(f, "a step of {step}; expected 1 us to 65.535 ms"),
            Self::TDelta { t_delta, step } => {
                write!(f, "a t_delta of {t_delta}; expected less than {step}, by which the code moves crosstalk")
            }
            Self::Votes { votes, phases } => {
                write!(f, "{votes} votes to confirm an echo; expected at most {phases}, the phases of the code")
            }
            Self::Period { period, least } => write!(f, "a period of {period}; expected {least} to 268435.456 ms"),
            Self::Window { window, most } => {
                write!(f, "a listening window of {window}; expected at most {most}")
            }
            Self::Lag { sensor, lag, most } => {
                write!(f, "a lag of {lag} for sensor {}; expected at most {most}", sensor + first)
            }
            Self::Shift { shift_after } => write!(
                f,
                "shift_after {shift_after}; expected 0 where sensors have limits of their own, which new lags would \
                 not keep"
            ),
            Self::OtherCode => f.write_str("a schedule of another code; expected that of the ring's own schedule"),
            Self::Ring(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for HoppingError {}
