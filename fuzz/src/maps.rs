//! Maps: a YAML file, followed by its picture `map.pgm` from the first line that begins a PGM.

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use eeruf_sim::OccupancyGrid;

use crate::one_line;

static FOLDER: LazyLock<PathBuf> = LazyLock::new(crate::folder);

/// The largest number of cells whose outlines are followed.
const MOST: usize = 10_000;

/// Reads the map, and turns it into walls.
pub fn check(bytes: &[u8]) {
    let picture =
        bytes.windows(3).position(|three| matches!(three, b"\nP2" | b"\nP5")).map_or(bytes.len(), |at| at + 1);
    let (yaml, pgm) = (FOLDER.join("map.yaml"), FOLDER.join("map.pgm"));
    fs::write(&yaml, &bytes[..picture]).expect("a file can be written");
    fs::write(&pgm, &bytes[picture..]).expect("a file can be written");
    let grid = match OccupancyGrid::read(&yaml) {
        Ok(grid) => grid,
        Err(error) => return one_line(&error.to_string()),
    };
    let [width, height] = grid.size();
    assert!(width > 0 && height > 0 && grid.cell_m() > 0.0);
    if width.saturating_mul(height) > MOST {
        return;
    }
    let cells = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let occupied = cells.filter(|&(column, row)| grid.is_occupied(column, row)).count();
    let exact = grid.walls(0.0);
    // Each cell that borders on a free one is seen, and an outline has at least four walls.
    assert_eq!(exact.is_empty(), occupied == 0);
    assert!(exact.is_empty() || exact.len() >= 4);
    let straight = grid.walls(grid.default_tolerance_m());
    assert!(straight.len() <= exact.len());
    let finite =
        |wall: &eeruf_sim::Wall| [wall.from.x, wall.from.y, wall.to.x, wall.to.y].iter().all(|m| m.is_finite());
    assert!(exact.iter().chain(&straight).all(finite));
}
