//! Directions that have a name in `MAVLink`.

/// Returns the angle between two directions, in degrees, 0 to 180.
fn between(one: f32, other: f32) -> f32 {
    let apart = (one - other).rem_euclid(360.0);
    apart.min(360.0 - apart)
}

/// Returns the `MAV_SENSOR_ORIENTATION`, 0 to 7, of one sensor, given all directions in degrees clockwise from ahead.
/// `None` if no value fits, or if another sensor faces the same 45 degrees: `ArduPilot` keeps one distance for each
/// eighth, so each `DISTANCE_SENSOR` would replace the value from `OBSTACLE_DISTANCE`.
pub fn rotation(yaws_deg: &[f32], sensor: usize) -> Option<u8> {
    let eighth = (yaws_deg.get(sensor)? / 45.0).round();
    let named = |yaw| between(yaw, 45.0 * eighth);
    let alone = yaws_deg.iter().enumerate().all(|(other, &yaw)| other == sensor || named(yaw) > 22.5);
    (alone && named(*yaws_deg.get(sensor)?) < 0.5).then_some(eighth.rem_euclid(8.0) as u8)
}
