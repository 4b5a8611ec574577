//! A world: a scene with robots, noise, and the seed of all random values. It is checked once, so that a simulation can
//! fail only because of the method.

use eeruf_core::{Micros, Requirements};

use super::check::{check, check_apart, check_heights};
use super::error::WorldError;
use super::fault::{Fault, FaultKind, scene_with};
use super::noise::Noise;
use super::robot::{MAX_ROBOTS, Robot};
use crate::{
    acoustics::Physics,
    geometry::Pose,
    scene::{Room, Scene},
    tracing::MAX_ORDER,
};

/// The default of a world's [`max_order`](World::max_order): as in Set I.
pub const DEFAULT_ORDER: u32 = 6;
/// Number of positions along the way of a door or a leg that are checked before a simulation begins.
const PLACES_TRIED: u32 = 16;
/// The longest time for which a path may fade in the same way, in seconds: a choice, practically infinite.
const MAX_FADING_TIME_S: f64 = 3600.0;

/// A scene, robots, noise, physics and a seed.
#[derive(Clone, Debug)]
pub struct World {
    scene: Scene,
    robots: Vec<Robot>,
    noise: Noise,
    max_order: u32,
    pole_order: u32,
    physics: Physics,
    seed: u64,
    faults: Vec<Fault>,
}

impl World {
    /// Checks the robots and the noise against the scene. The order is [`DEFAULT_ORDER`], the seed 1, the physics
    /// [`Physics::DEFAULT`].
    ///
    /// # Errors
    /// The first error found, naming the robot by its index.
    ///
    /// ```
    /// use eeruf_sim::*;
    /// let scene = Scene::new(vec![Wall::new(2.0, 5.0, 2.0, -5.0).with_faces(Faces::Both)], vec![], Air::default())?;
    /// let robot = Robot::ring(Pose::translation(1.8, 0.0), 8, 0.26, 0.3, Transducer::POLAROID_6500);
    /// let error = World::new(scene, vec![robot], Noise::default()).unwrap_err();
    /// let expected = "robot 1 touches wall 0; expected it to stand free at its pose. It has no body";
    /// assert!(error.to_string().starts_with(expected));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(scene: Scene, robots: Vec<Robot>, noise: Noise) -> Result<Self, WorldError> {
        if robots.is_empty() || robots.len() > MAX_ROBOTS {
            return Err(WorldError::Robots { robots: robots.len() });
        }
        for (index, robot) in robots.iter().enumerate() {
            check(&scene, index, robot)?;
        }
        check_apart(&robots)?;
        noise.check()?;
        Ok(Self {
            scene,
            robots,
            noise,
            max_order: DEFAULT_ORDER,
            pole_order: MAX_ORDER,
            physics: Physics::DEFAULT,
            seed: 1,
            faults: vec![],
        })
    }

    /// Returns the world with another largest number of bounces.
    ///
    /// # Errors
    /// [`WorldError::Order`] above [`MAX_ORDER`].
    pub fn with_max_order(self, max_order: u32) -> Result<Self, WorldError> {
        if max_order > MAX_ORDER {
            return Err(WorldError::Order { max_order });
        }
        Ok(Self { max_order, ..self })
    }

    /// Returns the world in which sound that meets a pole is followed for at most this many bounces, and no more than
    /// all other sound. Such sound is faint, and by far the most expensive to follow.
    ///
    /// # Errors
    /// [`WorldError::Order`] above [`MAX_ORDER`].
    pub fn with_pole_order(self, pole_order: u32) -> Result<Self, WorldError> {
        if pole_order > MAX_ORDER {
            return Err(WorldError::Order { max_order: pole_order });
        }
        Ok(Self { pole_order, ..self })
    }

    /// Returns the world with other effects.
    ///
    /// # Errors
    /// [`WorldError::Physics`] for an invalid number.
    pub fn with_physics(self, physics: Physics) -> Result<Self, WorldError> {
        if !(0.0..=MAX_FADING_TIME_S).contains(&physics.fading_time_s) {
            let (value, expected) = (physics.fading_time_s, "0 to 3600");
            return Err(WorldError::Physics { field: "fading_time_s", value, expected });
        }
        Ok(Self { physics, ..self })
    }

    /// Returns the world between floor and ceiling, or flat without them.
    ///
    /// # Errors
    /// [`WorldError`] for an invalid room, or a sensor that is not between floor and ceiling.
    pub fn with_room(self, room: Option<Room>) -> Result<Self, WorldError> {
        let scene = self.scene.with_room(room)?;
        self.robots.iter().enumerate().try_for_each(|(index, robot)| check_heights(&scene, index, robot))?;
        Ok(Self { scene, ..self })
    }

    /// Returns the world with another seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Returns the world with another scene, without a check that the robots stand free.
    pub(crate) fn with_scene(&self, scene: Scene) -> Self {
        Self { scene, ..self.clone() }
    }

    /// Returns the world with these faults.
    ///
    /// # Errors
    /// [`WorldError::Fault`] for an invalid fault; another [`WorldError`] for a door or a leg without enough room in
    /// the scene somewhere on its way.
    pub fn with_faults(self, faults: Vec<Fault>) -> Result<Self, WorldError> {
        faults.iter().enumerate().try_for_each(|(index, fault)| fault.check(index, &self.robots))?;
        for robot in 0..self.robots.len() {
            let drifts = |fault: &&Fault| matches!(fault.kind, FaultKind::ClockDrift { .. }) && fault.robot == robot;
            if let Some((index, _)) = faults.iter().enumerate().filter(|(_, fault)| drifts(fault)).nth(1) {
                let expected = "no second clock_drift of one robot";
                return Err(WorldError::Fault { fault: index, field: "robot", value: robot as f64, expected });
            }
        }
        for fault in faults.iter().filter(|fault| fault.kind.is_of_scene()) {
            let to_s = if fault.to_s.is_finite() { fault.to_s } else { fault.from_s };
            for step in 0..=PLACES_TRIED {
                let share = f64::from(step) / f64::from(PLACES_TRIED);
                scene_with(&self.scene, &faults, fault.from_s + share * (to_s - fault.from_s))?;
            }
        }
        Ok(Self { faults, ..self })
    }

    /// Returns the faults.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// Returns walls, poles and air.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the robots, at least one.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// Returns a warning for each robot, counted from 0, whose `t_delta` is too large for its schedule.
    pub fn doubts(&self) -> Vec<(usize, String)> {
        let nothing_asked = Requirements::new(Micros::ZERO);
        let doubt = |(index, robot): (usize, &Robot)| {
            let most = robot.schedule.as_ref()?.verify(&nothing_asked).max_t_delta();
            let (most, t_delta) = (most.filter(|&most| most < robot.t_delta)?.as_micros(), robot.t_delta.as_micros());
            let expected = format!("expected at most {most}, what its schedule rejects; crosstalk passes");
            Some((index, format!("t_delta_us: {t_delta}; {expected}; see `eeruf verify`")))
        };
        self.robots.iter().enumerate().filter_map(doubt).collect()
    }

    /// Returns the effects.
    pub fn physics(&self) -> Physics {
        self.physics
    }

    /// Returns the noise.
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// Returns the largest number of bounces of sound.
    pub fn max_order(&self) -> u32 {
        self.max_order
    }

    /// Returns the largest number of bounces of sound that meets a pole.
    pub fn pole_order(&self) -> u32 {
        self.pole_order.min(self.max_order)
    }

    /// Returns the seed of all random values.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns true if any robot ever moves.
    pub fn moves(&self) -> bool {
        self.robots.iter().any(|robot| !robot.motion.is_still())
    }

    /// Returns the poses of one robot's sensors at a time in seconds; none for a robot out of range.
    pub fn sensors(&self, robot: usize, time_s: f64) -> impl Iterator<Item = Pose> + '_ {
        self.robots.get(robot).into_iter().flat_map(move |robot| {
            let pose = robot.motion.at(&robot.pose, time_s).pose;
            robot.sensors.iter().map(move |sensor| pose * sensor)
        })
    }
}
