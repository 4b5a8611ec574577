//! What can be wrong with a question about paths. Receivers are counted from 0.

use core::fmt;

use super::limits::MAX_ORDER;

/// Why a question about paths cannot be answered.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathsError {
    /// The source is not a number or lies out of the scene's reach.
    Source {
        /// Its position in metres.
        at: [f64; 2],
        /// How far from the walls the scene reaches, in metres.
        reach_m: f64,
    },
    /// A receiver is not a number or lies out of the scene's reach.
    Receiver {
        /// Index of the receiver.
        receiver: usize,
        /// Its position in metres.
        at: [f64; 2],
        /// How far from the walls the scene reaches, in metres.
        reach_m: f64,
    },
    /// The order asked for is above [`MAX_ORDER`].
    Order {
        /// What was asked for.
        max_order: u32,
    },
    /// The longest path asked for is not a positive number (infinity is allowed).
    Length {
        /// What was asked for, in metres.
        max_length_m: f64,
    },
    /// The scene has more beams or paths of this order than fit into the budget.
    Budget {
        /// The budget that was exceeded.
        beams: usize,
    },
    /// The caller asked to stop.
    Stopped,
}

impl fmt::Display for PathsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Source { at: [x, y], reach_m } => {
                write!(f, "the source is at ({x}, {y}) m; expected a point within {reach_m} m of the walls")
            }
            Self::Receiver { receiver, at: [x, y], reach_m } => {
                write!(f, "receiver {receiver} is at ({x}, {y}) m; expected a point within {reach_m} m of the walls")
            }
            Self::Order { max_order } => {
                write!(f, "paths up to order {max_order}; expected at most {MAX_ORDER}")
            }
            Self::Length { max_length_m } => write!(f, "paths up to {max_length_m} m; expected a positive length"),
            Self::Stopped => f.write_str("stopped"),
            Self::Budget { beams } => write!(f, "more than {beams} beams; lower the order or the longest path"),
        }
    }
}

impl core::error::Error for PathsError {}
