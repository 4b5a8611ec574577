//! The platform of the paper's second set, TRC's `LabMate`: a box on two driven wheels, with limited speed, rate of
//! turn and acceleration.

use crate::{
    geometry::{Moment, Pose, Vector},
    scene::Body,
};

/// Limits of the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LabMate {
    /// Length and width, in metres.
    pub side_m: f64,
    /// The highest speed, in m/s.
    pub speed_max_m_s: f64,
    /// Largest change of the speed, in m/s^2.
    pub acceleration_m_s2: f64,
    /// The highest rate of turn, in rad/s.
    pub turn_max_rad_s: f64,
    /// Largest change of the rate of turn, in rad/s^2.
    pub turn_acceleration_rad_s2: f64,
}

impl Default for LabMate {
    /// 75 x 75 cm and at most 1 m/s, as in the paper. The other limits are a choice, typical of heavy platforms of this
    /// size: 1 m/s^2, 90 deg/s, 360 deg/s^2.
    fn default() -> Self {
        Self {
            side_m: 0.75,
            speed_max_m_s: 1.0,
            acceleration_m_s2: 1.0,
            turn_max_rad_s: 90f64.to_radians(),
            turn_acceleration_rad_s2: 360f64.to_radians(),
        }
    }
}

/// The pose and motion of a platform. Its two driven wheels can only carry it along its heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Driven {
    /// Place and heading.
    pub pose: Pose,
    /// Forward speed in m/s.
    pub speed_m_s: f64,
    /// Rate of turn in rad/s, counter-clockwise.
    pub turn_rad_s: f64,
}

impl Driven {
    /// Returns a platform at rest.
    pub fn at_rest(pose: Pose) -> Self {
        Self { pose, speed_m_s: 0.0, turn_rad_s: 0.0 }
    }

    /// Returns pose and velocity `after_s` seconds later, at constant speeds.
    pub fn moment(&self, after_s: f64) -> Moment {
        let pose = self.carried(after_s);
        let velocity = pose.rotation * Vector::new(self.speed_m_s, 0.0);
        Moment { pose, velocity, turn_rad_s: self.turn_rad_s }
    }

    /// Returns the pose after moving along the arc of both speeds, approximated by its chord: for the few milliseconds
    /// of a step the difference is far below a micrometre.
    fn carried(&self, for_s: f64) -> Pose {
        let heading = self.pose.rotation.angle();
        let turned = self.turn_rad_s * for_s;
        let (sin, cos) = libm::sincos(heading + 0.5 * turned);
        let way = Vector::new(cos, sin) * (self.speed_m_s * for_s);
        Pose::new(self.pose.translation.vector + way, heading + turned)
    }
}

impl LabMate {
    /// Returns the outline.
    pub fn body(&self) -> Body {
        Body::Box(self.side_m, self.side_m)
    }

    /// Drives for a short time towards a requested speed and rate of turn.
    ///
    /// ```
    /// use eeruf_sim::{Driven, LabMate, Pose};
    /// let (labmate, mut state) = (LabMate::default(), Driven::at_rest(Pose::identity()));
    /// for _ in 0..400 {
    ///     labmate.drive(&mut state, 5.0, 0.0, 0.005);
    /// }
    /// // Half a metre while it gathers speed in the first second, and a metre in the next.
    /// assert!((state.pose.translation.x - 1.5).abs() < 0.01 && state.speed_m_s == 1.0);
    /// ```
    pub fn drive(&self, state: &mut Driven, speed_m_s: f64, turn_rad_s: f64, for_s: f64) {
        let towards = |now: f64, wanted: f64, most: f64| now + (wanted - now).clamp(-most, most);
        let speed = speed_m_s.clamp(0.0, self.speed_max_m_s);
        let turn = turn_rad_s.clamp(-self.turn_max_rad_s, self.turn_max_rad_s);
        state.speed_m_s = towards(state.speed_m_s, speed, self.acceleration_m_s2 * for_s);
        state.turn_rad_s = towards(state.turn_rad_s, turn, self.turn_acceleration_rad_s2 * for_s);
        state.pose = state.carried(for_s);
    }

    /// Returns the distance from the outline to a point, in metres; negative inside.
    pub fn clearance_m(&self, pose: &Pose, point: nalgebra::Point2<f64>) -> f64 {
        let half = 0.5 * self.side_m;
        let local = pose.inverse_transform_point(&point);
        let (x, y) = (local.x.abs() - half, local.y.abs() - half);
        if x <= 0.0 && y <= 0.0 { x.max(y) } else { libm::hypot(x.max(0.0), y.max(0.0)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn it_turns_no_faster_and_brakes_no_harder_than_it_can() {
        let labmate = LabMate::default();
        let mut state = Driven { speed_m_s: 1.0, ..Driven::at_rest(Pose::identity()) };
        labmate.drive(&mut state, 0.0, 9.0, 0.1);
        assert!((state.speed_m_s - 0.9).abs() < 1e-12);
        assert!((state.turn_rad_s - 36f64.to_radians()).abs() < 1e-12);
        labmate.drive(&mut state, 0.0, 9.0, 1.0);
        assert_eq!((state.speed_m_s, state.turn_rad_s), (0.0, labmate.turn_max_rad_s));
    }

    #[test]
    fn a_full_turn_at_constant_speed_is_a_circle() {
        let labmate = LabMate::default();
        let mut state = Driven { speed_m_s: 0.5, turn_rad_s: 1.0, ..Driven::at_rest(Pose::identity()) };
        for _ in 0..1257 {
            labmate.drive(&mut state, 0.5, 1.0, core::f64::consts::TAU / 1257.0);
        }
        assert!(state.pose.translation.vector.norm() < 1e-3);
    }

    #[test]
    fn clearance_is_that_of_the_turned_box() {
        let labmate = LabMate::default();
        let clearance = |heading: f64, x: f64| labmate.clearance_m(&Pose::rotation(heading), Point::new(x, 0.0));
        assert!((clearance(0.0, 1.0) - 0.625).abs() < 1e-12);
        assert!((clearance(core::f64::consts::FRAC_PI_4, 1.0) - (1.0 - 0.375 * 2f64.sqrt())).abs() < 1e-12);
        assert!(clearance(0.3, 0.2) < 0.0);
    }
}
