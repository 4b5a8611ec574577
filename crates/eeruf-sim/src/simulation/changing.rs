//! Simulation of worlds that replace each other while rings run, for a wall that changes its place at one moment.

use std::sync::Arc;

use super::engine::{EventLoop, Own, end_of, expected_readings, plans};
use super::error::SimulationError;
use super::kinematics::Planned;
use super::options::Options;
use crate::{methods::Method, results::Readings, threads::Stop, world::World};

/// Simulates worlds in turn, each for `each` periods of the first robot, until [`Options::periods`] are over. Only the
/// scenes may differ, and nothing may move. Sound in flight when the scene changes arrives as in the previous scene.
///
/// # Errors
/// Errors of [`simulate`](super::simulate); [`SimulationError::Stopped`] without a world.
pub(crate) fn simulate_in_turn(
    worlds: &[World],
    each: u32,
    method: Method,
    options: &Options,
    mut own: Own,
    mut keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    let Some(first) = worlds.first() else { return Err(SimulationError::Stopped) };
    let kinematics = Planned(first);
    own.check(first.robots().len())?;
    let plans = plans(first, method, options, &kinematics, &own)?;
    let (end, room) = (end_of(first, options.periods), expected_readings(first, options.periods));
    let stop = Stop::default();
    let world = &Arc::new(first.clone());
    let mut events = EventLoop::new(world, &plans, method, options, kinematics, &mut own, Some(end), room, stop)?;
    let change = end_of(first, each);
    for (turn, world) in (1..).zip(worlds.iter().cycle().skip(1)) {
        if !events.run_until(turn * change, &mut keep_going)? || turn * change >= end {
            break;
        }
        events.change_scene(Arc::new(world.clone()), turn * change)?;
    }
    events.run_until(u64::MAX, keep_going)?;
    Ok(events.take(end as f64 * 1e-9))
}
