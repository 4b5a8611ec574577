//! Histogramic in-motion mapping (HIMM): a grid of certainty values that range readings fill and clear while the robot
//! drives.
//!
//! J. Borenstein and Y. Koren, "Histogramic in-motion mapping for mobile robot obstacle avoidance", IEEE Transactions
//! on Robotics and Automation 7(4), 1991, pp. 535-539. A reading counts only on the sensor's acoustic axis: the cell at
//! the measured range gains 3, each cell on the way there loses 1, and values stay between 0 and 15. A real obstacle is
//! met again and again and grows quickly; a phantom is met once and is cleared by the next readings that look past it.

#[cfg(test)]
mod tests;

use crate::geometry::{Point, Vector};

/// The highest certainty value, as in the HIMM paper.
pub const MAX_VALUE: u8 = 15;
/// Increase of the cell at the measured range, as in the HIMM paper.
pub const INCREMENT: u8 = 3;
/// Decrease of each cell in front of the measured range, as in the HIMM paper.
pub const DECREMENT: u8 = 1;

/// The certainty grid: a square of cells on a lattice fixed in the scene. The square can be moved along with the robot.
///
/// ```
/// use eeruf_sim::{Himm, Point};
/// let mut grid = Himm::new(33, 0.1);
/// grid.echo(Point::new(0.05, 0.05), 0.0, 0.0, 1.0);
/// assert_eq!(grid.value(Point::new(1.05, 0.05)), Some(3));
/// assert_eq!(grid.value(Point::new(9.0, 0.0)), None); // not in the window
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Himm {
    /// Values, row by row. The index of a cell is its lattice index modulo `side`, so that moving the window copies
    /// nothing.
    values: Vec<u8>,
    side: i64,
    cell_m: f64,
    /// Lattice index of the window's first cell.
    first: [i64; 2],
    /// The growth rate operator: a cell whose neighbours are certain grows faster.
    ///
    /// ```text
    /// C' = C + 3 + (sum of the eight neighbours) / 2
    /// ```
    ///
    /// The HIMM paper offers it for fast robots, which see an obstacle only a few times. Off by default.
    pub growth: bool,
}

impl Himm {
    /// Makes an empty grid of `side` times `side` cells, each `cell_m` metres wide, around the scene's origin. The
    /// papers use 33 cells of 0.1 m.
    ///
    /// A side of 0 counts as 1, a side above 4096 as 4096, and a width that is not positive as 0.1 m.
    pub fn new(side: usize, cell_m: f64) -> Self {
        let side = side.clamp(1, 4096);
        let cell_m = if cell_m > 0.0 && cell_m.is_finite() { cell_m } else { 0.1 };
        let mut grid = Self { values: vec![0; side * side], side: side as i64, cell_m, first: [0; 2], growth: false };
        grid.first = grid.first_around(Point::origin());
        grid
    }

    /// Returns the width of a cell in metres.
    pub fn cell_m(&self) -> f64 {
        self.cell_m
    }

    /// Returns the number of cells on a side of the window.
    pub fn side(&self) -> usize {
        self.side as usize
    }

    /// Returns the corner of the window with the least x and y.
    pub fn corner(&self) -> Point {
        Point::new(self.first[0] as f64 * self.cell_m, self.first[1] as f64 * self.cell_m)
    }

    /// Moves the window so that `place` is in its middle cell. Cells that leave the window are forgotten, and cells
    /// that enter it are empty.
    pub fn move_to(&mut self, place: Point) {
        let first = self.first_around(place);
        for axis in 0..2 {
            let gone = first[axis] - self.first[axis];
            // Cells that leave and cells that enter share their memory.
            let (from, to) = if gone >= 0 { (self.first[axis], first[axis]) } else { (first[axis], self.first[axis]) };
            for line in from..to.min(from + self.side) {
                for across in 0..self.side {
                    let cell = if axis == 0 { [line, across] } else { [across, line] };
                    let index = self.index(cell);
                    self.values[index] = 0;
                }
            }
            self.first[axis] = first[axis];
        }
    }

    /// Enters an echo: an obstacle `range_m` metres from `sensor` in the direction `heading_rad`, and nothing before
    /// it. Cells within `near_m` metres of the sensor, where it is deaf, remain unchanged.
    pub fn echo(&mut self, sensor: Point, heading_rad: f64, near_m: f64, range_m: f64) {
        if !(is_number(sensor, heading_rad) && (0.0..1e4).contains(&range_m)) {
            return;
        }
        let hit = self.cell_of(along(sensor, heading_rad, range_m));
        self.clear_until(sensor, heading_rad, near_m, range_m, Some(hit));
        if self.holds(hit) {
            let gain = INCREMENT + if self.growth { self.neighbours(hit) / 2 } else { 0 };
            let index = self.index(hit);
            self.values[index] = self.values[index].saturating_add(gain).min(MAX_VALUE);
        }
    }

    /// Enters free space between `near_m` and `range_m` metres from `sensor` in the direction `heading_rad`.
    pub fn clear(&mut self, sensor: Point, heading_rad: f64, near_m: f64, range_m: f64) {
        if is_number(sensor, heading_rad) {
            self.clear_until(sensor, heading_rad, near_m, range_m, None);
        }
    }

    /// Returns the certainty value of the cell that contains a point; `None` outside the window.
    pub fn value(&self, point: Point) -> Option<u8> {
        let cell = self.cell_of(point);
        self.holds(cell).then(|| self.values[self.index(cell)])
    }

    /// Returns the cells that are not empty, with their middles, in a square of `side` cells around a point, or in the
    /// whole window if that is smaller.
    pub fn occupied(&self, around: Point, side: usize) -> impl Iterator<Item = (Point, u8)> + '_ {
        let middle = self.cell_of(around);
        let half = (side.clamp(1, 8192) as i64) / 2;
        let range = move |axis: usize| {
            (middle[axis] - half).max(self.first[axis])..(middle[axis] + half + 1).min(self.first[axis] + self.side)
        };
        range(1).flat_map(move |y| range(0).map(move |x| [x, y])).filter_map(move |cell| {
            let value = self.values[self.index(cell)];
            let middle = |index: i64| (index as f64 + 0.5) * self.cell_m;
            (value > 0).then(|| (Point::new(middle(cell[0]), middle(cell[1])), value))
        })
    }

    fn first_around(&self, place: Point) -> [i64; 2] {
        self.cell_of(place).map(|index| index - self.side / 2)
    }

    fn cell_of(&self, point: Point) -> [i64; 2] {
        // A float too large for an index becomes the largest index, which is outside every window.
        [point.x, point.y].map(|value| ((value / self.cell_m).floor() as i64).clamp(-(1 << 40), 1 << 40))
    }

    fn holds(&self, cell: [i64; 2]) -> bool {
        (0..2).all(|axis| (self.first[axis]..self.first[axis] + self.side).contains(&cell[axis]))
    }

    fn index(&self, cell: [i64; 2]) -> usize {
        let [x, y] = cell.map(|index| index.rem_euclid(self.side));
        (y * self.side + x) as usize
    }

    fn neighbours(&self, cell: [i64; 2]) -> u8 {
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [dx, dy])).filter(|step| *step != [0, 0]);
        let cells = around.map(|[dx, dy]| [cell[0] + dx, cell[1] + dy]).filter(|&cell| self.holds(cell));
        // The sum is at most eight times fifteen.
        cells.map(|cell| self.values[self.index(cell)]).sum()
    }

    /// Subtracts one from each cell that the axis crosses between the two ranges, except from `hit` and the cells
    /// behind it.
    fn clear_until(&mut self, sensor: Point, heading_rad: f64, near_m: f64, range_m: f64, hit: Option<[i64; 2]>) {
        let near_m = near_m.max(0.0);
        if !(range_m > near_m && range_m < 1e4) {
            return;
        }
        let from = along(sensor, heading_rad, near_m);
        let to = along(sensor, heading_rad, range_m);
        let way = to - from;
        let (mut cell, last) = (self.cell_of(from), self.cell_of(to));
        let step = [way.x, way.y].map(|way| if way > 0.0 { 1 } else { -1 });
        // Shares of the way at which the axis enters the next column and the next row, and between two of them.
        let next = |axis: usize| {
            let (start, way) = ([from.x, from.y][axis], [way.x, way.y][axis]);
            let border = (cell[axis] + i64::from(step[axis] > 0)) as f64 * self.cell_m;
            if way == 0.0 { f64::INFINITY } else { (border - start) / way }
        };
        let mut next = [next(0), next(1)];
        let between = [way.x, way.y].map(|way| (self.cell_m / way).abs());
        let steps = (0..2).map(|axis| (last[axis] - cell[axis]).unsigned_abs()).sum::<u64>();
        for left in (0..=steps).rev() {
            if Some(cell) == hit {
                return;
            }
            if self.holds(cell) {
                let index = self.index(cell);
                self.values[index] = self.values[index].saturating_sub(DECREMENT);
            }
            if left > 0 {
                let axis = usize::from(next[1] < next[0]);
                cell[axis] += step[axis];
                next[axis] += between[axis];
            }
        }
    }
}

fn is_number(place: Point, heading_rad: f64) -> bool {
    place.x.is_finite() && place.y.is_finite() && heading_rad.is_finite()
}

fn along(from: Point, heading_rad: f64, range_m: f64) -> Point {
    from + Vector::new(libm::cos(heading_rad), libm::sin(heading_rad)) * range_m
}
