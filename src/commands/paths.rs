//! `eeruf lab paths`: every critical path of a ring, by which one sensor hears another.

use std::path::PathBuf;

use eeruf_sim::{MAX_ORDER, World};

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::toml::read_world;
use crate::report::bounces::{by_way_of, wall_numbers};
use crate::report::paths::PathsJson;

/// List the critical paths of a ring: all paths of sound between the sensors of a scene's first robot.
///
/// A path counts if its sound is loud enough to be heard, under the scene's own physics and with other robots' bodies,
/// as in a simulation. Sensors are printed from 1; walls and poles from 0, as in files.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The scene
    #[arg(value_name = "SCENE.toml")]
    file: PathBuf,
    /// Largest number of bounces; by default the scene's max_order
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_ORDER)))]
    order: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let world = read_world(&args.file)?;
    let max_order = args.order.unwrap_or(world.max_order());
    let bad = |error| InputError::new(&args.file, error);
    let paths = critical_paths(&world, max_order).map_err(|error| bad(error.to_string()))?;
    let text = || {
        format!(
            "{}: {} critical paths of up to {max_order} bounces; levels in dB above what is just heard\n{}\n",
            args.file.display(),
            paths.order.len(),
            paths.table(),
        )
    };
    show(args.json, || &paths, text)?;
    Ok(Answer::Yes)
}

fn critical_paths(world: &World, max_order: u32) -> Result<PathsJson, eeruf_sim::PathsError> {
    let mut out = PathsJson::default();
    let Some(robot) = world.robots().first() else { return Ok(out) };
    let matrix = world.ring_paths(0, max_order)?;
    for path in matrix.paths().iter().filter(|path| path.emitter != path.receiver) {
        out.emitter.push(path.emitter);
        out.receiver.push(path.receiver);
        out.length_m.push(path.length_m);
        out.order.push(path.order);
        out.departure_rad.push(path.departure_rad);
        out.arrival_rad.push(path.arrival_rad);
        out.amplitude.push(path.amplitude);
        let receiver = robot.transducer_of(path.receiver as usize);
        out.level_db.push(receiver.level_db(path.amplitude, path.length_m, world.scene().air()));
        let bounces = matrix.bounces(path);
        out.walls.push(wall_numbers(bounces));
        out.by_way_of.push(by_way_of(bounces));
    }
    Ok(out)
}
