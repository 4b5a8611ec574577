//! Rooms in which rings are judged: the objects in each, and the robot's place and motion.

use core::f64::consts::{FRAC_PI_2, PI, TAU};
use core::fmt;
use core::str::FromStr;

use serde::{Serialize, Serializer};

use crate::{
    geometry::{Point, Pose, Vector},
    maps::OccupancyGrid,
    scene::{Air, Pole, Scene, SceneError, Wall},
    world::{Clock, Motion, Noise, Random, Robot, World, WorldError},
};

/// The version of the set. A room is fixed by version and number.
pub const VERSION: u32 = 1;
/// Simulated time of a driving robot, in seconds, for which it has a free way.
pub const DRIVING_S: f64 = 8.0;

/// The random key of places in maps, next to the keys of the kinds.
const MAP: u64 = 100;
/// Largest number of places drawn in a map to find one that is wide enough.
const MOST_DRAWN: u32 = 100_000;

/// Free space that is kept around a robot, in metres.
const CLEARANCE_M: f64 = 0.2;

/// A kind of room. All dimensions are choices, after rooms in which people live and work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum RoomKind {
    /// A corridor 16 m long and 1.6 to 2.4 m wide.
    Corridor,
    /// A room of 4.5 to 6 by 3.5 to 4.5 m with a cupboard in a corner.
    Office,
    /// A bare hall of 8 to 12 by 6 to 9 m.
    Hall,
    /// A hall of the same size with three to six cupboards and two to four poles.
    Clutter,
    /// Three walls 1 to 2.4 m apart and 0.9 to 2 m deep, the robot in the mouth: the paper's Set I.
    Alcove,
    /// A garage of 6 by 5.4 to 6.5 m with a car and a pillar.
    Garage,
    /// An aisle 1.5 to 2.2 m wide between shelves whose ends leave gaps.
    Aisle,
    /// A corridor 2.2 to 3 m wide with another robot of the same make 1.4 to 3 m away.
    Meeting,
}

impl RoomKind {
    /// Every kind.
    pub const ALL: [Self; 8] = [
        Self::Corridor,
        Self::Office,
        Self::Hall,
        Self::Clutter,
        Self::Alcove,
        Self::Garage,
        Self::Aisle,
        Self::Meeting,
    ];

    /// Returns the name in tables, in JSON and in Python.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Corridor => "corridor",
            Self::Office => "office",
            Self::Hall => "hall",
            Self::Clutter => "clutter",
            Self::Alcove => "alcove",
            Self::Garage => "garage",
            Self::Aisle => "aisle",
            Self::Meeting => "meeting",
        }
    }
}

impl fmt::Display for RoomKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Serialize for RoomKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

/// An unknown name of a kind of room.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownRoom(pub String);

impl fmt::Display for UnknownRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = RoomKind::ALL.map(RoomKind::as_str).join(", ");
        write!(f, "no room `{}`; expected {names}", self.0)
    }
}

impl core::error::Error for UnknownRoom {}

impl FromStr for RoomKind {
    type Err = UnknownRoom;

    /// ```
    /// use eeruf_sim::experiments::rooms::RoomKind;
    /// assert_eq!("office".parse(), Ok(RoomKind::Office));
    /// assert!("kitchen".parse::<RoomKind>().unwrap_err().to_string().starts_with("no room `kitchen`; expected corr"));
    /// ```
    fn from_str(name: &str) -> Result<Self, UnknownRoom> {
        Self::ALL.into_iter().find(|kind| kind.as_str() == name).ok_or_else(|| UnknownRoom(name.to_owned()))
    }
}

/// A room with a place in it.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomPlan {
    /// The room's number in the set, or the file's own; it seeds all random values.
    pub number: u64,
    /// The walls.
    pub walls: Vec<Wall>,
    /// The poles.
    pub poles: Vec<Pole>,
    /// The robot's place.
    pub pose: Pose,
    /// The place of another robot of the same make.
    pub other: Option<Pose>,
    /// The direction in which the robot drives, if it does, as a unit vector, and the free way ahead in metres.
    way: (Vector, f64),
    /// True if the robot faces its driving direction.
    turns: bool,
}

/// An object in a room: a box from corner to corner.
#[derive(Clone, Copy, Debug)]
struct Solid {
    low: [f64; 2],
    high: [f64; 2],
}

impl Solid {
    fn new(x: f64, y: f64, width: f64, depth: f64) -> Self {
        Self { low: [x, y], high: [x + width, y + depth] }
    }

    /// Returns the walls, seen from outside.
    fn walls(self) -> impl Iterator<Item = Wall> {
        let Self { low: [x0, y0], high: [x1, y1] } = self;
        Wall::polyline(&[[x0, y0], [x0, y1], [x1, y1], [x1, y0], [x0, y0]]).collect::<Vec<_>>().into_iter()
    }

    fn distance_m(self, [x, y]: [f64; 2]) -> f64 {
        let off = |at: f64, low: f64, high: f64| (low - at).max(at - high).max(0.0);
        libm::hypot(off(x, self.low[0], self.high[0]), off(y, self.low[1], self.high[1]))
    }

    fn is_near(self, other: Self, m: f64) -> bool {
        (0..2).all(|axis| self.low[axis] < other.high[axis] + m && other.low[axis] < self.high[axis] + m)
    }
}

/// A room being furnished; its middle is the origin.
struct Draft {
    /// Length and width inside.
    size: [f64; 2],
    solids: Vec<Solid>,
    poles: Vec<Pole>,
}

impl Draft {
    /// Returns the distance from a place to the nearest object, in metres; negative outside.
    fn free_m(&self, place: [f64; 2]) -> f64 {
        let [x, y] = place;
        let walls = (0.5 * self.size[0] - x.abs()).min(0.5 * self.size[1] - y.abs());
        let solids = self.solids.iter().map(|solid| solid.distance_m(place));
        let poles = self.poles.iter().map(|pole| (pole.centre - Point::new(x, y)).norm() - pole.radius_m);
        solids.chain(poles).fold(walls, f64::min)
    }

    /// Returns the first place drawn that is wide enough in the middle part of the room, or else the widest of 200.
    fn place(&self, random: &mut Random, share: f64, radius_m: f64) -> Vector {
        let mut best = ([0.0; 2], f64::NEG_INFINITY);
        for _ in 0..200 {
            let [x, y] = self.size.map(|side| 0.5 * share * side);
            let place = [random.between(-x, x), random.between(-y, y)];
            let free = self.free_m(place);
            if free >= radius_m {
                return Vector::new(place[0], place[1]);
            }
            if free > best.1 {
                best = (place, free);
            }
        }
        Vector::new(best.0[0], best.0[1])
    }

    fn walls(&self) -> Vec<Wall> {
        let [x, y] = self.size.map(|side| 0.5 * side);
        let outer = [[-x, -y], [x, -y], [x, y], [-x, y], [-x, -y]];
        Wall::polyline(&outer).chain(self.solids.iter().flat_map(|solid| solid.walls())).collect()
    }
}

/// Returns the direction of the longest free way from a place, and its length in metres, at most 10.
fn longest_way(from: Vector, directions: &[f64], is_free: impl Fn(Vector) -> bool) -> (Vector, f64) {
    const STEP_M: f64 = 0.05;
    let ways = directions.iter().map(|&rad| {
        let direction = Vector::new(libm::cos(rad), libm::sin(rad));
        let is_free = |step: &u32| is_free(from + direction * (STEP_M * f64::from(*step)));
        (direction, STEP_M * f64::from((1..=200).take_while(is_free).count() as u32))
    });
    let longest = ways.reduce(|one, next| if next.1 > one.1 { next } else { one });
    longest.unwrap_or((Vector::new(1.0, 0.0), 0.0))
}

/// Returns sixteen directions all round.
fn directions() -> Vec<f64> {
    (0..16).map(|k| TAU * f64::from(k) / 16.0).collect()
}

impl RoomPlan {
    /// Returns the room of a kind and number, for a robot that needs a circle of this radius. If the robot does not
    /// fit, the room is made larger.
    pub fn random(kind: RoomKind, number: u64, radius_m: f64) -> Self {
        let mut random = Random::new(number).of(kind as u64);
        let radius_m = radius_m + CLEARANCE_M;
        // Half of the robots look along a wall or at it, as robots in rooms do; the others anywhere.
        let is_square = number.is_multiple_of(2);
        let tilt = random.between(-2.0, 2.0).to_radians();
        let turn = |random: &mut Random| {
            if is_square { FRAC_PI_2 * (random.bits() % 4) as f64 + tilt } else { random.between(0.0, TAU) }
        };
        // The room is at least as wide as the robot needs.
        let wide = |width: f64| width.max(2.0 * radius_m + 0.1);
        if kind == RoomKind::Alcove {
            return Self::alcove(number, &mut random, radius_m, tilt, is_square);
        }
        let draft = Draft::new(kind, &mut random, wide);
        let share = match kind {
            RoomKind::Corridor | RoomKind::Aisle => 0.6,
            RoomKind::Meeting => 0.4,
            _ => 0.8,
        };
        let at = draft.place(&mut random, share, radius_m);
        let pose = Pose::new(at, turn(&mut random));
        let other = (kind == RoomKind::Meeting).then(|| {
            let ahead = at + Vector::new(2.0 * radius_m + random.between(0.8, 2.2), 0.0);
            let room = (0.5 * draft.size[1] - radius_m).max(0.0);
            Pose::new(Vector::new(ahead.x, random.between(-room, room)), random.between(0.0, TAU))
        });
        // The way leads away from the other robot along a corridor; without one it leads where there is most room.
        let directions = match kind {
            RoomKind::Meeting => vec![PI],
            _ => directions(),
        };
        let way = longest_way(at, &directions, |at| draft.free_m([at.x, at.y]) >= radius_m);
        Self { number, walls: draft.walls(), poles: draft.poles, pose, other, way, turns: true }
    }

    /// Makes three walls with the robot in the mouth, looking in.
    fn alcove(number: u64, random: &mut Random, radius_m: f64, tilt: f64, is_square: bool) -> Self {
        let half = (0.5 * random.between(1.0, 2.4)).max(radius_m);
        let depth = random.between(0.9, 2.0) + (radius_m - 0.5).max(0.0);
        let corners = [[half, 0.0], [half, depth], [-half, depth], [-half, 0.0]];
        let aside = half - radius_m;
        let x = if aside > 0.0 { random.between(-aside, aside) } else { 0.0 };
        let y = random.between(-0.4, 0.3);
        let heading = if is_square { tilt } else { random.between(-20.0, 20.0).to_radians() };
        Self {
            number,
            walls: Wall::polyline(&corners).collect(),
            poles: vec![],
            pose: Pose::new(Vector::new(x, y), FRAC_PI_2 + heading),
            other: None,
            // The robot backs out.
            way: (Vector::new(0.0, -1.0), 10.0),
            turns: false,
        }
    }

    /// Returns a place in a map by its number, one of the places in `free`, for a robot that needs a circle of this
    /// radius; `None` if no free space is wide enough. The walls are the map's.
    pub(super) fn in_map(
        grid: &OccupancyGrid,
        free: &[[f64; 2]],
        walls: &[Wall],
        number: u64,
        radius_m: f64,
    ) -> Option<Self> {
        // Walls lie a little off the cells' edges.
        let needs_m = radius_m + grid.default_tolerance_m().max(CLEARANCE_M);
        let is_free = |at: Vector| grid.is_free_around([at.x, at.y], needs_m);
        let mut random = Random::new(number).of(MAP);
        let tilt = random.between(-2.0, 2.0).to_radians();
        let square = grid.heading_rad() + FRAC_PI_2 * (random.bits() % 4) as f64 + tilt;
        let any = random.between(0.0, TAU);
        // As in the set, half of the robots stand square to the map.
        let heading = if number.is_multiple_of(2) { square } else { any };
        let drawn = (0..MOST_DRAWN).filter_map(|_| free.get(random.bits().checked_rem(free.len() as u64)? as usize));
        let at = drawn.map(|&[x, y]| Vector::new(x, y)).find(|&at| is_free(at))?;
        let way = longest_way(at, &directions(), is_free);
        let (pose, walls) = (Pose::new(at, heading), walls.to_vec());
        Some(Self { number, walls, poles: vec![], pose, other: None, way, turns: true })
    }

    /// Makes the caller's own room, with the robot at a place from which it can drive this far ahead.
    pub fn own(number: u64, walls: Vec<Wall>, poles: Vec<Pole>, pose: Pose, way_m: f64) -> Self {
        let ahead = Vector::new(pose.rotation.re, pose.rotation.im);
        Self { number, walls, poles, pose, other: None, way: (ahead, way_m), turns: false }
    }

    /// Returns the walls and poles as a scene.
    ///
    /// # Errors
    /// [`SceneError`] for dimensions that make no valid walls.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        Scene::new(self.walls.clone(), self.poles.clone(), Air::default())
    }

    /// Returns the world with a robot in its place, standing or driving at this speed, or more slowly if it would meet
    /// something within [`DRIVING_S`]. Another robot of its make has its own clock.
    ///
    /// # Errors
    /// [`WorldError`] for a robot that does not fit.
    pub fn world(&self, robot: &Robot, speed_m_s: f64) -> Result<World, WorldError> {
        self.moving(robot, speed_m_s.min(self.way_m() / DRIVING_S), 0.0)
    }

    /// Returns the free way ahead of a robot that drives, in metres.
    pub(in crate::experiments) fn way_m(&self) -> f64 {
        self.way.1
    }

    /// Returns true if the robot faces its driving direction.
    pub(in crate::experiments) fn turns(&self) -> bool {
        self.turns
    }

    /// Returns the world with a robot that drives off at this speed, or turns on the spot.
    pub(in crate::experiments) fn moving(
        &self,
        robot: &Robot,
        speed_m_s: f64,
        turn_rad_s: f64,
    ) -> Result<World, WorldError> {
        let (direction, _) = self.way;
        let moves = speed_m_s > 0.0 || turn_rad_s != 0.0;
        let motion = match moves {
            true => Motion::Constant { velocity: speed_m_s * direction, turn_rad_s },
            false => Motion::Still,
        };
        // The alcove's robot faces the alcove while it backs away.
        let pose = if speed_m_s > 0.0 && self.turns {
            Pose::new(self.pose.translation.vector, libm::atan2(direction.y, direction.x))
        } else {
            self.pose
        };
        let first = Robot { pose, motion, odometry: moves && robot.odometry, ..robot.clone() };
        let mut random = Random::new(self.number).of(99);
        let period = f64::from(robot.period.as_micros());
        let other = self.other.map(|pose| Robot {
            pose,
            start: eeruf_core::Micros::new(random.between(0.0, period) as u32),
            clock: Clock { offset_us: random.bits() as u32, drift_ppm: random.between(-50.0, 50.0) },
            ..robot.clone()
        });
        let robots = core::iter::once(first).chain(other).collect();
        Ok(World::new(self.scene()?, robots, Noise::default())?.with_seed(self.number))
    }
}

impl Draft {
    fn new(kind: RoomKind, random: &mut Random, wide: impl Fn(f64) -> f64) -> Self {
        let mut draft = Self { size: [0.0; 2], solids: vec![], poles: vec![] };
        draft.size = match kind {
            RoomKind::Corridor => [16.0, wide(random.between(1.6, 2.4))],
            RoomKind::Office => [wide(random.between(4.5, 6.0)), wide(random.between(3.5, 4.5))],
            RoomKind::Garage => [wide(6.0), wide(random.between(5.4, 6.5))],
            // Shelves of 0.6 m on both sides.
            RoomKind::Aisle => [16.0, wide(random.between(1.5, 2.2)) + 1.2],
            RoomKind::Meeting => [20.0, wide(random.between(2.2, 3.0))],
            RoomKind::Hall | RoomKind::Clutter | RoomKind::Alcove => {
                [wide(random.between(8.0, 12.0)), wide(random.between(6.0, 9.0))]
            }
        };
        let [x, y] = draft.size.map(|side| 0.5 * side);
        match kind {
            RoomKind::Office => draft.solids.push(Solid::new(x - 1.0, y - 0.5, 0.8, 0.4)),
            RoomKind::Garage => {
                // A car at one side, and a pillar.
                draft.solids.push(Solid::new(-0.5 * 4.2, y - 2.2, 4.2, 1.7));
                draft.solids.push(Solid::new(random.between(-2.0, 1.6), -y + 0.1, 0.3, 0.3));
            }
            RoomKind::Aisle => {
                for side in [-1.0, 1.0] {
                    let mut at = 0.1 - x;
                    while at < x - 1.0 {
                        let length = random.between(1.2, 2.6).min(x - 0.1 - at);
                        let low = if side < 0.0 { 0.01 - y } else { y - 0.61 };
                        draft.solids.push(Solid::new(at, low, length, 0.6));
                        at += length + random.between(0.1, 0.4);
                    }
                }
            }
            RoomKind::Clutter => {
                let count = 3 + random.bits() % 4;
                for _ in 0..count {
                    let (width, depth) = (random.between(0.4, 1.6), random.between(0.4, 1.0));
                    let corner = [random.between(0.3 - x, x - 0.3 - width), random.between(0.3 - y, y - 0.3 - depth)];
                    let solid = Solid::new(corner[0], corner[1], width, depth);
                    if draft.solids.iter().all(|other| !solid.is_near(*other, 0.3)) {
                        draft.solids.push(solid);
                    }
                }
                let count = 2 + random.bits() % 3;
                for _ in 0..count {
                    let place = [random.between(0.5 - x, x - 0.5), random.between(0.5 - y, y - 0.5)];
                    if draft.free_m(place) > 0.2 {
                        draft.poles.push(Pole::new(place[0], place[1], random.between(0.02, 0.1)));
                    }
                }
            }
            RoomKind::Corridor | RoomKind::Hall | RoomKind::Alcove | RoomKind::Meeting => {}
        }
        draft
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::acoustics::Transducer;

    fn ring(radius_m: f64) -> Robot {
        Robot::ring(Pose::identity(), 12, TAU / 12.0, radius_m, Transducer::POLAROID_6500)
    }

    #[test]
    fn each_room_of_each_kind_holds_a_small_robot_and_a_car() {
        for kind in RoomKind::ALL {
            for number in 0..150 {
                for radius_m in [0.05, 0.3, 0.9] {
                    let plan = RoomPlan::random(kind, number, radius_m);
                    assert_eq!(plan, RoomPlan::random(kind, number, radius_m));
                    for speed_m_s in [0.0, 0.5] {
                        let world = plan.world(&ring(radius_m), speed_m_s);
                        let world = world.unwrap_or_else(|error| panic!("{kind} {number} {radius_m}: {error}"));
                        assert_eq!(world.robots().len(), if kind == RoomKind::Meeting { 2 } else { 1 });
                    }
                }
            }
        }
    }

    #[test]
    fn a_robot_that_drives_meets_nothing() {
        let mut slowest: f64 = 1.0;
        for (kind, number) in RoomKind::ALL.into_iter().flat_map(|kind| (0..60).map(move |number| (kind, number))) {
            let plan = RoomPlan::random(kind, number, 0.25);
            let world = plan.world(&ring(0.25), 0.5).unwrap();
            let robot = &world.robots()[0];
            let ends = robot.motion.at(&robot.pose, DRIVING_S).pose;
            let stands = Robot { pose: ends, motion: Motion::Still, ..ring(0.25) };
            World::new(plan.scene().unwrap(), vec![stands], Noise::default()).unwrap();
            let Motion::Constant { velocity, .. } = robot.motion else { panic!("{kind} {number} stands") };
            slowest = slowest.min(velocity.norm());
        }
        assert!(slowest > 0.05, "{slowest}");
    }
}
