//! [`FlowDesign`]: the settings by which a ring fires by flow.

use eeruf_core::flow::{BeliefSettings, TurnSettings};
use eeruf_core::{EachSensor, MAX_SENSORS, Micros, SensorLimits};
use eeruf_sim::{Pose, Robot};

use crate::ring::RingSpec;

/// The settings of a ring that fires by flow, for [`FlowRing`](eeruf_core::flow::FlowRing).
#[derive(Clone, Debug)]
pub struct FlowDesign {
    /// When its sensors fire.
    pub turns: TurnSettings,
    /// The belief in its readings.
    pub belief: BeliefSettings,
    /// The longest time for which its sensors listen.
    pub window: Micros,
    /// Deaf time after a firing.
    pub blanking: Micros,
    /// Limits of single sensors, without the lines that they share; none where all are alike.
    pub limits: EachSensor<MAX_SENSORS>,
}

/// When the sensors of a robot fire, with the seed of their dice.
pub fn turns_of(robot: &Robot, seed: u32) -> TurnSettings {
    let &Robot { window, blanking, audible, .. } = robot;
    // A sensor that fires while its last sound is heard would take old echoes for new ones.
    let rest = robot.module_rest().max(window).max(audible);
    let mut turns = TurnSettings::for_module(seed, window, rest, blanking);
    if audible > Micros::ZERO {
        turns.most = audible;
        turns.least = Micros::new(audible.as_micros() / 11 * 2);
    }
    turns
}

impl RingSpec {
    /// The settings by which the ring fires by flow, with the seed of its dice.
    ///
    /// # Errors
    /// The first thing by which its robot cannot be built.
    pub fn flow(&self, seed: u32) -> Result<FlowDesign, String> {
        // Where sensors stand is of no account.
        let robot = Robot::of_ring(&self.robot_ring(), Pose::identity(), Some(vec![Pose::identity(); self.sensors]))?;
        Ok(self.flow_of(&Robot { others: self.others, ..robot }, seed))
    }

    /// The same, of its robot as it was judged in rooms.
    pub fn flow_of(&self, robot: &Robot, seed: u32) -> FlowDesign {
        let &Robot { window, blanking, ref limits, ref together, .. } = robot;
        let needs = self.problem().requirements;
        let turns = turns_of(robot, seed).keeping(&needs);
        let mut belief = BeliefSettings { alone: !robot.others, ..BeliefSettings::DEFAULT };
        belief.top_speed_mm_s = self.speed_mm_s.unwrap_or(0).try_into().unwrap_or(u16::MAX);
        let shares_lines = needs.uneven.is_some_and(|uneven| !uneven.shared_lines.is_empty());
        let is_alike = together.is_empty() && !shares_lines && limits.iter().all(|of| of.window == window);
        let limits = if is_alike {
            EachSensor::NONE
        } else {
            // No more counts than what its judge compares by.
            let t_delta = belief.t_delta;
            EachSensor::for_flow(
                std::array::from_fn(|sensor| SensorLimits {
                    window: limits.get(sensor).map_or(window, |of| of.window.min(window)),
                    t_delta: limits.get(sensor).map_or(t_delta, |of| of.t_delta.min(t_delta)),
                }),
                together,
            )
        };
        FlowDesign { turns, belief, window, blanking, limits }
    }
}
