//! The plane cut into triangles along the walls: a constrained Delaunay mesh, built once per scene.
//! Stored as *gates*: a gate is one side of one triangle, seen by a beam that enters through it.

use crate::{
    error::SceneError,
    plane::{Point, SAME_DIRECTION, cross},
    wall::{Faces, Wall},
};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashMap;

/// Marks an exit that is a reflecting wall; the other bits are the gate by which the reflected beam comes back.
const WALL: u32 = 1 << 31;
/// An exit from which nothing returns: an opening, the back of a wall, the rim of the mesh.
const SWALLOW: u32 = u32::MAX;
/// Not a wall, not a triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// What lies behind one side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exit(u32);

/// [`Exit`], taken apart.
pub(crate) enum Beyond {
    /// The next triangle, entered by this gate.
    Gate(u32),
    /// A wall; the reflected beam enters by this gate.
    Wall(u32),
    /// Nothing.
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
    /// What lies behind the side left of the apex, seen from the gate.
    pub(crate) left: Exit,
    /// What lies behind the side right of the apex.
    pub(crate) right: Exit,
}

/// A side of a triangle seen from within: what is behind it, and its two ends.
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

/// The triangles and a grid of hints that finds the one under a point.
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
    /// How far beyond the walls the mesh reaches.
    pub(crate) reach_m: f64,
}

impl Mesh {
    /// Builds the mesh from distinct vertices and pieces of walls that do not cross.
    /// It reaches beyond the walls and the `landmarks`, which are not part of it.
    pub(crate) fn build(
        mut vertices: Vec<Point>,
        pieces: &[Piece],
        walls: &[Wall],
        landmarks: impl Iterator<Item = Point>,
    ) -> Result<Self, SceneError> {
        let (middle, extent) = bounds(vertices.iter().copied().chain(landmarks));
        // Far corners let source and receiver stand outside the walls. They never become the limit of a beam that meets a
        // wall, because nothing lies behind them.
        let reach_m = 1000.0 + 10.0 * extent;
        let half_m = reach_m + extent;
        let first_corner = vertices.len();
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            vertices.push(Point::new(middle.x + half_m * x, middle.y + half_m * y));
        }

        let points: Vec<_> = vertices.iter().map(|v| Point2::new(v.x, v.y)).collect();
        let edges: Vec<_> = pieces.iter().map(|piece| piece.ends).collect();
        let mut refused = 0;
        let cdt = ConstrainedDelaunayTriangulation::<_>::try_bulk_load_cdt(points, edges, |_| {
            refused += 1;
        })
        .map_err(|_| SceneError::Tangled { pieces: pieces.len() })?;
        if refused > 0 || cdt.num_vertices() != first_corner + 4 {
            return Err(SceneError::Tangled { pieces: refused });
        }
        let mut wall_between = HashMap::with_capacity(pieces.len());
        for piece in pieces {
            wall_between.insert((piece.ends[0] as u32, piece.ends[1] as u32), piece.wall as u32);
        }

        // Number triangles and gates.
        let mut triangle_of_face = vec![NONE; cdt.num_all_faces()];
        for (triangle, face) in cdt.inner_faces().enumerate() {
            triangle_of_face[face.fix().index()] = triangle as u32;
        }
        let count = cdt.num_inner_faces();
        let mut sides = Vec::with_capacity(3 * count);
        let mut gate_of_edge = vec![NONE; cdt.num_directed_edges()];
        for face in cdt.inner_faces() {
            for edge in face.adjacent_edges() {
                gate_of_edge[edge.fix().index()] = sides.len() as u32;
                sides.push(edge);
            }
        }
        let mut exits = Vec::with_capacity(3 * count);
        let mut wall_along = Vec::with_capacity(3 * count);
        let mut across = Vec::with_capacity(3 * count);
        for (gate, edge) in sides.iter().enumerate() {
            let (from, to) = (edge.from().fix().index() as u32, edge.to().fix().index() as u32);
            // The triangle is on the left of its side, so a piece in the same direction shows it the wall's left.
            let front = wall_between.get(&(from, to)).copied();
            let wall = front.or_else(|| wall_between.get(&(to, from)).copied());
            let twin = gate_of_edge[edge.rev().fix().index()];
            let exit = match wall {
                Some(wall) => match (walls[wall as usize].faces, front.is_some()) {
                    (Faces::Both, _) | (Faces::Left, true) => WALL | gate as u32,
                    (Faces::Left, false) | (Faces::Open, _) => SWALLOW,
                },
                None if twin == NONE => SWALLOW,
                None => twin,
            };
            exits.push(Exit(exit));
            wall_along.push(wall.unwrap_or(NONE));
            across.push(if twin == NONE { NONE } else { twin / 3 });
        }
        let gates: Vec<_> = (0..3 * count)
            .map(|gate| {
                let (triangle, k) = (gate - gate % 3, gate % 3);
                Gate {
                    apex: vertices[sides[triangle + (k + 2) % 3].from().fix().index()],
                    left: exits[triangle + (k + 2) % 3],
                    right: exits[triangle + (k + 1) % 3],
                }
            })
            .collect();

        let mut mesh = Self {
            gates,
            walls: wall_along,
            across,
            solid: Vec::new(),
            hints: Hints::default(),
            half_m,
            middle,
            reach_m,
        };
        mesh.solid = mesh.find_solid(&exits, walls);
        mesh.hints = Hints::over(&mesh, middle, extent);
        Ok(mesh)
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.gates.len() / 3
    }

    /// The three sides of a triangle seen from within.
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

    /// Whether a point can be located: finite and within reach.
    pub(crate) fn covers(&self, point: Point) -> bool {
        // Written so that a NaN fails.
        (point.x - self.middle.x).abs() < self.half_m && (point.y - self.middle.y).abs() < self.half_m
    }

    /// Finds all triangles that contain a point: one, two when it lies on a side, a fan when it lies on a corner.
    /// The point must be [covered](Self::covers).
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

    /// Whether a triangle contains a point, its border included.
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
        // A visibility walk may circle in a mesh that is not Delaunay everywhere; turning the first side tried makes that
        // rare, and a plain scan ends it for good.
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

    /// All triangles that a disc overlaps, whatever walls are in between.
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

    /// Whether a point lies inside something solid: in a region bounded by backs of walls only.
    pub(crate) fn is_solid(&self, point: Point) -> bool {
        self.covers(point) && self.solid[self.locate(point) as usize]
    }

    /// Whether the straight segment between two points meets no wall.
    pub(crate) fn sees(&self, from: Point, to: Point, [starts, goals]: &mut [Vec<u32>; 2]) -> bool {
        self.containing(from, starts);
        self.containing(to, goals);
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

    fn segment_reaches(&self, mut exit: Exit, from: Point, ahead: crate::plane::Vector, goals: &[u32]) -> bool {
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

    /// Regions (triangles joined where no wall or an opening is between them) that touch backs of walls and no front.
    fn find_solid(&self, exits: &[Exit], walls: &[Wall]) -> Vec<bool> {
        let mut solid = vec![false; self.len()];
        let mut seen = vec![false; self.len()];
        let mut region = Vec::new();
        for start in 0..self.len() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            region.clear();
            region.push(start as u32);
            let (mut backs, mut fronts) = (false, false);
            let mut next = 0;
            while let Some(&triangle) = region.get(next) {
                next += 1;
                for gate in 3 * triangle as usize..3 * triangle as usize + 3 {
                    let wall = walls.get(self.walls[gate] as usize);
                    if wall.is_none_or(Wall::is_open) {
                        let neighbour = self.across[gate];
                        if neighbour != NONE && !seen[neighbour as usize] {
                            seen[neighbour as usize] = true;
                            region.push(neighbour);
                        }
                    } else if exits[gate] == Exit(SWALLOW) {
                        backs = true;
                    } else {
                        fronts = true;
                    }
                }
            }
            if backs && !fronts {
                for &triangle in &region {
                    solid[triangle as usize] = true;
                }
            }
        }
        solid
    }
}

/// A coarse grid over the walls; each cell knows a triangle near it.
#[derive(Debug, Default)]
struct Hints {
    corner: [f64; 2],
    per_m: f64,
    side: usize,
    cells: Vec<u32>,
}

impl Hints {
    fn over(mesh: &Mesh, middle: Point, extent: f64) -> Self {
        let side = ((mesh.len() as f64).sqrt().ceil() as usize).clamp(1, 2048);
        let mut hints = Self {
            corner: [middle.x - extent, middle.y - extent],
            per_m: side as f64 / (2.0 * extent),
            side,
            cells: vec![NONE; side * side],
        };
        for triangle in 0..mesh.len() as u32 {
            let [a, b, c] = mesh.corners(triangle);
            let cell = hints.cell(Point::from((a.coords + b.coords + c.coords) / 3.0));
            hints.cells[cell] = triangle;
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
        // The cast saturates, so far points land in the cells of the rim.
        let index = |offset: f64| ((offset * self.per_m) as usize).min(self.side - 1);
        index(point.y - self.corner[1]) * self.side + index(point.x - self.corner[0])
    }

    fn near(&self, point: Point) -> u32 {
        self.cells[self.cell(point)]
    }
}

/// Middle and half extent (at least a metre) of a set of points.
fn bounds(mut points: impl Iterator<Item = Point>) -> (Point, f64) {
    let Some(first) = points.next() else {
        return (Point::origin(), 1.0);
    };
    let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let middle = Point::from((low.coords + high.coords) / 2.0);
    let half = (high - low) / 2.0;
    (middle, half.x.max(half.y).max(1.0))
}
