//! Edges: free ends of walls, and corners that jut out. Sound bends around them.

use core::f64::consts::{PI, TAU};

use super::Piece;
use crate::geometry::Point;
use crate::scene::wall::Wall;

/// Least angle by which a corner must open further than a straight wall, in radians: a choice, far above rounding.
const LEAST_TURN_RAD: f64 = 1e-6;

/// An edge with the open space around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Position.
    pub at: Point,
    /// The direction of one face, from the edge along the wall. The open space begins there, counter-clockwise.
    pub face_rad: f64,
    /// Angle of the open space around the edge: more than half a turn; a full turn at a wall's free end.
    pub outside_rad: f64,
}

impl Edge {
    /// Returns the direction of a point, from the face through the open space, in radians; `None` inside the solid.
    pub(crate) fn around(&self, point: Point) -> Option<f64> {
        let out = point - self.at;
        let angle = (libm::atan2(out.y, out.x) - self.face_rad).rem_euclid(TAU);
        (angle <= self.outside_rad).then_some(angle)
    }
}

/// Returns all edges of these pieces of wall, with the numbers of their vertices. Openings have none.
pub(crate) fn edges_of(vertices: &[Point], pieces: &[Piece], walls: &[Wall]) -> Vec<Edge> {
    let mut faces: Vec<Vec<f64>> = vec![Vec::new(); vertices.len()];
    for piece in pieces.iter().filter(|piece| !walls[piece.wall].is_open()) {
        let [from, to] = piece.ends;
        let along = vertices[to] - vertices[from];
        faces[from].push(libm::atan2(along.y, along.x));
        faces[to].push(libm::atan2(-along.y, -along.x));
    }
    let mut edges = Vec::new();
    for (&at, faces) in vertices.iter().zip(&mut faces) {
        faces.sort_by(f64::total_cmp);
        for (k, &face_rad) in faces.iter().enumerate() {
            let outside_rad = match faces.get(k + 1) {
                Some(next) => next - face_rad,
                None => faces[0] + TAU - face_rad,
            };
            if outside_rad > PI + LEAST_TURN_RAD {
                edges.push(Edge { at, face_rad, outside_rad });
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use crate::*;
    use core::f64::consts::{PI, TAU};

    // Free ends and corners that jut out are edges, and nothing else is.
    #[test]
    fn free_ends_and_outer_corners_are_edges() {
        let room = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let mut walls: Vec<_> = Wall::polyline(&room).collect();
        // One panel ends on a wall, and another is made of two straight pieces.
        walls.push(Wall::new(1.0, 0.0, 1.0, 1.0).with_faces(Faces::Both));
        walls.extend(Wall::polyline(&[[3.0, 0.5], [3.0, 1.0], [3.0, 1.5]]).map(|wall| wall.with_faces(Faces::Both)));
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        let open: Vec<_> =
            scene.edges().iter().filter(|edge| !scene.is_solid(edge.at + Vector::new(-0.01, -0.01))).collect();
        let mut found: Vec<_> = open.iter().map(|edge| ([edge.at.x, edge.at.y], edge.outside_rad)).collect();
        found.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]).then(a.0[1].total_cmp(&b.0[1])));
        let expected = [([1.0, 1.0], TAU), ([2.0, 2.0], 1.5 * PI), ([3.0, 0.5], TAU), ([3.0, 1.5], TAU)];
        for edge in expected {
            assert!(found.iter().any(|(at, outside)| *at == edge.0 && (outside - edge.1).abs() < 1e-12), "{edge:?}");
        }
        // The other edges are the corners of the room, seen from outside.
        assert!(
            found.iter().all(|(at, _)| room.contains(at) || expected.iter().any(|edge| edge.0 == *at)),
            "{found:?}"
        );
    }
}
