//! Early rejection of paths that are certainly too faint to be heard, by their directions, before any expensive
//! computation.
//!
//! Every bound is an upper bound, so that no audible path is lost: the envelope of the patterns, the greatest echo of a
//! pole, and the loss in the air on a slightly shorter path.

mod aim;
mod ensonified;
mod reach;
#[cfg(test)]
mod tests;

use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::Arc;

use crate::{
    acoustics::{Beam, Piston},
    geometry::{Point, Vector},
    scene::Pole,
};
pub(super) use aim::Aim;
pub(super) use ensonified::EnsonifiedPole;
use reach::Reach;

/// Number of equal steps of `sin(angle / 2)` in the envelope.
const STEPS: usize = 1024;
/// Steps per metre in the table of loss in the air, and the length of the table in metres.
const STEPS_PER_M: f64 = 32.0;
const REACH_M: f64 = 32.0;

/// Emitter, receivers and threshold of one query.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Audibility {
    tables: Arc<Tables>,
    /// Heading of the source.
    source: Vector,
    receivers: Vec<Vector>,
}

/// Tables of the faintest audible sound from an emitter to receivers of one kind.
#[derive(Debug, PartialEq)]
struct Tables {
    /// The emitter's and the receivers' patterns.
    pistons: [Piston; 2],
    /// True if paths rise and fall, so that their angle off an axis may be smaller than in the plan.
    in_room: bool,
    /// The highest squares of the two patterns beyond each angle.
    departing: Vec<f64>,
    arriving: Vec<f64>,
    /// The threshold amplitude, and the natural logarithm of the air's attenuation per metre, negative.
    floor: f64,
    loss_per_m: f64,
    /// For each step of length, a lower bound on the square of the amplitude that would be just audible without loss in
    /// the air.
    faint: Vec<f64>,
    /// Range of sound by its strength at departure.
    reach: Reach,
}

thread_local! {
    /// Recently made tables, kept because making one takes longer than a short simulation.
    static KNOWN: RefCell<VecDeque<Arc<Tables>>> = const { RefCell::new(VecDeque::new()) };
}
/// Number of tables that are kept for each thread.
const MOST_KNOWN: usize = 8;

impl Tables {
    fn new(pistons: [Piston; 2], in_room: bool, [floor, loss_per_m]: [f64; 2]) -> Self {
        let steps = (REACH_M * STEPS_PER_M) as usize;
        let faint = (0..=steps).map(|step| {
            let length_m = step as f64 / STEPS_PER_M;
            let faint = floor * libm::exp(-loss_per_m * length_m) * (1.0 - 1e-9);
            faint * faint
        });
        let [departing, arriving] = pistons.each_ref().map(|piston| envelope(piston, in_room));
        let (faint, reach) = (faint.collect(), Reach::new(floor, loss_per_m));
        Self { pistons, in_room, departing, arriving, floor, loss_per_m, faint, reach }
    }

    fn is_for(&self, pistons: &[Piston; 2], in_room: bool, floor_and_loss: [f64; 2]) -> bool {
        self.pistons == *pistons && self.in_room == in_room && [self.floor, self.loss_per_m] == floor_and_loss
    }
}

impl Audibility {
    /// Makes tables for an emitter and receivers with these patterns, in a flat scene or in a room. `floor` is the
    /// faintest audible amplitude, `loss_per_m` the natural logarithm of the air's attenuation per metre.
    pub(crate) fn new(pistons: [Piston; 2], in_room: bool, floor: f64, loss_per_m: f64) -> Self {
        let floor_and_loss = [floor, loss_per_m];
        let tables = KNOWN.with_borrow_mut(|known| {
            let found = known.iter().find(|tables| tables.is_for(&pistons, in_room, floor_and_loss)).cloned();
            found.unwrap_or_else(|| {
                let made = Arc::new(Tables::new(pistons, in_room, floor_and_loss));
                known.truncate(MOST_KNOWN - 1);
                known.push_front(Arc::clone(&made));
                made
            })
        });
        Self { tables, source: Vector::x(), receivers: Vec::new() }
    }

    /// Returns true if the tables are for these patterns, and for this amplitude and loss.
    pub(crate) fn is_for(&self, pistons: &[Piston; 2], in_room: bool, floor: f64, loss_per_m: f64) -> bool {
        self.tables.is_for(pistons, in_room, [floor, loss_per_m])
    }

    /// Sets the headings of source and receivers.
    pub(crate) fn aim(&mut self, source_rad: f64, receivers: impl Iterator<Item = Vector>) {
        self.source = Vector::new(libm::cos(source_rad), libm::sin(source_rad));
        self.receivers.clear();
        self.receivers.extend(receivers);
    }

    /// Returns the strength of the source's sound by direction.
    pub(crate) fn of_source(&self) -> Aim<'_> {
        Aim {
            envelope: &self.tables.departing,
            reach: &self.tables.reach,
            axis: self.source,
            beam: self.tables.pistons[0].beam,
        }
    }

    /// Returns a receiver's sensitivity by direction, in an emitter's form; `None` if everything counts as heard.
    pub(crate) fn of_receiver(&self, receiver: usize) -> Option<Aim<'_>> {
        let axis = *self.receivers.get(receiver).filter(|_| self.tables.floor > 0.0)?;
        Some(Aim {
            envelope: &self.tables.arriving,
            reach: &self.tables.reach,
            axis,
            beam: self.tables.pistons[1].beam,
        })
    }

    /// Returns an upper bound on the square of the emitter's pattern, by the cosine of the angle off its axis.
    #[inline]
    fn sent(&self, cos: f64) -> f64 {
        at_cos(&self.tables.departing, cos)
    }

    /// Returns an upper bound on the square of a receiver's pattern, by the cosine of the angle off its axis.
    #[inline]
    fn heard(&self, cos: f64) -> f64 {
        at_cos(&self.tables.arriving, cos)
    }

    /// Returns the least square of an amplitude that is heard after this length, without loss in the air.
    #[inline]
    fn faint(&self, length_m: f64) -> f64 {
        let step = ((length_m * STEPS_PER_M) as usize).min(self.tables.faint.len().saturating_sub(1));
        self.tables.faint.get(step).copied().unwrap_or(0.0)
    }

    /// Returns true if a path over walls may be heard: it leaves at an angle with this cosine off the source's axis,
    /// and `towards` is the vector from the receiver to its image.
    #[inline]
    pub(crate) fn may_hear_image(
        &self,
        departure_cos: f64,
        receiver: usize,
        towards: Vector,
        length_m: f64,
        reflection_gain: f64,
    ) -> bool {
        let Some(axis) = self.receivers.get(receiver) else { return true };
        let (sent, least) =
            (self.sent(departure_cos) * reflection_gain * reflection_gain, self.faint(length_m) * length_m * length_m);
        // Most paths fail by the strength at departure.
        sent >= least && sent * self.heard(towards.dot(axis) / length_m) >= least
    }

    /// Returns the cosines, in the plan, of a path's angles off the source's and a receiver's axis.
    #[inline]
    pub(crate) fn cosines(&self, receiver: usize, [departure_rad, arrival_rad]: [f64; 2]) -> [f64; 2] {
        let towards = |angle: f64| Vector::new(libm::cos(angle), libm::sin(angle));
        let axis = self.receivers.get(receiver).copied().unwrap_or_default();
        [towards(departure_rad).dot(&self.source), towards(arrival_rad).dot(&axis)]
    }

    /// Returns true if a path of a room may be heard, given the [cosines](Self::cosines) of its plan, the cosine of its
    /// elevation, and the share `vertical` of the amplitude that floor and ceiling leave.
    #[inline]
    pub(crate) fn may_hear_in_room(&self, plan: [f64; 2], cos_elevation: f64, vertical: f64, length_m: f64) -> bool {
        if self.receivers.is_empty() {
            return true;
        }
        let least = self.faint(length_m) * length_m * length_m;
        let sent = self.sent(plan[0] * cos_elevation) * vertical * vertical;
        sent >= least && sent * self.heard(plan[1] * cos_elevation) >= least
    }

    /// Returns the longest audible path, in metres, of sound whose amplitude is at most `most` over its length.
    pub(crate) fn reach_m(&self, most: f64) -> f64 {
        self.tables.reach.at((most * most).min(1.0))
    }

    /// Returns true if sound that leaves in the direction `out` may be heard after `least_m` or more. Its amplitude
    /// without the patterns is at most `most` over its length.
    #[inline]
    pub(crate) fn may_ensonify(&self, most: f64, out: Vector, least_m: f64) -> bool {
        if !(self.tables.floor > 0.0 && least_m > 0.0) {
            return true;
        }
        let cos = out.dot(&self.source) / out.norm();
        self.sent(cos) * most * most >= self.faint(least_m) * least_m * least_m
    }

    /// Returns true if a path around an edge may be heard. Its amplitude without the patterns is at most `most`.
    /// `out` leads from the source to the edge, `home` from the receiver.
    #[inline]
    pub(crate) fn may_hear_around(&self, most: f64, receiver: usize, out: Vector, home: Vector, length_m: f64) -> bool {
        let Some(axis) = self.receivers.get(receiver) else { return true };
        let sent = self.sent(out.dot(&self.source) / out.norm());
        sent * self.heard(home.dot(axis) / home.norm()) * most * most >= self.faint(length_m)
    }

    /// Returns true if a path over one pole may be heard, given the square of its amplitude after patterns and walls
    /// and its least lengths before and after the pole:
    ///
    /// ```text
    /// A^2 <= square (a / 2) / (s' s (s' + s))
    /// ```
    #[inline]
    pub(crate) fn may_hear_pole(&self, square: f64, radius_m: f64, before_m: f64, after_m: f64) -> bool {
        let length_m = before_m + after_m;
        square * 0.5 * radius_m >= self.faint(length_m) * before_m * after_m * length_m
    }

    /// Returns true if a path over two poles, `between_m` apart, may be heard.
    pub(crate) fn may_hear_two_poles(
        &self,
        square: f64,
        radii_m: [f64; 2],
        [before_m, between_m, after_m]: [f64; 3],
    ) -> bool {
        let length_m = before_m + between_m + after_m;
        let left = square * 0.25 * radii_m[0] * radii_m[1];
        left >= self.faint(length_m) * before_m * between_m * after_m * length_m
    }

    /// Returns the sound that reaches a pole.
    pub(crate) fn ensonify<'a>(&'a self, source: Point, pole: &'a Pole) -> EnsonifiedPole<'a> {
        let out = pole.centre - source;
        let far_m = out.norm();
        let before_m = (far_m - pole.radius_m).max(0.0);
        let part = self.sent(nearest_cos(out, far_m, pole.radius_m, self.source)) * 0.5 * pole.radius_m;
        EnsonifiedPole { audibility: self, pole, before_m, part }
    }
}

/// Returns the highest squares of a pattern beyond each angle. An angle between two steps takes the value of the lower
/// step, where the envelope is at least as high.
///
/// In a room, sound may leave at a smaller angle behind a sensor's plane than in the plan, down to right beside it.
fn envelope(piston: &Piston, in_room: bool) -> Vec<f64> {
    let mut envelope = vec![0.0; STEPS + 1];
    let mut highest: f64 = 0.0;
    // Angles go from behind to the front.
    for step in (0..=STEPS).rev() {
        let pattern = piston.pattern(2.0 * libm::asin(step as f64 / STEPS as f64));
        highest = highest.max(pattern * pattern);
        envelope[step] = highest;
    }
    if in_room && piston.beam != Beam::CutAt90 {
        let (front, behind) =
            envelope.split_at_mut(libm::ceil(STEPS as f64 * core::f64::consts::FRAC_1_SQRT_2) as usize);
        let beside = front.last().copied().unwrap_or_default();
        behind.fill(beside);
    }
    envelope
}

/// Returns the cosine of the least angle off an axis of a point on a circle, whose centre is at `out`.
#[inline]
fn nearest_cos(out: Vector, far_m: f64, radius_m: f64, axis: Vector) -> f64 {
    let (cos, sin_half) = (out.dot(&axis) / far_m, radius_m / far_m);
    let cos_half = (1.0 - sin_half * sin_half).max(0.0).sqrt();
    // The comparison is written so that a point inside the circle lies ahead.
    if cos < cos_half { cos * cos_half + (1.0 - cos * cos).max(0.0).sqrt() * sin_half } else { 1.0 }
}

#[inline]
fn at_cos(envelope: &[f64], cos: f64) -> f64 {
    let step = (0.5 - 0.5 * cos).max(0.0).sqrt() * STEPS as f64;
    envelope.get(step as usize).copied().unwrap_or(0.0)
}
