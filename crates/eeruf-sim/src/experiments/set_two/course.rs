//! A course: a lab with poles about 1.6 m apart (Fig. 6), with a way through for a robot.

use eeruf_core::Micros;

use crate::experiments::set_one::{RADIUS_M, SENSORS, SPACING_DEG};
use crate::{
    acoustics::Transducer,
    geometry::{Point, Pose, Vector},
    navigation::LabMate,
    scene::{Air, Body, Material, Pole, Scene, Wall},
    world::{Clock, Noise, Random, Robot, World, WorldError},
};

/// Length and width of the lab, in metres: a choice, as the paper gives none. The course runs along its length.
pub const ROOM_M: [f64; 2] = [10.0, 6.0];
/// Radius of the poles in metres: they are 8 mm thick (Sec. 4).
pub const POLE_RADIUS_M: f64 = 0.004;
/// Distance between poles of the regular lattice, in metres.
const SPACING_M: f64 = 1.6;
/// Largest distance in metres by which a pole is moved from its place, along either axis.
const SHAKE_M: f64 = 0.2;
/// Least distance of two poles, in metres.
const LEAST_GAP_M: f64 = 1.4;
/// Radius of a disc for which a free way exists: the platform's corners are 0.53 m from its middle.
const PASSABLE_M: f64 = 0.6;
/// Size of the cells for finding a free way, in metres.
const CELL_M: f64 = 0.1;
/// Start of the robot, and the finishing line, in metres.
const START_M: [f64; 2] = [1.0, 3.0];
pub(super) const FINISH_X_M: f64 = 8.2;
/// Target of the steering.
pub(super) const TARGET: Point = Point::new(9.4, 3.0);

/// Places for a second robot, out of the first one's way: in the corner behind it, and in the reflective corner ahead,
/// which all its sensors face.
pub const SECOND_BEHIND: Point = Point::new(0.6, 5.4);
/// See [`SECOND_BEHIND`].
pub const SECOND_AHEAD: Point = Point::new(9.4, 5.3);

/// One course.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// The number.
    pub number: u64,
    /// The poles' axes.
    pub poles: Vec<Point>,
}

impl Course {
    /// Returns the course of a number. Poles are drawn around the points of a triangular lattice, until no two are
    /// nearer than 1.4 m and a disc of radius 0.6 m can roll from the start to the finish; a search over cells of 10 cm
    /// proves it.
    pub fn random(number: u64) -> Self {
        let mut random = Random::new(number).of(2);
        loop {
            let course = Self { number, poles: shaken(&mut random) };
            if course.gap_m() >= LEAST_GAP_M && course.is_passable() {
                return course;
            }
        }
    }

    /// Returns the distance between the two poles nearest to each other.
    fn gap_m(&self) -> f64 {
        let pairs =
            self.poles.iter().enumerate().flat_map(|(k, a)| self.poles[..k].iter().map(move |b| (a - b).norm()));
        pairs.fold(f64::INFINITY, f64::min)
    }

    fn is_passable(&self) -> bool {
        let [columns, rows] = ROOM_M.map(|length| (length / CELL_M) as usize);
        let middle = |cell: usize| Point::new((cell % columns) as f64 + 0.5, (cell / columns) as f64 + 0.5) * CELL_M;
        let free = |cell: usize| {
            let at = middle(cell);
            // The disc rolls from the middle of a cell to the next, so it needs half a cell's diagonal more.
            let needed = PASSABLE_M + 0.05;
            let [x, y] = [at.x.min(ROOM_M[0] - at.x), at.y.min(ROOM_M[1] - at.y)];
            x >= needed && y >= needed && self.poles.iter().all(|pole| (pole - at).norm() >= needed)
        };
        let start = (START_M[1] / CELL_M) as usize * columns + (START_M[0] / CELL_M) as usize;
        let mut known = vec![false; columns * rows];
        let mut ahead = vec![start];
        while let Some(cell) = ahead.pop() {
            if known[cell] || !free(cell) {
                continue;
            }
            known[cell] = true;
            if middle(cell).x >= FINISH_X_M {
                return true;
            }
            // Free cells are never at the border, so all four neighbours exist.
            ahead.extend([cell - columns, cell - 1, cell + 1, cell + columns]);
        }
        false
    }

    /// Returns the lab: its far end and left side are smooth and form the reflective corner. The other two walls are
    /// lined with furniture and return half of the sound.
    ///
    /// # Errors
    /// [`WorldError`] if the poles do not make a valid scene.
    pub fn scene(&self) -> Result<Scene, WorldError> {
        let [x, y] = ROOM_M;
        let corners = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y], [0.0, 0.0]];
        let materials = [Material::SOFT, Material::SMOOTH, Material::SMOOTH, Material::SOFT];
        let walls = Wall::polyline(&corners).zip(materials).map(|(wall, material)| wall.with_material(material));
        let poles = self.poles.iter().map(|pole| Pole::new(pole.x, pole.y, POLE_RADIUS_M));
        Ok(Scene::new(walls.collect(), poles.collect(), Air::default())?)
    }

    /// Makes the ring of Set I on the platform's middle, at the start.
    pub fn robot(&self) -> Robot {
        let pose = Pose::new(Vector::from(START_M), 0.0);
        Robot::ring(pose, SENSORS, SPACING_DEG.to_radians(), RADIUS_M, Transducer::POLAROID_6500)
    }

    /// Makes the platform with its square body; the sensors of its ring are on its edge, along their axes.
    pub fn robot_with_body(&self, labmate: &LabMate) -> Robot {
        let mut robot = Robot { body: Some(labmate.body()), ..self.robot() };
        for sensor in &mut robot.sensors {
            let heading = sensor.rotation.angle();
            let out = Vector::new(libm::cos(heading), libm::sin(heading));
            let to_edge_m = 0.5 * labmate.side_m / out.x.abs().max(out.y.abs());
            *sensor = Pose::new(out * to_edge_m, heading);
        }
        robot
    }

    /// Makes the other robot: a stationary ring of 24 sensors all around that fires 24 times in 80 ms, with a clock 40
    /// ppm fast and a random start.
    pub fn second_robot(&self, at: Point) -> Robot {
        let mut random = Random::new(self.number).of(3);
        let pose = Pose::new(at.coords, random.between(-3.1, 3.1));
        let ring = Robot::ring(pose, 24, 15f64.to_radians(), RADIUS_M, Transducer::POLAROID_6500);
        Robot {
            period: Micros::from_millis(80),
            clock: Clock { offset_us: random.bits() as u32, drift_ppm: 40.0 },
            start: Micros::new(random.between(0.0, 80_000.0) as u32),
            ..ring
        }
    }

    /// Returns the lab with its robots. If the first one has a body, the other has the disc of its ring. Sound is
    /// followed for two bounces at walls, or one at a pole: a choice, for speed, which leaves out fainter sound.
    ///
    /// # Errors
    /// [`WorldError`] if a pole or a robot does not fit.
    pub fn world(&self, robot: Robot, second: Option<Point>) -> Result<World, WorldError> {
        let mut robots = vec![robot];
        let body = robots[0].body.map(|_| Body::Disc(RADIUS_M));
        robots.extend(second.map(|at| Robot { body, ..self.second_robot(at) }));
        let world = World::new(self.scene()?, robots, Noise::default())?;
        world.with_max_order(ORDER)?.with_pole_order(POLE_ORDER).map(|world| world.with_seed(self.number))
    }
}

/// Largest number of bounces of sound, at walls alone, and with a pole among them.
const ORDER: u32 = 2;
const POLE_ORDER: u32 = 1;

/// Draws a triangular lattice in the middle of the lab, shifts it as a whole, and moves each pole a little.
fn shaken(random: &mut Random) -> Vec<Point> {
    let column_m = SPACING_M * 0.75f64.sqrt();
    let aside = random.between(-0.5 * SPACING_M, 0.5 * SPACING_M);
    let mut poles = Vec::new();
    for column in 0..4 {
        let shift = aside + if column % 2 == 0 { 0.0 } else { 0.5 * SPACING_M };
        for row in -3..=3 {
            let shake = [random.between(-SHAKE_M, SHAKE_M), random.between(-SHAKE_M, SHAKE_M)];
            let x = 2.8 + column_m * f64::from(column) + shake[0];
            let y = 0.5 * ROOM_M[1] + shift + SPACING_M * f64::from(row) + shake[1];
            if (0.3..ROOM_M[1] - 0.3).contains(&y) {
                poles.push(Point::new(x, y));
            }
        }
    }
    poles
}

#[cfg(test)]
mod tests {
    use super::*;

    // Every random course has room for both robots, and poles about 1.6 m apart.
    #[test]
    fn random_course_has_room_for_both_robots() {
        for number in 0..200 {
            let course = Course::random(number);
            assert!(course.world(course.robot(), Some(SECOND_BEHIND)).is_ok(), "{number}");
            let nearest = |pole: &Point| {
                let others = course.poles.iter().filter(|other| *other != pole).map(|other| (other - pole).norm());
                others.fold(f64::INFINITY, f64::min)
            };
            let mean = course.poles.iter().map(nearest).sum::<f64>() / course.poles.len() as f64;
            assert!(course.gap_m() >= LEAST_GAP_M && (1.4..1.75).contains(&mean), "{number}: {mean}");
        }
    }

    // A platform with a body has its sensors on its edge, with unchanged headings.
    #[test]
    fn platform_with_body_has_sensors_on_its_edge() {
        let (course, labmate) = (Course::random(0), LabMate::default());
        let (round, square) = (course.robot(), course.robot_with_body(&labmate));
        assert_eq!(square.body, Some(Body::Box(0.75, 0.75)));
        for (before, sensor) in round.sensors.iter().zip(&square.sensors) {
            assert!((sensor.rotation.angle() - before.rotation.angle()).abs() < 1e-12);
            let [x, y] = [sensor.translation.x, sensor.translation.y];
            assert!((x.abs().max(y.abs()) - 0.375).abs() < 1e-12, "{x} {y}");
            assert!((libm::atan2(y, x) - sensor.rotation.angle()).abs() < 1e-12);
        }
        let world = course.world(square, Some(SECOND_AHEAD)).unwrap();
        assert_eq!(world.robots()[1].body, Some(Body::Disc(RADIUS_M)));
        assert_eq!(course.world(round, Some(SECOND_AHEAD)).unwrap().robots()[1].body, None);
    }

    #[test]
    fn a_course_closed_by_a_row_of_poles_is_not_passable() {
        let poles = (0..6).map(|k| Point::new(5.0, 0.5 + f64::from(k))).collect();
        assert!(!Course { number: 0, poles }.is_passable());
        assert!(Course { number: 0, poles: vec![] }.is_passable());
    }
}
