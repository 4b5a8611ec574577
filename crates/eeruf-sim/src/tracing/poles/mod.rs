//! Paths that bounce at a pole. Walls before the pole mirror the source forward, and walls after it mirror the receiver
//! backward. Between the two images remains one problem of Alhazen, whose solution must lie in a beam of each.

mod legs;
mod shadow;

use super::audibility::Audibility;
use super::beam::{BeamTree, Growth, push_chain};
use super::ends::Ends;
use super::limits::Limits;
use crate::{
    acoustics::pole_spread,
    geometry::{Point, Specular, Vector, alhazen, alhazen_twice, wrap_angle},
    scene::{Bounce, Pole, Scene},
    threads::Stop,
};
use legs::{Home, Leg, Legs, Seen};
pub(super) use shadow::is_shaded;

/// Largest number of Alhazen problems that one query may try: about ten seconds of work.
const MAX_TRIED: usize = 1 << 25;

/// Number of Alhazen problems between two checks of the stop switch.
const TRIED_PER_LOOK: usize = 64;

/// A path over one pole, or over two in turn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PolePath {
    pub(crate) receiver: u32,
    pub(crate) length_m: f64,
    pub(crate) order: u32,
    pub(crate) departure_rad: f64,
    pub(crate) arrival_rad: f64,
    /// Image of the source, for recognising duplicates.
    pub(crate) image: Point,
    /// Share of the amplitude after spreading along the legs and at the poles' curvature.
    pub(crate) spread: f64,
    pub(crate) cos_incidence: [f64; 2],
    bounces: (u32, u32),
}

/// The input of a search: a source with its grown tree, and the limits.
#[derive(Clone, Copy)]
pub(crate) struct PoleQuery<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) tree: &'a BeamTree,
    pub(crate) source: Point,
    pub(crate) ends: &'a Ends,
    pub(crate) limits: Limits,
    /// Audibility, if certainly inaudible sound may be left out.
    pub(crate) audibility: Option<&'a Audibility>,
    pub(crate) asked: Asked,
    /// Largest number of beams and paths.
    pub(crate) budget: usize,
    /// Switch that ends the search early.
    pub(crate) stop: &'a Stop,
}

/// Position of a query in a series with the same scene, receivers, limits and audibility but different sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    Once,
    /// The first query of a series.
    First,
    Again,
}

/// One receiver of a query.
#[derive(Clone, Copy)]
struct Receiver {
    index: u32,
    at: Point,
}

/// The search for paths over poles, with its buffers.
#[derive(Debug, Default)]
pub(crate) struct PoleSearch {
    pub(crate) found: Vec<PolePath>,
    bounces: Vec<Bounce>,
    from_source: Legs,
    back: BeamTree,
    /// Legs of each receiver of this query, kept for the next query if it has the same receivers.
    homes: Vec<Home>,
    /// Number of valid entries; the others are kept for their memory.
    grown: usize,
    /// The triangles of points on poles.
    triangles: [Vec<u32>; 2],
    /// For each pole, a lower bound on the distance from its surface to the nearest receiver, in metres.
    nearest_m: Vec<f64>,
    /// Poles directly visible from the source over which a second pole may be ensonified, and those second poles, by
    /// number.
    firsts: Vec<Seen>,
    seconds: Vec<bool>,
    /// Triangles of the poles over which the source may be heard.
    wanted: Vec<(u32, u32)>,
    /// Number of Alhazen problems tried so far.
    tried: usize,
}

impl PoleSearch {
    pub(crate) fn bounces(&self, path: &PolePath) -> &[Bounce] {
        &self.bounces[path.bounces.0 as usize..path.bounces.1 as usize]
    }

    /// Finds all paths over poles to these receivers, except those that are certainly too faint. Returns true if the
    /// result is complete: the budget was not exceeded, and the work was not stopped.
    pub(crate) fn search(&mut self, query: &PoleQuery<'_>, receivers: &[Point]) -> bool {
        let PoleQuery { scene, tree, limits, audibility, budget, stop, .. } = *query;
        self.found.clear();
        self.bounces.clear();
        self.tried = 0;
        if scene.poles().is_empty() || limits.max_order == 0 {
            return true;
        }
        if limits.max_order == 1 {
            self.one_pole(query, receivers);
            return !stop.is_stopped();
        }
        if query.asked != Asked::Again {
            self.grown = 0;
        }
        self.from_source.fill(tree, scene, audibility.map(Audibility::of_source));
        self.nearest_m.clear();
        self.nearest_m.extend(scene.poles().iter().map(|pole| nearest_m(pole, receivers)));
        self.pair_poles(audibility, scene);
        if let Some(audibility) = audibility {
            self.drop_faint(audibility, scene);
        }
        if query.asked == Asked::Once {
            self.choose_poles(scene);
            if self.wanted.is_empty() {
                return true;
            }
        }
        for (index, &at) in receivers.iter().enumerate() {
            let receiver = Receiver { index: index as u32, at };
            if self.grown <= index && !self.grow_home(query, receiver) {
                return false;
            }
            let homes = core::mem::take(&mut self.homes);
            let home = &homes[index];
            for behind in &home.legs.legs {
                self.join(query, home, behind, receiver);
            }
            let spent = self.found.len() > budget || self.tried > MAX_TRIED || stop.is_stopped();
            if !spent {
                self.two_poles(query, &home.in_sight, receiver);
            }
            self.homes = homes;
            if spent || stop.is_stopped() {
                return false;
            }
        }
        true
    }

    /// Drops the source's legs to poles over which no receiver hears it at any heading.
    fn drop_faint(&mut self, audibility: &Audibility, scene: &Scene) {
        let Self { from_source, nearest_m, .. } = self;
        from_source.legs.retain(|leg| {
            let pole = leg.pole as usize;
            audibility.may_hear_pole(leg.square, scene.poles()[pole].radius_m, leg.least_m, nearest_m[pole])
        });
    }

    /// Selects pairs of poles over which sound may be heard at any heading of the receiver.
    fn pair_poles(&mut self, audibility: Option<&Audibility>, scene: &Scene) {
        let Self { from_source, nearest_m, firsts, seconds, .. } = self;
        firsts.clear();
        firsts.extend(from_source.in_sight());
        seconds.clear();
        seconds.resize(scene.poles().len(), audibility.is_none());
        if audibility.is_none() {
            return;
        }
        firsts.retain(|first| {
            let mut is_first = false;
            for (last, is_second) in seconds.iter_mut().enumerate() {
                let nearest = Seen { pole: last as u32, square: 1.0, least_m: nearest_m[last] };
                if may_hear_two(audibility, scene, first, &nearest) {
                    (is_first, *is_second) = (true, true);
                }
            }
            is_first
        });
    }

    /// Selects the poles over which the source's sound may be heard.
    fn choose_poles(&mut self, scene: &Scene) {
        let is_heard = |last: u32| self.seconds[last as usize] || !self.from_source.to(last).is_empty();
        self.wanted.clear();
        for triangles in scene.pole_triangles.chunk_by(|one, next| one.1 == next.1) {
            if triangles.first().is_some_and(|&(_, pole)| is_heard(pole)) {
                self.wanted.extend(triangles);
            }
        }
    }

    /// Grows a receiver's legs to the poles, backwards. Returns true if they are complete.
    fn grow_home(&mut self, query: &PoleQuery<'_>, receiver: Receiver) -> bool {
        let PoleQuery { scene, ends, limits, audibility, budget, stop, .. } = *query;
        let aim = audibility.and_then(|audibility| audibility.of_receiver(receiver.index as usize));
        let growth = Growth {
            mesh: scene.mesh(),
            mirrors: scene.mirrors(),
            poles: scene.poles(),
            pole_triangles: if query.asked == Asked::Once { &self.wanted } else { &scene.pole_triangles },
            pole_order: limits.max_order,
            max_order: limits.max_order - 1,
            max_length_m: limits.max_length_m,
            budget,
            last_for_receivers: false,
            aim,
            stop,
        };
        let here = (receiver.at, ends.of_receiver(receiver.index as usize));
        let complete = self.back.grow(&growth, here, &[], ends);
        if self.homes.len() == self.grown {
            self.homes.push(Home::default());
        }
        self.homes[self.grown].fill(&mut self.back, scene, aim);
        self.grown += 1;
        complete
    }

    /// Joins one of a receiver's legs to a pole with all of the source's legs to it.
    fn join(&mut self, query: &PoleQuery<'_>, home: &Home, behind: &Leg, receiver: Receiver) {
        let PoleQuery { scene, limits, audibility, stop, .. } = *query;
        let radius_m = scene.poles()[behind.pole as usize].radius_m;
        let from_source = core::mem::take(&mut self.from_source);
        for before in from_source.to(behind.pole) {
            if before.order + behind.order >= limits.max_order || self.tried > MAX_TRIED || self.is_stopped(stop) {
                break;
            }
            let may_be_heard = audibility.is_none_or(|audibility| {
                audibility.may_hear_pole(before.square * behind.square, radius_m, before.least_m, behind.least_m)
            });
            if may_be_heard {
                self.between(query, &from_source, before, home, behind, receiver);
            }
        }
        self.from_source = from_source;
    }

    /// Returns true if the search should end.
    fn is_stopped(&self, stop: &Stop) -> bool {
        self.tried.is_multiple_of(TRIED_PER_LOOK) && stop.is_stopped()
    }

    /// Finds the paths over one pole between a beam of the source and a beam of the receiver.
    fn between(
        &mut self,
        query: &PoleQuery<'_>,
        from_source: &Legs,
        before: &Leg,
        home: &Home,
        behind: &Leg,
        receiver: Receiver,
    ) {
        let PoleQuery { scene, tree, limits, .. } = *query;
        let order = before.order + 1 + behind.order;
        let pole = &scene.poles()[before.pole as usize];
        let far_m = before.far_m + behind.far_m;
        if far_m > limits.max_length_m + 2.0 * pole.radius_m {
            return;
        }
        self.tried += 1;
        let Some(hit) = alhazen(before.image, behind.image, pole.centre, pole.radius_m) else {
            return;
        };
        let length_m = hit.before_m + hit.after_m;
        if length_m > limits.max_length_m || !from_source.meet(before, &home.legs, behind, hit.point, scene.mesh()) {
            return;
        }
        let start = self.bounces.len();
        tree.push_chain(before.beam, &mut self.bounces);
        self.bounces[start..].reverse();
        self.bounces.push(Bounce::Pole(before.pole));
        push_chain(&home.beams, behind.beam, &mut self.bounces);
        let departure_rad = unfolded(hit.point - before.image, before.order, before.turn);
        let arrival_rad = unfolded(hit.point - behind.image, behind.order, behind.turn);
        self.push(receiver, order, [departure_rad, arrival_rad], &[(hit, pole.radius_m)], start);
    }

    /// Finds the path over one pole that is directly visible from source and receiver, without trees.
    fn one_pole(&mut self, query: &PoleQuery<'_>, receivers: &[Point]) {
        let PoleQuery { scene, source, ends, limits, audibility, stop, .. } = *query;
        let mesh = scene.mesh();
        for (index, pole) in scene.poles().iter().enumerate() {
            if stop.is_stopped() {
                return;
            }
            let ensonified = audibility.map(|audibility| audibility.ensonify(source, pole));
            if ensonified.as_ref().is_some_and(|pole| pole.is_inaudible(receivers)) {
                continue;
            }
            for (receiver, &at) in receivers.iter().enumerate() {
                if ensonified.as_ref().is_some_and(|pole| !pole.may_be_heard(receiver, at)) {
                    continue;
                }
                let Some(hit) = alhazen(source, at, pole.centre, pole.radius_m) else { continue };
                if hit.before_m + hit.after_m > limits.max_length_m {
                    continue;
                }
                let triangles = &mut self.triangles[0];
                mesh.containing(hit.point, triangles);
                if !mesh.sees(source, ends.of_source(), hit.point, triangles)
                    || !mesh.sees(hit.point, triangles, at, ends.of_receiver(receiver))
                {
                    continue;
                }
                let start = self.bounces.len();
                self.bounces.push(Bounce::Pole(index as u32));
                let angles = [unfolded(hit.point - source, 0, 0.0), unfolded(hit.point - at, 0, 0.0)];
                self.push(Receiver { index: receiver as u32, at }, 1, angles, &[(hit, pole.radius_m)], start);
            }
        }
    }

    /// Finds the paths from the source over two poles to the receiver, all directly visible.
    fn two_poles(&mut self, query: &PoleQuery<'_>, lasts: &[Seen], receiver: Receiver) {
        let PoleQuery { scene, source, ends, limits, audibility, stop, .. } = *query;
        let (at, poles, mesh) = (receiver.at, scene.poles(), scene.mesh());
        for index in 0..self.firsts.len() {
            if stop.is_stopped() {
                return;
            }
            let before = self.firsts[index];
            for after in lasts {
                if !may_hear_two(audibility, scene, &before, after) {
                    continue;
                }
                let (a, b) = (before.pole, after.pole);
                let (first, second) = (&poles[a as usize], &poles[b as usize]);
                self.tried += 1;
                let circles = ((first.centre, first.radius_m), (second.centre, second.radius_m));
                let Some((one, two)) = alhazen_twice(source, at, circles.0, circles.1) else {
                    continue;
                };
                if one.before_m + two.before_m + two.after_m > limits.max_length_m {
                    continue;
                }
                let [at_one, at_two] = &mut self.triangles;
                mesh.containing(one.point, at_one);
                mesh.containing(two.point, at_two);
                if !mesh.sees(source, ends.of_source(), one.point, at_one)
                    || !mesh.sees(one.point, at_one, two.point, at_two)
                    || !mesh.sees(two.point, at_two, at, ends.of_receiver(receiver.index as usize))
                {
                    continue;
                }
                let start = self.bounces.len();
                self.bounces.extend([Bounce::Pole(a), Bounce::Pole(b)]);
                let angles = [unfolded(one.point - source, 0, 0.0), unfolded(two.point - at, 0, 0.0)];
                self.push(receiver, 2, angles, &[(one, circles.0.1), (two, circles.1.1)], start);
            }
        }
    }

    fn push(
        &mut self,
        receiver: Receiver,
        order: u32,
        [departure_rad, arrival_rad]: [f64; 2],
        hits: &[(Specular, f64)],
        start: usize,
    ) {
        let length_m =
            hits.iter().map(|(hit, _)| hit.before_m).sum::<f64>() + hits.last().map_or(0.0, |(hit, _)| hit.after_m);
        let mut cos_incidence = [1.0; 2];
        for (cos, (hit, _)) in cos_incidence.iter_mut().zip(hits) {
            *cos = libm::cos(hit.incidence_rad);
        }
        let (sin, cos) = libm::sincos(arrival_rad);
        self.found.push(PolePath {
            receiver: receiver.index,
            length_m,
            order,
            departure_rad,
            arrival_rad,
            image: receiver.at + Vector::new(cos, sin) * length_m,
            spread: pole_spread(hits),
            cos_incidence,
            bounces: (start as u32, self.bounces.len() as u32),
        });
    }
}

/// Returns a lower bound on the distance from a pole's surface to the nearest receiver, in metres.
fn nearest_m(pole: &Pole, receivers: &[Point]) -> f64 {
    let far_m = receivers.iter().map(|at| (at - pole.centre).norm()).fold(f64::INFINITY, f64::min);
    (far_m - pole.radius_m).max(0.0)
}

/// Returns true if sound that bounces at these two different poles in turn may be heard.
fn may_hear_two(audibility: Option<&Audibility>, scene: &Scene, before: &Seen, after: &Seen) -> bool {
    before.pole != after.pole
        && audibility.is_none_or(|audibility| {
            let [first, second] = [before.pole, after.pole].map(|pole| &scene.poles()[pole as usize]);
            let between_m = (first.centre - second.centre).norm() - first.radius_m - second.radius_m;
            let legs_m = [before.least_m, between_m.max(0.0), after.least_m];
            audibility.may_hear_two_poles(before.square * after.square, [first.radius_m, second.radius_m], legs_m)
        })
}

/// Returns the direction at the source that corresponds to `ahead` in the image's world.
fn unfolded(ahead: Vector, order: u32, turn: f64) -> f64 {
    let there = libm::atan2(ahead.y, ahead.x);
    wrap_angle(if order.is_multiple_of(2) { there - turn } else { turn - there })
}
