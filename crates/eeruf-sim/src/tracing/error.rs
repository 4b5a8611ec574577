//! Errors of a query for paths. Receivers are counted from 0.

use core::fmt;

use super::limits::MAX_ORDER;
use crate::scene::Contact;

/// Reason why a query for paths fails.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathsError {
    /// The source is not a number or is out of the scene's reach.
    Source {
        /// The position in metres.
        at: [f64; 2],
        /// Distance from the walls to which the scene extends, in metres.
        reach_m: f64,
    },
    /// A receiver is not a number or is out of the scene's reach.
    Receiver {
        /// Index of the receiver.
        receiver: usize,
        /// The position in metres.
        at: [f64; 2],
        /// Distance from the walls to which the scene extends, in metres.
        reach_m: f64,
    },
    /// A source or a receiver is inside a solid object.
    Inside {
        /// The position in metres.
        at: [f64; 2],
        /// The object around the position.
        what: Contact,
    },
    /// A source or a receiver is not between floor and ceiling.
    Height {
        /// The height in metres.
        height_m: f64,
        /// Height of the ceiling, in metres.
        ceiling_m: f64,
    },
    /// The requested order is above [`MAX_ORDER`].
    Order {
        /// The requested order.
        max_order: u32,
    },
    /// The requested longest path is not a positive number (infinity is allowed).
    Length {
        /// The requested length, in metres.
        max_length_m: f64,
    },
    /// The scene has more beams or paths of this order than fit into the budget.
    Budget {
        /// The budget that was exceeded.
        beams: usize,
    },
    /// A robot's body touches an object, or a sensor of another robot, in a simulation.
    Body {
        /// The robot, counted from 0 and printed from 1.
        robot: usize,
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
            Self::Inside { at: [x, y], what } => {
                write!(f, "a sensor at ({x}, {y}) m is inside ")?;
                match what {
                    Contact::Wall(wall) => write!(f, "wall {wall}")?,
                    Contact::Pole(pole) => write!(f, "pole {pole}")?,
                    Contact::Solid => f.write_str("a wall or outside the room")?,
                }
                f.write_str("; expected it in the open")
            }
            Self::Height { height_m, ceiling_m } => {
                write!(
                    f,
                    "a sensor is {height_m} m high; expected more than 0 and less than the ceiling's {ceiling_m} m"
                )
            }
            Self::Order { max_order } => {
                write!(f, "paths up to order {max_order}; expected at most {MAX_ORDER}")
            }
            Self::Length { max_length_m } => write!(f, "paths up to {max_length_m} m; expected a positive length"),
            Self::Body { robot } => write!(
                f,
                "the body of robot {} touches a wall, a pole, another robot's body or one of its sensors; expected it \
                 clear of them",
                robot + 1
            ),
            Self::Stopped => f.write_str("stopped"),
            Self::Budget { beams } => write!(f, "more than {beams} beams; lower the order or the longest path"),
        }
    }
}

impl core::error::Error for PathsError {}
