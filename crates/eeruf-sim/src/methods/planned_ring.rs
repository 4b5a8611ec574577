//! A ring whose periods are planned one by one, by a method or by the caller's own code.

use eeruf_core::{Instant, MAX_SENSORS, Micros};

use super::firing::{Firing, PeriodFiring};
use super::ring_runner::{self, REMEMBERED, StartError, Started, config_of};
use crate::world::Robot;

/// A robot's ring that fires as it is planned, no sensor again within `refire` of firing, with up to `E` echoes of a
/// firing; whether its judge `ASKS` what explains a reading.
pub(super) fn planned<'s, const E: usize, const ASKS: bool>(
    robot: &Robot,
    firing: Box<dyn Firing>,
    refire: Micros,
    now: Instant,
) -> Started<'s> {
    let plan = PeriodFiring::new(firing, robot.sensors.len(), refire, now);
    if let Some(error) = plan.error() {
        return Err(StartError::Own(error.clone()));
    }
    ring_runner::ring::<_, MAX_SENSORS, E, REMEMBERED, ASKS>(plan, config_of(robot), now)
}
