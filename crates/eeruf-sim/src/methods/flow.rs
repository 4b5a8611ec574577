//! A robot's ring that fires by flow, as implemented in core.

use eeruf_core::{
    MAX_SENSORS, Micros,
    flow::{BeliefSettings, FlowRing, TurnSettings},
};

use super::method::MAX_ECHOES;
use super::ring_runner::{RingStart, Started, Way, config_of, trusting};
use super::schedules;
use crate::world::Robot;

/// Settings of a flow ring that override those of its robot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FlowOptions {
    /// Listening time of the sensors, in an [`Entry`](crate::Entry); `None` for the robot's window.
    pub window: Option<Micros>,
    /// R: the time for which sound is heard, its tail included, and the greatest quiet; `None` for the robot's
    /// [`audible`](Robot::audible), or a value derived from its window.
    pub most: Option<Micros>,
    /// The least quiet; `None` for 2/11 of R.
    pub least: Option<Micros>,
    /// The least time between two firings of a sensor; `None` for the longest of its module's rest, its window, and R.
    pub rest: Option<Micros>,
    /// Random time in every gap; `None` for 2 ms.
    pub dice: Option<Micros>,
    /// Settings of belief; `None` for [`BeliefSettings::DEFAULT`]. The world and the robot's
    /// [expectation](Robot::others) decide if it is alone.
    pub belief: Option<BeliefSettings>,
}

impl FlowOptions {
    /// Returns the gaps of a robot's ring, with the given seed.
    fn turns(&self, robot: &Robot, seed: u32) -> TurnSettings {
        let &Robot { window, audible, blanking, .. } = robot;
        // A sensor that fires while its last sound is still heard would take old echoes for new ones.
        let rest = self.rest.unwrap_or(robot.module_rest().max(window).max(audible));
        let mut settings = TurnSettings::for_module(seed, window, rest, blanking);
        let heard = if audible > Micros::ZERO { audible } else { settings.most };
        settings.most = self.most.unwrap_or(heard);
        settings.least = self.least.unwrap_or(Micros::new(settings.most.as_micros() / 11 * 2));
        settings.dice = self.dice.unwrap_or(settings.dice);
        settings
    }
}

pub(super) const WAY: Way =
    Way { ring: flow, refire: |robot, _, _| robot.window, ..Way::by_table(schedules::conventional) };

/// Starts a flow ring that is no larger than needed.
fn flow(start: &RingStart<'_>) -> Started {
    match (start.judging.echoes, start.robot.sensors.len()) {
        (..=1, ..=8) => ring::<8, 1>(start),
        (..=1, 9..=24) => ring::<24, 1>(start),
        (..=1, _) => ring::<MAX_SENSORS, 1>(start),
        _ => ring::<MAX_SENSORS, MAX_ECHOES>(start),
    }
}

fn ring<const K: usize, const E: usize>(start: &RingStart<'_>) -> Started {
    let RingStart { robot, flow, mut random, now, .. } = *start;
    // A seed of 0 would make no random numbers.
    let turns = flow.turns(robot, random.bits() as u32 | 1);
    let ring = FlowRing::<K, E>::flow(robot.sensors.len(), turns, start.judging.belief, config_of(robot), now)?;
    Ok(Box::new(trusting(ring)))
}
