//! Which paths are certainly too faint to be heard, told from where they point before anything dear is computed of them.
//!
//! Every bound is an upper one, so that nothing audible is lost: the patterns by their envelope, a pole by the most that it can
//! return, the air by what it takes on a slightly shorter way.

use crate::{
    piston::Piston,
    plane::{Point, Vector},
    pole::Pole,
};

/// How finely the envelope is known: in equal steps of `sin(angle / 2)`.
const STEPS: usize = 1024;
/// By how much a path to a pole's surface may point past its axis, in radians, if the pole is [`FAR`] or farther.
const ASIDE_RAD: f64 = 1.2 / FAR;
/// Poles nearer than this many radii are not judged.
const FAR: f64 = 60.0;
/// How finely the loss in the air is known, in steps per metre, and how far.
const STEPS_PER_M: f64 = 32.0;
const REACH_M: f64 = 32.0;

/// One question's emitter and receivers, and what is just heard.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gate {
    piston: Piston,
    /// The highest square of the pattern from an angle on.
    envelope: Vec<f64>,
    /// The amplitude that is just heard, and the natural logarithm of what the air leaves of one per metre, negative.
    floor: f64,
    loss_per_m: f64,
    /// After so many steps at least: the square of the amplitude that would just be heard if the air took nothing.
    faint: Vec<f64>,
    /// Where the source heads, as an angle and as a direction.
    source_rad: f64,
    source: Vector,
    receivers: Vec<Vector>,
}

impl Gate {
    pub(crate) fn new(piston: Piston) -> Self {
        let mut envelope = vec![0.0; STEPS + 1];
        let mut highest: f64 = 0.0;
        // From behind to the front; each entry stands for all angles up to the next one's.
        for step in (0..=STEPS).rev() {
            let angle = 2.0 * (step as f64 / STEPS as f64).asin();
            let shifted = piston.pattern((angle - ASIDE_RAD).max(0.0));
            highest = highest.max(shifted * shifted).max(piston.pattern(angle).powi(2));
            envelope[step] = highest;
        }
        // An angle between two steps is judged by the lower one, where the envelope is no less.
        let ahead = Vector::x();
        Self {
            piston,
            envelope,
            floor: 0.0,
            loss_per_m: 0.0,
            faint: Vec::new(),
            source_rad: 0.0,
            source: ahead,
            receivers: Vec::new(),
        }
    }

    pub(crate) fn is_for(&self, piston: &Piston) -> bool {
        self.piston == *piston
    }

    /// Sets the amplitude that is just heard, and the natural logarithm of what the air leaves of one per metre.
    pub(crate) fn set_floor(&mut self, floor: f64, loss_per_m: f64) {
        if (self.floor, self.loss_per_m) == (floor, loss_per_m) && !self.faint.is_empty() {
            return;
        }
        (self.floor, self.loss_per_m) = (floor, loss_per_m);
        self.faint.clear();
        let steps = (REACH_M * STEPS_PER_M) as usize;
        self.faint.extend((0..=steps).map(|step| {
            let length_m = step as f64 / STEPS_PER_M;
            (floor * (-loss_per_m * length_m).exp() * (1.0 - 1e-9)).powi(2)
        }));
    }

    /// Sets where source and receivers head.
    pub(crate) fn aim(&mut self, source_rad: f64, receivers: impl Iterator<Item = Vector>) {
        self.source_rad = source_rad;
        self.source = Vector::new(source_rad.cos(), source_rad.sin());
        self.receivers.clear();
        self.receivers.extend(receivers);
    }

    /// Where the source heads, as a direction. Nothing leaves it at right angles to that, or further behind.
    pub(crate) fn source(&self) -> Vector {
        self.source
    }

    /// Where the source heads, in radians.
    pub(crate) fn source_rad(&self) -> f64 {
        self.source_rad
    }

    /// The square of the pattern at most, by the cosine of the angle off the axis.
    #[inline]
    fn square(&self, cos: f64) -> f64 {
        let step = (0.5 - 0.5 * cos).max(0.0).sqrt() * STEPS as f64;
        self.envelope.get(step as usize).copied().unwrap_or(0.0)
    }

    /// What the square of an amplitude is at least that is heard after this length, but for the air.
    #[inline]
    fn faint(&self, length_m: f64) -> f64 {
        let step = ((length_m * STEPS_PER_M) as usize).min(self.faint.len().saturating_sub(1));
        self.faint.get(step).copied().unwrap_or(0.0)
    }

    /// Whether a path over walls may be heard that leaves at an angle with this cosine off the source's axis, and whose image
    /// the receiver sees in the direction `towards`, as long as the path.
    #[inline]
    pub(crate) fn walls(&self, departure_cos: f64, receiver: usize, towards: Vector, length_m: f64, kept: f64) -> bool {
        let Some(axis) = self.receivers.get(receiver) else { return true };
        let (sent, least) = (self.square(departure_cos) * kept * kept, self.faint(length_m) * length_m * length_m);
        // Most are turned away for what the source sends there.
        sent >= least && sent * self.square(towards.dot(axis) / length_m) >= least
    }

    /// What falls on a pole.
    pub(crate) fn light<'a>(&'a self, source: Point, pole: &'a Pole) -> Lit<'a> {
        let out = pole.centre - source;
        let far = out.norm();
        let judged = far >= FAR * pole.radius_m;
        let before_m = far - pole.radius_m;
        let part = self.square(out.dot(&self.source) / far) * 0.5 * pole.radius_m / before_m;
        Lit { gate: self, pole, before_m: judged.then_some(before_m), part }
    }
}

/// A pole that the source shines at; which receivers may hear it?
///
/// ```text
/// A^2 <= (a / 2) / (s' s (s' + s))
/// ```
pub(crate) struct Lit<'a> {
    gate: &'a Gate,
    pole: &'a Pole,
    /// `s'`; none if the pole is too near to be judged.
    before_m: Option<f64>,
    /// What is known of `A^2`: all but the receiver's pattern and `s (s' + s)`.
    part: f64,
}

impl Lit<'_> {
    /// Whether certainly none of these receivers hears it.
    #[inline]
    pub(crate) fn is_dark(&self, receivers: &[Point]) -> bool {
        if self.part == 0.0 && self.before_m.is_some() {
            return true;
        }
        let far2 = receivers.iter().map(|at| (self.pole.centre - at).norm_squared());
        let nearest_m = far2.fold(f64::INFINITY, f64::min).sqrt();
        nearest_m >= FAR * self.pole.radius_m && self.is_lost(self.part, nearest_m)
    }

    /// Whether a receiver may hear it.
    #[inline]
    pub(crate) fn may_be_heard(&self, receiver: usize, at: Point) -> bool {
        let Some(axis) = self.gate.receivers.get(receiver) else { return true };
        let home = self.pole.centre - at;
        let far_m = home.norm();
        far_m < FAR * self.pole.radius_m || !self.is_lost(self.part * self.gate.square(home.dot(axis) / far_m), far_m)
    }

    /// Whether `A^2 s (s' + s)` is too little this far from the pole's centre.
    #[inline]
    fn is_lost(&self, part: f64, far_m: f64) -> bool {
        let Some(before_m) = self.before_m else { return false };
        let after_m = far_m - self.pole.radius_m;
        let length_m = before_m + after_m;
        part < self.gate.faint(length_m) * after_m * length_m
    }
}

#[cfg(test)]
mod tests {
    use crate::{noise::Chance, *};

    /// A room with poles and a ring in it, by a number.
    fn random(number: u64) -> (Scene, Vec<Pose>) {
        let mut chance = Chance::new(number);
        let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 3.0], [6.0, 3.0], [6.0, 5.0], [0.0, 5.0], [0.0, 0.0]];
        let poles = (0..12).map(|_| Pole::new(chance.between(0.1, 8.9), chance.between(0.1, 2.9), 0.004)).collect();
        let scene = Scene::new(Wall::polyline(&corners).collect(), poles, Air::default()).unwrap();
        let place = Vector::new(chance.between(0.5, 8.5), chance.between(0.5, 2.5));
        let robot = Pose::new(place, chance.between(-3.0, 3.0));
        (scene, ring_of(&robot, 8, 0.3, -0.9, 0.26).collect())
    }

    #[test]
    fn nothing_that_is_heard_is_kept_back() {
        let transducer = Transducer::POLAROID_6500;
        let (mut heard, mut over_poles) = (0, 0);
        for number in 0..40 {
            let (scene, ring) = random(number);
            let floor = 0.5 * transducer.detection_floor(scene.air());
            let piston = transducer.piston(scene.air());
            let mut matrix = CrosstalkMatrix::new();
            matrix.compute(&mut Tracer::new(), &scene, &ring, &transducer, Limits::order(3), floor).unwrap();
            let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
            for (emitter, source) in ring.iter().enumerate() {
                let all = scene.paths(places[emitter], &places, 3, f64::INFINITY).unwrap();
                for (receiver, listener) in ring.iter().enumerate() {
                    let loud = all.of(receiver as u32).filter(|&k| {
                        all.amplitude[k]
                            * piston.pattern(all.departure_rad[k] - source.rotation.angle())
                            * piston.pattern(all.arrival_rad[k] - listener.rotation.angle())
                            >= floor
                    });
                    let expected: Vec<_> = loud.map(|k| (all.length_m[k], all.bounces(k))).collect();
                    let kept = matrix.between(emitter, receiver);
                    let found: Vec<_> = kept.iter().map(|path| (path.length_m, matrix.bounces(path))).collect();
                    assert_eq!(found, expected, "{number}: {emitter} to {receiver}");
                    heard += found.len();
                    over_poles +=
                        found.iter().filter(|path| path.1.iter().any(|b| matches!(b, Bounce::Pole(_)))).count();
                }
            }
        }
        assert!(heard > 2000 && over_poles > 500, "{heard} {over_poles}");
    }

    #[test]
    fn single_poles_are_the_same_whether_or_not_longer_paths_are_sought() {
        let mut seen = 0;
        for number in 0..40 {
            let (scene, ring) = random(number);
            let places: Vec<_> = ring.iter().map(|sensor| Point::from(sensor.translation.vector)).collect();
            let alone = |max_order| {
                let paths = scene.paths(places[0], &places, max_order, f64::INFINITY).unwrap();
                let poles = (0..paths.len()).filter(|&k| matches!(paths.bounces(k), [Bounce::Pole(_)]));
                poles.map(|k| (paths.receiver[k], paths.length_m[k], paths.bounces(k).to_vec())).collect::<Vec<_>>()
            };
            assert_eq!(alone(1), alone(2), "{number}");
            seen += alone(1).len();
        }
        assert!(seen > 1000);
    }
}
