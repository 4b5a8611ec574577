//! Reading TOML: any file of ours, schedules, and scenes.

use std::fs;
use std::path::Path;

use eeruf_core::{Micros, Requirements};
use eeruf_design::{PhaseFile, PhaseSchedule, parse, robot_ring};
use eeruf_sim::{AnySchedule, ScheduleFile, World};
use serde::de::DeserializeOwned;

use super::error::InputError;
use super::implausible::{warn, warn_of};
use super::kind::Kind;

/// Reads a text file of this kind.
fn read_text(file: &Path, kind: Kind) -> Result<String, InputError> {
    let bad = |message: &dyn std::fmt::Display| InputError::new(file, None, message);
    // The name of a log says what it is, and not every log is text.
    kind.expect(file, "").map_err(|message| bad(&message))?;
    let text = fs::read_to_string(file).map_err(|error| InputError::reading(file, &error))?;
    kind.expect(file, &text).map_err(|message| bad(&message))?;
    Ok(text)
}

/// The parser's message, with the expectation that it leaves out where a key is missing.
fn expected(message: &str) -> String {
    if message.starts_with("missing field") {
        format!("{message}; expected the key to be set")
    } else {
        message.to_owned()
    }
}

/// Reads a TOML file of this kind, builds what it says, and warns about implausible values in it.
pub(crate) fn read_toml<T: DeserializeOwned, B>(
    file: &Path,
    kind: Kind,
    build: impl FnOnce(T) -> Result<B, String>,
) -> Result<B, InputError> {
    let text = read_text(file, kind)?;
    let parsed = parse(&text).map_err(|error| InputError::new(file, error.line, expected(&error.message)))?;
    let built = build(parsed).map_err(|message| InputError::new(file, None, message))?;
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
    let text = read_text(file, Kind::Schedule)?;
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
    let text = read_text(file, Kind::Scene)?;
    let world = World::from_text_with(file, &text, robot_ring).map_err(|error| {
        // A scene names the file that is to blame, which may be that of a schedule.
        InputError::new(&error.file, error.line.map(|line| line as u64), expected(&error.message))
    })?;
    warn_of(file, &text)?;
    for (number, robot) in (1..).zip(world.robots()) {
        let Some(schedule) = &robot.schedule else { continue };
        let nothing_asked = Requirements::new(Micros::ZERO);
        let report = schedule.verify(&nothing_asked);
        let Some(most) = report.max_t_delta().filter(|&most| most < robot.t_delta) else { continue };
        let message = format!(
            "robot {number}: t_delta_us: {}; expected at most {}, what its schedule rejects; crosstalk passes; see \
             `eeruf verify`",
            robot.t_delta.as_micros(),
            most.as_micros()
        );
        warn(InputError::new(file, None, message))?;
    }
    Ok(world)
}
