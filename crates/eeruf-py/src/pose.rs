//! A robot's pose and motion from Python's arguments.

use eeruf_sim::{Motion, Point, Pose, Vector, world::heading_rad};
use pyo3::prelude::*;

use crate::arguments::{in_radians, items, number, number_or, points, shown, wrong};

/// A pose as Python gives it: (x, y, heading).
pub(crate) type PoseOf = (f64, f64, f64);

/// A heading of at most two turns: a larger one is probably in degrees.
pub(crate) fn heading(name: &str, given: f64) -> PyResult<f64> {
    in_radians(name, given, 4.0 * core::f64::consts::PI)
}

pub(crate) fn pose_of(name: &str, value: &Bound<'_, PyAny>) -> PyResult<PoseOf> {
    let expected = "(x, y, heading) in metres and radians";
    let coordinates = items(name, value, expected)?;
    let [x, y, heading] = &coordinates[..] else { return Err(wrong(name, shown(value), expected)) };
    let coordinate = |index: usize, value| number(&format!("{name}[{index}]"), value, -1e5..=1e5);
    Ok((coordinate(0, x)?, coordinate(1, y)?, self::heading(&format!("{name}[2]"), coordinate(2, heading)?)?))
}

/// A point (x, y) in metres.
pub(crate) fn point_of(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Point> {
    let expected = "a point (x, y) in metres";
    let coordinates = items(name, value, expected)?;
    let [x, y] = &coordinates[..] else { return Err(wrong(name, shown(value), expected)) };
    let coordinate = |index: usize, value| number(&format!("{name}[{index}]"), value, -1e5..=1e5);
    Ok(Point::new(coordinate(0, x)?, coordinate(1, y)?))
}

pub(crate) fn to_pose((x, y, heading): PoseOf) -> Pose {
    Pose::new(Vector::new(x, y), heading)
}

pub(crate) fn from_pose(pose: &Pose) -> PoseOf {
    (pose.translation.x, pose.translation.y, heading_rad(pose))
}

/// Reads a motion from keyword arguments.
pub(crate) fn motion(
    velocity_m_s: Option<&Bound<'_, PyAny>>,
    turn_rad_s: Option<&Bound<'_, PyAny>>,
    waypoints_m: Option<&Bound<'_, PyAny>>,
    speed_m_s: Option<&Bound<'_, PyAny>>,
) -> PyResult<Motion> {
    match (velocity_m_s, turn_rad_s, waypoints_m, speed_m_s) {
        (None, None, None, None) => Ok(Motion::Still),
        (velocity, turn, None, None) => {
            let velocity = match velocity.map(|value| points("velocity_m_s", value)).transpose()?.as_deref() {
                None => Vector::zeros(),
                Some([velocity]) => velocity.coords,
                Some(_) => {
                    let given = velocity.map(shown).unwrap_or_default();
                    return Err(wrong("velocity_m_s", given, "(x, y) in m/s"));
                }
            };
            let turn_rad_s = number_or("turn_rad_s", turn, 0.0, -50.0..=50.0)?;
            Ok(Motion::Constant { velocity, turn_rad_s })
        }
        (None, None, Some(waypoints), Some(speed)) => {
            let points = points("waypoints_m", waypoints)?;
            Ok(Motion::Waypoints { points, speed_m_s: number("speed_m_s", speed, 0.0..=50.0)? })
        }
        (.., waypoints, speed) => {
            let name = if waypoints.is_some() { "waypoints_m" } else { "speed_m_s" };
            let given = waypoints.or(speed).map(shown).unwrap_or_default();
            Err(wrong(name, given, "waypoints_m and speed_m_s, or velocity_m_s, turn_rad_s or both"))
        }
    }
}
