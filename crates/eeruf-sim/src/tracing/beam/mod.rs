//! The beam tree: every sequence of walls over which some of the source's sound really passes.
//!
//! A beam is an image of the source and a cone that looks through one visible piece of wall. It is followed through the
//! triangles of the mesh: a corner inside the cone splits it, and a wall turns it into a beam of the next order. The
//! limits of a cone always point at mirrored *corners* of the scene, never at computed points of intersection, so that
//! errors do not accumulate. Each node is a piece of wall that is really visible, and the tree grows about
//! quadratically with the order.

mod growth;
mod readout;
mod receiver_block;
mod tree;

use crate::geometry::{Point, SAME_DIRECTION, Vector, cross};

pub(super) use growth::Growth;
pub(super) use readout::push_chain;
pub(super) use tree::BeamTree;

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    /// The source, mirrored in every wall of the sequence.
    pub(crate) image: Point,
    /// The limits of the beam's cone.
    pub(super) left: Vector,
    pub(super) right: Vector,
    /// The last wall's side of the mesh, through which the beam enters.
    pub(super) gate: u32,
    /// The parent beam; `NONE` for the source's own.
    pub(crate) parent: u32,
    /// The last wall.
    pub(crate) wall: u32,
    pub(crate) order: u32,
    /// Turn of the image's world: the direction of departure `d` is `turn + d` there after an even number of bounces,
    /// `turn - d` after an odd number.
    pub(crate) turn: f64,
    /// The product of the walls' reflections.
    pub(crate) reflection_gain: f64,
    /// Heading of the source in the image's world, if it matters.
    pub(crate) axis: Vector,
    /// Length beyond which paths of this beam are inaudible or exceed the query's limit.
    pub(super) reach_m: f64,
}

/// An image of the source that a receiver sees over walls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VisibleImage {
    pub(crate) length_m: f64,
    pub(crate) image: Point,
    pub(crate) turn: f64,
    /// The product of the walls' reflections, as if all were flat.
    pub(crate) reflection_gain: f64,
    pub(crate) receiver: u32,
    pub(crate) order: u32,
    /// The beam before the last wall, or `NONE` without a wall.
    pub(crate) parent: u32,
    /// The last wall.
    pub(crate) wall: u32,
    /// Heading of the source in the image's world, if it matters.
    pub(super) axis: Vector,
}

/// A cone through a triangle that contains a pole.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PoleCone {
    pub(crate) pole: u32,
    pub(crate) triangle: u32,
    pub(crate) beam: u32,
    pub(super) left: Vector,
    pub(super) right: Vector,
}

impl PoleCone {
    /// Returns true if a point, relative to the beam's image, is in the cone, limits included.
    pub(crate) fn holds(&self, ahead: Vector) -> bool {
        cone_holds(self.left, self.right, ahead)
    }
}

/// Returns true if a point is in a cone, limits included. A relative tolerance makes a path through the apex of a
/// corner visible to both walls.
#[inline(always)]
pub(super) fn cone_holds(left: Vector, right: Vector, ahead: Vector) -> bool {
    let (l, r) = (cross(ahead, left), cross(right, ahead));
    if l >= 0.0 && r >= 0.0 {
        return true;
    }
    let near = SAME_DIRECTION * (ahead.x.abs() + ahead.y.abs());
    l >= -near * (left.x.abs() + left.y.abs())
        && r >= -near * (right.x.abs() + right.y.abs())
        && (ahead.dot(&left) > 0.0 || ahead.dot(&right) > 0.0)
}
