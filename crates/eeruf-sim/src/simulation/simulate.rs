//! Simulation of a world under a method.

use super::engine::{self, Own};
use super::error::SimulationError;
use super::kinematics::Planned;
use super::options::Options;
use crate::{methods::Method, results::Readings, threads::Stop, world::World};

/// Simulates a world under a method. The same world, method and options give the same readings, bit for bit.
///
/// # Errors
/// A robot's ring cannot fire by the method with its listening times, or something moves out of the scene's reach.
///
/// ```
/// use eeruf_sim::*;
/// let wall = Wall::new(5.0, 2.0, -5.0, 2.0);
/// let pose = Pose::rotation(std::f64::consts::FRAC_PI_2);
/// let robot = Robot::ring(pose, 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
/// let world = World::new(Scene::new(vec![wall], vec![], Air::default())?, vec![robot], Noise::default())?;
/// let readings = simulate(&world, Method::Eeruf, &Options::periods(100))?;
/// assert_eq!(readings.len(), 800);
/// assert!(readings.summary().wrong_of_all < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(world: &World, method: Method, options: &Options) -> Result<Readings, SimulationError> {
    simulate_while(world, method, options, |_| true)
}

/// Simulates like [`simulate`], and calls `keep_going` from time to time with the elapsed share of the time, 0 to 1. If
/// it returns `false`, the simulation stops with [`SimulationError::Stopped`].
///
/// # Errors
/// See [`simulate`].
pub fn simulate_while(
    world: &World,
    method: Method,
    options: &Options,
    keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    simulate_until(world, method, options, &Stop::default(), keep_going)
}

/// Simulates like [`simulate_while`]; `stop` also ends the simulation from another thread, even while paths are
/// computed before the first event.
///
/// # Errors
/// See [`simulate`].
pub fn simulate_until(
    world: &World,
    method: Method,
    options: &Options,
    stop: &Stop,
    keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    engine::run(world, method, options, Own::new(), &mut Planned(world), stop, keep_going)
}
