//! Maps of robots, for `scene` and as rooms.

use std::path::Path;

use eeruf_files::{Kind, doubt};
use eeruf_sim::OccupancyGrid;

use super::error::InputError;
use super::implausible::warn;

/// Reads a map: a YAML file and the picture beside it.
pub(crate) fn read_map(file: &Path) -> Result<OccupancyGrid, InputError> {
    Kind::Map.read(file)?;
    let grid = OccupancyGrid::read(file)?;
    if let Some(doubt) = doubt("resolution", grid.cell_m()) {
        warn(InputError::new(file, format!("resolution: {doubt}")))?;
    }
    Ok(grid)
}
