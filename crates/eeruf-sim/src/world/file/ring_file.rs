//! Robots from ring files. The caller supplies the reader, which knows more about rings than a simulator needs.

use std::path::Path;

use eeruf_core::{MAX_SENSORS, Micros, Phase};
use eeruf_files::{FileError, RobotRing};

use crate::{
    acoustics::Transducer,
    geometry::{Pose, pose_of},
    scene::Air,
    world::robot::Robot,
};

/// A reader of ring files: makes the robot from the file's path and text.
pub type ReadRing = fn(&Path, &str) -> Result<RobotRing, FileError>;

/// Always fails: it stands in for callers that have no reader of ring files.
pub(super) fn no_reader(file: &Path, _: &str) -> Result<RobotRing, FileError> {
    Err(FileError::new(
        file,
        "a ring file, which this reader of scenes does not know; expected a table with sensors, spacing_deg and \
         radius_m. `eeruf study` and Python read ring files",
    ))
}

impl Robot {
    /// Makes the robot of a ring file at a place, with its sensors at `poses` if given, or else at the file's poses.
    ///
    /// # Errors
    /// A missing key, or a key that does not fit the number of sensors.
    pub fn of_ring(ring: &RobotRing, pose: Pose, poses: Option<Vec<Pose>>) -> Result<Self, String> {
        let heights_m = if poses.is_none() { ring.heights_m.clone() } else { vec![] };
        let poses = poses.unwrap_or_else(|| ring.poses.iter().map(pose_of).collect());
        if poses.is_empty() {
            return Err("it does not say where sensors stand; expected poses or spacing_deg and radius_m in it, or \
                        sensors beside it"
                .to_owned());
        }
        if poses.len() != ring.sensors || ring.sensors > MAX_SENSORS || ring.limits.len() != ring.sensors {
            return Err(format!("{} places of sensors; expected {}, as many as it has", poses.len(), ring.sensors));
        }
        let mut robot = Self::with_sensors(pose, poses, Transducer::POLAROID_6500)
            .with_modules(ring.modules.clone())
            .with_heights(heights_m);
        robot.window = ring.limits.iter().map(|limits| limits.window).max().unwrap_or(robot.window);
        robot.t_delta = ring.limits.iter().map(|limits| limits.t_delta).max().unwrap_or(robot.t_delta);
        if ring.limits.iter().any(|limits| *limits != ring.limits[0]) {
            robot.limits = ring.limits.clone();
        }
        robot.together = ring.together.clone();
        robot.neighbours = ring.neighbours;
        robot.path_change = ring.path_change;
        robot.audible = ring.audible.unwrap_or(robot.audible);
        Ok(robot)
    }
}

/// Increases a robot's `T_delta` and `path_change` by the greatest change of readings between two firings of a sensor
/// at this speed without odometry: `2 v (T_p + max |d|) / c` by its schedule, or by the paper's waits at its period.
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
