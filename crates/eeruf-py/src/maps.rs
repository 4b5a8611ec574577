//! A scene from an occupancy grid.

use std::path::PathBuf;

use eeruf_sim::{Air, Noise, OccupancyGrid, Physics, WorldParts, world::DEFAULT_ORDER};
use pyo3::prelude::*;

use crate::{
    arguments::{number, shown, wrong},
    errors::{EerufError, Raise, warn},
};

/// The walls of a map as parts of a world without robots.
pub(crate) fn read_map(path: &Bound<'_, PyAny>, tolerance_m: Option<&Bound<'_, PyAny>>) -> PyResult<WorldParts> {
    let py = path.py();
    let path: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a map's YAML file"))?;
    let tolerance_m = tolerance_m.map(|value| number("tolerance_m", value, 0.0..=1000.0)).transpose()?;
    let grid = OccupancyGrid::read(&path).map_err(|error| EerufError::new_err(error.to_string()))?;
    if let Some(doubt) = eeruf_files::doubt("resolution", grid.cell_m()) {
        warn(py, format_args!("{}: resolution: {doubt}", path.display()))?;
    }
    let walls = grid.walls(tolerance_m.unwrap_or(grid.default_tolerance_m()));
    let scene = eeruf_sim::Scene::new(walls, vec![], Air::default()).map_err(Raise::raise)?;
    let (noise, physics) = (Noise::default(), Physics::DEFAULT);
    Ok(WorldParts { scene, robots: vec![], noise, physics, max_order: DEFAULT_ORDER, seed: 0, faults: vec![] })
}
