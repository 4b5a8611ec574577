//! The robot of a ring file in the form that scenes take: poses and modules of its sensors, and their limits.

use eeruf_core::{Micros, SensorLimits};
use eeruf_modules::Module;

/// Position and heading on a robot, or of a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Distance ahead, in metres.
    pub x_m: f64,
    /// Distance to the left, in metres.
    pub y_m: f64,
    /// Counter-clockwise from straight ahead, in radians.
    pub heading_rad: f64,
}

/// Returns poses spaced evenly on an arc of a circle about the origin, facing outwards: the first at `first_rad` from
/// straight ahead, each next one `spacing_rad` further.
pub fn arc(sensors: usize, radius_m: f64, first_rad: f64, spacing_rad: f64) -> impl Iterator<Item = Pose> {
    (0..sensors).map(move |sensor| {
        let heading_rad = first_rad + spacing_rad * sensor as f64;
        Pose { x_m: radius_m * libm::cos(heading_rad), y_m: radius_m * libm::sin(heading_rad), heading_rad }
    })
}

/// The robot of a ring file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotRing {
    /// Number of sensors, 1 to 64.
    pub sensors: usize,
    /// Position of each sensor on the robot; empty if the file gives none.
    pub poses: Vec<Pose>,
    /// Height of each sensor above the floor in metres; empty if the file gives none.
    pub heights_m: Vec<f64>,
    /// The module of each sensor; empty if the file names none.
    pub modules: Vec<Module>,
    /// Window and `T_delta` of each sensor.
    pub limits: Vec<SensorLimits>,
    /// Sets of sensors that fire together, bit x for sensor x.
    pub together: Vec<u64>,
    /// The speed in m/s that `T_delta` must also cover, without odometry.
    pub speed_m_s: f64,
    /// Number of adjacent sensors that must not fire close together.
    pub neighbours: u8,
    /// Largest change of a foreign sound's path from one reading to the next; `None` for `T_delta`.
    pub path_change: Option<Micros>,
    /// Time for which sound is audible; `None` for the modules' own.
    pub audible: Option<Micros>,
}
