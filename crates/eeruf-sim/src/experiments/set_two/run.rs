//! Outcome of one course under one method.

use serde::{Deserialize, Deserializer, Serialize};

/// End of a course.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The robot crossed the finishing line.
    Finished,
    /// The robot touched a pole or a wall.
    Contact,
    /// The robot was still driving, or stuck, when the time was over.
    TimeOut,
}

/// Pose of a robot at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrackPoint {
    /// Time in seconds.
    pub time_s: f64,
    /// Position along x, in metres.
    pub x_m: f64,
    /// Position along y, in metres.
    pub y_m: f64,
    /// Heading in radians.
    pub heading_rad: f64,
    /// Speed in m/s.
    pub speed_m_s: f64,
}

/// A cell of the grid that is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// The middle's x, in metres.
    pub x_m: f64,
    /// The middle's y, in metres.
    pub y_m: f64,
    /// The certainty, 1 to 15.
    pub value: u8,
}

/// Outcome of one course under one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Number of the course.
    pub course: u64,
    /// The end.
    pub ending: Ending,
    /// Time of driving, in seconds.
    pub time_s: f64,
    /// Distance driven, in metres.
    pub way_m: f64,
    /// The highest speed, in m/s.
    pub top_speed_m_s: f64,
    /// Least distance between the robot's outline and a pole, in metres; infinite if the robot never came near one,
    /// which is null in JSON.
    #[serde(deserialize_with = "infinite")]
    pub nearest_m: f64,
    /// Number of readings of the robot's sensors.
    pub readings: u32,
    /// Number of readings that were not accepted.
    pub rejected: u32,
    /// Number of readings that were accepted and wrong.
    pub wrong: u32,
    /// Number of echoes that were entered into the grid where there is no object.
    pub phantom_echoes: u32,
    /// Number of cells of the grid that are certain at the end although there is no object.
    pub phantom_cells: u32,
    /// Number of poles the robot came near.
    pub poles_passed: u32,
    /// Number of poles passed that never had an echo entered into the grid.
    pub poles_missed: u32,
    /// The robot's poses on the way, every 30 ms.
    #[serde(default)]
    pub track: Vec<TrackPoint>,
    /// The grid at the end.
    #[serde(default)]
    pub grid: Vec<Cell>,
}

/// Reads a number, or null as infinity.
fn infinite<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Option::deserialize(deserializer).map(|number| number.unwrap_or(f64::INFINITY))
}

impl Run {
    /// Returns a course that has just begun; it times out unless something else happens.
    pub(super) fn begun(course: u64) -> Self {
        Self {
            course,
            ending: Ending::TimeOut,
            time_s: 0.0,
            way_m: 0.0,
            top_speed_m_s: 0.0,
            nearest_m: f64::INFINITY,
            readings: 0,
            rejected: 0,
            wrong: 0,
            phantom_echoes: 0,
            phantom_cells: 0,
            poles_passed: 0,
            poles_missed: 0,
            track: Vec::new(),
            grid: Vec::new(),
        }
    }
}
