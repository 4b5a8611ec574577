//! [`FlowDesign`]: the settings by which a ring fires by flow.

use eeruf_core::flow::{BeliefSettings, TurnSettings};
use eeruf_core::{EachSensor, MAX_SENSORS, Micros, SensorLimits};
use eeruf_sim::modules::Interface;
use eeruf_sim::{Pose, Robot};

use crate::ring::RingSpec;

/// The settings of a ring that fires by flow, for [`FlowRing`](eeruf_core::flow::FlowRing).
#[derive(Clone, Debug)]
pub struct FlowDesign {
    /// Settings of the ring's firing.
    pub turns: TurnSettings,
    /// Settings of the ring's judge.
    pub belief: BeliefSettings,
    /// The longest listening time of the ring's sensors, with the time until a module's line rises.
    pub window: Micros,
    /// Deaf time after a firing.
    pub blanking: Micros,
    /// Limits of single sensors, without the lines that they share; `None` if all are alike.
    pub limits: EachSensor<MAX_SENSORS>,
}

/// Speed in m/s from which on a flow ring listens no farther than the robot needs to see, a choice: a slower robot can
/// wait.
const FAST_M_S: f64 = 1.0;
/// The range in metres that driving among obstacles needs at any speed: a choice, made on courses below 2,000.
const NEAR_M: f64 = 2.4;
/// Deceleration in m/s^2, and reaction time in seconds: choices, those of a heavy platform.
const BRAKES_M_S2: f64 = 1.0;
const REACTS_S: f64 = 0.2;

/// The range that a fast robot needs, in metres: its stopping distance plus the range needed near obstacles. `None`
/// below 1 m/s, where a ring listens as far as its modules see.
pub fn needs_to_see_m(speed_m_s: f64) -> Option<f64> {
    let stops_m = 0.5 * speed_m_s * speed_m_s / BRAKES_M_S2 + REACTS_S * speed_m_s;
    (speed_m_s >= FAST_M_S).then(|| stops_m.max(NEAR_M))
}

/// Returns the settings for firing a robot's sensors in turn, with this seed of the random gaps.
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
    /// The settings by which the ring fires by flow, with this seed of its random gaps.
    ///
    /// # Errors
    /// The first reason why the ring's robot cannot be built.
    pub fn flow(&self, seed: u32) -> Result<FlowDesign, String> {
        // The places of the sensors do not matter.
        let robot = Robot::of_ring(&self.robot_ring(), Pose::identity(), Some(vec![Pose::identity(); self.sensors]))?;
        Ok(self.flow_of(&Robot { others: self.others, reach: self.reach(), ..robot }.by_flow(), seed))
    }

    /// The listening time of a fast flow ring, if only its modules say how far they see.
    pub(crate) fn reach(&self) -> Option<Micros> {
        let fast_m_s = self.speed_mm_s.filter(|_| self.sees_by_module).map(|mm| f64::from(mm) / 1e3)?;
        Some(self.c.echo_time((1e3 * needs_to_see_m(fast_m_s)?).round() as u32).min(self.listening))
    }

    /// Returns the flow design of the robot as judged in rooms.
    pub fn flow_of(&self, robot: &Robot, seed: u32) -> FlowDesign {
        let &Robot { window, blanking, ref limits, ref together, .. } = robot;
        let needs = self.problem().requirements;
        let turns = turns_of(robot, seed).keeping(&needs);
        let mut belief = BeliefSettings { alone: !robot.others, ..BeliefSettings::DEFAULT };
        belief.top_speed_mm_s = self.speed_mm_s.unwrap_or(0).try_into().unwrap_or(u16::MAX);
        let shares_lines = needs.uneven.is_some_and(|uneven| !uneven.shared_lines.is_empty());
        let is_alike = together.is_empty() && !shares_lines && limits.iter().all(|of| of.window >= window);
        // A ring file without a module is taken for one of modules that answer by a pulse.
        let rise_us = self.modules.iter().map(|module| module.interface.rise_us()).max();
        let rise = Micros::new(rise_us.unwrap_or(Interface::PulseWidth.rise_us()));
        let listens = |echo: Micros| echo.min(window).saturating_add(rise);
        let limits = if is_alike {
            EachSensor::NONE
        } else {
            // A sensor's own limit counts only if it is below that of the judge.
            let t_delta = belief.t_delta;
            EachSensor::for_flow(
                std::array::from_fn(|sensor| SensorLimits {
                    window: listens(limits.get(sensor).map_or(window, |of| of.window)),
                    t_delta: limits.get(sensor).map_or(t_delta, |of| of.t_delta.min(t_delta)),
                }),
                together,
            )
        };
        FlowDesign { turns, belief, window: listens(window), blanking, limits }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::way::Way;

    // A fast robot does not wait for what it cannot reach, unless its file says how far to look.
    #[test]
    fn fast_rings_listen_by_flow_no_farther_than_they_need() {
        let ring = |more: &str| {
            let text = format!("sensors = 8\nmodule = \"polaroid-6500\"\nlayout = \"ring\"\n{more}");
            RingSpec::from_text(&text).unwrap()
        };
        let of = |more: &str, way| {
            let spec = ring(more);
            let flow = spec.fired(way, &spec.room_robot().unwrap().robot, 1).unwrap();
            [flow.window, flow.turns.least, flow.turns.most].map(Micros::as_micros)
        };
        // R with its tail, and the least quiet that follows from it.
        assert_eq!(of("speed_m_s = 2.0\nothers = false", Way::Flow), [13_986, 3_108, 17_094]);
        let fast = ring("speed_m_s = 2.0\nothers = false").flow(1).unwrap();
        assert_eq!((fast.turns.most.as_micros(), fast.belief.alone), (17_094, false));
        // At 3 m/s the robot stops within 5.1 m.
        assert_eq!(of("speed_m_s = 3.0", Way::Flow)[0], 29_720);
        let all = of("speed_m_s = 0.9", Way::Flow);
        assert!(all[0] > 60_000 && all[2] > 70_000, "{all:?}");
        assert_eq!(of("speed_m_s = 2.0\nmax_range_m = 10.7", Way::Flow), all);
        // One by one waits until all is quiet, whatever the speed.
        let one = of("speed_m_s = 2.0", Way::Sequential);
        assert_eq!((one[0], one[1], one[2]), (all[0], all[2], all[2]));
    }
}
