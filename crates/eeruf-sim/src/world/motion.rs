//! The pose and speed of a robot at a time.

use crate::geometry::{Moment, Point, Pose, Vector};

/// The fastest motion, in m/s and rad/s: a choice. No robot is faster, so a larger value is a mistake in the input.
pub const MAX_SPEED: f64 = 50.0;

/// Motion of a robot from its first pose on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Motion {
    /// The robot stands still.
    #[default]
    Still,
    /// The robot keeps a velocity and a rate of turn forever.
    Constant {
        /// Velocity in the scene's frame, in m/s.
        velocity: Vector,
        /// Rate of turn in rad/s, counter-clockwise.
        turn_rad_s: f64,
    },
    /// The robot drives in straight lines from its pose through these points, turns on the spot to face its direction,
    /// and stops at the last point.
    Waypoints {
        /// The points, in metres.
        points: Vec<Point>,
        /// The speed in m/s.
        speed_m_s: f64,
    },
}

impl Motion {
    /// Returns true if the robot never moves.
    pub fn is_still(&self) -> bool {
        match self {
            Self::Still => true,
            Self::Constant { velocity, turn_rad_s } => *velocity == Vector::zeros() && *turn_rad_s == 0.0,
            Self::Waypoints { points, speed_m_s } => points.is_empty() || *speed_m_s == 0.0,
        }
    }

    /// Returns pose and velocity `time_s` seconds after the robot was at `start`.
    ///
    /// ```
    /// use eeruf_sim::{Motion, Point, Pose, Vector};
    /// let points = vec![Point::new(2.0, 0.0), Point::new(2.0, 1.0)];
    /// let round_the_corner = Motion::Waypoints { points, speed_m_s: 0.5 };
    /// let moment = round_the_corner.at(&Pose::identity(), 5.0);
    /// assert!((moment.pose.translation.vector - Vector::new(2.0, 0.5)).norm() < 1e-12);
    /// assert!((moment.pose.rotation.angle() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    /// ```
    pub fn at(&self, start: &Pose, time_s: f64) -> Moment {
        let still = Moment { pose: *start, velocity: Vector::zeros(), turn_rad_s: 0.0 };
        match self {
            Self::Still => still,
            Self::Constant { velocity, turn_rad_s } => {
                let place = start.translation.vector + velocity * time_s;
                let pose = Pose::new(place, start.rotation.angle() + turn_rad_s * time_s);
                Moment { pose, velocity: *velocity, turn_rad_s: *turn_rad_s }
            }
            Self::Waypoints { points, speed_m_s } => {
                let mut left = speed_m_s * time_s;
                let mut from = start.translation.vector;
                let mut heading = start.rotation.angle();
                for point in points {
                    let way = point.coords - from;
                    let length = way.norm();
                    if length > 0.0 {
                        heading = libm::atan2(way.y, way.x);
                        if left < length {
                            let ahead = way / length;
                            let pose = Pose::new(from + ahead * left, heading);
                            return Moment { pose, velocity: ahead * *speed_m_s, turn_rad_s: 0.0 };
                        }
                    }
                    left -= length;
                    from = point.coords;
                }
                Moment { pose: Pose::new(from, heading), ..still }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_stops_at_its_last_waypoint() {
        let motion = Motion::Waypoints { points: vec![Point::new(1.0, 0.0), Point::new(1.0, 0.0)], speed_m_s: 1.0 };
        let end = motion.at(&Pose::identity(), 100.0);
        assert_eq!((end.pose.translation.vector, end.velocity), (Vector::new(1.0, 0.0), Vector::zeros()));
        assert_eq!(motion.at(&Pose::identity(), 0.5).velocity, Vector::new(1.0, 0.0));
    }

    // A sensor off the middle of a turning robot has a velocity of its own.
    #[test]
    fn off_centre_sensor_has_a_velocity_of_its_own() {
        let motion = Motion::Constant { velocity: Vector::new(0.5, 0.0), turn_rad_s: 2.0 };
        let moment = motion.at(&Pose::identity(), 0.0);
        assert_eq!(moment.velocity_at(Vector::new(0.0, 0.25)), Vector::new(0.0, 0.0));
        assert!(!motion.is_still() && Motion::default().is_still());
    }
}
