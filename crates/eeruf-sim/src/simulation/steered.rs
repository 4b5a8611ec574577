//! Robots that follow the world's motion until they are steered.

use std::{collections::VecDeque, sync::Arc};

use super::kinematics::Kinematics;
use crate::{
    geometry::{Moment, Pose, Vector},
    world::World,
};

/// Time before a robot's last steering for which its poses are remembered, in nanoseconds: longer than sound is heard.
const REMEMBERED: u64 = 10_000_000_000;

/// Steered robots, each from its first steering on.
#[derive(Clone)]
pub(super) struct Steered {
    world: Arc<World>,
    legs: Vec<Legs>,
}

/// Legs of a steered robot; the last one is current.
#[derive(Clone, Default)]
struct Legs {
    legs: VecDeque<Leg>,
    /// Time before which legs have been forgotten.
    known_since: u64,
}

/// A constant speed and rate of turn from a moment on.
#[derive(Clone, Copy)]
struct Leg {
    /// Start in true nanoseconds.
    since: u64,
    pose: Pose,
    v_m_s: f64,
    w_rad_s: f64,
}

impl Steered {
    pub(super) fn new(world: Arc<World>) -> Self {
        let legs = vec![Legs::default(); world.robots().len()];
        Self { world, legs }
    }

    /// Sets a robot's forward speed, `v_m_s`, and rate of turn, `w_rad_s`, from now on.
    pub(super) fn set(&mut self, robot: usize, now: u64, v_m_s: f64, w_rad_s: f64) {
        let pose = self.moment(robot, now).pose;
        let Legs { legs, known_since } = &mut self.legs[robot];
        while legs.get(1).is_some_and(|next| next.since + REMEMBERED <= now) {
            legs.pop_front();
            *known_since = legs.front().map_or(0, |first| first.since);
        }
        // A leg that ends when it begins moves nothing.
        if legs.back().is_some_and(|last| last.since == now) {
            legs.pop_back();
        }
        legs.push_back(Leg { since: now, pose, v_m_s, w_rad_s });
    }

    /// Moves a robot to another place from now on, with the speeds set last.
    pub(super) fn place(&mut self, robot: usize, now: u64, pose: Pose) {
        let legs = &mut self.legs[robot].legs;
        let (v_m_s, w_rad_s) = legs.back().map_or((0.0, 0.0), |last| (last.v_m_s, last.w_rad_s));
        self.set(robot, now, v_m_s, w_rad_s);
        if let Some(last) = self.legs[robot].legs.back_mut() {
            last.pose = pose;
        }
    }

    /// Returns true if the robot's pose at a time is known.
    pub(super) fn knows(&self, robot: usize, then: u64) -> bool {
        self.legs[robot].known_since <= then
    }
}

impl Leg {
    /// Returns the motion at a time on this leg, along an arc or a straight line.
    fn at(&self, now: u64) -> Moment {
        let Self { since, pose, v_m_s, w_rad_s } = *self;
        let time_s = now.saturating_sub(since) as f64 * 1e-9;
        let half_rad = 0.5 * w_rad_s * time_s;
        // The chord of the arc is turned by half of the arc's angle.
        let chord_m = v_m_s * time_s * if half_rad.abs() < 1e-6 { 1.0 } else { libm::sin(half_rad) / half_rad };
        let heading = pose.rotation.angle();
        let ahead = |rad: f64| Vector::new(libm::cos(rad), libm::sin(rad));
        let place = pose.translation.vector + chord_m * ahead(heading + half_rad);
        let pose = Pose::new(place, heading + 2.0 * half_rad);
        Moment { pose, velocity: v_m_s * ahead(heading + 2.0 * half_rad), turn_rad_s: w_rad_s }
    }
}

impl Kinematics for Steered {
    fn moves(&self) -> bool {
        self.world.moves() || self.legs.iter().any(|of| !of.legs.is_empty())
    }

    fn moment(&self, robot: usize, now: u64) -> Moment {
        match self.legs[robot].legs.iter().rfind(|leg| leg.since <= now) {
            Some(leg) => leg.at(now),
            None => {
                let robot = &self.world.robots()[robot];
                robot.motion.at(&robot.pose, now as f64 * 1e-9)
            }
        }
    }
}
