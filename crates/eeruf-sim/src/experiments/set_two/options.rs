//! What is asked of Set II.

use eeruf_core::Micros;

use super::pilot::Piloting;
use crate::{
    acoustics::Physics,
    geometry::Point,
    methods::{BestSchedule, Method},
    navigation::LabMate,
};

/// What is asked of Set II.
#[derive(Clone, Debug, PartialEq)]
pub struct SetTwoOptions {
    /// How many courses. The default is 100.
    pub seeds: u64,
    /// The first course's number, so that parameters can be tuned on other courses than those that they are tested on.
    /// The default is 0.
    pub first: u64,
    /// The methods.
    pub methods: Vec<Method>,
    /// What [`Method::EerufBest`] fires by, see [`best_schedule_for`](crate::best_schedule_for).
    pub best: Option<BestSchedule>,
    /// Where another robot stands that fires 24 times in 80 ms, if there is one.
    pub second_robot: Option<Point>,
    /// The platform.
    pub labmate: LabMate,
    /// Whether odometry gives the ring by how much readings should change from the robot's own motion.
    pub odometry: bool,
    /// `T_delta`. With odometry it need not leave room for motion, and readings agree by accident the more rarely the
    /// smaller it is.
    pub t_delta: Micros,
    /// Which effects the lab has. The default is [`Physics::PLAIN`].
    pub physics: Physics,
    /// How it steers.
    pub piloting: Piloting,
}

impl Default for SetTwoOptions {
    fn default() -> Self {
        Self {
            seeds: 100,
            first: 0,
            methods: vec![
                Method::Sequential,
                Method::Conventional,
                Method::Comparison,
                Method::Eeruf,
                Method::EerufBest,
                Method::Adaptive,
                Method::MultiEcho,
            ],
            best: None,
            second_robot: None,
            labmate: LabMate::default(),
            odometry: true,
            t_delta: Micros::new(150),
            physics: Physics::PLAIN,
            piloting: Piloting::default(),
        }
    }
}
