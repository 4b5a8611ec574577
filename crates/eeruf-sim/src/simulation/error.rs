//! Reasons why a simulation cannot be run.

use core::fmt;

use eeruf_core::{RingError, ScheduleError, conditions::Violation};

use crate::methods::{ChangeError, Method, OwnError, StartError};
use crate::results::Readings;
use crate::tracing::PathsError;
use crate::world::WorldError;

/// Reason why a simulation cannot be run. Robots are counted from 0 in code and with `{:#}`, but from 1 with `{}`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulationError {
    /// The method has no schedule for a robot.
    Schedule {
        /// The robot.
        robot: usize,
        /// The method.
        method: Method,
        /// Reason.
        error: ScheduleError,
    },
    /// A robot's ring cannot listen as requested under the method.
    Ring {
        /// The robot.
        robot: usize,
        /// The method.
        method: Method,
        /// Reason.
        error: RingError,
    },
    /// No schedule keeps a robot's `t_delta` and window with [`Method::Adaptive`].
    Unverified {
        /// The robot.
        robot: usize,
        /// The violation of the robot's own schedule.
        violation: Violation,
    },
    /// A robot's schedules do not form a ladder for [`Method::Adaptive`].
    Ladder {
        /// The robot.
        robot: usize,
        /// Reason.
        error: ScheduleError,
    },
    /// The median is of no readings, or of too many.
    Median {
        /// The number asked for.
        median_of: u8,
    },
    /// Paths could not be found, usually because a robot has moved out of the scene's reach.
    Paths {
        /// Time, in seconds.
        at_s: f64,
        /// Reason.
        error: PathsError,
    },
    /// There is not enough memory for this many readings.
    Memory {
        /// Number of readings.
        readings: u64,
    },
    /// The robot's number is out of range.
    Robot {
        /// The robot.
        robot: usize,
        /// Number of robots in the world.
        robots: usize,
    },
    /// A number is invalid.
    Number {
        /// The name of the number.
        what: &'static str,
        /// The number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// The caller's own firing method or filter has ended the simulation.
    Own {
        /// The robot.
        robot: usize,
        /// The part: firing or filter.
        what: &'static str,
        /// Time, in seconds.
        at_s: f64,
        /// Reason.
        error: OwnError,
    },
    /// A robot's ring fires by a method whose schedule cannot change.
    FixedSchedule {
        /// The robot.
        robot: usize,
        /// The method.
        method: Method,
    },
    /// The schedule is for another number of sensors than the robot has.
    Sensors {
        /// The robot.
        robot: usize,
        /// Number of sensors of the schedule.
        schedule: usize,
        /// Number of sensors of the robot.
        sensors: usize,
    },
    /// The object of a fault has no room in the scene at some time.
    Fault {
        /// Time, in seconds.
        at_s: f64,
        /// Reason.
        error: WorldError,
    },
    /// The caller asked to stop.
    Stopped,
}

impl SimulationError {
    /// Returns the error of a ring that cannot change its schedule.
    pub(super) fn change(robot: usize, method: Method, error: ChangeError) -> Self {
        match error {
            ChangeError::Fixed => Self::FixedSchedule { robot, method },
            ChangeError::Ring(error) => Self::Ring { robot, method, error },
        }
    }

    /// Returns the error of a ring that cannot be started.
    pub(super) fn start(robot: usize, method: Method, error: StartError) -> Self {
        match error {
            StartError::Ring(error) => Self::Ring { robot, method, error },
            StartError::Unverified(violation) => Self::Unverified { robot, violation },
            StartError::Ladder(error) => Self::Ladder { robot, error },
            StartError::Own(error) => Self::Own { robot, what: "firing", at_s: 0.0, error },
        }
    }

    /// Returns the error of paths that cannot be found at a time in true nanoseconds.
    pub(super) fn paths(at: u64, error: PathsError) -> Self {
        if error == PathsError::Stopped {
            return Self::Stopped;
        }
        Self::Paths { at_s: at as f64 * 1e-9, error }
    }
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = usize::from(!f.alternate());
        match self {
            Self::Schedule { robot, method, error } => {
                write!(f, "robot {}, method {method}: ", robot + first)?;
                error.fmt(f)
            }
            Self::Ring { robot, method, error } => write!(f, "robot {}, method {method}: {error}", robot + first),
            Self::Ladder { robot, error } => write!(f, "robot {}, method adaptive: {error}", robot + first),
            Self::Unverified { robot, violation } => {
                write!(f, "robot {}, method adaptive: {violation}", robot + first)
            }
            Self::Median { median_of } => write!(f, "the median of {median_of} readings; expected 1 to 15"),
            Self::Paths { at_s, error } => write!(f, "at {at_s:.3} s: {error}"),
            Self::Memory { readings } => {
                let needed = Readings::bytes_for(*readings).div_ceil(1_000_000);
                write!(
                    f,
                    "{readings} readings take {needed} MB; expected as many as fit into memory, or blocks of them"
                )
            }
            Self::Robot { robot, robots } => write!(f, "robot {}; expected one of {robots}", robot + first),
            Self::Number { what, value, expected } => write!(f, "{what} is {value}; expected {expected}"),
            Self::Own { robot, what, at_s, error } => {
                write!(f, "at {at_s:.3} s: the {what} of robot {}: {error}", robot + first)
            }
            Self::FixedSchedule { robot, method } => write!(
                f,
                "robot {} fires by {method} or by its own firing; expected a method with a schedule that can be \
                 changed",
                robot + first
            ),
            Self::Sensors { robot, schedule, sensors } => {
                write!(f, "robot {}: a schedule of {schedule} sensors; expected one of {sensors}", robot + first)
            }
            Self::Fault { at_s, error } => write!(f, "at {at_s} s a door or a leg has no room: {error}"),
            Self::Stopped => write!(f, "stopped"),
        }
    }
}

impl core::error::Error for SimulationError {}
