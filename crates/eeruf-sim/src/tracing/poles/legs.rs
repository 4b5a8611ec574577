//! The ways from a transducer to the poles: the cones of its beam tree that pass one, and how loud they are there at
//! most.

use crate::{
    geometry::Point,
    scene::Scene,
    tracing::audibility::Aim,
    tracing::beam::{Beam, BeamTree, PoleCone},
};

/// One way from a transducer to a pole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) cone: PoleCone,
    pub(super) image: Point,
    pub(super) order: u32,
    pub(super) turn: f64,
    /// The square of all that is left of the amplitude at the pole but spreading and air, at most.
    pub(super) square: f64,
    /// From the image to the pole's axis, and at least to its surface, in metres.
    pub(super) far_m: f64,
    pub(super) least_m: f64,
}

impl Leg {
    /// The same for the same pole and triangle.
    pub(super) fn key(&self) -> (u32, u32) {
        (self.cone.pole, self.cone.triangle)
    }
}

/// All ways from a receiver, found backwards.
#[derive(Debug)]
pub(super) struct Home {
    pub(super) beams: Vec<Beam>,
    pub(super) legs: Vec<Leg>,
    /// Poles in plain sight.
    pub(super) in_sight: Vec<Seen>,
}

/// A pole in plain sight of a transducer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) pole: u32,
    /// As of a [`Leg`].
    pub(super) square: f64,
    pub(super) least_m: f64,
}

/// Writes the ways of a grown tree. Without an aim everything may be loud.
pub(super) fn legs_of(tree: &BeamTree, scene: &Scene, aim: Option<Aim<'_>>, legs: &mut Vec<Leg>) {
    legs.clear();
    legs.extend(tree.pole_cones.iter().map(|&cone| {
        let beam = &tree.beams[cone.beam as usize];
        let pole = &scene.poles()[cone.pole as usize];
        let far_m = (beam.image - pole.centre).norm();
        let square = aim.map_or(1.0, |aim| aim.towards_pole(beam.image, beam.axis, pole, beam.reflection_gain));
        let least_m = (far_m - pole.radius_m).max(0.0);
        Leg { cone, image: beam.image, order: beam.order, turn: beam.turn, square, far_m, least_m }
    }));
}

/// The poles that a transducer's own, unreflected cones pass.
pub(super) fn in_sight(legs: &[Leg], poles: &mut Vec<Seen>) {
    poles.clear();
    let seen = |leg: &Leg| Seen { pole: leg.cone.pole, square: leg.square, least_m: leg.least_m };
    poles.extend(legs.iter().filter(|leg| leg.cone.beam == 0).map(seen));
    poles.sort_unstable_by_key(|seen| seen.pole);
    poles.dedup_by_key(|seen| seen.pole);
}
