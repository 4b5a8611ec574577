//! The geometries of Set I: an alcove of three walls and the robot before it.

use crate::{
    acoustics::Transducer,
    geometry::{Pose, Vector},
    scene::{Air, Scene, SceneError, Wall},
    world::{Noise, Random, Robot, World, WorldError},
};

/// Number of sensors in the ring: a choice, as the paper does not give it (see `docs/log/experiments.md`).
pub const SENSORS: usize = 8;
/// Spacing of the sensors, in degrees: as in the paper's ring.
pub const SPACING_DEG: f64 = 15.0;
/// The radius of the sensors' arc, in metres: a choice.
pub const RADIUS_M: f64 = 0.30;

/// Dimensions of one alcove and of the robot before it. The mouth lies on the x axis around the origin, the back wall
/// at `y = depth_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alcove {
    /// Width from side wall to side wall, in metres.
    pub width_m: f64,
    /// Depth from the mouth to the back wall, in metres.
    pub depth_m: f64,
    /// Position of the robot's middle, in metres.
    pub robot_m: [f64; 2],
    /// Heading, in radians from the alcove's axis, counter-clockwise.
    pub heading_rad: f64,
}

impl Alcove {
    /// Returns the alcove of a number: one of the set's random geometries.
    pub fn random(number: u64) -> Self {
        let mut random = Random::new(number);
        let width_m = random.between(1.0, 2.4);
        let depth_m = random.between(0.9, 2.0);
        // Five centimetres stay free on either side of the ring.
        let aside = 0.5 * width_m - RADIUS_M - 0.05;
        let robot_m = [random.between(-aside, aside), random.between(-0.4, 0.3)];
        let most = 20f64.to_radians();
        Self { width_m, depth_m, robot_m, heading_rad: random.between(-most, most) }
    }

    /// Returns the three walls.
    ///
    /// # Errors
    /// [`SceneError`] for dimensions that make no valid walls.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let half = 0.5 * self.width_m;
        let corners = [[half, 0.0], [half, self.depth_m], [-half, self.depth_m], [-half, 0.0]];
        Scene::new(Wall::polyline(&corners).collect(), vec![], Air::default())
    }

    /// Returns the alcove with the back wall nearer by [`STEP_M`](super::STEP_M).
    pub(super) fn nearer(self) -> Self {
        Self { depth_m: self.depth_m - super::STEP_M, ..self }
    }

    /// Returns the robot.
    pub fn robot(&self) -> Robot {
        self.robot_of(SENSORS)
    }

    /// Returns the robot with a ring of this many sensors.
    pub fn robot_of(&self, sensors: usize) -> Robot {
        let [x, y] = self.robot_m;
        let pose = Pose::new(Vector::new(x, y), core::f64::consts::FRAC_PI_2 + self.heading_rad);
        Robot::ring(pose, sensors, SPACING_DEG.to_radians(), RADIUS_M, Transducer::POLAROID_6500)
    }

    /// Returns walls and robot together, with the default noise and up to six bounces of sound.
    ///
    /// # Errors
    /// [`WorldError`] for dimensions that make no valid walls or leave no room for the robot.
    pub fn world(&self) -> Result<World, WorldError> {
        World::new(self.scene()?, vec![self.robot()], Noise::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_random_alcove_has_room_for_the_robot() {
        for number in 0..500 {
            let alcove = Alcove::random(number);
            assert!(alcove.world().is_ok(), "{number}: {alcove:?}");
        }
    }
}
