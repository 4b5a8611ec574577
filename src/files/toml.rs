//! Reading TOML: any file of ours, schedules, and scenes.

use std::path::Path;

use eeruf_design::{PhaseFile, PhaseSchedule, robot_ring};
use eeruf_files::{Kind, build};
use eeruf_sim::{AnySchedule, ScheduleFile, World};
use serde::de::DeserializeOwned;

use super::error::InputError;
use super::implausible::{warn, warn_of};

/// Reads a TOML file of this kind, builds what it says, and warns about implausible values in it.
pub(crate) fn read_toml<T: DeserializeOwned, B>(
    file: &Path,
    kind: Kind,
    builder: impl FnOnce(T) -> Result<B, String>,
) -> Result<B, InputError> {
    let text = kind.read(file)?;
    let built = build(&text, builder).map_err(|error| error.in_file(file))?;
    warn_of(file, &text)?;
    Ok(built)
}

/// A schedule of two phases, as in the paper, or of many.
pub(crate) enum FoundSchedule {
    Two(Box<AnySchedule>),
    Many(Box<PhaseSchedule>),
}

/// Reads a schedule file of any number of phases.
pub(crate) fn read_any_schedule(file: &Path) -> Result<FoundSchedule, InputError> {
    let text = Kind::Schedule.read(file)?;
    if !PhaseFile::is_meant(&text) {
        return read_schedule(file).map(Box::new).map(FoundSchedule::Two);
    }
    let many = read_toml(file, Kind::Schedule, |many: PhaseFile| many.schedule())?;
    Ok(FoundSchedule::Many(Box::new(many)))
}

/// Reads a schedule file of two phases.
pub(crate) fn read_schedule(file: &Path) -> Result<AnySchedule, InputError> {
    read_toml(file, Kind::Schedule, |schedule: ScheduleFile| schedule.schedule())
}

/// Reads a scene with its robots.
pub(crate) fn read_world(file: &Path) -> Result<World, InputError> {
    let text = Kind::Scene.read(file)?;
    let world = World::from_text_with(file, &text, robot_ring)?;
    warn_of(file, &text)?;
    for (robot, doubt) in world.doubts() {
        warn(InputError::new(file, format!("robot {}: {doubt}", robot + 1)))?;
    }
    Ok(world)
}
