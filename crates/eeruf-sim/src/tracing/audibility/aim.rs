//! Greatest strength with which a transducer sends into a cone or hears from it, and the resulting range.

use super::reach::Reach;
use super::{at_cos, nearest_cos};
use crate::{
    acoustics::Beam,
    geometry::{Point, Vector, cross},
    scene::Pole,
};

/// A transducer's pattern about its axis, and the threshold of hearing.
#[derive(Clone, Copy)]
pub(crate) struct Aim<'a> {
    pub(super) envelope: &'a [f64],
    pub(super) reach: &'a Reach,
    pub(super) axis: Vector,
    pub(super) beam: Beam,
}

impl Aim<'_> {
    /// Returns the axis.
    pub(crate) fn axis(&self) -> Vector {
        self.axis
    }

    /// Returns true if the pattern is zero at 90 degrees and beyond.
    pub(crate) fn is_cut(&self) -> bool {
        self.beam == Beam::CutAt90
    }

    /// Returns the longest path, in metres, after which sound is heard.
    pub(crate) fn longest_m(&self) -> f64 {
        self.reach.at(1.0)
    }

    /// Returns the longest path, in metres, on which sound may be heard if it leaves within a cone and keeps
    /// `reflection_gain` of its amplitude at walls. `axis` is the transducer's axis in the cone's world.
    #[inline]
    pub(crate) fn reach_m(&self, axis: Vector, left: Vector, right: Vector, reflection_gain: f64) -> f64 {
        let strongest = if cross(axis, left) >= 0.0 && cross(right, axis) >= 0.0 {
            1.0
        } else {
            let cos = |limit: Vector| axis.dot(&limit) / limit.norm();
            // Take the nearer limit, if it is clear which limit is nearer.
            let nearest = match (cross(axis, left) < 0.0, cross(right, axis) < 0.0) {
                (true, false) => cos(left),
                (false, true) => cos(right),
                _ => cos(left).max(cos(right)),
            };
            at_cos(self.envelope, nearest)
        };
        self.reach.at(strongest * reflection_gain * reflection_gain)
    }

    /// Returns an upper bound on the square of the amplitude sent towards a pole after reflections, without spreading,
    /// air, and the part of the path beyond the pole.
    pub(crate) fn towards_pole(&self, image: Point, axis: Vector, pole: &Pole, reflection_gain: f64) -> f64 {
        let out = pole.centre - image;
        let nearest = nearest_cos(out, out.norm(), pole.radius_m, axis);
        at_cos(self.envelope, nearest) * reflection_gain * reflection_gain
    }
}
