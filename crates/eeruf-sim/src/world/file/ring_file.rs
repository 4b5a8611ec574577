//! Robots out of ring files, whose reader the caller brings: it knows more of rings than a simulator needs.

use std::path::Path;

use eeruf_core::{MAX_SENSORS, Micros, Phase, SensorLimits};
use eeruf_files::FileError;
use eeruf_modules::Module;

use crate::{acoustics::Transducer, geometry::Pose, scene::Air, world::robot::Robot};

/// The robot of a ring file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotRing {
    /// Number of sensors, 1 to 64.
    pub sensors: usize,
    /// Where each stands on the robot; empty if the file does not say it.
    pub poses: Vec<Pose>,
    /// Height of each above the floor in metres; empty if the file does not say it.
    pub heights_m: Vec<f64>,
    /// The module of each sensor; empty if the file names none.
    pub modules: Vec<Module>,
    /// Window and `T_delta` of each sensor.
    pub limits: Vec<SensorLimits>,
    /// Sets of sensors that fire together, bit x for sensor x.
    pub together: Vec<u64>,
    /// Its speed in m/s, which `T_delta` must cover too where it has no odometry.
    pub speed_m_s: f64,
    /// Number of adjacent sensors that must not fire close together.
    pub neighbours: u8,
    /// Change of the path of a foreign sound from one reading to the next, at most; `None` for `T_delta`.
    pub path_change: Option<Micros>,
    /// Time for which sound is audible; `None` for what modules say.
    pub audible: Option<Micros>,
}

/// A reader of ring files: from the file and its text to the robot.
pub type ReadRing = fn(&Path, &str) -> Result<RobotRing, FileError>;

/// The reader of who has none.
pub(super) fn no_reader(file: &Path, _: &str) -> Result<RobotRing, FileError> {
    Err(FileError::new(
        file,
        "a ring file, which this reader of scenes does not know; expected a table with sensors, spacing_deg and \
         radius_m. `eeruf study` and Python read ring files",
    ))
}

impl RobotRing {
    /// The robot at a place, with its sensors where `poses` are, or else where the file has them.
    ///
    /// # Errors
    /// The key that is missing, or does not fit its number of sensors.
    pub fn robot(&self, pose: Pose, poses: Option<Vec<Pose>>) -> Result<Robot, String> {
        let heights_m = if poses.is_none() { self.heights_m.clone() } else { vec![] };
        let poses = poses.unwrap_or_else(|| self.poses.clone());
        if poses.is_empty() {
            return Err("it does not say where sensors stand; expected poses or spacing_deg and radius_m in it, or \
                        sensors beside it"
                .to_owned());
        }
        if poses.len() != self.sensors || self.sensors > MAX_SENSORS || self.limits.len() != self.sensors {
            return Err(format!("{} places of sensors; expected {}, as many as it has", poses.len(), self.sensors));
        }
        let mut robot = Robot::with_sensors(pose, poses, Transducer::POLAROID_6500)
            .with_modules(self.modules.clone())
            .with_heights(heights_m);
        robot.window = self.limits.iter().map(|limits| limits.window).max().unwrap_or(robot.window);
        robot.t_delta = self.limits.iter().map(|limits| limits.t_delta).max().unwrap_or(robot.t_delta);
        if self.limits.iter().any(|limits| *limits != self.limits[0]) {
            robot.limits = self.limits.clone();
        }
        robot.together = self.together.clone();
        robot.neighbours = self.neighbours;
        robot.path_change = self.path_change;
        robot.audible = self.audible.unwrap_or(robot.audible);
        Ok(robot)
    }
}

/// Adds to a robot's `T_delta`, and to its `path_change`, what its readings change from one firing of a sensor to the
/// next at most when it drives so fast without odometry: `2 v (T_p + max |d|) / c` by its schedule, or as much of its
/// period as the paper's waits span.
pub fn cover_motion(robot: &mut Robot, speed_m_s: f64) {
    let gap = robot.schedule.map_or_else(
        || Micros::new((u64::from(robot.period.as_micros()) * 5 / 4) as u32),
        |schedule| {
            let fires = |phase, sensor| schedule.t_fire(phase, sensor).unwrap_or_default();
            let apart = (0..schedule.sensors()).map(|x| fires(Phase::A, x).abs_diff(fires(Phase::B, x)));
            schedule.period().saturating_add(apart.max().unwrap_or_default())
        },
    );
    let more = (2.0 * speed_m_s * f64::from(gap.as_micros()) / Air::default().speed_of_sound()).ceil();
    let more = Micros::new(more as u32);
    robot.t_delta = robot.t_delta.saturating_add(more);
    robot.path_change = robot.path_change.map(|change| change.saturating_add(more));
    for limits in &mut robot.limits {
        limits.t_delta = limits.t_delta.saturating_add(more);
    }
}
