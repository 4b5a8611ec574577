//! Reading TOML: any file of ours, schedules, and scenes.

use std::path::Path;

use eeruf_design::robot_ring;
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

/// Keys of schedules of earlier versions.
const OF_MANY_PHASES: [&str; 4] = ["step_us", "phases", "first_multiplier", "t_fire_us"];

/// Reads a schedule file.
pub(crate) fn read_schedule(file: &Path) -> Result<AnySchedule, InputError> {
    let text = Kind::Schedule.read(file)?;
    let keys = toml::from_str::<toml::Table>(&text).unwrap_or_default();
    if let Some(key) = OF_MANY_PHASES.into_iter().find(|&key| keys.contains_key(key)) {
        return Err(InputError::new(file, format!("{key}, of many phases: gone; flow does it")));
    }
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
