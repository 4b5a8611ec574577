//! The plane cut into triangles along the walls: a constrained Delaunay mesh, built once per scene. It is stored as
//! *gates*: a gate is one side of one triangle, seen by a beam that enters through it.

mod build;
pub(super) mod edges;
pub(super) mod extents;
mod hints;
pub(super) mod joints;

use crate::geometry::{Point, SAME_DIRECTION, Vector, cross};
use hints::Hints;

/// Marker of an exit that is a reflecting wall; the other bits are the gate through which the reflected beam returns.
const WALL: u32 = 1 << 31;
/// Marker of an exit from which nothing returns: an opening, the back of a wall, the rim of the mesh.
const SWALLOW: u32 = u32::MAX;
/// Marker of no wall and of no triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// The triangle behind one side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exit(u32);

/// The meaning of an [`Exit`].
pub(crate) enum Beyond {
    /// The next triangle, entered through this gate.
    Gate(u32),
    /// A wall; the reflected beam enters through this gate.
    Wall(u32),
    /// No sound returns from here.
    Swallow,
}

impl Exit {
    #[inline(always)]
    pub(crate) fn beyond(self) -> Beyond {
        if self.0 & WALL == 0 {
            Beyond::Gate(self.0)
        } else if self.0 == SWALLOW {
            Beyond::Swallow
        } else {
            Beyond::Wall(self.0 & !WALL)
        }
    }
}

/// One side of a triangle, entered from outside.
///
/// Gates `3 t`, `3 t + 1`, `3 t + 2` belong to triangle `t`, counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gate {
    /// The corner opposite to the gate.
    pub(crate) apex: Point,
    /// The triangle behind the side left of the apex, seen from the gate.
    pub(crate) left: Exit,
    /// The triangle behind the side right of the apex.
    pub(crate) right: Exit,
}

/// A side of a triangle seen from within: the exit behind it, and its two ends.
pub(crate) struct Side {
    pub(crate) exit: Exit,
    pub(crate) left: Point,
    pub(crate) right: Point,
}

/// A piece of wall between two vertices of the mesh.
pub(crate) struct Piece {
    pub(crate) ends: [usize; 2],
    pub(crate) wall: usize,
}

/// The triangles, and a grid of hints for locating points.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) gates: Vec<Gate>,
    /// The wall along each gate's own side, or [`NONE`].
    pub(crate) walls: Vec<u32>,
    /// The triangle on the far side of each gate, walls or not; [`NONE`] at the rim.
    across: Vec<u32>,
    /// Triangles in a region that meets only backs of walls.
    solid: Vec<bool>,
    hints: Hints,
    /// Half the width of the square that the mesh covers, and its middle.
    half_m: f64,
    middle: Point,
    /// Distance by which the mesh extends beyond the walls.
    pub(crate) reach_m: f64,
}

impl Mesh {
    /// Returns the number of triangles.
    pub(crate) fn len(&self) -> usize {
        self.gates.len() / 3
    }

    /// Returns the three sides of a triangle seen from within.
    pub(crate) fn sides(&self, triangle: u32) -> [Side; 3] {
        let base = 3 * triangle as usize;
        core::array::from_fn(|k| {
            let next = &self.gates[base + (k + 1) % 3];
            Side { exit: next.left, left: self.gates[base + (k + 2) % 3].apex, right: next.apex }
        })
    }

    fn corners(&self, triangle: u32) -> [Point; 3] {
        let base = 3 * triangle as usize;
        core::array::from_fn(|k| self.gates[base + (k + 1) % 3].apex)
    }

    /// Returns true if a point can be located: finite and within reach.
    pub(crate) fn covers(&self, point: Point) -> bool {
        // The comparison is written so that a NaN fails.
        (point.x - self.middle.x).abs() < self.half_m && (point.y - self.middle.y).abs() < self.half_m
    }

    /// Finds all triangles that contain a point: one, or two at a side, or a fan at a corner. The point must be
    /// [covered](Self::covers).
    pub(crate) fn containing(&self, point: Point, found: &mut Vec<u32>) {
        found.clear();
        found.push(self.locate(point));
        let mut next = 0;
        while let Some(&triangle) = found.get(next) {
            next += 1;
            let corners = self.corners(triangle);
            for k in 0..3 {
                let along = corners[(k + 1) % 3] - corners[k];
                let to = point - corners[k];
                let off = cross(along, to).abs();
                if off > SAME_DIRECTION * along.norm() * (to.norm() + along.norm()) {
                    continue;
                }
                let neighbour = self.across[3 * triangle as usize + k];
                if neighbour != NONE && !found.contains(&neighbour) && self.touches(neighbour, point) {
                    found.push(neighbour);
                }
            }
        }
    }

    /// Returns true if a triangle contains a point, its border included.
    pub(crate) fn touches(&self, triangle: u32, point: Point) -> bool {
        let corners = self.corners(triangle);
        (0..3).all(|k| {
            let along = corners[(k + 1) % 3] - corners[k];
            let to = point - corners[k];
            cross(along, to) >= -SAME_DIRECTION * along.norm() * (to.norm() + along.norm())
        })
    }

    /// Walks from a hint to a triangle that contains the point.
    fn locate(&self, point: Point) -> u32 {
        let mut triangle = self.hints.near(point);
        // A visibility walk may circle in a mesh that is not Delaunay everywhere. Rotating the first side tried makes
        // that rare, and a plain scan then ends it.
        for step in 0..64 + self.len().min(4096) {
            let corners = self.corners(triangle);
            let mut moved = false;
            for turn in 0..3 {
                let k = (turn + step) % 3;
                if cross(corners[(k + 1) % 3] - corners[k], point - corners[k]) < 0.0 {
                    let neighbour = self.across[3 * triangle as usize + k];
                    if neighbour != NONE {
                        triangle = neighbour;
                        moved = true;
                        break;
                    }
                }
            }
            if !moved {
                return triangle;
            }
        }
        (0..self.len() as u32).find(|&t| self.touches(t, point)).unwrap_or(triangle)
    }

    /// Returns all triangles that a disc overlaps, regardless of walls in between.
    pub(crate) fn near(&self, centre: Point, radius: f64) -> Vec<u32> {
        let mut found = Vec::new();
        self.containing(centre, &mut found);
        let mut next = 0;
        while let Some(&triangle) = found.get(next) {
            next += 1;
            let corners = self.corners(triangle);
            for k in 0..3 {
                let (from, along) = (corners[k], corners[(k + 1) % 3] - corners[k]);
                let share = ((centre - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                let neighbour = self.across[3 * triangle as usize + k];
                if neighbour != NONE && (from + along * share - centre).norm() <= radius && !found.contains(&neighbour)
                {
                    found.push(neighbour);
                }
            }
        }
        found
    }

    /// Returns true if a point lies inside a solid: in a region bounded by backs of walls only.
    pub(crate) fn is_solid(&self, point: Point) -> bool {
        self.covers(point) && self.solid[self.locate(point) as usize]
    }

    /// Returns true if a point, given with its triangles, is inside a solid and not on its surface; see
    /// [`containing`](Self::containing).
    pub(crate) fn is_solid_at(&self, triangles: &[u32]) -> bool {
        triangles.iter().all(|&triangle| self.solid[triangle as usize])
    }

    /// Visits the triangles within a distance that are visible from a point, some more than once. `starts` are the
    /// triangles that [contain](Self::containing) the point.
    pub(crate) fn visit_seen(&self, from: Point, starts: &[u32], reach_m: f64, mut visit: impl FnMut(u32)) {
        // Each entry is a cone between two corners of the scene, behind one side.
        let mut open: Vec<(Exit, Vector, Vector)> = Vec::new();
        for &start in starts {
            visit(start);
            open.extend(self.sides(start).map(|side| (side.exit, side.left - from, side.right - from)));
        }
        open.retain(|(_, left, right)| cross(*right, *left) > 0.0);
        while let Some((exit, left, right)) = open.pop() {
            let Beyond::Gate(number) = exit.beyond() else { continue };
            let [gate, end, other] = [0, 1, 2].map(|k| &self.gates[(number - number % 3 + (number + k) % 3) as usize]);
            let (to, along) = (end.apex - from, other.apex - end.apex);
            let nearest = to - along * (to.dot(&along) / along.norm_squared()).clamp(-1.0, 0.0);
            if nearest.norm() > reach_m {
                continue;
            }
            visit(number / 3);
            let ahead = gate.apex - from;
            // A line that meets a corner passes it on the right, as in `segment_reaches`.
            let (is_left, is_right) = (cross(right, ahead) >= 0.0, cross(ahead, left) > 0.0);
            if is_left {
                open.push((gate.right, if is_right { ahead } else { left }, right));
            }
            if is_right {
                open.push((gate.left, left, if is_left { ahead } else { right }));
            }
        }
    }

    /// Returns true if no wall crosses the segment between two points. `starts` and `goals` are the triangles that
    /// [contain](Self::containing) them.
    pub(crate) fn sees(&self, from: Point, starts: &[u32], to: Point, goals: &[u32]) -> bool {
        if starts.iter().any(|triangle| goals.contains(triangle)) {
            return true;
        }
        let ahead = to - from;
        let mut sides = starts.iter().flat_map(|&start| self.sides(start));
        sides.any(|side| {
            let (left, right) = (side.left - from, side.right - from);
            cross(right, left) > 0.0
                && cross(right, ahead) >= 0.0
                && cross(ahead, left) >= 0.0
                && self.segment_reaches(side.exit, from, ahead, goals)
        })
    }

    fn segment_reaches(&self, mut exit: Exit, from: Point, ahead: Vector, goals: &[u32]) -> bool {
        // A straight line enters a triangle at most once.
        for _ in 0..self.len() {
            let Beyond::Gate(gate) = exit.beyond() else {
                return false;
            };
            if goals.contains(&(gate / 3)) {
                return true;
            }
            let gate = &self.gates[gate as usize];
            exit = if cross(ahead, gate.apex - from) >= 0.0 { gate.right } else { gate.left };
        }
        false
    }
}
