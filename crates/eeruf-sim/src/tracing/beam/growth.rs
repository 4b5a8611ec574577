//! Parameters of a beam tree's growth.

use crate::tracing::audibility::Aim;
use crate::{
    geometry::{Mirror, SAME_DIRECTION, Vector},
    scene::{Mesh, Pole},
    threads::Stop,
};

/// Parameters of a tree's growth.
pub(crate) struct Growth<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) mirrors: &'a [Mirror],
    pub(crate) poles: &'a [Pole],
    /// Triangles that contain the poles searched for.
    pub(crate) pole_triangles: &'a [(u32, u32)],
    /// Order below which beams search for poles.
    pub(crate) pole_order: u32,
    pub(crate) max_order: u32,
    pub(crate) max_length_m: f64,
    pub(crate) budget: usize,
    /// True if beams of the last order serve only receivers and not poles, so that beams that meet none can be dropped.
    pub(crate) last_for_receivers: bool,
    /// Sound of the source by direction, if certainly inaudible sound may be left out.
    pub(crate) aim: Option<Aim<'a>>,
    /// Switch that ends the search early.
    pub(crate) stop: &'a Stop,
}

impl Growth<'_> {
    /// Returns the longest path of a beam, in metres, that may be heard and is within the query's limit.
    #[inline]
    pub(super) fn reach_m(&self, axis: Vector, left: Vector, right: Vector, reflection_gain: f64) -> f64 {
        self.aim.map_or(self.max_length_m, |aim| self.max_length_m.min(aim.reach_m(axis, left, right, reflection_gain)))
    }

    /// Returns the part of a cone from the source into which sound leaves; `None` if there is none.
    pub(super) fn ensonified(&self, left: Vector, right: Vector) -> Option<(Vector, Vector)> {
        let Some(forward) = self.aim.filter(Aim::is_cut).map(|aim| aim.axis()) else { return Some((left, right)) };
        let ahead = |limit: Vector| limit.dot(&forward) > -SAME_DIRECTION * (limit.x.abs() + limit.y.abs());
        match (ahead(left), ahead(right)) {
            (true, true) => Some((left, right)),
            (true, false) => Some((left, Vector::new(forward.y, -forward.x))),
            (false, true) => Some((Vector::new(-forward.y, forward.x), right)),
            // A cone through the side of a triangle is narrower than the ensonified half plane.
            (false, false) => None,
        }
    }
}
