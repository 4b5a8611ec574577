//! Extents of walls: the ends of straight reflecting surfaces. Pieces that continue each other are one surface; it ends
//! at the end of a wall and at corners that jut out, but not at corners of less than half a turn.

use core::f64::consts::{PI, TAU};

use super::Piece;
use super::edges::Edge;
use crate::geometry::{Point, Vector};
use crate::scene::wall::{Faces, Wall};

/// Angle in radians below which two pieces continue each other: a choice, half a degree. A decimetre from such a bend,
/// half a first Fresnel zone at 1 m, an echo is out of step by less than a quarter of a wavelength.
const STRAIGHT_RAD: f64 = 0.0087;

/// The left and the right side of a wall, looking from its start to its end.
const LEFT: usize = 0;
const RIGHT: usize = 1;

/// The two ends of a surface, first towards its start and then towards its end. `None` if another wall meets it at less
/// than half a turn: the image continues beyond the corner, and no sound is diffracted.
pub(crate) type Ends = [Option<End>; 2];

/// One end of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    pub(crate) at: Point,
    /// The scene's number of the edge there, if sound is diffracted at it.
    pub(crate) edge: Option<u32>,
}

/// A surface that reflects on its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// A point of the surface, and its direction.
    pub(crate) on: Point,
    pub(crate) along: Vector,
    pub(crate) ends: Ends,
}

/// A piece of a wall, and the ends of the surfaces on its two sides.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    wall: usize,
    /// Distance of the stretch's end from the wall's start, in metres.
    upto_m: f64,
    sides: [Ends; 2],
}

/// The ends of all surfaces of a scene.
#[derive(Debug, Default)]
pub(crate) struct Extents {
    /// Stretches of each wall, in order from its start.
    stretches: Vec<Stretch>,
    /// Surfaces that end at an edge, each once.
    pub(crate) surfaces: Vec<Surface>,
    /// For each edge, the index of its first surface in `at_edges`; one more entry follows at the end.
    starts: Vec<u32>,
    /// The surfaces that end at each edge, in the order of the edges.
    at_edges: Vec<u32>,
    /// For each wall, true if its surface ends somewhere, on either side.
    ends: Vec<bool>,
}

impl Extents {
    /// Follows each piece of wall both ways on each side. Openings are ignored.
    pub(crate) fn new(vertices: &[Point], pieces: &[Piece], walls: &[Wall], edges: &[Edge]) -> Self {
        let corners = Corners::new(vertices, pieces, walls);
        let edges_in_all = edges.len();
        let mut edges = edges.iter().enumerate().peekable();
        // Edges are in the order of their vertices.
        let edge_at: Vec<_> =
            vertices.iter().map(|at| edges.next_if(|(_, edge)| edge.at == *at).map(|(k, _)| k as u32)).collect();
        let mut extents = Self::default();
        for (index, piece) in pieces.iter().enumerate().filter(|(_, piece)| !walls[piece.wall].is_open()) {
            let wall = &walls[piece.wall];
            let found = [LEFT, RIGHT].map(|side| [0, 1].map(|end| corners.end_of(index, side, end)));
            let end = |vertex: usize| End { at: vertices[vertex], edge: edge_at[vertex] };
            let sides = found.map(|ends| ends.map(|vertex| vertex.map(end)));
            let upto_m = (vertices[piece.ends[1]] - wall.from).norm();
            extents.stretches.push(Stretch { wall: piece.wall, upto_m, sides });
            let along = (wall.to - wall.from).normalize();
            for side in [LEFT, RIGHT].into_iter().filter(|side| reflects(wall, *side)) {
                // On the right side, directions are reversed.
                let along = if side == LEFT { along } else { -along };
                let [first, last] = if side == LEFT { [0, 1] } else { [1, 0] };
                // The piece at one end represents the surface.
                let stands = match found[side][first] {
                    Some(vertex) => vertex == piece.ends[first],
                    None => found[side][last] == Some(piece.ends[last]),
                };
                let ends = [sides[side][first], sides[side][last]];
                if stands && ends.iter().flatten().any(|end| end.edge.is_some()) {
                    extents.surfaces.push(Surface { on: wall.from, along, ends });
                }
            }
        }
        extents.index(edges_in_all, walls.len());
        extents
    }

    /// Lists the surfaces that end at each edge, and marks the walls whose surface ends.
    fn index(&mut self, edges: usize, walls: usize) {
        let mut of_edges = vec![Vec::new(); edges];
        for (number, surface) in (0..).zip(&self.surfaces) {
            for edge in surface.ends.iter().flatten().filter_map(|end| end.edge) {
                of_edges[edge as usize].push(number);
            }
        }
        self.starts.push(0);
        for surfaces in &of_edges {
            self.at_edges.extend_from_slice(surfaces);
            self.starts.push(self.at_edges.len() as u32);
        }
        self.ends.resize(walls, false);
        for stretch in &self.stretches {
            self.ends[stretch.wall] |= stretch.sides.iter().flatten().any(Option::is_some);
        }
    }

    /// Returns the numbers of the surfaces that end at an edge.
    pub(crate) fn at_edge(&self, edge: usize) -> &[u32] {
        &self.at_edges[self.starts[edge] as usize..self.starts[edge + 1] as usize]
    }

    /// Returns true if a wall's surface ends somewhere, on either side.
    pub(crate) fn ends(&self, wall: u32) -> bool {
        self.ends.get(wall as usize).is_some_and(|ends| *ends)
    }

    /// Returns the ends of the surface around a point of a wall, at this distance from the wall's start, on one side.
    pub(crate) fn around(&self, wall: u32, from_start_m: f64, on_left: bool) -> Ends {
        let wall = wall as usize;
        let first = self.stretches.partition_point(|stretch| stretch.wall < wall);
        let of_wall = self.stretches[first..].iter().take_while(|stretch| stretch.wall == wall);
        let mut ends = [None; 2];
        for stretch in of_wall {
            ends = stretch.sides[if on_left { LEFT } else { RIGHT }];
            if from_start_m <= stretch.upto_m {
                break;
            }
        }
        ends
    }
}

/// A wall that leaves a vertex.
#[derive(Clone, Copy)]
struct Arm {
    angle_rad: f64,
    piece: usize,
    /// The end of the piece at this vertex.
    end: usize,
}

/// All walls around each vertex, counter-clockwise.
struct Corners<'a> {
    pieces: &'a [Piece],
    walls: &'a [Wall],
    arms: Vec<Vec<Arm>>,
}

impl<'a> Corners<'a> {
    fn new(vertices: &[Point], pieces: &'a [Piece], walls: &'a [Wall]) -> Self {
        let mut arms = vec![Vec::new(); vertices.len()];
        for (piece, Piece { ends, wall }) in pieces.iter().enumerate() {
            if walls[*wall].is_open() {
                continue;
            }
            for end in 0..2 {
                let out = vertices[ends[1 - end]] - vertices[ends[end]];
                arms[ends[end]].push(Arm { angle_rad: libm::atan2(out.y, out.x), piece, end });
            }
        }
        for arms in &mut arms {
            arms.sort_by(|a, b| a.angle_rad.total_cmp(&b.angle_rad));
        }
        Self { pieces, walls, arms }
    }

    /// Returns the vertex at which the surface on this side of a piece ends, towards one of the piece's ends.
    fn end_of(&self, mut piece: usize, mut side: usize, mut end: usize) -> Option<usize> {
        let mut bent_rad = 0.0;
        for _ in 0..self.pieces.len() {
            let vertex = self.pieces[piece].ends[end];
            let arms = &self.arms[vertex];
            let here = arms.iter().position(|arm| (arm.piece, arm.end) == (piece, end))?;
            // The open space on the left is clockwise of the arm at the piece's end, counter-clockwise at its start.
            let clockwise = (side == LEFT) == (end == 1);
            let next = arms[(here + if clockwise { arms.len() - 1 } else { 1 }) % arms.len()];
            let turn = arms[here].angle_rad - next.angle_rad;
            let open_rad = if arms.len() == 1 { TAU } else { if clockwise { turn } else { -turn }.rem_euclid(TAU) };
            let facing = if clockwise == (next.end == 0) { LEFT } else { RIGHT };
            bent_rad += open_rad - PI;
            if bent_rad > STRAIGHT_RAD || !reflects(&self.walls[self.pieces[next.piece].wall], facing) {
                return Some(vertex);
            }
            if bent_rad < -STRAIGHT_RAD {
                return None;
            }
            (piece, side, end) = (next.piece, facing, 1 - next.end);
        }
        None
    }
}

fn reflects(wall: &Wall, side: usize) -> bool {
    match wall.faces {
        Faces::Left => side == LEFT,
        Faces::Both => true,
        Faces::Open => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::*;

    /// Returns the end of the surface that a point of a wall belongs to, on the wall's left or right.
    fn ends(walls: &[Wall], wall: u32, from_start_m: f64, on_left: bool) -> [Option<[f64; 2]>; 2] {
        let scene = Scene::new(walls.to_vec(), vec![], Air::default()).unwrap();
        scene.extents().around(wall, from_start_m, on_left).map(|end| end.map(|end| [end.at.x, end.at.y]))
    }

    fn panels(corners: &[[f64; 2]]) -> Vec<Wall> {
        Wall::polyline(corners).map(|wall| wall.with_faces(Faces::Both)).collect()
    }

    #[test]
    fn a_panel_ends_where_it_ends_however_it_is_cut_and_directed() {
        let whole = panels(&[[0.0, 0.0], [1.0, 0.0]]);
        let mut cut = panels(&[[0.0, 0.0], [0.3, 0.0], [0.7, 0.0], [1.0, 0.0]]);
        cut[1] = Wall::new(0.7, 0.0, 0.3, 0.0).with_faces(Faces::Both);
        let (start, end) = (Some([0.0, 0.0]), Some([1.0, 0.0]));
        for on_left in [true, false] {
            assert_eq!(ends(&whole, 0, 0.5, on_left), [start, end]);
            assert_eq!(ends(&cut, 0, 0.1, on_left), [start, end]);
            assert_eq!(ends(&cut, 1, 0.1, on_left), [end, start]);
            assert_eq!(ends(&cut, 2, 0.1, on_left), [start, end]);
        }
        let scene = Scene::new(cut, vec![], Air::default()).unwrap();
        assert_eq!(scene.extents().surfaces.len(), 2, "its two sides");
    }

    #[test]
    fn a_wall_ends_at_corners_that_jut_out_and_not_at_others() {
        // An L, walked counter-clockwise: the corner at (2, 2) juts out into it.
        let room = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        let walls: Vec<_> = Wall::polyline(&room).collect();
        let corner = Some([2.0, 2.0]);
        assert_eq!(ends(&walls, 0, 1.0, true), [None, None]);
        assert_eq!(ends(&walls, 2, 1.0, true), [None, corner]);
        assert_eq!(ends(&walls, 3, 1.0, true), [corner, None]);
        // The surface ends next to an opening and at the back of a wall, which absorbs sound.
        let mut open = walls.clone();
        open[1].faces = Faces::Open;
        assert_eq!(ends(&open, 0, 1.0, true), [None, Some([4.0, 0.0])]);
        let backs = [Wall::new(0.0, 0.0, 1.0, 0.0), Wall::new(1.0, 1.0, 1.0, 0.0)];
        assert_eq!(ends(&backs, 0, 0.5, true), [Some([0.0, 0.0]), Some([1.0, 0.0])]);
    }

    // A wall on which another ends continues behind it, and has a corner in front of it.
    #[test]
    fn wall_behind_a_junction_goes_on() {
        let mut walls = panels(&[[0.0, 0.0], [2.0, 0.0]]);
        walls.push(Wall::new(0.5, 1.0, 0.5, 0.0).with_faces(Faces::Both));
        let (start, end) = (Some([0.0, 0.0]), Some([2.0, 0.0]));
        assert_eq!(ends(&walls, 0, 0.2, true), [start, None]);
        assert_eq!(ends(&walls, 0, 1.2, true), [None, end]);
        assert_eq!(ends(&walls, 0, 0.2, false), [start, end]);
        assert_eq!(ends(&walls, 0, 1.2, false), [start, end]);
        assert_eq!(ends(&walls, 1, 0.2, true), [Some([0.5, 1.0]), None]);
    }

    #[test]
    fn a_bend_of_half_a_degree_is_straight_and_many_of_them_are_not() {
        let bent = |steps: u32, each: f64| {
            let (mut at, mut corners) = ([0.0, 0.0], vec![[0.0, 0.0]]);
            for k in 0..steps {
                let (sin, cos) = libm::sincos(f64::from(k) * each);
                at = [at[0] + cos, at[1] + sin];
                corners.push(at);
            }
            (panels(&corners), at)
        };
        let (once, last) = bent(2, 0.008);
        assert_eq!(ends(&once, 0, 0.5, true), [Some([0.0, 0.0]), Some(last)]);
        let (sharper, _) = bent(2, 0.012);
        assert_eq!(ends(&sharper, 0, 0.5, true), [Some([0.0, 0.0]), None], "its inner side");
        assert_eq!(ends(&sharper, 0, 0.5, false), [Some([0.0, 0.0]), Some([1.0, 0.0])], "its outer side");
        // No surface goes around a ring of such bends.
        let (ring, _) = bent(785, 0.008);
        assert_eq!(ends(&ring, 100, 0.5, true), [None, None]);
        let on = |end: Option<[f64; 2]>| end.is_some();
        assert_eq!(ends(&ring, 100, 0.5, false).map(on), [true, true]);
    }
}
