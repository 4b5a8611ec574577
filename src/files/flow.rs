//! A flow ring's settings, from its ring file or scene.

use std::path::Path;

use eeruf_core::EachSensor;
use eeruf_core::flow::BeliefSettings;
use eeruf_design::{FlowDesign, turns_of};
use eeruf_files::Kind;
use eeruf_logs::FlowSettings;
use eeruf_sim::Robot;

use super::error::InputError;
use super::ring::read_ring;
use super::toml::read_world;

/// Reads the settings by which a ring judges: a ring file's, or those of a scene's first robot.
pub(crate) fn read_flow(file: &Path) -> Result<FlowSettings, InputError> {
    if Kind::of_file(file) != Some(Kind::Scene) {
        let spec = read_ring(file)?;
        let robot = spec.room_robot().map_err(|error| InputError::new(file, error))?.robot.by_flow();
        let FlowDesign { turns, belief, window, blanking, limits } = spec.flow_of(&robot, 1);
        return Ok(FlowSettings { window, blanking, audible: turns.most, belief, limits });
    }
    let world = read_world(file)?;
    let robot = world.robots().first().ok_or_else(|| InputError::new(file, "no robot; expected one"))?;
    let belief = BeliefSettings { alone: world.robots().len() == 1 && !robot.others, ..BeliefSettings::DEFAULT };
    let &Robot { window, blanking, .. } = robot;
    let audible = turns_of(robot, 1).most;
    Ok(FlowSettings { window, blanking, audible, belief, limits: EachSensor::NONE })
}
