//! Panels: flat stretches of wall both of whose ends are edges, so that they may be narrower than what sound needs to
//! be reflected whole. A stretch that ends at a corner which juts in is none: its image goes on where it ends.

use core::f64::consts::{PI, TAU};

use super::Piece;
use crate::geometry::Point;
use crate::scene::wall::Wall;

/// A stretch is flat as far as its pieces are turned against each other by no more, in radians: a choice, ten degrees.
const FLAT_RAD: f64 = PI / 18.0;
/// A stretch of more pieces counts as one without end.
const MAX_PIECES: usize = 1000;

/// One side of a wall: the left one, seen from its first end, or the right one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Side {
    pub(crate) wall: u32,
    pub(crate) left: bool,
}

/// All panels of a scene.
#[derive(Debug, Default)]
pub(crate) struct Panels {
    /// For each wall the ends of the panel that its left side belongs to, and of that of its right side.
    of_walls: Vec<[Option<[Point; 2]>; 2]>,
    /// For each edge the side of a wall where the open space around it begins, and the one where it ends.
    of_edges: Vec<[Side; 2]>,
    any: bool,
}

impl Panels {
    /// The panels of these pieces of wall, whose edges have `of_edges` as their sides.
    pub(crate) fn new(vertices: &[Point], pieces: &[Piece], walls: &[Wall], of_edges: Vec<[Side; 2]>) -> Self {
        let joints = Joints::new(vertices, pieces, walls);
        let mut of_walls = vec![[None; 2]; walls.len()];
        let mut known = vec![false; walls.len()];
        for (index, piece) in pieces.iter().enumerate().filter(|(_, piece)| !walls[piece.wall].is_open()) {
            if core::mem::replace(&mut known[piece.wall], true) {
                continue;
            }
            of_walls[piece.wall] = [true, false].map(|left| {
                let [from, to] = [false, true].map(|at_end| joints.end(Visit { piece: index, at_end, left }));
                Some([from?, to?])
            });
        }
        let any = of_walls.iter().flatten().any(Option::is_some);
        Self { of_walls, of_edges, any }
    }

    /// Whether there is one.
    pub(crate) fn any(&self) -> bool {
        self.any
    }

    /// The ends of the panel that a side belongs to, if it does to one.
    pub(crate) fn of(&self, side: Side) -> Option<[Point; 2]> {
        self.of_walls.get(side.wall as usize)?[usize::from(!side.left)]
    }

    /// The sides of walls between which an edge's open space is.
    pub(crate) fn sides(&self, edge: usize) -> Option<[Side; 2]> {
        self.of_edges.get(edge).copied()
    }
}

/// A piece of wall as it leaves a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) angle_rad: f64,
    pub(super) piece: usize,
    /// Whether the vertex is where the piece ends, seen from its first end.
    pub(super) at_end: bool,
}

impl Face {
    /// The side of its wall that the open space looks at which begins at the face, counter-clockwise.
    pub(super) fn begins(&self, pieces: &[Piece]) -> Side {
        Side { wall: pieces[self.piece].wall as u32, left: !self.at_end }
    }

    /// The same where the open space ends.
    pub(super) fn ends(&self, pieces: &[Piece]) -> Side {
        Side { wall: pieces[self.piece].wall as u32, left: self.at_end }
    }
}

/// For each vertex the pieces of wall that leave it, counter-clockwise. Openings are none.
pub(super) fn faces_of(vertices: &[Point], pieces: &[Piece], walls: &[Wall]) -> Vec<Vec<Face>> {
    let mut faces: Vec<Vec<Face>> = vec![Vec::new(); vertices.len()];
    for (index, piece) in pieces.iter().enumerate().filter(|(_, piece)| !walls[piece.wall].is_open()) {
        let [from, to] = piece.ends;
        let along = vertices[to] - vertices[from];
        faces[from].push(Face { angle_rad: libm::atan2(along.y, along.x), piece: index, at_end: false });
        faces[to].push(Face { angle_rad: libm::atan2(-along.y, -along.x), piece: index, at_end: true });
    }
    for faces in &mut faces {
        faces.sort_by(|a, b| a.angle_rad.total_cmp(&b.angle_rad));
    }
    faces
}

/// One end of one side of a piece.
#[derive(Clone, Copy)]
struct Visit {
    piece: usize,
    at_end: bool,
    left: bool,
}

/// How pieces are joined.
struct Joints<'a> {
    vertices: &'a [Point],
    pieces: &'a [Piece],
    faces: Vec<Vec<Face>>,
}

impl<'a> Joints<'a> {
    fn new(vertices: &'a [Point], pieces: &'a [Piece], walls: &[Wall]) -> Self {
        Self { vertices, pieces, faces: faces_of(vertices, pieces, walls) }
    }

    /// Where the flat stretch ends that a side of a piece belongs to; none where it goes on by its image.
    fn end(&self, mut at: Visit) -> Option<Point> {
        let mut turned = 0.0;
        for _ in 0..MAX_PIECES {
            let vertex = self.pieces[at.piece].ends[usize::from(at.at_end)];
            let faces = &self.faces[vertex];
            let own = faces.iter().position(|face| face.piece == at.piece && face.at_end == at.at_end)?;
            // The open space before this side begins at its face, or ends there.
            let begins = at.left != at.at_end;
            let (next, open_rad) = if begins {
                let next = (own + 1) % faces.len();
                (next, (faces[next].angle_rad - faces[own].angle_rad).rem_euclid(TAU))
            } else {
                let next = (own + faces.len() - 1) % faces.len();
                (next, (faces[own].angle_rad - faces[next].angle_rad).rem_euclid(TAU))
            };
            turned += if next == own { PI } else { open_rad - PI };
            if turned > FLAT_RAD {
                return Some(self.vertices[vertex]);
            }
            if turned < -FLAT_RAD {
                return None;
            }
            let Face { piece, at_end, .. } = faces[next];
            at = Visit { piece, at_end: !at_end, left: if begins { at_end } else { !at_end } };
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Side;
    use crate::*;

    fn widths(scene: &Scene) -> Vec<[Option<f64>; 2]> {
        let of = |wall, left| scene.panels.of(Side { wall, left }).map(|[from, to]| (to - from).norm());
        (0..scene.walls().len() as u32).map(|wall| [of(wall, true), of(wall, false)]).collect()
    }

    fn panels(walls: Vec<Wall>) -> Vec<[Option<f64>; 2]> {
        let scene = Scene::new(walls, vec![], Air::default()).unwrap();
        let rounded = |width: f64| (width * 1e9).round() / 1e9;
        widths(&scene).iter().map(|sides| sides.map(|width| width.map(rounded))).collect()
    }

    #[test]
    fn a_panel_ends_where_nothing_goes_on_and_at_corners_that_jut_out() {
        let both = |points: &[[f64; 2]]| Wall::polyline(points).map(|wall| wall.with_faces(Faces::Both)).collect();
        assert_eq!(panels(both(&[[0.0, 0.0], [0.1, 0.0]])), [[Some(0.1); 2]]);
        // Two pieces of one, and three that are turned by nearly nothing.
        assert_eq!(panels(both(&[[0.0, 0.0], [0.1, 0.0], [0.3, 0.0]])), [[Some(0.3); 2]; 2]);
        // A pillar, walked clockwise, from outside; its inside has only corners that jut in.
        let pillar = [[0.0, 0.0], [0.0, 0.2], [0.1, 0.2], [0.1, 0.0], [0.0, 0.0]];
        let [high, wide] = [0.2, 0.1].map(|width| [Some(width), None]);
        assert_eq!(panels(Wall::polyline(&pillar).collect()), [high, wide, high, wide]);
        // A room has none, and neither has an alcove: its sides go on in their images at the back.
        let room = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
        assert!(panels(Wall::polyline(&room).collect()).iter().all(|[inside, _]| inside.is_none()));
        let alcove = [[0.8, 0.0], [0.8, 1.4], [-0.8, 1.4], [-0.8, 0.0]];
        assert!(panels(Wall::polyline(&alcove).collect()).iter().all(|[inside, _]| inside.is_none()));
    }

    #[test]
    fn a_wall_that_ends_on_a_panel_from_one_side_divides_that_side_only() {
        let panel = Wall::new(0.0, 0.0, 0.2, 0.0).with_faces(Faces::Both);
        let on_it = Wall::new(0.1, 0.0, 0.1, 0.5).with_faces(Faces::Both);
        assert_eq!(panels(vec![panel, on_it])[0], [None, Some(0.2)]);
    }
}
