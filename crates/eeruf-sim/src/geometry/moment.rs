//! Where something is and how fast it goes, at one moment.

use super::plane::{Pose, Vector};

/// Pose and velocity at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Place and heading.
    pub pose: Pose,
    /// Velocity in the scene's frame, in m/s.
    pub velocity: Vector,
    /// Rate of turn in rad/s.
    pub turn_rad_s: f64,
}

impl Moment {
    /// The velocity in m/s of a point that the robot carries at `offset` from its middle, in the scene's frame.
    pub fn velocity_at(&self, offset: Vector) -> Vector {
        self.velocity + Vector::new(-offset.y, offset.x) * self.turn_rad_s
    }
}
