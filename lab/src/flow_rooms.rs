//! Flow beside one-by-one firing in rooms, standing and driving: shares of the time in which what is
//! believed is right, and of the time in which it is foreign sound; and of readings, those that were crosstalk.
//!
//! `cargo lab flow-rooms [ROOMS [FIRST [PHYSICS]]]`

use std::f64::consts::PI;

use eeruf_sim::experiments::{Spread, set_one::Alcove};
use eeruf_sim::*;

/// Half a minute of periods of 60 ms.
const PERIODS: u32 = 500;

/// A room with a robot in it, drawn by its number.
type Draw = fn(&mut Random) -> Result<(Scene, Pose), SceneError>;

struct Kind {
    name: &'static str,
    sensors: usize,
    speed_m_s: f64,
    draw: Draw,
}

const KINDS: [Kind; 9] = [
    Kind { name: "alcove", sensors: 8, speed_m_s: 0.0, draw: alcove },
    Kind { name: "alcove, 12 sensors", sensors: 12, speed_m_s: 0.0, draw: alcove },
    Kind { name: "corridor", sensors: 8, speed_m_s: 0.0, draw: corridor },
    Kind { name: "corner", sensors: 8, speed_m_s: 0.0, draw: corner },
    Kind { name: "clutter", sensors: 8, speed_m_s: 0.0, draw: clutter },
    Kind { name: "hall", sensors: 8, speed_m_s: 0.0, draw: hall },
    Kind { name: "corridor, 0.2 m/s", sensors: 8, speed_m_s: 0.2, draw: along_a_corridor },
    Kind { name: "corridor, 0.5 m/s", sensors: 8, speed_m_s: 0.5, draw: along_a_corridor },
    Kind { name: "corridor, 1 m/s", sensors: 8, speed_m_s: 1.0, draw: along_a_corridor },
];

fn alcove(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let alcove = Alcove::random(random.bits());
    Ok((alcove.scene()?, alcove.robot().pose))
}

fn scene(walls: Vec<Wall>, poles: Vec<Pole>, at: [f64; 2], heading: f64) -> Result<(Scene, Pose), SceneError> {
    Ok((Scene::new(walls, poles, Air::default())?, Pose::new(Vector::new(at[0], at[1]), heading)))
}

fn box_of(low: [f64; 2], high: [f64; 2]) -> Vec<Wall> {
    let ([left, bottom], [right, top]) = (low, high);
    Wall::polyline(&[[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]]).collect()
}

/// Two walls 1.4 to 2.6 m apart.
fn corridor(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let heading = random.between(0.0, 2.0 * PI);
    corridor_to(random, heading)
}

fn along_a_corridor(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let heading = random.between(-0.01, 0.01);
    corridor_to(random, heading)
}

fn corridor_to(random: &mut Random, heading: f64) -> Result<(Scene, Pose), SceneError> {
    let width = random.between(1.4, 2.6);
    let walls = vec![Wall::new(-20.0, 0.0, 50.0, 0.0), Wall::new(-20.0, width, 50.0, width)];
    scene(walls, vec![], [0.0, random.between(0.5, width - 0.5)], heading)
}

/// Two walls at right angles, the robot heading into the corner.
fn corner(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let walls = vec![Wall::new(0.0, 0.0, 12.0, 0.0), Wall::new(0.0, 0.0, 0.0, 12.0)];
    let at = [random.between(0.5, 2.0), random.between(0.5, 2.0)];
    scene(walls, vec![], at, PI + random.between(0.2, 1.37))
}

/// Ten poles around the robot, in a room of 8 m by 8 m.
fn clutter(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let poles = (0..10).map(|_| {
        let (far, towards) = (random.between(0.8, 3.0), random.between(0.0, 2.0 * PI));
        let at = Pose::rotation(towards) * Point::new(far, 0.0);
        Pole::new(at.x, at.y, random.between(0.03, 0.2))
    });
    let poles = poles.collect();
    scene(box_of([-4.0, -4.0], [4.0, 4.0]), poles, [0.0, 0.0], random.between(0.0, 2.0 * PI))
}

/// 10 m by 8 m, empty.
fn hall(random: &mut Random) -> Result<(Scene, Pose), SceneError> {
    let at = [random.between(1.0, 9.0), random.between(1.0, 7.0)];
    scene(box_of([0.0, 0.0], [10.0, 8.0]), vec![], at, random.between(0.0, 2.0 * PI))
}

/// The belief of one method in one room.
fn run(
    kind: &Kind,
    number: u64,
    physics: Physics,
    method: Method,
) -> Result<(Belief, f64), Box<dyn std::error::Error + Send + Sync>> {
    let mut random = Random::new(number);
    let (scene, pose) = (kind.draw)(&mut random)?;
    let ring = Robot::ring(pose, kind.sensors, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    let ahead = pose * Point::new(40.0, 0.0);
    let motion = match kind.speed_m_s {
        0.0 => Motion::Still,
        speed_m_s => Motion::Waypoints { points: vec![ahead], speed_m_s },
    };
    let robot = Robot { odometry: true, motion, ..ring };
    let world = World::new(scene, vec![robot], Noise::default())?.with_physics(physics)?.with_seed(number);
    let summary = simulate(&world, method, &Options::periods(PERIODS))?.summary();
    Ok((summary.belief, summary.crosstalk_of_all))
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (rooms, first) = (number(200)?, number(20_000)?);
    let physics = arguments.next().map_or(Ok(Physics::PLAIN), |name| name.parse::<Physics>())?;
    let numbers: Vec<u64> = (first..first + rooms).collect();
    let methods = [
        ("sequential", Method::Sequential),
        ("two votes", Method::SequentialVotes),
        ("flow", Method::Flow),
        ("flow, several echoes", Method::FlowMultiEcho),
    ];
    println!("{rooms} of each from {first} on, {physics}: % right (95 % interval), foreign.\n");
    let head =
        format!("| room | {} |\n|---|{}", methods.map(|(name, _)| name).join(" | "), "---:|".repeat(methods.len()));
    println!("{head}");
    let mut crosstalk =
        format!("Readings that were believed and crosstalk, % in the room at the 90th percentile.\n\n{head}\n");
    for kind in &KINDS {
        let mut cells = Vec::new();
        crosstalk += &format!("| {} |", kind.name);
        for (_, method) in methods {
            let runs = sweep(&numbers, |&number| run(kind, number, physics, method));
            let runs = runs.into_iter().collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
            let percent = |of: fn(&Belief) -> f64| Spread::of(runs.iter().map(|(belief, _)| 100.0 * of(belief)));
            let (Some(right), Some(foreign)) = (percent(|of| of.right), percent(|of| of.phantom)) else { continue };
            let [low, high] = right.mean_95;
            cells.push(format!("{:.1} ({low:.1}-{high:.1}), {:.2}", right.mean, foreign.mean));
            let of_readings = Spread::of(runs.iter().map(|(_, crosstalk)| 100.0 * crosstalk));
            crosstalk += &of_readings.map_or_else(String::new, |spread| format!(" {:.2} |", spread.p90));
        }
        crosstalk += "\n";
        println!("| {} | {} |", kind.name, cells.join(" | "));
    }
    println!("\n{crosstalk}");
    Ok(())
}
