//! Running a world under a method: what can be asked for, what can go wrong, and many simulations at once.

use core::fmt;

use eeruf_core::{LadderError, RingError, ScheduleError};
use rayon::prelude::*;

use crate::{
    error::PathsError,
    events,
    guide::Planned,
    method::{AnySchedule, Method},
    readings::Readings,
    world::World,
};

/// How long, with which seed, and what some methods need to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// For how many periods of the first robot (its `period`, whatever the method fires by), so that all methods run for the
    /// same time. 1000 to begin with.
    pub periods: u32,
    /// Another seed than the world's.
    pub seed: Option<u64>,
    /// What [`Method::EerufBest`] fires by, on every robot with as many sensors; the others and `None` fall back to
    /// [`Method::Eeruf`].
    pub best: Option<AnySchedule>,
    /// How many readings [`Method::Median`] takes the median of, 1 to 15. 3 to begin with.
    pub median_of: u8,
}

impl Default for Options {
    fn default() -> Self {
        Self { periods: 1000, seed: None, best: None, median_of: 3 }
    }
}

impl Options {
    /// For this many periods.
    pub fn periods(periods: u32) -> Self {
        Self { periods, ..Self::default() }
    }
}

/// Simulates a world under a method. The same world, method and options give the same readings, bit for bit.
///
/// # Errors
/// If a robot's ring cannot fire by the method as it should listen, or if something moves out of the scene's reach.
///
/// ```
/// use eeruf_sim::*;
/// let wall = Wall::new(5.0, 2.0, -5.0, 2.0);
/// let robot = Robot::ring(Pose::rotation(std::f64::consts::FRAC_PI_2), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
/// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
/// let readings = simulate(&world, Method::Eeruf, &Options::periods(100))?;
/// assert_eq!(readings.len(), 800);
/// assert!(readings.summary().wrong_of_all < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(world: &World, method: Method, options: &Options) -> Result<Readings, SimulationError> {
    simulate_while(world, method, options, |_| true)
}

/// As [`simulate`], calling back now and then with the share of time that has passed, 0 to 1. When the answer is `false` it
/// stops with [`SimulationError::Stopped`].
///
/// # Errors
/// As [`simulate`].
pub fn simulate_while(
    world: &World,
    method: Method,
    options: &Options,
    keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    events::run(world, method, options, &mut Planned(world), keep_going)
}

/// Several simulations at once on all cores, the answers in the order of the jobs. What comes out does not depend on the
/// number of threads.
///
/// ```
/// assert_eq!(eeruf_sim::sweep(&[1, 2, 3], |seed| seed * seed), [1, 4, 9]);
/// ```
pub fn sweep<J: Sync, T: Send>(jobs: &[J], run: impl Fn(&J) -> T + Sync + Send) -> Vec<T> {
    jobs.par_iter().map(run).collect()
}

/// Why a simulation cannot be run. Robots are counted from 0 in code and printed from 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SimulationError {
    /// The method has no schedule for a robot.
    Schedule {
        /// The robot.
        robot: usize,
        /// The method.
        method: Method,
        /// Why.
        error: ScheduleError,
    },
    /// A robot's ring cannot listen as asked under the method.
    Ring {
        /// The robot.
        robot: usize,
        /// The method.
        method: Method,
        /// Why.
        error: RingError,
    },
    /// No ladder of schedules keeps a robot's `t_delta` for [`Method::Adaptive`].
    Ladder {
        /// The robot.
        robot: usize,
        /// Why.
        error: LadderError,
    },
    /// The median of none or of too many readings.
    Median {
        /// How many were asked for.
        median_of: u8,
    },
    /// Paths could not be found, most often because a robot has moved out of the scene's reach.
    Paths {
        /// When, in seconds.
        at_s: f64,
        /// Why.
        error: PathsError,
    },
    /// The caller asked to stop.
    Stopped,
}

impl fmt::Display for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Schedule { robot, method, error } => write!(f, "robot {}, method {method}: {error}", robot + 1),
            Self::Ring { robot, method, error } => write!(f, "robot {}, method {method}: {error}", robot + 1),
            Self::Ladder { robot, error } => write!(f, "robot {}, method adaptive: {error}", robot + 1),
            Self::Median { median_of } => write!(f, "the median of {median_of} readings; expected 1 to 15"),
            Self::Paths { at_s, error } => write!(f, "at {at_s:.3} s: {error}"),
            Self::Stopped => write!(f, "stopped"),
        }
    }
}

impl core::error::Error for SimulationError {}
