//! Which paths are certainly too faint to be heard, told from where they point before anything dear is computed of them.
//!
//! Every bound is an upper one, so that nothing audible is lost: the patterns by their envelope, a pole by the most that it can
//! return, surfaces and air as if they took nothing.

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

/// One question's emitter and receivers, and what is just heard.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gate {
    piston: Piston,
    /// The highest square of the pattern from an angle on.
    envelope: Vec<f64>,
    floor: f64,
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
        Self { piston, envelope, floor: 0.0, source_rad: 0.0, source: ahead, receivers: Vec::new() }
    }

    pub(crate) fn is_for(&self, piston: &Piston) -> bool {
        self.piston == *piston
    }

    /// Sets where source and receivers head, and the amplitude that is just heard.
    pub(crate) fn aim(&mut self, floor: f64, source_rad: f64, receivers: impl Iterator<Item = Vector>) {
        self.floor = floor * (1.0 - 1e-9);
        self.source_rad = source_rad;
        self.source = Vector::new(source_rad.cos(), source_rad.sin());
        self.receivers.clear();
        self.receivers.extend(receivers);
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

    /// Whether a path over walls may be heard that leaves at an angle with this cosine off the source's axis, and whose image
    /// the receiver sees in the direction `towards`, as long as the path.
    #[inline]
    pub(crate) fn walls(&self, departure_cos: f64, receiver: usize, towards: Vector, length_m: f64, kept: f64) -> bool {
        let Some(axis) = self.receivers.get(receiver) else { return true };
        let square = self.square(departure_cos) * self.square(towards.dot(axis) / length_m);
        square * kept * kept >= (self.floor * length_m).powi(2)
    }

    /// Whether a path from source to receiver over one pole may be heard.
    ///
    /// ```text
    /// A^2 <= (a / 2) / (s' s (s' + s))
    /// ```
    #[inline]
    pub(crate) fn pole(&self, source: Point, receiver: usize, at: Point, pole: &Pole) -> bool {
        let Some(axis) = self.receivers.get(receiver) else { return true };
        let (out, home) = (pole.centre - source, pole.centre - at);
        let (far_out, far_home) = (out.norm(), home.norm());
        if far_out.min(far_home) < FAR * pole.radius_m {
            return true;
        }
        let (before, after) = (far_out - pole.radius_m, far_home - pole.radius_m);
        let square = self.square(out.dot(&self.source) / far_out) * self.square(home.dot(axis) / far_home);
        square * 0.5 * pole.radius_m >= self.floor * self.floor * before * after * (before + after)
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
