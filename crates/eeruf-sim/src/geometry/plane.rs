//! Points and the few operations on them that other modules need. The types are nalgebra's; the cross product is an
//! orientation test.

use nalgebra::{Point2, Vector2};

/// A point of the plane, in metres.
pub type Point = Point2<f64>;
/// A displacement or direction in the plane.
pub type Vector = Vector2<f64>;
/// Position and heading of a robot or a transducer.
pub type Pose = nalgebra::Isometry2<f64>;

/// Converts a file's pose.
pub fn pose_of(pose: &eeruf_files::Pose) -> Pose {
    Pose::new(Vector::new(pose.x_m, pose.y_m), pose.heading_rad)
}

/// Distance in metres below which two points count as one, for example joined walls, duplicates of a path, or a source
/// on top of its receiver. A choice: above rounding errors in a room, below any real length.
pub const TOUCH_M: f64 = 1e-9;

/// Angle below which a direction lies on a beam's limit. Rounding stays under 1e-15 per bounce, so the figure separates
/// directions on the limit from real misses.
pub(crate) const SAME_DIRECTION: f64 = 1e-12;

/// Returns twice the signed area spanned by two vectors: positive when `b` points to the left of `a`.
#[inline(always)]
pub(crate) fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns the opposite of a direction in (-pi, pi], in the same range.
#[inline]
pub(crate) fn opposite(angle_rad: f64) -> f64 {
    use core::f64::consts::PI;
    if angle_rad > 0.0 { angle_rad - PI } else { angle_rad + PI }
}

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
    /// Returns the velocity in m/s of a point that the robot carries at `offset` from its middle, in the scene's frame.
    pub fn velocity_at(&self, offset: Vector) -> Vector {
        self.velocity + Vector::new(-offset.y, offset.x) * self.turn_rad_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_opposite_of_an_angle_is_in_the_half_open_circle() {
        use core::f64::consts::PI;
        assert_eq!((opposite(PI), opposite(0.0)), (0.0, PI));
    }
}
