//! Reading TOML: any file of ours, schedules, and scenes.

use std::path::Path;

use eeruf_core::Micros;
use eeruf_design::robot_ring;
use eeruf_files::{Kind, build, doubt};
use eeruf_sim::{AnySchedule, Body, Motion, ScheduleFile, World};
use serde::de::DeserializeOwned;

use super::error::InputError;
use super::implausible::{warn, warn_of};

/// Reads a TOML file of this kind, builds a value from it, and warns about implausible values in it.
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
    unlikely(&world).map_or(Ok(()), |why| Err(InputError::new(file, why)))?;
    warn_of(file, &text)?;
    if let [robot] = world.robots()
        && matches!(robot.motion, Motion::Still)
        && is_silent(&world)
    {
        let found = "robot 1: no wall or pole within its sensors' range";
        warn(InputError::new(file, format!("{found}; expected one; check its pose, and points_m of walls")))?;
    }
    for (robot, doubt) in world.doubts() {
        warn(InputError::new(file, format!("robot {}: {doubt}", robot + 1)))?;
    }
    Ok(world)
}

/// Finds two signs that a scene's numbers are in units other than its keys say.
fn unlikely(world: &World) -> Option<String> {
    let number = |us: Micros| f64::from(us.as_micros());
    for robot in world.robots() {
        let (period, window) = (robot.period, robot.window);
        if doubt("period_us", number(period)).is_some() && period < window {
            return Some(format!(
                "period_us: {}, and a window of {window}, which is longer; expected microseconds, likely milliseconds",
                period.as_micros()
            ));
        }
    }
    // Nothing near reflects sound, and coordinates are beyond those of rooms.
    let walls = world.scene().walls().iter().flat_map(|wall| [wall.from, wall.to]);
    let farthest = walls.flat_map(|at| [at.x.abs(), at.y.abs()]).fold(0.0, f64::max);
    let is_far = doubt("points_m", farthest).is_some() && is_silent(world);
    is_far.then(|| {
        format!(
            "points_m: {farthest}, and no wall that a sensor hears; expected metres, likely centimetres or millimetres"
        )
    })
}

/// Returns true if no stationary robot has a wall or a pole within its sensors' range.
fn is_silent(world: &World) -> bool {
    world.robots().iter().filter(|robot| matches!(robot.motion, Motion::Still)).all(|robot| {
        let reach_m = robot.transducers().map(|transducer| transducer.max_range_m).fold(0.0, f64::max);
        let reach = Body::Disc(robot.radius_m() + reach_m);
        world.scene().contact(&reach, &robot.pose).is_none()
    })
}
