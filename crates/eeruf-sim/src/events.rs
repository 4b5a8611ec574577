//! The event simulation.
use crate::{
    method::Method,
    readings::Readings,
    simulate::{Options, SimulationError},
    world::World,
};

pub(crate) fn run(
    world: &World,
    method: Method,
    options: &Options,
    mut keep_going: impl FnMut(f64) -> bool,
) -> Result<Readings, SimulationError> {
    let duration_s = f64::from(options.periods) * 1e-6 * f64::from(world.robots()[0].period.as_micros());
    _ = keep_going(0.0);
    Ok(Readings::new(method, duration_s, world.robots().iter().map(|robot| robot.sensors.len()).sum(), 0))
}
