//! Things that appear before a robot: their choice, their places, and the sensors that would read them if no other
//! fired.

use core::f64::consts::FRAC_PI_2;

use crate::{
    acoustics::Physics,
    experiments::rooms::RoomPlan,
    geometry::{Point, Pose, Vector},
    methods::Method,
    results::{DEFAULT_TOLERANCE_US, Readings},
    scene::{Body, Faces, Pole, Room, Scene, Wall},
    simulation::{Options, simulate},
    world::{Noise, Random, Robot, World},
};

/// Least and greatest distance of a thing from its sensor, in metres.
const NEAR_M: [f64; 2] = [0.3, 2.0];
/// Greatest angle of a thing off the sensor's axis, in degrees.
const ASIDE_DEG: f64 = 7.5;
/// Number of firings of the sensor alone in quiet air, one a second, and the number that must read the thing first.
const FIRINGS: u32 = 10;
const MUST_READ: usize = 9;
/// Number of unsuccessful draws after which a trial goes without a thing.
const MOST_DRAWN: u32 = 400;

/// A kind of thing. All dimensions are choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ThingKind {
    /// A pole of 6 cm radius.
    Leg,
    /// A pole of 1.5 cm radius: a chair's leg.
    Chair,
    /// A thin wall of 1 m with one end nearest; it leads away from the sensor at any angle up to 90 degrees.
    WallEnd,
    /// A panel 0.6 m wide that faces the sensor with its middle.
    Panel,
    /// Two poles of 6 cm radius, 0.25 m apart seen from the sensor; a pole of 15 cm radius is 0.2 m behind them.
    Person,
}

impl ThingKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [Self::Leg, Self::Chair, Self::WallEnd, Self::Panel, Self::Person];
}

/// A thing at the place where it appears.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Thing {
    /// The kind.
    pub kind: ThingKind,
    /// The sensor before which the thing was drawn.
    pub sensor: usize,
    /// The distance of the thing's nearest point from the sensor, in metres.
    pub distance_m: f64,
    poles: Vec<Pole>,
    walls: Vec<Wall>,
}

/// Counts of the things drawn at random.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Draws {
    /// Number of things that fitted.
    pub fitted: u32,
    /// Number of fitting things that their sensor does not read: the module's blindness.
    pub unread: u32,
}

impl Thing {
    fn random(random: &mut Random, robot: &Robot, pose: &Pose) -> Self {
        let sensor = (random.bits() % robot.sensors.len() as u64) as usize;
        let kind = ThingKind::ALL[(random.bits() % 5) as usize];
        let distance_m = random.between(NEAR_M[0], NEAR_M[1]);
        let seen = *pose * robot.sensors[sensor];
        let rad = seen.rotation.angle() + random.between(-ASIDE_DEG, ASIDE_DEG).to_radians();
        let turn = random.between(-FRAC_PI_2, FRAC_PI_2);
        let towards = |rad: f64| Vector::new(libm::cos(rad), libm::sin(rad));
        let (from, ahead, left) = (seen.translation.vector, towards(rad), towards(rad + FRAC_PI_2));
        let pole = |m: f64, aside_m: f64, radius_m: f64| {
            let centre = from + m * ahead + aside_m * left;
            Pole::new(centre.x, centre.y, radius_m)
        };
        let wall = |one: Vector, end: Vector| Wall::new(one.x, one.y, end.x, end.y).with_faces(Faces::Both);
        let nearest = from + distance_m * ahead;
        let (poles, walls) = match kind {
            ThingKind::Leg => (vec![pole(distance_m + 0.06, 0.0, 0.06)], vec![]),
            ThingKind::Chair => (vec![pole(distance_m + 0.015, 0.0, 0.015)], vec![]),
            ThingKind::WallEnd => (vec![], vec![wall(nearest, nearest + towards(rad + turn))]),
            ThingKind::Panel => (vec![], vec![wall(nearest + 0.3 * left, nearest - 0.3 * left)]),
            ThingKind::Person => {
                let to_legs = distance_m + 0.06;
                let legs_m = libm::sqrt(to_legs * to_legs - 0.125 * 0.125);
                let legs = [0.125, -0.125].map(|aside| pole(legs_m, aside, 0.06));
                ([&legs[..], &[pole(legs_m + 0.2, 0.0, 0.15)]].concat(), vec![])
            }
        };
        Self { kind, sensor, distance_m, poles, walls }
    }

    /// Draws things for a robot at a pose in a room until one fits, has a clear line to its sensor and is read by it;
    /// `None` after 400 draws.
    pub(super) fn draw(
        mut random: Random,
        plan: &RoomPlan,
        world: &World,
        pose: &Pose,
        draws: &mut Draws,
    ) -> Option<Self> {
        let robot = world.robots().first()?;
        for _ in 0..MOST_DRAWN {
            let thing = Self::random(&mut random, robot, pose);
            if !thing.fits(world, pose) {
                continue;
            }
            // A wall that crosses another does not fit either.
            let Ok(scene) = thing.scene(plan) else { continue };
            draws.fitted += 1;
            let seen = *pose * robot.sensors[thing.sensor];
            let with = alone(scene, robot, thing.sensor, &seen, FIRINGS, random.bits());
            let us = thing.nearest_us(world.scene().air().speed_of_sound(), Point::from(seen.translation.vector));
            let reads = |readings: &Readings| readings.earliest_us.iter().filter(|&&read| is_near(read, us)).count();
            let is_read = with.is_some_and(|readings| reads(&readings) >= MUST_READ);
            if is_read && thing.changes(plan, robot, thing.sensor, &seen, us) {
                return Some(thing);
            }
            draws.unread += 1;
        }
        None
    }

    /// Returns the room with the thing.
    pub(super) fn scene(&self, plan: &RoomPlan) -> Result<Scene, crate::scene::SceneError> {
        let (walls, poles) = ([&plan.walls[..], &self.walls].concat(), [&plan.poles[..], &self.poles].concat());
        Scene::new(walls, poles, crate::scene::Air::default())?.with_room(Some(Room::DEFAULT))
    }

    /// Returns the caller's scene with the thing.
    pub(super) fn added_to(&self, scene: &Scene) -> Result<Scene, crate::scene::SceneError> {
        let (walls, poles) = ([scene.walls(), &self.walls].concat(), [scene.poles(), &self.poles].concat());
        Scene::new(walls, poles, scene.air())?.with_room(scene.room().copied())
    }

    /// Returns the parts of the thing as bodies with their poses.
    fn bodies(&self) -> impl Iterator<Item = (Body, Pose)> + '_ {
        let poles = self.poles.iter().map(|pole| (Body::Disc(pole.radius_m), Pose::from(pole.centre.coords)));
        poles.chain(self.walls.iter().map(|wall| between(wall.from, wall.to)))
    }

    /// Returns true if the thing touches nothing, is in no robot, and has a clear line to its sensor.
    fn fits(&self, world: &World, pose: &Pose) -> bool {
        let (robots, scene) = (world.robots(), world.scene());
        let at = |index: usize| if index == 0 { *pose } else { robots[index].pose };
        let meets_robot = |(body, there): &(Body, Pose)| {
            (0..robots.len()).any(|index| robots[index].outline().overlaps(&at(index), body, there))
        };
        if self.bodies().any(|part| meets_robot(&part) || scene.contact(&part.0, &part.1).is_some()) {
            return false;
        }
        let seen = Point::from((*pose * robots[0].sensors[self.sensor]).translation.vector);
        let (line, middle) = between(seen, self.nearest_point(seen));
        let others = (1..robots.len()).any(|index| robots[index].outline().overlaps(&at(index), &line, &middle));
        !others && scene.contact(&line, &middle).is_none()
    }

    /// Returns the point of the thing nearest to a place.
    fn nearest_point(&self, from: Point) -> Point {
        let of_pole = |pole: &Pole| pole.centre + (from - pole.centre).normalize() * pole.radius_m;
        let poles = self.poles.iter().map(of_pole);
        let points = poles.chain(self.walls.iter().map(|wall| nearest_of(wall.from, wall.to, from)));
        points.min_by(|a, b| (a - from).norm().total_cmp(&(b - from).norm())).unwrap_or(from)
    }

    /// Returns the echo time of the thing's nearest point for a sensor at a place.
    pub(super) fn nearest_us(&self, c: f64, from: Point) -> f64 {
        2e6 * (self.nearest_point(from) - from).norm() / c
    }

    /// Returns true if the sensor, firing alone, would read something else without the thing.
    pub(super) fn changes(&self, plan: &RoomPlan, robot: &Robot, sensor: usize, seen: &Pose, us: f64) -> bool {
        let room = plan.scene().and_then(|scene| scene.with_room(Some(Room::DEFAULT)));
        let without = room.ok().and_then(|scene| alone(scene, robot, sensor, seen, 1, 0));
        without.is_some_and(|readings| readings.reference_us.first().is_some_and(|&before| !is_near(before, us)))
    }

    /// Returns true if a robot at a pose touches the thing.
    pub(super) fn touches(&self, robot: &Robot, pose: &Pose) -> bool {
        self.bodies().any(|(body, there)| robot.outline().overlaps(pose, &body, &there))
    }
}

/// Returns true if two echo times differ by at most 8.6 cm.
pub(super) fn is_near(one_us: f64, other_us: f64) -> bool {
    (one_us - other_us).abs() <= DEFAULT_TOLERANCE_US
}

/// Returns true if two echo times agree: near each other, or both silent.
pub(super) fn agree(one_us: f64, other_us: f64) -> bool {
    is_near(one_us, other_us) || (one_us.is_nan() && other_us.is_nan())
}

/// Makes a strip from one point to another.
fn between(from: Point, to: Point) -> (Body, Pose) {
    let way = to - from;
    let pose = Pose::new(0.5 * (from.coords + to.coords), libm::atan2(way.y, way.x));
    (Body::Box(way.norm().max(1e-3) - 5e-4, 1e-3), pose)
}

/// Returns the point nearest to a place on a line from one point to another.
pub(super) fn nearest_of(from: Point, to: Point, place: Point) -> Point {
    let way = to - from;
    from + way * ((place - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
}

/// Simulates one sensor of a robot, alone in quiet air, one firing a second; `None` if it cannot stand there.
fn alone(scene: Scene, robot: &Robot, sensor: usize, seen: &Pose, firings: u32, seed: u64) -> Option<Readings> {
    let second = eeruf_core::Micros::from_millis(1000);
    let mut one = Robot::with_sensors(*seen, vec![Pose::identity()], robot.transducer_of(sensor));
    one.modules = robot.modules.get(sensor).copied().into_iter().collect();
    one.heights_m = robot.heights_m.get(sensor).copied().into_iter().collect();
    (one.blanking, one.window) = (robot.blanking_of(sensor), robot.window);
    (one.period, one.audible) = (second, second);
    let world = World::new(scene, vec![one], Noise::default()).ok()?.with_physics(Physics::DEFAULT).ok()?;
    let options = Options { seed: Some(seed), ..Options::periods(firings) };
    simulate(&world, Method::Sequential, &options).ok()
}
