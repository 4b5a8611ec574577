//! Triangles at which the search for a point starts.

use super::NONE;
use crate::geometry::Point;

/// A coarse grid over the walls; each cell stores a nearby triangle.
#[derive(Debug, Default)]
pub(super) struct Hints {
    corner: [f64; 2],
    per_m: f64,
    side: usize,
    cells: Vec<u32>,
}

impl Hints {
    pub(super) fn over(corners: &[[Point; 3]], middle: Point, extent: f64) -> Self {
        let side = ((corners.len() as f64).sqrt().ceil() as usize).clamp(1, 2048);
        let mut hints = Self {
            corner: [middle.x - extent, middle.y - extent],
            per_m: side as f64 / (2.0 * extent),
            side,
            cells: vec![NONE; side * side],
        };
        for (triangle, [a, b, c]) in corners.iter().enumerate() {
            let cell = hints.cell(Point::from((a.coords + b.coords + c.coords) / 3.0));
            hints.cells[cell] = triangle as u32;
        }
        let mut last = 0;
        for cell in &mut hints.cells {
            if *cell == NONE {
                *cell = last;
            }
            last = *cell;
        }
        hints
    }

    fn cell(&self, point: Point) -> usize {
        // The cast saturates, so distant points fall into cells of the rim.
        let index = |offset: f64| ((offset * self.per_m) as usize).min(self.side - 1);
        index(point.y - self.corner[1]) * self.side + index(point.x - self.corner[0])
    }

    pub(super) fn near(&self, point: Point) -> u32 {
        self.cells[self.cell(point)]
    }
}
