//! Arguments of Set II.

use eeruf_core::Micros;
use eeruf_period::ShortestPeriod;

use super::odometry::OdometryNoise;
use super::pilots::Pilots;
use crate::{
    acoustics::{GainProfile, Physics, Transducer},
    experiments::FIRST,
    geometry::Point,
    methods::Method,
    navigation::LabMate,
    scene::Room,
    simulation::Entry,
    world::Robot,
};

/// Arguments of Set II.
#[derive(Clone, Debug, PartialEq)]
pub struct SetTwoOptions {
    /// Number of courses. The default is 100.
    pub seeds: u64,
    /// The first course's number. The default is [`FIRST`]: pilots were tuned on courses below 2,000, the shared one
    /// also on 10,000 to 10,999.
    pub first: u64,
    /// The methods.
    pub methods: Vec<Entry>,
    /// Schedule of [`Method::EerufBest`], see [`best_schedule_for`](crate::best_schedule_for).
    pub best: Option<ShortestPeriod>,
    /// Position of another robot that fires 24 times in 80 ms, if there is one.
    pub second_robot: Option<Point>,
    /// The platform.
    pub labmate: LabMate,
    /// True if odometry gives the ring the change of each reading that the robot's own motion should cause.
    pub odometry: bool,
    /// `T_delta`. With odometry it need not cover motion; the smaller it is, the fewer readings agree by accident.
    pub t_delta: Micros,
    /// The simulated effects in the lab. The default is [`Physics::DEFAULT`].
    pub physics: Physics,
    /// Floor and ceiling of the lab. The default is none: it is flat.
    pub room: Option<Room>,
    /// The gain of the robot's receivers. The default is [`GainProfile::Constant`].
    pub gain: GainProfile,
    /// True if robots have bodies that block sound and the platform: the platform's is a square with the ring on its
    /// edge, and the other robot's is the disc of its ring. The default is false, as when the pilots were tuned.
    pub bodies: bool,
    /// Errors of the platform's odometry.
    pub odometry_noise: OdometryNoise,
    /// The pilots.
    pub pilots: Pilots,
}

impl SetTwoOptions {
    /// Returns the robot of a course under these options.
    #[must_use]
    pub fn robot(&self, robot: Robot) -> Robot {
        let transducer = Transducer { gain: self.gain, ..robot.transducer };
        Robot { odometry: self.odometry, t_delta: self.t_delta, transducer, ..robot }
    }
}

impl Default for SetTwoOptions {
    fn default() -> Self {
        Self {
            seeds: 100,
            first: FIRST,
            methods: Entry::all([
                Method::Sequential,
                Method::FarGroups,
                Method::Conventional,
                Method::Comparison,
                Method::Eeruf,
                Method::EerufBest,
                Method::Adaptive,
                Method::Flow,
                Method::MultiEcho,
            ]),
            best: None,
            second_robot: None,
            labmate: LabMate::default(),
            odometry: true,
            t_delta: Micros::new(150),
            physics: Physics::DEFAULT,
            room: None,
            gain: GainProfile::Constant,
            bodies: false,
            odometry_noise: OdometryNoise::default(),
            pilots: Pilots::Own,
        }
    }
}
