//! `sim.read_map`: a scene out of an occupancy grid.

use std::path::PathBuf;

use eeruf_sim::{Air, Noise, OccupancyGrid, Physics, WorldParts, world::DEFAULT_ORDER};
use pyo3::prelude::*;

use crate::{
    arguments::{number, shown, wrong},
    errors::{Raise, SceneError, warn},
    scene::Scene,
};

/// A scene out of an occupancy grid, as the ROS ``map_server`` saves it: walls along the outlines of what is occupied.
///
/// A cell is occupied if it is with a probability above the file's ``occupied_thresh``; one of which nothing is known
/// is not. Add robots with :meth:`Scene.replace`.
///
/// Args:
///     path: of the YAML file, which names a PGM picture beside it.
///     tolerance_m: how far walls may be from the edges of the occupied cells, in metres, 0 to 1000; one and a half
///         cells if it is not given, which makes the stair straight that a slanted wall becomes in cells.
///
/// Raises:
///     ArgumentError: not a path, or no such tolerance.
///     SceneError: no such file, or it says something that makes no map: by name, value and what is expected.
///
/// Example:
///     >>> from pathlib import Path
///     >>> from tempfile import TemporaryDirectory
///     >>> from eeruf import sim
///     >>> with TemporaryDirectory() as folder:
///     ...     _ = (Path(folder) / "room.pgm").write_text("P2 4 3 1  0 0 0 0  0 1 1 0  0 0 0 0")
///     ...     text = "image: room.pgm\nresolution: 0.5\norigin: [0, 0, 0]"
///     ...     _ = (Path(folder) / "room.yaml").write_text(text)
///     ...     sim.read_map(Path(folder) / "room.yaml", tolerance_m=0)
///     <Scene: 8 walls, 0 poles, 0 robots>
#[pyfunction]
#[pyo3(signature = (path, *, tolerance_m=None))]
pub(crate) fn read_map(path: &Bound<'_, PyAny>, tolerance_m: Option<&Bound<'_, PyAny>>) -> PyResult<Scene> {
    let py = path.py();
    let path: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a map's YAML file"))?;
    let tolerance_m = tolerance_m.map(|value| number("tolerance_m", value, 0.0..=1000.0)).transpose()?;
    let grid = OccupancyGrid::read(&path).map_err(|error| SceneError::new_err(error.to_string()))?;
    if let Some(doubt) = eeruf_files::doubt("resolution", grid.cell_m()) {
        warn(py, format_args!("{}: resolution: {doubt}", path.display()))?;
    }
    let walls = grid.walls(tolerance_m.unwrap_or(grid.default_tolerance_m()));
    let scene = eeruf_sim::Scene::new(walls, vec![], Air::default()).map_err(Raise::raise)?;
    let (noise, physics) = (Noise::default(), Physics::DEFAULT);
    Scene::of(
        WorldParts { scene, robots: vec![], noise, physics, max_order: DEFAULT_ORDER, seed: 0, faults: vec![] },
        vec![],
    )
}
