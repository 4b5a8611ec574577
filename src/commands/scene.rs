//! `eeruf lab scene`: makes a scene file from a map.

use std::path::PathBuf;

use eeruf_sim::{Air, Noise, Physics, Scene, world_file};

use super::Answer;
use crate::console::{print, print_line};
use crate::files::error::InputError;
use crate::files::map::read_map;

/// Turn an occupancy grid into a scene file.
///
/// The grid is what ROS's map_server saves, a YAML file that names a PGM picture beside it; the walls are its outlines.
/// A cell is occupied if its probability is above the file's occupied_thresh; an unknown one is not. Add robots to the
/// scene, and study it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The map
    #[arg(value_name = "MAP.yaml")]
    file: PathBuf,
    /// Largest distance of walls from the edges of the occupied cells, in metres; by default one and a half cells,
    /// which straightens the stairs that a slanted wall becomes in cells
    #[arg(long, value_name = "M", value_parser = tolerance)]
    tolerance_m: Option<f64>,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(tolerance) if (0.0..=1000.0).contains(&tolerance) => Ok(tolerance),
        _ => Err("expected 0 to 1000".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let grid = read_map(&args.file)?;
    let tolerance_m = args.tolerance_m.unwrap_or(grid.default_tolerance_m());
    let walls = grid.walls(tolerance_m);
    let bad = |error: eeruf_sim::SceneError| InputError::new(&args.file, error);
    let (count, [columns, rows]) = (walls.len(), grid.size());
    let scene = Scene::new(walls, vec![], Air::default()).map_err(bad)?;
    print_line(format_args!(
        "# {}: {columns} x {rows} cells of {} m; {count} walls within {tolerance_m} m of their edges.",
        args.file.display(),
        grid.cell_m(),
    ))?;
    print(world_file(&scene, &[], &Noise::default(), &Physics::DEFAULT, eeruf_sim::world::DEFAULT_ORDER, 0, &[]))?;
    Ok(Answer::Yes)
}
