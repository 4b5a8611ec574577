//! Checks that a robot is valid and touches nothing in its scene.

use eeruf_core::{MAX_PERIOD, MAX_SENSORS, Micros};

use super::clock::MAX_DRIFT_PPM;
use super::error::WorldError;
use super::motion::{MAX_SPEED, Motion};
use super::robot::Robot;
use crate::geometry::{Point, Pose};
use crate::scene::{Body, MAX_COORDINATE_M, Scene};

/// Returns true if a number is finite and its magnitude at most `most`.
fn within(value: f64, most: f64) -> bool {
    (-most..=most).contains(&value)
}

/// Checks that no robot stands inside an earlier one.
pub(super) fn check_apart(robots: &[Robot]) -> Result<(), WorldError> {
    for (other, robot) in robots.iter().enumerate() {
        for (one, before) in robots[..other].iter().enumerate() {
            if robot.body.is_some() || before.body.is_some() {
                check_bodies_apart([one, other], [before, robot])?;
                continue;
            }
            let apart_m = (robot.pose.translation.vector - before.pose.translation.vector).norm();
            let least_m = robot.radius_m() + before.radius_m();
            if apart_m <= least_m {
                return Err(WorldError::Overlap { robots: (one, other), apart_m, least_m });
            }
        }
    }
    Ok(())
}

/// Checks that two robots, at least one of them with a body, do not overlap, sensors included.
fn check_bodies_apart(index: [usize; 2], robots: [&Robot; 2]) -> Result<(), WorldError> {
    let [one, other] = robots;
    if one.outline().overlaps(&one.pose, &other.outline(), &other.pose) {
        return Err(WorldError::Bodies { robots: (index[0], index[1]) });
    }
    for (k, j) in [(0, 1), (1, 0)] {
        let Some(body) = robots[j].body else { continue };
        let inside =
            |sensor: &Pose| body.holds(&robots[j].pose, Point::from((robots[k].pose * sensor).translation.vector));
        if let Some(sensor) = robots[k].sensors.iter().position(inside) {
            return Err(WorldError::SensorInside { robot: index[k], sensor, of: index[j] });
        }
    }
    Ok(())
}

/// Checks that a robot's sensors are between floor and ceiling, if there are any.
pub(super) fn check_heights(scene: &Scene, index: usize, robot: &Robot) -> Result<(), WorldError> {
    let fail = |value, expected| Err(WorldError::Field { robot: index, field: "height_m", value, expected });
    if !robot.heights_m.is_empty() && robot.heights_m.len() != robot.sensors.len() {
        return fail(robot.heights_m.len() as f64, "one for all, or one for each sensor");
    }
    for sensor in 0..robot.sensors.len() {
        let height_m = robot.height_m(sensor);
        if !(height_m > 0.0 && height_m.is_finite() && scene.room().is_none_or(|room| room.holds(height_m))) {
            return fail(height_m, "more than 0, and less than the ceiling");
        }
    }
    Ok(())
}

/// Finds the first error of a robot.
pub(super) fn check(scene: &Scene, index: usize, robot: &Robot) -> Result<(), WorldError> {
    if robot.sensors.is_empty() || robot.sensors.len() > MAX_SENSORS {
        return Err(WorldError::Sensors { robot: index, sensors: robot.sensors.len() });
    }
    let fail = |field, value, expected| Err(WorldError::Field { robot: index, field, value, expected });
    let poses = [("pose", &robot.pose)].into_iter().chain(robot.sensors.iter().map(|sensor| ("sensors", sensor)));
    for (field, pose) in poses {
        for value in [pose.translation.x, pose.translation.y, pose.rotation.angle()] {
            if !within(value, MAX_COORDINATE_M) {
                return fail(field, value, "a number within 100000 m");
            }
        }
    }
    let speed = "at most 50 m/s and 50 rad/s";
    match &robot.motion {
        Motion::Still => {}
        Motion::Constant { velocity, turn_rad_s } => {
            for value in [velocity.x, velocity.y, *turn_rad_s] {
                if !within(value, MAX_SPEED) {
                    return fail("motion", value, speed);
                }
            }
        }
        Motion::Waypoints { points, speed_m_s } => {
            if !(0.0..=MAX_SPEED).contains(speed_m_s) {
                return fail("speed_m_s", *speed_m_s, speed);
            }
            for value in points.iter().flat_map(|point| [point.x, point.y]) {
                if !within(value, MAX_COORDINATE_M) {
                    return fail("waypoints_m", value, "a number within 100000 m");
                }
            }
        }
    }
    if !within(robot.clock.drift_ppm, MAX_DRIFT_PPM) {
        return fail("drift_ppm", robot.clock.drift_ppm, "-1000 to 1000");
    }
    for transducer in robot.transducers() {
        for (field, value) in [
            ("frequency_hz", transducer.frequency_hz),
            ("bandwidth_hz", transducer.bandwidth_hz),
            ("radius_m", transducer.radius_m),
            ("max_range_m", transducer.max_range_m),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return fail(field, value, "a positive number");
            }
        }
    }
    for (field, values) in [("module", robot.modules.len()), ("blanking_us", robot.blankings.len())] {
        if values != 0 && values != robot.sensors.len() {
            return fail(field, values as f64, "one for all, or one for each sensor");
        }
    }
    if let Some(coupling_db) = robot.coupling_db.filter(|db| !(-200.0..=0.0).contains(db)) {
        return fail("coupling_db", coupling_db, "-200 to 0");
    }
    for (field, value) in
        [("period_us", robot.period), ("window_us", robot.window), ("min_refire_us", robot.min_refire)]
    {
        if value == Micros::ZERO || value > MAX_PERIOD {
            return fail(field, f64::from(value.as_micros()), "1 to 268435456");
        }
    }
    if (0..robot.sensors.len()).any(|sensor| robot.window <= robot.blanking_of(sensor)) {
        return fail("window_us", f64::from(robot.window.as_micros()), "more than the blanking time");
    }
    if robot.neighbours == 0 || usize::from(robot.neighbours) > MAX_SENSORS {
        return fail("neighbours", f64::from(robot.neighbours), "1 to 64");
    }
    if !(2..=8).contains(&robot.consecutive) {
        return fail("consecutive", f64::from(robot.consecutive), "2 to 8");
    }
    check_heights(scene, index, robot)?;
    robot
        .firing
        .check(robot.sensors.len(), robot.window)
        .or_else(|(field, value, expected)| fail(field, value, expected))?;
    if robot.audible > MAX_PERIOD {
        return fail("audible_us", f64::from(robot.audible.as_micros()), "0 to 268435456");
    }
    // A ring does not accept larger values.
    if let Some(change) = robot.path_change.filter(|change| change.as_micros() >= u32::from(u16::MAX)) {
        return fail("path_change_us", f64::from(change.as_micros()), "0 to 65534");
    }
    for (sensor, limits) in robot.limits.iter().enumerate() {
        let window = limits.window;
        if robot.limits.len() != robot.sensors.len() {
            return fail("window_us", robot.limits.len() as f64, "one for all, or one for each sensor");
        }
        if window <= robot.blanking_of(sensor) || window <= limits.t_delta || window > robot.window {
            return fail("window_us", f64::from(window.as_micros()), "more than t_delta_us and the blanking time");
        }
    }
    if let Some(schedule) = &robot.schedule {
        if schedule.sensors() != robot.sensors.len() {
            let (sensors, expected) = (schedule.sensors(), robot.sensors.len());
            return Err(WorldError::Schedule { robot: index, sensors, expected });
        }
        if robot.limits.is_empty() && robot.window > schedule.min_refire() {
            return Err(WorldError::Window { robot: index, window: robot.window, min_refire: schedule.min_refire() });
        }
    }
    if robot.body.is_some_and(|body| !body.is_valid()) {
        return fail("body", f64::NAN, "measures above 0 and up to 100 m");
    }
    if let Some(contact) = scene.contact(&robot.outline(), &robot.pose) {
        let disc_m = robot.body.is_none().then(|| robot.radius_m());
        return Err(WorldError::Contact { robot: index, contact, disc_m });
    }
    // Sensors may stick out of a body; without a body they are within the disc that was just checked.
    for (sensor, pose) in robot.sensors.iter().enumerate().filter(|_| robot.body.is_some()) {
        if let Some(contact) = scene.contact(&Body::Disc(1e-6), &(robot.pose * pose)) {
            return Err(WorldError::SensorContact { robot: index, sensor, contact });
        }
    }
    Ok(())
}
