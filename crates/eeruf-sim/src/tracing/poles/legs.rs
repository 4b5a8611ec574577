//! Legs from a transducer to the poles: beams of its tree that pass a pole, with upper bounds on their loudness there.

use crate::{
    geometry::{Point, Vector},
    scene::{Mesh, Scene},
    tracing::audibility::Aim,
    tracing::beam::{Beam, BeamTree, PoleCone},
};

/// A leg from a transducer to a pole: a beam that passes the pole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    pub(super) pole: u32,
    pub(super) beam: u32,
    pub(super) image: Point,
    pub(super) order: u32,
    pub(super) turn: f64,
    /// Upper bound on the square of the amplitude at the pole, without spreading and air.
    pub(super) square: f64,
    /// Distance from the image to the pole's axis, and least distance to its surface, in metres.
    pub(super) far_m: f64,
    pub(super) least_m: f64,
    /// The beam's cones through triangles that contain the pole.
    cones: [u32; 2],
}

/// All legs from a transducer, by pole, with the lowest orders first.
#[derive(Debug, Default)]
pub(super) struct Legs {
    pub(super) legs: Vec<Leg>,
    cones: Vec<PoleCone>,
    /// Next free index for a cone of each pole.
    next: Vec<u32>,
}

/// All legs from a receiver, found backwards.
#[derive(Debug, Default)]
pub(super) struct Home {
    pub(super) beams: Vec<Beam>,
    pub(super) legs: Legs,
    /// Poles that are directly visible.
    pub(super) in_sight: Vec<Seen>,
}

/// A pole that is directly visible from a transducer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) pole: u32,
    /// Upper bound as in [`Leg::square`].
    pub(super) square: f64,
    pub(super) least_m: f64,
}

impl Home {
    /// Stores the legs of a tree that was grown from the receiver, and its beams.
    pub(super) fn fill(&mut self, tree: &mut BeamTree, scene: &Scene, aim: Option<Aim<'_>>) {
        self.legs.fill(tree, scene, aim);
        core::mem::swap(&mut self.beams, &mut tree.beams);
        self.in_sight.clear();
        self.in_sight.extend(self.legs.in_sight());
    }
}

impl Legs {
    /// Stores the legs of a grown tree. Without an aim, everything counts as audible.
    pub(super) fn fill(&mut self, tree: &BeamTree, scene: &Scene, aim: Option<Aim<'_>>) {
        self.take_by_pole(&tree.pole_cones, scene.poles().len());
        let Self { legs, cones, .. } = self;
        legs.clear();
        let mut next = 0;
        legs.extend(cones.chunk_by(|one, other| (one.pole, one.beam) == (other.pole, other.beam)).map(|of_beam| {
            let PoleCone { pole, beam, .. } = of_beam[0];
            let Beam { image, order, turn, axis, reflection_gain, .. } = tree.beams[beam as usize];
            let of = &scene.poles()[pole as usize];
            let far_m = (image - of.centre).norm();
            let square = aim.map_or(1.0, |aim| aim.towards_pole(image, axis, of, reflection_gain));
            let start = next;
            next += of_beam.len() as u32;
            let least_m = (far_m - of.radius_m).max(0.0);
            Leg { pole, beam, image, order, turn, square, far_m, least_m, cones: [start, next] }
        }));
    }

    /// Regroups a tree's cones, which are in the order of its beams, by pole.
    fn take_by_pole(&mut self, of: &[PoleCone], poles: usize) {
        let Self { cones, next, .. } = self;
        next.clear();
        next.resize(poles + 1, 0);
        of.iter().for_each(|cone| next[cone.pole as usize + 1] += 1);
        (0..poles).for_each(|pole| next[pole + 1] += next[pole]);
        cones.clear();
        cones.extend_from_slice(of);
        for cone in of {
            let place = &mut next[cone.pole as usize];
            cones[*place as usize] = *cone;
            *place += 1;
        }
    }

    /// Returns the poles that the transducer's own, unreflected beam passes.
    pub(super) fn in_sight(&self) -> impl Iterator<Item = Seen> {
        let unreflected = self.legs.iter().filter(|leg| leg.beam == 0);
        unreflected.map(|leg| Seen { pole: leg.pole, square: leg.square, least_m: leg.least_m })
    }

    /// Returns the legs to one pole.
    pub(super) fn to(&self, pole: u32) -> &[Leg] {
        let start = self.legs.partition_point(|leg| leg.pole < pole);
        let end = start + self.legs[start..].partition_point(|leg| leg.pole == pole);
        &self.legs[start..end]
    }

    /// Returns the leg's cones that contain a point, relative to its image.
    fn holding(&self, leg: &Leg, ahead: Vector) -> impl Iterator<Item = &PoleCone> + Clone {
        let [start, end] = leg.cones.map(|cone| cone as usize);
        self.cones[start..end].iter().filter(move |cone| cone.holds(ahead))
    }

    /// Returns true if this leg and another see a point of a pole's surface in the same triangle.
    pub(super) fn meet(&self, leg: &Leg, others: &Self, other: &Leg, at: Point, mesh: &Mesh) -> bool {
        let theirs = others.holding(other, at - other.image);
        let is_seen = |cone: &PoleCone| theirs.clone().any(|their| their.triangle == cone.triangle);
        self.holding(leg, at - leg.image).any(|cone| is_seen(cone) && mesh.touches(cone.triangle, at))
    }
}
