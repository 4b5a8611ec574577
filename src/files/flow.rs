//! A flow ring's settings, by the file of its ring or its scene.

use std::path::Path;

use eeruf_core::flow::{BeliefSettings, TurnSettings};
use eeruf_core::{EachSensor, MAX_SENSORS, Micros, SensorLimits};
use eeruf_design::RingSpec;
use eeruf_files::Kind;
use eeruf_logs::FlowSettings;
use eeruf_sim::Robot;

use super::error::InputError;
use super::ring::read_ring;
use super::toml::read_world;

/// The gaps of a robot's ring.
fn turns_of(robot: &Robot) -> TurnSettings {
    let &Robot { window, blanking, audible, .. } = robot;
    // A sensor that fires while its last sound is heard would take old echoes for new ones.
    let rest = robot.module_rest().max(window).max(audible);
    let mut turns = TurnSettings::for_module(1, window, rest, blanking);
    if audible > Micros::ZERO {
        turns.most = audible;
        turns.least = Micros::new(audible.as_micros() / 11 * 2);
    }
    turns
}

/// When the robot of a ring file fires, and how it judges.
pub(crate) fn of_ring(spec: &RingSpec, robot: &Robot) -> (TurnSettings, FlowSettings) {
    let &Robot { window, blanking, ref limits, ref together, .. } = robot;
    let needs = spec.problem().requirements;
    let turns = turns_of(robot).keeping(&needs);
    let mut belief = BeliefSettings { alone: !robot.others, ..BeliefSettings::DEFAULT };
    belief.top_speed_mm_s = spec.speed_mm_s.unwrap_or(0).try_into().unwrap_or(u16::MAX);
    let shared_lines = needs.uneven.map_or(&[][..], |uneven| uneven.shared_lines);
    let is_alike = together.is_empty() && shared_lines.is_empty() && limits.iter().all(|of| of.window == window);
    let limits = if is_alike {
        EachSensor::NONE
    } else {
        // No more counts than what its judge compares by.
        let t_delta = belief.t_delta;
        EachSensor::<MAX_SENSORS>::for_flow(
            std::array::from_fn(|sensor| SensorLimits {
                window: limits.get(sensor).map_or(window, |of| of.window.min(window)),
                t_delta: limits.get(sensor).map_or(t_delta, |of| of.t_delta.min(t_delta)),
            }),
            together,
        )
    };
    (turns, FlowSettings { window, blanking, audible: turns.most, belief, limits })
}

/// How the ring of a file judges: a ring file's, or the first robot's of a scene.
pub(crate) fn read_flow(file: &Path) -> Result<FlowSettings, InputError> {
    if Kind::of_file(file) != Some(Kind::Scene) {
        let spec = read_ring(file)?;
        let robot = spec.room_robot().map_err(|error| InputError::new(file, error))?.robot;
        return Ok(of_ring(&spec, &robot).1);
    }
    let world = read_world(file)?;
    let robot = world.robots().first().ok_or_else(|| InputError::new(file, "no robot; expected one"))?;
    let belief = BeliefSettings { alone: world.robots().len() == 1 && !robot.others, ..BeliefSettings::DEFAULT };
    let &Robot { window, blanking, .. } = robot;
    let audible = turns_of(robot).most;
    Ok(FlowSettings { window, blanking, audible, belief, limits: EachSensor::NONE })
}
