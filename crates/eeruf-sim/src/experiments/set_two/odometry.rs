//! The robot's estimate of its own way: dead reckoning by two wheels with errors.

use crate::{
    geometry::Pose,
    navigation::Driven,
    world::{Normal, Random},
};

/// Distance between the wheels, in metres: a choice.
const TRACK_M: f64 = 0.34;

/// Errors of the platform's odometry. They do not affect the expected change of readings: the default noise would alter
/// it by some 3 us, a fiftieth of `T_delta`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryNoise {
    /// Root mean square of each wheel's scale error, constant for a course: wheels do not have exactly their assumed
    /// diameters.
    pub scale_rms: f64,
    /// Root mean square of each wheel's random error after a metre, in metres; it grows with the root of the way.
    pub slip_m_rms: f64,
}

impl Default for OdometryNoise {
    /// A thousandth of the way, and 2 mm after a metre (a choice, typical of hard wheels on a smooth floor): at the end
    /// of a course the estimate is off by about a decimetre.
    fn default() -> Self {
        Self { scale_rms: 0.001, slip_m_rms: 0.002 }
    }
}

impl OdometryNoise {
    /// No errors: the robot knows its true place.
    pub const NONE: Self = Self { scale_rms: 0.0, slip_m_rms: 0.0 };
}

/// The robot's estimate of its way.
pub(super) struct Odometry {
    noise: OdometryNoise,
    /// Scale errors of each wheel's travel, left and right.
    scales: [f64; 2],
    random: Random,
    state: Driven,
}

impl Odometry {
    /// Makes odometry at the start, where the robot knows its place. The noise depends on the course alone.
    pub(super) fn new(noise: OdometryNoise, start: &Driven, course: u64) -> Self {
        let mut random = Random::new(course).of(4);
        let scales = Normal::shared().pair(random.bits()).map(|normal| noise.scale_rms * f64::from(normal));
        Self { noise, scales, random, state: *start }
    }

    /// Returns the estimated pose.
    pub(super) fn pose(&self) -> &Pose {
        &self.state.pose
    }

    /// Records a short motion of the platform, and its current speeds.
    pub(super) fn drove(&mut self, platform: &Driven, for_s: f64) {
        let (way_m, turned) = (platform.speed_m_s * for_s, platform.turn_rad_s * for_s);
        let aside_m = 0.5 * TRACK_M * turned;
        let slips = Normal::shared().pair(self.random.bits());
        let wheel = |travel_m: f64, scale: f64, slip: f32| {
            travel_m * (1.0 + scale) + self.noise.slip_m_rms * travel_m.abs().sqrt() * f64::from(slip)
        };
        let left_m = wheel(way_m - aside_m, self.scales[0], slips[0]);
        let right_m = wheel(way_m + aside_m, self.scales[1], slips[1]);
        self.state.speed_m_s = 0.5 * (left_m + right_m) / for_s;
        self.state.turn_rad_s = (right_m - left_m) / (TRACK_M * for_s);
        self.state.pose = self.state.moment(for_s).pose;
    }

    /// Returns the estimated pose of something at a true pose, given the robot's true pose.
    pub(super) fn estimate_of(&self, platform: &Pose, real: &Pose) -> Pose {
        self.state.pose * platform.inverse() * real
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::navigation::LabMate;

    /// Returns the odometry's error after eight metres along a curve.
    fn off_m(noise: OdometryNoise, course: u64) -> f64 {
        let labmate = LabMate::default();
        let mut state = Driven::at_rest(Pose::identity());
        let mut odometry = Odometry::new(noise, &state, course);
        for _ in 0..1700 {
            labmate.drive(&mut state, 1.0, 0.1, 0.005);
            odometry.drove(&state, 0.005);
        }
        (odometry.pose().translation.vector - state.pose.translation.vector).norm()
    }

    #[test]
    fn without_noise_odometry_is_where_the_robot_is() {
        assert!((0..5).all(|course| off_m(OdometryNoise::NONE, course) < 1e-9));
    }

    // After eight metres the default noise is off by a decimetre or two.
    #[test]
    fn default_noise_is_off_by_decimetres_after_8_m() {
        let off: Vec<f64> = (0..200).map(|course| off_m(OdometryNoise::default(), course)).collect();
        let rms = (off.iter().map(|off| off * off).sum::<f64>() / 200.0).sqrt();
        assert!((0.08..0.25).contains(&rms), "{rms}");
    }
}
