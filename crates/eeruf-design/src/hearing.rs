//! Pairs of sensors that can hear each other from their places, directly or off one wall.

use core::f64::consts::TAU;

use eeruf_files::Pose;
use eeruf_modules::{Air, Beam, Module, Piston};

/// Numbers of directions and distances at which a reflection between two sensors is tried.
const DIRECTIONS: u32 = 180;
const DISTANCES: u32 = 40;
/// Least distance, in metres.
const NEAREST_M: f64 = 0.01;
/// Greatest amplitude of a narrow panel's echo relative to a wall's (`docs/explanation/physics.md`).
const LOUDEST_PANEL: f64 = 1.35;
/// Tolerance in degrees: angles off the axis are rounded down, but a right angle with a rounding error stays one.
const SAME_DEG: f64 = 1e-9;

/// A sensor as seen by others.
struct Heard<'a> {
    at: [f64; 2],
    /// Sine and cosine of the sensor's heading.
    heading: (f64, f64),
    module: &'a Module,
    absorption_db_per_m: f64,
    /// Amplitude at the threshold of hearing.
    floor: f64,
    /// Greatest share of sound sent or received at this many degrees off the axis or more.
    pattern: Vec<f64>,
}

impl<'a> Heard<'a> {
    fn new(pose: &Pose, module: &'a Module, air: Air) -> Self {
        let frequency_hz = f64::from(module.frequency_hz);
        let absorption_db_per_m = air.absorption_db_per_m(frequency_hz);
        let wave_number = TAU * frequency_hz / air.speed_of_sound();
        // The robot's body blocks the sound behind the sensor.
        let piston = Piston { beam: Beam::CutAt90, ..Piston::new(wave_number, f64::from(module.radius_um) / 1e6) };
        let mut pattern: Vec<f64> = (0..=180_u32)
            .map(|deg| {
                let within =
                    (0..4).map(|quarter| piston.pattern((f64::from(deg) + 0.25 * f64::from(quarter)).to_radians()));
                within.fold(0.0, f64::max)
            })
            .collect();
        for deg in (0..180).rev() {
            pattern[deg] = pattern[deg].max(pattern[deg + 1]);
        }
        let length_m = 2.0 * f64::from(module.hears_to_mm) / 1e3;
        let floor = lost(absorption_db_per_m, length_m);
        let heading = libm::sincos(pose.heading_rad);
        Self { at: [pose.x_m, pose.y_m], heading, module, absorption_db_per_m, floor, pattern }
    }

    /// Share of the sound in the direction of a point, and the distance to that point.
    fn towards(&self, point: [f64; 2]) -> (f64, f64) {
        let [east, north] = [point[0] - self.at[0], point[1] - self.at[1]];
        let (sin, cos) = self.heading;
        let [ahead, aside] = [cos * east + sin * north, cos * north - sin * east];
        let deg = libm::atan2(aside, ahead).abs().to_degrees() + SAME_DEG;
        (self.pattern[deg as usize], length(ahead, aside))
    }

    /// Returns true if this sensor hears another one whose sound is reflected at a point.
    fn hears(&self, other: &Self, point: [f64; 2], farthest_m: f64) -> bool {
        let ((departs, out_m), (arrives, back_m)) = (other.towards(point), self.towards(point));
        let length_m = out_m + back_m;
        let amplitude = LOUDEST_PANEL * departs * arrives * lost(other.absorption_db_per_m, length_m);
        length_m <= 2.0 * farthest_m && amplitude >= self.floor
    }
}

/// The amplitude after this distance, relative to that after 1 m without absorption.
fn lost(absorption_db_per_m: f64, length_m: f64) -> f64 {
    libm::exp10(-absorption_db_per_m * length_m / 20.0) / length_m
}

fn length(x_m: f64, y_m: f64) -> f64 {
    (x_m * x_m + y_m * y_m).sqrt()
}

/// For each sensor the bit set of those that hear it or that it hears: directly, or off one wall or object at any angle
/// up to `farthest_m` away, in a module's strongest fading. The robot's body blocks sound: a sensor sends and hears
/// nothing behind itself.
pub(crate) fn hearing(poses: &[Pose], modules: &[Module], air: Air, farthest_m: f64) -> Vec<u64> {
    let sensors: Vec<_> = poses.iter().zip(modules).map(|(pose, module)| Heard::new(pose, module, air)).collect();
    let mut rows = vec![0; sensors.len()];
    for (x, one) in sensors.iter().enumerate() {
        for (y, other) in sensors.iter().enumerate().skip(x + 1) {
            if one.module.hears(other.module) && hear(one, other, farthest_m) {
                rows[x] |= 1 << y;
                rows[y] |= 1 << x;
            }
        }
    }
    rows
}

fn hear(one: &Heard<'_>, other: &Heard<'_>, farthest_m: f64) -> bool {
    let middle = [0, 1].map(|axis| 0.5 * (one.at[axis] + other.at[axis]));
    // Any point can reflect sound, by a wall through it at the right angle.
    let mut points = (0..DISTANCES).flat_map(|step| {
        let share = f64::from(step) / f64::from(DISTANCES - 1);
        let away_m = NEAREST_M * libm::pow(farthest_m.max(NEAREST_M) / NEAREST_M, share);
        (0..DIRECTIONS).map(move |step| {
            let rad = TAU * f64::from(step) / f64::from(DIRECTIONS);
            [middle[0] + away_m * libm::cos(rad), middle[1] + away_m * libm::sin(rad)]
        })
    });
    let hear_at = |point| one.hears(other, point, farthest_m) || other.hears(one, point, farthest_m);
    // The middle is on the direct path, if there is one.
    let apart_m = length(one.at[0] - other.at[0], one.at[1] - other.at[1]);
    (apart_m > NEAREST_M && hear_at(middle)) || points.any(hear_at)
}

#[cfg(test)]
mod tests {
    use eeruf_files::arc;
    use eeruf_modules::{HC_SR04, POLAROID_6500};
    use eeruf_period::Random;
    use eeruf_sim::{CrosstalkMatrix, CrosstalkQuery, Limits, Pose, Scene, Tracer, Transducer, Vector, Wall, pose_of};

    use super::*;
    use crate::RingSpec;

    /// Two sensors on the edge of a robot of this radius, with headings this far apart.
    fn two(apart_deg: f64, radius_m: f64, modules: [Module; 2]) -> bool {
        let poses: Vec<_> = arc(2, radius_m, 0.0, apart_deg.to_radians()).collect();
        hearing(&poses, &modules, Air::default(), 2.57)[0] != 0
    }

    #[test]
    fn back_to_back_is_deaf_and_side_by_side_is_not() {
        for radius_m in [0.0, 0.05, 0.2, 1.0] {
            for module in [HC_SR04, POLAROID_6500] {
                assert!(!two(180.0, radius_m, [module; 2]), "{} {radius_m}", module.name);
                assert!(two(30.0, radius_m, [module; 2]), "{} {radius_m}", module.name);
            }
            // 40 and 49.4 kHz.
            assert!(!two(30.0, radius_m, [HC_SR04, POLAROID_6500]));
        }
        assert!(two(90.0, 0.2, [HC_SR04; 2]) && !two(135.0, 0.2, [HC_SR04; 2]));
    }

    // By the simulator's own tracer, no wall within the limit lets two sensors hear each other that are said not to.
    #[test]
    fn no_wall_near_by_joins_a_deaf_pair() {
        let (air, farthest_m) = (Air::default(), 1.5);
        let (mut random, mut tracer, mut matrix) = (Random::new(7), Tracer::new(), CrosstalkMatrix::new());
        let (mut heard, mut deaf) = (0, 0);
        for (module, sensors) in [(HC_SR04, 8), (POLAROID_6500, 9), (HC_SR04, 13)] {
            let transducer = Transducer::of(&module);
            for radius_m in [0.1, 0.3] {
                let poses: Vec<_> = arc(sensors, radius_m, 0.0, TAU / sensors as f64).collect();
                let ring: Vec<_> = poses.iter().map(pose_of).collect();
                let rows = hearing(&poses, &vec![module; sensors], air, farthest_m);
                deaf += rows.iter().map(|row| sensors as u32 - 1 - row.count_ones()).sum::<u32>();
                // Sound that fading lifts by five sigma is heard.
                let floor = transducer.detection_floor(air) * libm::exp10(-5.0 * 1.5 / 20.0);
                let (gain, beam) = (eeruf_sim::GainProfile::Constant, Beam::CutAt90);
                let transducer = Transducer { gain, beam, ..transducer };
                for _ in 0..200 {
                    let turned = Pose::new(Vector::zeros(), random.between(0.0, TAU));
                    let away_m = random.between(radius_m + 0.01, farthest_m);
                    let corner = |y: f64| {
                        let at = turned * eeruf_sim::Point::new(away_m, y);
                        [at.x, at.y]
                    };
                    let wall = Wall::polyline(&[corner(-20.0), corner(20.0)]).collect();
                    let scene = Scene::new(wall, vec![], air).unwrap();
                    let limits = Limits { max_length_m: 2.0 * farthest_m, ..Limits::order(1) };
                    let query = CrosstalkQuery::new(&scene, &ring, &transducer, limits, floor);
                    matrix.compute(&mut tracer, &query).unwrap();
                    for path in matrix.paths().iter().filter(|path| path.emitter != path.receiver) {
                        heard += 1;
                        assert!(rows[path.emitter as usize] >> path.receiver & 1 == 1, "{} {path:?}", module.name);
                    }
                }
            }
        }
        assert!(heard > 1000 && deaf > 60, "{heard} {deaf}");
    }

    fn spec(text: &str) -> RingSpec {
        RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    #[test]
    fn deaf_pairs_of_a_ring_are_no_neighbours() {
        let ring = "sensors = 8\nmodule = \"hc-sr04\"\nmin_interval_us = 9_000\n";
        let arc = "spacing_deg = 45\nradius_m = 0.2\n";
        let without = spec(&format!("{ring}layout = \"ring\""));
        let with = spec(&format!("{ring}{arc}"));
        assert_eq!(without.layout.layout().to_string(), "4 adjacent sensors of a ring");
        // 135 degrees apart.
        assert_eq!(with.layout.layout().to_string(), "3 adjacent sensors of a ring");
        assert_eq!((without.not_neighbours.len(), with.not_neighbours.len()), (0, 8));
        assert!(with.not_neighbours.contains(&(0, 3)) && with.not_neighbours.contains(&(0, 5)));
        // Pairs that a file names are its own.
        let named = spec(&format!("{ring}{arc}layout = [[0, 4]]"));
        assert!(named.layout.layout().neighbours(8, 0, 4) && named.not_neighbours.is_empty());
        // A pair back to back needs no interval.
        let poses = "poses = [{ x_m = 0.1, y_m = 0 }, { x_m = -0.1, y_m = 0, heading_deg = 180 }]";
        let pair = spec(&format!("{}{poses}", ring.replace('8', "2")));
        assert!(!pair.layout.layout().neighbours(2, 0, 1));
        assert_eq!(pair.not_neighbours, [(0, 1)]);
    }
}
