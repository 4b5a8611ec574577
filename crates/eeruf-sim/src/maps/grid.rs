//! An occupancy grid, and its conversion to walls.

use std::fs;
use std::path::Path;

use eeruf_files::FileError;

use super::contours::contours;
use super::{pgm, simplify, yaml};
use crate::scene::Wall;

/// Probability that `map_saver`'s grey of unknown cells stands for, rounded down; newer versions write a `free_thresh`
/// above it.
const UNKNOWN: f64 = 0.196;

/// Occupied and free cells of a square grid, and the pose of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct OccupancyGrid {
    width: usize,
    height: usize,
    /// Occupied cells, row by row, the lowest first.
    occupied: Vec<bool>,
    /// Cells that are known to be free.
    free: Vec<bool>,
    cell_m: f64,
    /// Position of the lower left corner, in metres, and the grid's heading, in radians.
    origin: [f64; 3],
}

impl OccupancyGrid {
    /// Reads a map of the ROS `map_server`: a YAML file that names a picture beside it. A cell is occupied if its
    /// probability is above `occupied_thresh`, free if it is below `free_thresh`, and otherwise neither.
    ///
    /// The keys are `image` (a PGM), `resolution` (metres per pixel), `origin` (x, y in metres and yaw in radians of
    /// the lower left corner), and optionally `negate`, `occupied_thresh`, `free_thresh` and `mode` (`trinary` or
    /// `scale`).
    ///
    /// # Errors
    /// The first error found, with the file that contains it.
    pub fn read(file: &Path) -> Result<Self, FileError> {
        let text = fs::read_to_string(file).map_err(|error| FileError::reading(file, &error))?;
        let head = yaml::read(&text).map_err(|message| FileError::new(file, message))?;
        let image = file.parent().unwrap_or(Path::new("")).join(&head.image);
        let bytes = fs::read(&image).map_err(|error| FileError::reading(&image, &error))?;
        let picture = pgm::read(&bytes).map_err(|message| FileError::new(&image, message))?;
        let chance = |bright: f32| if head.negate { f64::from(bright) } else { 1.0 - f64::from(bright) };
        let free_thresh = head.free_thresh.min(UNKNOWN).min(head.occupied_thresh);
        // A picture's first row is the highest.
        let rows = || picture.pixels.chunks_exact(picture.width).rev().flatten();
        let occupied = rows().map(|&bright| chance(bright) > head.occupied_thresh).collect();
        let free = rows().map(|&bright| chance(bright) < free_thresh).collect();
        let (width, height) = (picture.width, picture.height);
        Ok(Self { width, height, occupied, free, cell_m: head.resolution_m, origin: head.origin })
    }

    /// Returns the number of columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Returns the width of a cell in metres.
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Returns true if the cell in this column and row, counted from the lower left, is occupied. Cells outside the
    /// grid are not.
    pub fn is_occupied(&self, column: usize, row: usize) -> bool {
        column < self.width && row < self.height && self.occupied[row * self.width + column]
    }

    /// Returns the middles of all cells that are known to be free, in metres.
    pub fn free_m(&self) -> Vec<[f64; 2]> {
        let cells = self.free.iter().enumerate().filter(|(_, free)| **free);
        cells.map(|(cell, _)| self.place([cell % self.width, cell / self.width].map(|at| at as f64 + 0.5))).collect()
    }

    /// Returns true if all cells within this distance of a point, in metres, are known to be free.
    ///
    /// Cells outside the grid are not known to be free.
    pub fn is_free_around(&self, [x, y]: [f64; 2], radius_m: f64) -> bool {
        let [left, low, yaw] = self.origin;
        let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
        let (along, aside) = (x - left, y - low);
        let at = [cos * along + sin * aside, cos * aside - sin * along].map(|m| m / self.cell_m);
        let radius = radius_m / self.cell_m;
        let [columns, rows] = at.map(|at| (at - radius).floor() as i64..=(at + radius).floor() as i64);
        let off = |cell: i64, at: f64| (cell as f64 - at).max(at - cell as f64 - 1.0).max(0.0);
        let is_free = |column: i64, row: i64| {
            let inside = |at: i64, size: usize| usize::try_from(at).ok().filter(|&at| at < size);
            let cell = inside(column, self.width).zip(inside(row, self.height));
            cell.is_some_and(|(column, row)| self.free[row * self.width + column])
        };
        rows.into_iter().all(|row| {
            let mut near = columns.clone().filter(|&column| libm::hypot(off(column, at[0]), off(row, at[1])) < radius);
            near.all(|column| is_free(column, row))
        })
    }

    /// Returns the direction of the grid's rows, in radians.
    pub fn heading_rad(&self) -> f64 {
        self.origin[2]
    }

    /// Converts a point counted in cells from the grid's corner to a position in metres.
    fn place(&self, cells: [f64; 2]) -> [f64; 2] {
        let [x, y, yaw] = self.origin;
        let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
        let [along, aside] = cells.map(|cells| cells * self.cell_m);
        [x + cos * along - sin * aside, y + sin * along + cos * aside]
    }

    /// The recommended tolerance in metres: one and a half cells. A straight wall becomes a stair whose corners lie in
    /// a strip at most `sqrt(2)` cells wide, so this tolerance makes it straight again.
    pub fn default_tolerance_m(&self) -> f64 {
        1.5 * self.cell_m
    }

    /// Returns the outlines of occupied cells as walls, seen from outside. Walls and edges of the cells are within the
    /// tolerance, in metres, of each other, and no two walls cross. With a tolerance of 0 or less a slanted wall is a
    /// stair of cells; see [`default_tolerance_m`](Self::default_tolerance_m).
    ///
    /// Cells that touch at a corner belong together, so that no sound slips between them.
    pub fn walls(&self, tolerance_m: f64) -> Vec<Wall> {
        let tolerance = if tolerance_m > 0.0 { tolerance_m / self.cell_m } else { 0.0 };
        let outlines = contours(self.width, self.height, |column, row| self.is_occupied(column, row));
        let place = |corner: [i64; 2]| self.place(corner.map(|cells| cells as f64));
        let closed = simplify::simplified(&outlines, tolerance).into_iter().map(|corners| {
            let mut places: Vec<_> = corners.into_iter().map(place).collect();
            places.extend(places.first().copied());
            places
        });
        closed.flat_map(|places| Wall::polyline(&places).collect::<Vec<_>>()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::scene::{Air, Scene};

    /// Writes a map into a folder of its own and reads it.
    fn map(name: &str, yaml: &str, pgm: &[u8]) -> Result<OccupancyGrid, FileError> {
        let folder = std::env::temp_dir().join(format!("eeruf-map-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("map.pgm"), pgm).unwrap();
        fs::write(folder.join("map.yaml"), yaml).unwrap();
        let grid = OccupancyGrid::read(&folder.join("map.yaml"));
        fs::remove_dir_all(&folder).unwrap();
        grid
    }

    const YAML: &str = "image: map.pgm\nresolution: 0.5\norigin: [10, 20, 0]\n";

    // A room in a picture has four walls on the inside and four on the outside.
    #[test]
    fn room_in_a_picture_has_four_walls_each_side() {
        // The picture is black all around and white within, with a grey pixel that is unknown.
        let grid = map("room", YAML, b"P2 4 4 255 0 0 0 0 0 255 255 0 0 255 205 0 0 0 0 0").unwrap();
        assert_eq!((grid.size(), grid.cell_m()), ([4, 4], 0.5));
        assert!(grid.is_occupied(0, 0) && !grid.is_occupied(1, 1) && !grid.is_occupied(9, 9));
        let walls = grid.walls(0.0);
        assert_eq!(walls.len(), 8);
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        assert!(!scene.is_solid(Point::new(11.0, 21.0)) && scene.is_solid(Point::new(10.25, 21.0)));
        assert!(!scene.is_solid(Point::new(9.0, 21.0)));
    }

    #[test]
    fn free_space_is_what_is_known_to_be_free() {
        // Newer maps have a free_thresh above the grey of unknown cells.
        for more in ["", "free_thresh: 0.25\n", "free_thresh: 0.1\n"] {
            let text = format!("{}{more}", YAML.replace("0]", "1.5707963267948966]"));
            let grid = map("free", &text, b"P2 4 2 255 255 255 205 0 255 255 255 255").unwrap();
            assert_eq!(grid.free_m().len(), 6, "{more}");
            // The grid's rows run along y.
            assert!(grid.is_free_around([9.5, 20.5], 0.5) && !grid.is_free_around([9.5, 20.5], 0.51));
            assert!(!grid.is_free_around([9.5, 21.0], 0.3) && grid.is_free_around([9.75, 21.75], 0.2));
            assert!(!grid.is_free_around([9.25, 21.25], 0.1));
        }
        assert_eq!(map("none", &format!("{YAML}free_thresh: 0\n"), b"P2 1 1 1 1").unwrap().free_m().len(), 0);
    }

    #[test]
    fn rows_count_from_below_and_the_origin_turns_the_map() {
        let grid = map("turned", &YAML.replace("20, 0]", "20, 1.5707963267948966]"), b"P2 1 2 1 1 0").unwrap();
        assert!(grid.is_occupied(0, 0) && !grid.is_occupied(0, 1));
        let walls = grid.walls(0.0);
        let x: Vec<f64> = walls.iter().map(|wall| wall.from.x).collect();
        let y: Vec<f64> = walls.iter().map(|wall| wall.from.y).collect();
        let near = |values: &[f64], low: f64, high: f64| {
            (values.iter().copied().fold(f64::INFINITY, f64::min) - low).abs() < 1e-12
                && (values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - high).abs() < 1e-12
        };
        assert!(near(&x, 9.5, 10.0) && near(&y, 20.0, 20.5), "{walls:?}");
    }

    #[test]
    fn errors_name_the_file_that_is_wrong() {
        let error = |name, yaml: &str, pgm: &[u8]| map(name, yaml, pgm).unwrap_err().to_string();
        assert!(error("a", "image: no.pgm\nresolution: 1\norigin: [0, 0, 0]", b"").contains("no.pgm: "));
        assert!(error("b", &YAML.replace("0.5", "0"), b"").contains("map.yaml: resolution = 0; expected above 0"));
        assert!(error("d", &format!("{YAML}mode: \"a\\nb\"\n"), b"").contains("mode = a; b; expected"));
        assert!(error("c", YAML, b"P5 2 2 255\n").contains("map.pgm: 0 bytes of pixels; 2 x 2 need 4"));
    }
}
