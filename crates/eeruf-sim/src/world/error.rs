//! Errors of building a world.

use core::fmt;

use eeruf_core::{MAX_SENSORS, Micros};

use super::robot::MAX_ROBOTS;
use crate::scene::{Contact, SceneError};
use crate::tracing::MAX_ORDER;

/// Error of building a world. Robots are counted from 0 in code and with `{:#}`, but from 1 with `{}`. Walls and poles
/// are counted from 0, as in files.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorldError {
    /// The scene is invalid.
    Scene(SceneError),
    /// There are no robots, or too many.
    Robots {
        /// The number given.
        robots: usize,
    },
    /// A robot has no sensors, or too many.
    Sensors {
        /// The robot.
        robot: usize,
        /// Number of sensors of the robot.
        sensors: usize,
    },
    /// A number is invalid.
    Field {
        /// The robot.
        robot: usize,
        /// The field, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// A fault is invalid.
    Fault {
        /// The fault.
        fault: usize,
        /// The key, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// A schedule is for another number of sensors.
    Schedule {
        /// The robot.
        robot: usize,
        /// Number of sensors of the schedule.
        sensors: usize,
        /// Number of sensors of the robot.
        expected: usize,
    },
    /// A sensor would fire again while it still listens.
    Window {
        /// The robot.
        robot: usize,
        /// The requested window.
        window: Micros,
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
    },
    /// A robot starts inside an object.
    Contact {
        /// The robot.
        robot: usize,
        /// The object that the robot touches.
        contact: Contact,
        /// The radius in metres of the disc that stands for a robot without a body.
        disc_m: Option<f64>,
    },
    /// A sensor starts inside an object.
    SensorContact {
        /// The robot.
        robot: usize,
        /// The sensor.
        sensor: usize,
        /// The object around the sensor.
        contact: Contact,
    },
    /// A sensor starts inside another robot's body.
    SensorInside {
        /// The sensor's robot.
        robot: usize,
        /// The sensor.
        sensor: usize,
        /// The other robot.
        of: usize,
    },
    /// The bodies of two robots overlap.
    Bodies {
        /// The robots.
        robots: (usize, usize),
    },
    /// A number of the physics is invalid.
    Physics {
        /// The field, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// Two robots start one inside the other.
    Overlap {
        /// The robots.
        robots: (usize, usize),
        /// Distance between their centres, in metres.
        apart_m: f64,
        /// Least allowed distance between the centres, in metres.
        least_m: f64,
    },
    /// A number of the noise is invalid.
    Noise {
        /// The field, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// An order is above the limit for paths.
    Order {
        /// The requested order.
        max_order: u32,
    },
}

impl From<SceneError> for WorldError {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = usize::from(!f.alternate());
        match *self {
            Self::Scene(error) => error.fmt(f),
            Self::Robots { robots } => write!(f, "{robots} robots; expected 1 to {MAX_ROBOTS}"),
            Self::Sensors { robot, sensors } => {
                write!(f, "robot {} has {sensors} sensors; expected 1 to {MAX_SENSORS}", robot + first)
            }
            Self::Field { robot, field, value, expected } => {
                write!(f, "robot {}: {field} is {value}; expected {expected}", robot + first)
            }
            Self::Fault { fault, field, value, expected } => {
                write!(f, "fault {}: {field} is {value}; expected {expected}", fault + first)
            }
            Self::Schedule { robot, sensors, expected } => {
                write!(f, "robot {}: a schedule for {sensors} sensors; expected one for its {expected}", robot + first)
            }
            Self::Window { robot, window, min_refire } => write!(
                f,
                "robot {}: window_us is {}; expected at most {}, after which a sensor of its schedule fires again",
                robot + first,
                window.as_micros(),
                min_refire.as_micros()
            ),
            Self::Contact { robot, contact, disc_m } => {
                let robot = robot + first;
                match contact {
                    Contact::Wall(wall) => write!(f, "robot {robot} touches wall {wall}")?,
                    Contact::Pole(pole) => write!(f, "robot {robot} touches pole {pole}")?,
                    Contact::Solid => write!(f, "robot {robot} is inside a wall or outside the room")?,
                }
                write!(f, "; expected it to stand free at its pose")?;
                disc_m.map_or(Ok(()), |radius_m| {
                    let likely =
                        if radius_m > 2.0 { "likely centimetres or millimetres in its ring; else " } else { "" };
                    write!(
                        f,
                        ". It has no body, so it takes up a disc of {radius_m:.3} m, which holds all its sensors: \
                         {likely}give its own outline, such as body = {{ box_m = [0.4, 0.3] }} in a file"
                    )
                })
            }
            Self::Overlap { robots: (one, other), apart_m, least_m } => write!(
                f,
                "robots {} and {} are {apart_m:.3} m apart; expected more than {least_m:.3} m, the sum of their radii",
                one + first,
                other + first
            ),
            Self::SensorContact { robot, sensor, contact } => {
                write!(f, "robot {}: sensor {} is inside ", robot + first, sensor + first)?;
                match contact {
                    Contact::Wall(wall) => write!(f, "wall {wall}")?,
                    Contact::Pole(pole) => write!(f, "pole {pole}")?,
                    Contact::Solid => write!(f, "a wall or outside the room")?,
                }
                write!(f, "; expected it in the open")
            }
            Self::SensorInside { robot, sensor, of } => write!(
                f,
                "robot {}: sensor {} is inside robot {}; expected it in the open",
                robot + first,
                sensor + first,
                of + first
            ),
            Self::Bodies { robots: (one, other) } => {
                write!(f, "the bodies of robots {} and {} overlap; expected them apart", one + first, other + first)
            }
            Self::Physics { field, value, expected } => write!(f, "physics: {field} is {value}; expected {expected}"),
            Self::Noise { field, value, expected } => write!(f, "noise: {field} is {value}; expected {expected}"),
            Self::Order { max_order } => write!(f, "max_order is {max_order}; expected at most {MAX_ORDER}"),
        }
    }
}

impl core::error::Error for WorldError {}
