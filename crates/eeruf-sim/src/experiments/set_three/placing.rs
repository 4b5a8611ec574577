//! Places and motions of the robots of Set III.

use core::f64::consts::{PI, TAU};

use eeruf_core::Micros;
use serde::Serialize;

use crate::{
    acoustics::Transducer,
    experiments::set_one::RADIUS_M,
    geometry::{Pose, Vector},
    scene::{Air, Faces, Scene, SceneError, Wall},
    world::{Clock, Motion, Random, Robot, Sketch},
};

/// Number of sensors of a ring, evenly spaced around the robot: as in the paper's table.
pub const SENSORS: usize = 12;
/// The period of the rings: as in the paper's table.
pub const PERIOD: Micros = Micros::from_millis(100);
/// Speed of robots that drive, in m/s: a choice.
pub const SPEED_M_S: f64 = 0.5;
/// The largest drift of a robot's clock, in parts per million: a choice, typical of a cheap quartz.
pub const DRIFT_PPM: f64 = 50.0;
/// Distance between the middles of robots that stand beside each other.
const NEAREST_M: f64 = 1.4;
/// Greatest distance between neighbours in a row.
const FARTHEST_M: f64 = 2.6;

/// Surroundings of the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Site {
    /// A corridor 1.8 to 2.6 m wide and 26 m long.
    Corridor,
    /// A hall 26 m long and 12 to 16 m wide, near one of its long walls.
    Hall,
}

/// Arrangement of the robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// The robots stand still, each at a random heading.
    Standing,
    /// Two rows drive past each other, side by side.
    Meeting,
    /// One row of robots drives in one direction.
    Following,
}

/// Robots of one make near each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Placing {
    /// Surroundings of the robots.
    pub place: Site,
    /// The robots' arrangement.
    pub arrangement: Arrangement,
    /// The robots, two to six.
    pub robots: Vec<Robot>,
    /// Length and width of the room, in metres; its middle is the origin.
    pub room_m: [f64; 2],
}

impl Placing {
    /// Returns the placing of a number. Thirty consecutive numbers cover each combination of place, arrangement and
    /// number of robots once.
    pub fn random(number: u64) -> Self {
        let place = if number.is_multiple_of(2) { Site::Corridor } else { Site::Hall };
        let arrangement =
            [Arrangement::Standing, Arrangement::Meeting, Arrangement::Following][(number / 2 % 3) as usize];
        let count = 2 + (number / 6 % 5) as usize;
        let mut random = Random::new(number);
        let room_m = match place {
            Site::Corridor => [26.0, random.between(1.8, 2.6)],
            Site::Hall => [26.0, random.between(12.0, 16.0)],
        };
        let poses = match (arrangement, place) {
            (Arrangement::Standing, Site::Hall) => scattered(count, &mut random),
            (Arrangement::Standing, Site::Corridor) => {
                let aside = 0.5 * room_m[1] - RADIUS_M - 0.1;
                let place = |x| (Vector::new(x, random.between(-aside, aside)), random.between(0.0, TAU));
                row(count, &mut Random::new(number).of(1)).into_iter().map(place).collect()
            }
            (Arrangement::Meeting, _) => meeting(count, &mut random),
            (Arrangement::Following, _) => {
                row(count, &mut random).into_iter().map(|x| (Vector::new(x, 0.0), 0.0)).collect()
            }
        };
        // In a hall rows are 1.2 to 3 m from a wall, and scattered robots are at least as far.
        let middle_m = match (place, arrangement) {
            (Site::Corridor, _) => 0.0,
            (Site::Hall, Arrangement::Standing) => 4.2 - 0.5 * room_m[1],
            (Site::Hall, _) => random.between(1.2, 3.0) - 0.5 * room_m[1],
        };
        let drives = arrangement != Arrangement::Standing;
        let robots = poses.into_iter().map(|(at, heading)| {
            let pose = Pose::new(at + Vector::new(0.0, middle_m), heading);
            let ring = Robot::ring(pose, SENSORS, TAU / SENSORS as f64, RADIUS_M, Transducer::POLAROID_6500);
            let velocity = SPEED_M_S * Vector::new(pose.rotation.re, pose.rotation.im);
            Robot {
                start: Micros::new(random.between(0.0, f64::from(PERIOD.as_micros())) as u32),
                clock: Clock { offset_us: random.bits() as u32, drift_ppm: random.between(-DRIFT_PPM, DRIFT_PPM) },
                motion: if drives { Motion::Constant { velocity, turn_rad_s: 0.0 } } else { Motion::Still },
                odometry: drives,
                period: PERIOD,
                firing: Sketch { rest: Some(ring.module_rest()), ..Sketch::default() },
                ..ring
            }
        });
        Self { place, arrangement, robots: robots.collect(), room_m }
    }

    /// Returns the four walls.
    ///
    /// # Errors
    /// [`SceneError`] for dimensions that make no valid walls.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        let [x, y] = self.room_m.map(|side| 0.5 * side);
        let corners = [[x, -y], [x, y], [-x, y], [-x, -y], [x, -y]];
        let walls = Wall::polyline(&corners).map(|wall| wall.with_faces(Faces::Both));
        Scene::new(walls.collect(), vec![], Air::default())
    }
}

/// Places robots on a line, centred on its middle.
fn row(count: usize, random: &mut Random) -> Vec<f64> {
    let mut at = 0.0;
    let mut places: Vec<f64> = (0..count)
        .map(|_| {
            at += random.between(NEAREST_M, FARTHEST_M);
            at
        })
        .collect();
    let middle = 0.5 * (places.first().unwrap_or(&0.0) + places.last().unwrap_or(&0.0));
    for place in &mut places {
        *place -= middle;
    }
    places
}

/// Places two rows that drive past each other: the first two robots are 4 m apart.
fn meeting(count: usize, random: &mut Random) -> Vec<(Vector, f64)> {
    const ASIDE_M: f64 = 0.45;
    let mut ahead = [2.0, 2.0];
    let each = |robot: usize| {
        let side = robot % 2;
        let at = ahead[side];
        ahead[side] += random.between(NEAREST_M, FARTHEST_M);
        if side == 0 { (Vector::new(-at, -ASIDE_M), 0.0) } else { (Vector::new(at, ASIDE_M), PI) }
    };
    (0..count).map(each).collect()
}

/// Draws random places in the middle of a hall, not too near each other.
fn scattered(count: usize, random: &mut Random) -> Vec<(Vector, f64)> {
    let mut places: Vec<(Vector, f64)> = Vec::with_capacity(count);
    while places.len() < count {
        let at = Vector::new(random.between(-3.0, 3.0), random.between(-3.0, 3.0));
        // Six discs of 1.4 m never fill a square of 6 m.
        if places.iter().all(|(other, _)| (at - other).norm() >= NEAREST_M) {
            places.push((at, random.between(0.0, TAU)));
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Noise, World};

    #[test]
    fn every_placing_is_a_world_and_thirty_differ() {
        let mut kinds = std::collections::BTreeSet::new();
        for number in 0..300 {
            let placing = Placing::random(number);
            assert_eq!(placing, Placing::random(number));
            kinds.insert((placing.place, placing.arrangement, placing.robots.len()));
            for (k, robot) in placing.robots.iter().enumerate() {
                for other in &placing.robots[..k] {
                    let apart_m = (robot.pose.translation.vector - other.pose.translation.vector).norm();
                    assert!((1.39..26.0).contains(&apart_m), "{number}: {apart_m}");
                    assert_ne!((robot.start, robot.clock), (other.start, other.clock));
                }
                let ends = robot.motion.at(&robot.pose, 5.0).pose.translation;
                let [x, y] = placing.room_m.map(|side| 0.5 * side - RADIUS_M);
                assert!(ends.x.abs() < x && ends.y.abs() < y, "{number}: {ends:?}");
            }
            let world = World::new(placing.scene().unwrap(), placing.robots, Noise::default());
            assert!(world.is_ok(), "{number}: {world:?}");
        }
        assert_eq!(kinds.len(), 30);
    }
}
