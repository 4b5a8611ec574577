//! Robots that move as the world says until somebody steers them.

use super::kinematics::Kinematics;
use crate::{
    geometry::{Moment, Pose, Vector},
    world::World,
};

/// Robots that somebody steers, each from the moment on at which it was first steered.
pub(super) struct Steered<'w> {
    world: &'w World,
    legs: Vec<Option<Leg>>,
}

/// A constant speed and rate of turn from one moment on.
#[derive(Clone, Copy)]
struct Leg {
    /// In true nanoseconds.
    since: u64,
    pose: Pose,
    v_m_s: f64,
    w_rad_s: f64,
}

impl<'w> Steered<'w> {
    pub(super) fn new(world: &'w World) -> Self {
        Self { world, legs: vec![None; world.robots().len()] }
    }

    /// From now on a robot goes ahead at `v_m_s` and turns at `w_rad_s`.
    pub(super) fn set(&mut self, robot: usize, now: u64, v_m_s: f64, w_rad_s: f64) {
        let pose = self.moment(robot, now).pose;
        self.legs[robot] = Some(Leg { since: now, pose, v_m_s, w_rad_s });
    }
}

impl Leg {
    /// Where it leads, on an arc or straight on.
    fn at(&self, now: u64) -> Moment {
        let Self { since, pose, v_m_s, w_rad_s } = *self;
        let time_s = now.saturating_sub(since) as f64 * 1e-9;
        let half_rad = 0.5 * w_rad_s * time_s;
        // The chord of the arc, which heads half of the turn aside.
        let chord_m = v_m_s * time_s * if half_rad.abs() < 1e-6 { 1.0 } else { libm::sin(half_rad) / half_rad };
        let heading = pose.rotation.angle();
        let ahead = |rad: f64| Vector::new(libm::cos(rad), libm::sin(rad));
        let place = pose.translation.vector + chord_m * ahead(heading + half_rad);
        let pose = Pose::new(place, heading + 2.0 * half_rad);
        Moment { pose, velocity: v_m_s * ahead(heading + 2.0 * half_rad), turn_rad_s: w_rad_s }
    }
}

impl Kinematics for Steered<'_> {
    fn moves(&self) -> bool {
        self.world.moves()
    }

    fn moment(&self, robot: usize, now: u64) -> Moment {
        match self.legs[robot] {
            Some(leg) => leg.at(now),
            None => {
                let robot = &self.world.robots()[robot];
                robot.motion.at(&robot.pose, now as f64 * 1e-9)
            }
        }
    }
}
