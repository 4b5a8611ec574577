//! Reading TOML: any file of ours, schedules, and scenes.

use std::fs;
use std::path::Path;

use eeruf_design::{PhaseFile, PhaseSchedule, parse};
use eeruf_sim::{AnySchedule, ScheduleFile, World};
use serde::de::DeserializeOwned;

use super::error::InputError;

/// Reads a TOML file.
pub(crate) fn read_toml<T: DeserializeOwned>(file: &Path) -> Result<T, InputError> {
    let text = fs::read_to_string(file).map_err(|error| InputError::new(file, None, error))?;
    parse(&text).map_err(|error| InputError::new(file, error.line, error.message))
}

/// A schedule of two phases, as in the paper, or of many.
pub(crate) enum FoundSchedule {
    Two(Box<AnySchedule>),
    Many(Box<PhaseSchedule>),
}

/// Reads a schedule file of any number of phases.
pub(crate) fn read_any_schedule(file: &Path) -> Result<FoundSchedule, InputError> {
    let text = fs::read_to_string(file).map_err(|error| InputError::new(file, None, error))?;
    if !PhaseFile::is_meant(&text) {
        return read_schedule(file).map(Box::new).map(FoundSchedule::Two);
    }
    let many = read_toml::<PhaseFile>(file)?.schedule().map_err(|message| InputError::new(file, None, message))?;
    Ok(FoundSchedule::Many(Box::new(many)))
}

/// Reads a schedule file of two phases.
pub(crate) fn read_schedule(file: &Path) -> Result<AnySchedule, InputError> {
    read_toml::<ScheduleFile>(file)?.schedule().map_err(|message| InputError::new(file, None, message))
}

/// Reads a scene with its robots.
pub(crate) fn read_world(file: &Path) -> Result<World, InputError> {
    World::from_toml(file).map_err(|error| {
        // A scene names the file that is to blame, which may be that of a schedule.
        InputError::new(&error.file, error.line.map(|line| line as u64), &error.message)
    })
}
