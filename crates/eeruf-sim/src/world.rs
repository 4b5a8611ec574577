//! A world: a scene with robots in it, how noisy it is, and the seed that decides all chance. Checked once, so that a
//! simulation has nothing left to refuse but what a method asks for.

use core::fmt;

use eeruf_core::{MAX_PERIOD, MAX_SENSORS, Micros};

use crate::{
    clock::MAX_DRIFT_PPM,
    collide::{Body, Contact},
    error::SceneError,
    motion::Motion,
    noise::Noise,
    paths::MAX_ORDER,
    plane::Pose,
    robot::Robot,
    scene::{MAX_COORDINATE_M, Scene},
};

/// The highest order that a world follows sound to, unless another is asked for.
pub const DEFAULT_ORDER: u32 = 6;
/// The most robots in one world.
pub const MAX_ROBOTS: usize = 64;
/// The fastest motion, in m/s and rad/s.
pub const MAX_SPEED: f64 = 50.0;

/// A scene, robots, noise and a seed.
#[derive(Debug)]
pub struct World {
    scene: Scene,
    robots: Vec<Robot>,
    noise: Noise,
    max_order: u32,
    pole_order: u32,
    seed: u64,
}

impl World {
    /// Checks the robots and the noise against the scene. The order is [`DEFAULT_ORDER`], the seed 1.
    ///
    /// # Errors
    /// The first thing found wrong, naming the robot by its index.
    ///
    /// ```
    /// use eeruf_sim::*;
    /// let scene = Scene::new(vec![Wall::new(2.0, 5.0, 2.0, -5.0).with_faces(Faces::Both)], vec![], Air::default())?;
    /// let robot = Robot::ring(Pose::translation(1.8, 0.0), 8, 0.26, 0.3, Transducer::POLAROID_6500);
    /// let error = World::new(scene, vec![robot], Noise::default()).unwrap_err();
    /// assert_eq!(error.to_string(), "robot 1 touches wall 0; expected it to stand free at its pose");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(scene: Scene, robots: Vec<Robot>, noise: Noise) -> Result<Self, WorldError> {
        if robots.is_empty() || robots.len() > MAX_ROBOTS {
            return Err(WorldError::Robots { robots: robots.len() });
        }
        for (index, robot) in robots.iter().enumerate() {
            check(&scene, index, robot)?;
        }
        noise.check()?;
        Ok(Self { scene, robots, noise, max_order: DEFAULT_ORDER, pole_order: MAX_ORDER, seed: 1 })
    }

    /// The same world, with sound followed up to another order.
    ///
    /// # Errors
    /// [`WorldError::Order`] above [`MAX_ORDER`].
    pub fn with_max_order(self, max_order: u32) -> Result<Self, WorldError> {
        if max_order > MAX_ORDER {
            return Err(WorldError::Order { max_order });
        }
        Ok(Self { max_order, ..self })
    }

    /// The same world, with sound that meets a pole followed up to this order only, at most that of all other sound. Such
    /// sound is faint, and by far the dearest to follow.
    ///
    /// # Errors
    /// [`WorldError::Order`] above [`MAX_ORDER`].
    pub fn with_pole_order(self, pole_order: u32) -> Result<Self, WorldError> {
        if pole_order > MAX_ORDER {
            return Err(WorldError::Order { max_order: pole_order });
        }
        Ok(Self { pole_order, ..self })
    }

    /// The same world with another seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Walls, poles and air.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The robots, at least one.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// How noisy it is.
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// The most bounces that sound is followed for.
    pub fn max_order(&self) -> u32 {
        self.max_order
    }

    /// The most bounces that sound is followed for if one of them is at a pole.
    pub fn pole_order(&self) -> u32 {
        self.pole_order.min(self.max_order)
    }

    /// What decides all chance.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Whether any robot ever moves.
    pub fn moves(&self) -> bool {
        self.robots.iter().any(|robot| !robot.motion.is_still())
    }

    /// The places and headings of one robot's sensors at a time in seconds; none for a robot that is not there.
    pub fn sensors(&self, robot: usize, time_s: f64) -> impl Iterator<Item = Pose> + '_ {
        self.robots.get(robot).into_iter().flat_map(move |robot| {
            let pose = robot.motion.at(&robot.pose, time_s).pose;
            robot.sensors.iter().map(move |sensor| pose * sensor)
        })
    }
}

/// Whether a number is one, and not farther from zero than `most`.
fn within(value: f64, most: f64) -> bool {
    (-most..=most).contains(&value)
}

fn check(scene: &Scene, index: usize, robot: &Robot) -> Result<(), WorldError> {
    if robot.sensors.is_empty() || robot.sensors.len() > MAX_SENSORS {
        return Err(WorldError::Sensors { robot: index, sensors: robot.sensors.len() });
    }
    let fail = |field, value, expected| Err(WorldError::Field { robot: index, field, value, expected });
    let poses = [("pose", &robot.pose)].into_iter().chain(robot.sensors.iter().map(|sensor| ("sensors", sensor)));
    for (field, pose) in poses {
        for value in [pose.translation.x, pose.translation.y, pose.rotation.angle()] {
            if !within(value, MAX_COORDINATE_M) {
                return fail(field, value, "a number within 100000 m");
            }
        }
    }
    let speed = "at most 50 m/s and 50 rad/s";
    match &robot.motion {
        Motion::Still => {}
        Motion::Constant { velocity, turn_rad_s } => {
            for value in [velocity.x, velocity.y, *turn_rad_s] {
                if !within(value, MAX_SPEED) {
                    return fail("motion", value, speed);
                }
            }
        }
        Motion::Waypoints { points, speed_m_s } => {
            if !(0.0..=MAX_SPEED).contains(speed_m_s) {
                return fail("speed_m_s", *speed_m_s, speed);
            }
            for value in points.iter().flat_map(|point| [point.x, point.y]) {
                if !within(value, MAX_COORDINATE_M) {
                    return fail("waypoints_m", value, "a number within 100000 m");
                }
            }
        }
    }
    if !within(robot.clock.drift_ppm, MAX_DRIFT_PPM) {
        return fail("drift_ppm", robot.clock.drift_ppm, "-1000 to 1000");
    }
    let transducer = &robot.transducer;
    for (field, value) in [
        ("frequency_hz", transducer.frequency_hz),
        ("radius_m", transducer.radius_m),
        ("max_range_m", transducer.max_range_m),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return fail(field, value, "a positive number");
        }
    }
    for (field, value) in
        [("period_us", robot.period), ("window_us", robot.window), ("min_refire_us", robot.min_refire)]
    {
        if value == Micros::ZERO || value > MAX_PERIOD {
            return fail(field, f64::from(value.as_micros()), "1 to 268435456");
        }
    }
    if robot.window <= robot.blanking {
        return fail("window_us", f64::from(robot.window.as_micros()), "more than the blanking time");
    }
    if robot.neighbours == 0 || usize::from(robot.neighbours) > MAX_SENSORS {
        return fail("neighbours", f64::from(robot.neighbours), "1 to 64");
    }
    if !(2..=8).contains(&robot.consecutive) {
        return fail("consecutive", f64::from(robot.consecutive), "2 to 8");
    }
    if robot.patience > 15 {
        return fail("patience", f64::from(robot.patience), "0 to 15");
    }
    if let Some(schedule) = &robot.schedule {
        if schedule.sensors() != robot.sensors.len() {
            let (sensors, expected) = (schedule.sensors(), robot.sensors.len());
            return Err(WorldError::Schedule { robot: index, sensors, expected });
        }
        if robot.window > schedule.min_refire() {
            return Err(WorldError::Window { robot: index, window: robot.window, min_refire: schedule.min_refire() });
        }
    }
    // A body without extent still stands somewhere.
    let body = Body::Disc(robot.radius_m().max(1e-6));
    match scene.contact(&body, &robot.pose) {
        Some(contact) => Err(WorldError::Contact { robot: index, contact }),
        None => Ok(()),
    }
}

/// Why a world cannot be. Robots are counted from 0 in code and printed from 1; walls and poles from 0, as in files.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum WorldError {
    /// The scene itself.
    Scene(SceneError),
    /// No robots, or too many.
    Robots {
        /// How many were given.
        robots: usize,
    },
    /// A robot without sensors, or with too many.
    Sensors {
        /// The robot.
        robot: usize,
        /// How many sensors it has.
        sensors: usize,
    },
    /// A number that makes no sense.
    Field {
        /// The robot.
        robot: usize,
        /// The field, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// What is expected.
        expected: &'static str,
    },
    /// A schedule for another number of sensors.
    Schedule {
        /// The robot.
        robot: usize,
        /// How many sensors the schedule has.
        sensors: usize,
        /// How many the robot has.
        expected: usize,
    },
    /// A sensor would fire again while it still listens.
    Window {
        /// The robot.
        robot: usize,
        /// The window asked for.
        window: Micros,
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
    },
    /// A robot that starts inside something.
    Contact {
        /// The robot.
        robot: usize,
        /// What it touches.
        contact: Contact,
    },
    /// A number of the noise that makes no sense.
    Noise {
        /// The field, by its name in files.
        field: &'static str,
        /// The offending number.
        value: f64,
        /// What is expected.
        expected: &'static str,
    },
    /// An order beyond what paths can be asked for.
    Order {
        /// What was asked for.
        max_order: u32,
    },
}

impl From<SceneError> for WorldError {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Scene(error) => error.fmt(f),
            Self::Robots { robots } => write!(f, "{robots} robots; expected 1 to {MAX_ROBOTS}"),
            Self::Sensors { robot, sensors } => {
                write!(f, "robot {} has {sensors} sensors; expected 1 to {MAX_SENSORS}", robot + 1)
            }
            Self::Field { robot, field, value, expected } => {
                write!(f, "robot {}: {field} is {value}; expected {expected}", robot + 1)
            }
            Self::Schedule { robot, sensors, expected } => {
                write!(f, "robot {}: a schedule for {sensors} sensors; expected one for its {expected}", robot + 1)
            }
            Self::Window { robot, window, min_refire } => write!(
                f,
                "robot {}: window_us is {}; expected at most {}, after which a sensor of its schedule fires again",
                robot + 1,
                window.as_micros(),
                min_refire.as_micros()
            ),
            Self::Contact { robot, contact } => {
                let robot = robot + 1;
                match contact {
                    Contact::Wall(wall) => write!(f, "robot {robot} touches wall {wall}")?,
                    Contact::Pole(pole) => write!(f, "robot {robot} touches pole {pole}")?,
                    Contact::Solid => write!(f, "robot {robot} is inside a wall or outside the room")?,
                }
                write!(f, "; expected it to stand free at its pose")
            }
            Self::Noise { field, value, expected } => write!(f, "noise: {field} is {value}; expected {expected}"),
            Self::Order { max_order } => write!(f, "max_order is {max_order}; expected at most {MAX_ORDER}"),
        }
    }
}

impl core::error::Error for WorldError {}
