//! Building the mesh: the triangulation, its gates with their exits, and the solid regions.

use super::hints::Hints;
use super::{Exit, Gate, Mesh, NONE, Piece, SWALLOW, WALL};
use crate::geometry::Point;
use crate::scene::error::SceneError;
use crate::scene::wall::{Faces, Wall};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashMap;

impl Mesh {
    /// Builds the mesh from distinct vertices and pieces of walls that do not cross. The mesh extends beyond the walls
    /// and beyond the `landmarks`, which are not part of it.
    pub(crate) fn build(
        mut vertices: Vec<Point>,
        pieces: &[Piece],
        walls: &[Wall],
        landmarks: impl Iterator<Item = Point>,
    ) -> Result<Self, SceneError> {
        let (middle, extent) = bounds(vertices.iter().copied().chain(landmarks));
        // Far corners let source and receiver stand outside the walls. They never become the limit of a beam that meets
        // a wall, because nothing lies behind them.
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
            // The triangle is on the left of its side, so a piece in the same direction faces it with the wall's left.
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
        let corners: Vec<_> = (0..mesh.len() as u32).map(|triangle| mesh.corners(triangle)).collect();
        mesh.hints = Hints::over(&corners, middle, extent);
        Ok(mesh)
    }

    /// Finds regions (triangles that join without a wall or at an opening) that touch backs of walls and no front.
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

/// Returns the middle and the half extent (at least a metre) of a set of points.
fn bounds(mut points: impl Iterator<Item = Point>) -> (Point, f64) {
    let Some(first) = points.next() else {
        return (Point::origin(), 1.0);
    };
    let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let middle = Point::from((low.coords + high.coords) / 2.0);
    let half = (high - low) / 2.0;
    (middle, half.x.max(half.y).max(1.0))
}
