//! Two to six robots of one make, not configured to avoid each other: standing, facing each other, and driving.

use eeruf_core::Micros;
use eeruf_sim::experiments::set_three::{Arrangement, Placing};
use eeruf_sim::{
    Clock, DEFAULT_TOLERANCE_US, Entry, Motion, NO_PATH, Noise, Options, Physics, Pose, Readings, Robot, Room, Stop,
    Vector, World, sweep,
};

use super::{Asked, Cell, Table, usual};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// The simulated time, in seconds.
const SECONDS: f64 = 8.0;

/// Robots of one make near each other.
#[derive(Clone, Copy)]
struct Together {
    name: &'static str,
    robots: usize,
    faces: bool,
    speed_m_s: f64,
}

const STANDING: Together = Together { name: "2 robots", robots: 2, faces: false, speed_m_s: 0.0 };
const CONDITIONS: [Together; 9] = [
    STANDING,
    Together { name: "2 robots that face", faces: true, ..STANDING },
    Together { name: "3 robots", robots: 3, ..STANDING },
    Together { name: "4 robots", robots: 4, ..STANDING },
    Together { name: "6 robots", robots: 6, ..STANDING },
    Together { name: "2 robots, 0.5 m/s", speed_m_s: 0.5, ..STANDING },
    Together { name: "2 robots, 1 m/s", speed_m_s: 1.0, ..STANDING },
    Together { name: "6 robots, 0.5 m/s", robots: 6, speed_m_s: 0.5, ..STANDING },
    Together { name: "6 robots, 1 m/s", robots: 6, speed_m_s: 1.0, ..STANDING },
];

impl Together {
    /// Puts robots of this make at the positions of a placing of Set III.
    fn place(self, robot: &Robot, placing: &Placing) -> Vec<Robot> {
        let places: Vec<Vector> = placing.robots.iter().map(|of| of.pose.translation.vector).collect();
        let with = |(k, of): (usize, &Robot)| {
            let Robot { pose, clock: Clock { offset_us, drift_ppm }, start, .. } = of.clone();
            let ahead = Vector::new(pose.rotation.re, pose.rotation.im);
            let velocity = self.speed_m_s * ahead;
            // The axis of its first sensor points at the next robot.
            let to = places[(k + 1) % places.len()] - places[k];
            let own = robot.sensors.first().map_or(0.0, |sensor| sensor.rotation.angle());
            let facing = Pose::new(places[k], to.y.atan2(to.x) - own);
            let start = Micros::new(start.as_micros() % robot.period.as_micros());
            Robot {
                pose: if self.faces { facing } else { pose },
                start,
                clock: Clock { offset_us, drift_ppm },
                motion: if self.speed_m_s > 0.0 {
                    Motion::Constant { velocity, turn_rad_s: 0.0 }
                } else {
                    Motion::Still
                },
                others: true,
                ..robot.clone()
            }
        };
        placing.robots.iter().enumerate().map(with).collect()
    }
}

fn read(placing: &Placing, robots: Vec<Robot>, number: u64, entry: &Entry) -> Result<Readings, Error> {
    let periods = 1e6 * SECONDS / f64::from(robots[0].period.as_micros());
    let world = World::new(placing.scene()?.with_room(Some(Room::DEFAULT))?, robots, Noise::default())?;
    let world = world.with_physics(Physics::DEFAULT)?.with_seed(number);
    Ok(entry.simulate(&world, &Options::periods(periods.ceil() as u32), &Stop::default(), |_| true)?)
}

/// Counts the readings that a robot accepts: right echoes, others' sound, and all.
fn echoes(readings: &Readings, robot: u16) -> [f64; 3] {
    let mut counts = [0.0; 3];
    for k in (0..readings.len()).filter(|&k| readings.robot[k] == robot) {
        if readings.is_accepted(k) {
            let path = Some(readings.path[k]).filter(|&path| path != NO_PATH);
            let emitter = path.and_then(|path| readings.paths.get(path as usize)).map(|path| path.emitter.robot);
            let right = !readings.t_echo_us[k].is_nan() && !readings.is_wrong(k, DEFAULT_TOLERANCE_US);
            counts[0] += f64::from(right);
            counts[1] += f64::from(emitter.is_some_and(|emitter| emitter != robot));
            counts[2] += 1.0;
        }
    }
    counts
}

/// Returns the share of others' sound among accepted readings, and the share of right echoes that each robot keeps.
fn run(of: Together, robot: &Robot, number: u64, entry: &Entry) -> Result<(f64, Vec<f64>), Error> {
    let placing = Placing::random(number);
    let robots = of.place(robot, &placing);
    let readings = read(&placing, robots.clone(), number, entry)?;
    let each: Vec<_> = (0..robots.len()).map(|robot| echoes(&readings, robot as u16)).collect();
    let sum = |of: usize| each.iter().map(|counts| counts[of]).sum::<f64>();
    let mut kept = vec![];
    for (robot, counts) in robots.into_iter().zip(&each) {
        let [alone, ..] = echoes(&read(&placing, vec![robot], number, entry)?, 0);
        kept.extend((alone > 0.0).then(|| 100.0 * counts[0] / alone));
    }
    Ok((100.0 * sum(1) / sum(2).max(1.0), kept))
}

pub(super) fn table(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let robot = asked.robot()?;
    let mut table = Table::new(
        "robots",
        1,
        &["others of accepted %, mean", "median", "90 % place", "right echoes kept %, median", "10 % place"],
    );
    for condition in CONDITIONS {
        let fits = |number: &u64| {
            let Placing { arrangement, robots, .. } = Placing::random(*number);
            (arrangement == Arrangement::Standing) == (condition.speed_m_s == 0.0) && robots.len() == condition.robots
        };
        let numbers: Vec<u64> = (asked.first..).filter(fits).take(asked.count as usize).collect();
        for entry in usual() {
            let runs = sweep(&numbers, |&number| run(condition, &robot, number, &entry));
            let runs = runs.into_iter().collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
            let others = || runs.iter().map(|run| run.0);
            let kept = || runs.iter().flat_map(|run| run.1.iter().copied());
            let cells = vec![
                Cell::mean(others()),
                Cell::median(others()),
                Cell::p90(others()),
                Cell::median(kept()),
                Cell::p10(kept()),
            ];
            table.row(condition.name, entry.name(), cells);
        }
    }
    Ok(table)
}
