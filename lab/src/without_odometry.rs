//! Robots that drive without odometry: what the paper's filter and the filter with a rate make of the same readings.
//!
//! `cargo lab without-odometry [ROOMS [FIRST [PHYSICS [SENSORS [PERIOD_MS]]]]]`

use core::f64::consts::TAU;

use eeruf_core::{EchoFilter, Instant, Micros, ReadingKind, judge::RateFilter};
use eeruf_sim::experiments::Spread;
use eeruf_sim::{
    Air, DEFAULT_TOLERANCE_US, Method, Motion, Noise, Options, Physics, Point, Pole, Pose, Random, Readings, Robot,
    Scene, Transducer, Wall, World, simulate, sweep,
};

/// Number of periods of each robot.
const PERIODS: u32 = 300;
const SPEEDS_M_S: [f64; 4] = [0.0, 0.5, 1.0, 2.0];
const SPEED_OF_SOUND: f64 = 343.2;

/// A room of 6 to 10 by 4 to 6 m with six table legs, and a robot that drives round four places in it, at least 0.8 m
/// from the walls and 0.5 m from the legs, turning on the spot.
fn world(number: u64, speed_m_s: f64, sensors: usize, period: Micros, physics: Physics) -> Result<World, String> {
    let mut random = Random::new(number);
    let (length, width) = (random.between(6.0, 10.0), random.between(4.0, 6.0));
    let places = [(); 4].map(|()| Point::new(random.between(0.8, length - 0.8), random.between(0.8, width - 0.8)));
    let mut poles = Vec::new();
    while poles.len() < 6 {
        let leg = Point::new(random.between(0.3, length - 0.3), random.between(0.3, width - 0.3));
        let ways = (0..4).map(|from| (places[from], places[(from + 1) % 4]));
        if ways.into_iter().all(|(from, to)| distance(&leg, &from, &to) > 0.5) {
            poles.push(Pole::new(leg.x, leg.y, 0.02));
        }
    }
    let corners = [[0.0, 0.0], [length, 0.0], [length, width], [0.0, width], [0.0, 0.0]];
    let scene = Scene::new(Wall::polyline(&corners).collect(), poles, Air::default());
    let heading = random.between(0.0, TAU);
    let points = (1..100).map(|place| places[place % 4]).collect();
    let motion = if speed_m_s > 0.0 { Motion::Waypoints { points, speed_m_s } } else { Motion::Still };
    let pose = Pose::new(places[0].coords, heading);
    let ring = Robot::ring(pose, sensors, 15_f64.to_radians(), 0.30, Transducer::POLAROID_6500);
    let robot = Robot { motion, period, odometry: false, ..ring };
    let scene = scene.map_err(|error| error.to_string())?;
    let world = World::new(scene, vec![robot], Noise::default());
    world.and_then(|world| world.with_physics(physics)).map_err(|error| format!("room {number}: {error}"))
}

/// From a point to the way from one place to another.
fn distance(point: &Point, from: &Point, to: &Point) -> f64 {
    let way = to - from;
    let along = ((point - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (point - (from + way * along)).norm()
}

/// Shares of one robot's readings.
#[derive(Clone, Copy)]
struct Figures {
    wrong_of_all: f64,
    wrong_of_believed: f64,
    good_lost: f64,
    believed: f64,
}

/// Figures of a filter over all readings: `push` says whether it believes one.
fn figures(readings: &Readings, mut push: impl FnMut(u8, Instant, Option<Micros>) -> ReadingKind) -> Figures {
    let (mut believed, mut wrong, mut good, mut lost) = (0_u32, 0_u32, 0_u32, 0_u32);
    for k in 0..readings.len() {
        let echo = readings.earliest_us[k];
        let t_echo = (!echo.is_nan()).then(|| Micros::new(echo as u32));
        let fired = Instant::from_micros((1e6 * readings.fired_s[k]).round() as u32);
        let kind = push(readings.sensor[k], fired, t_echo);
        let believes = matches!(kind, ReadingKind::Accepted | ReadingKind::Clear);
        let is_good = readings.is_good(k, DEFAULT_TOLERANCE_US);
        believed += u32::from(believes);
        wrong += u32::from(believes && !is_good);
        good += u32::from(is_good);
        lost += u32::from(is_good && !believes);
    }
    let share = |of: u32, all: u32| f64::from(of) / f64::from(all.max(1));
    let all = readings.len() as u32;
    Figures {
        wrong_of_all: share(wrong, all),
        wrong_of_believed: share(wrong, believed),
        good_lost: share(lost, good),
        believed: share(believed, all),
    }
}

/// The filters: the paper's and the one with a rate, each with this `T_delta`.
const FILTERS: [(&str, u32, bool); 5] = [
    ("two agree", 500, false),
    ("two agree", 1000, false),
    ("with a rate", 500, true),
    ("with a rate", 250, true),
    ("three agree", 500, false),
];

fn all_figures(readings: &Readings, speed_m_s: f64) -> Result<Vec<Figures>, String> {
    // A little more than the robot drives.
    let us_per_s = (2e6 * (1.1 * speed_m_s + 0.1) / SPEED_OF_SOUND).round() as u32;
    let mut found = Vec::new();
    for (name, t_delta_us, with_rate) in FILTERS {
        let t_delta = Micros::new(t_delta_us);
        found.push(if with_rate {
            let mut filter = RateFilter::<64>::new(t_delta, us_per_s).map_err(|error| error.to_string())?;
            let mut push = |sensor, fired, t_echo| filter.push(sensor, fired, t_echo).map(|verdict| verdict.kind);
            figures(readings, |sensor, fired, t_echo| push(sensor, fired, t_echo).unwrap_or(ReadingKind::Stuck))
        } else {
            let consecutive = if name == "three agree" { 3 } else { 2 };
            let mut filter = EchoFilter::<64>::new(t_delta, consecutive).map_err(|error| error.to_string())?;
            let mut push = |sensor, t_echo| filter.push(sensor, t_echo).map(|verdict| verdict.kind);
            figures(readings, |sensor, _, t_echo| push(sensor, t_echo).unwrap_or(ReadingKind::Stuck))
        });
    }
    Ok(found)
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (rooms, first) = (number(100)?, number(20_000)?);
    let physics = arguments.next().map_or(Ok(Physics::DEFAULT), |name| name.parse::<Physics>())?;
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u32>());
    let (sensors, period) = (number(8)? as usize, Micros::from_millis(number(60)?));
    println!(
        "{rooms} rooms from {first} on, {sensors} sensors, {PERIODS} periods of {period}: median (95 % interval), \
         90 %.\n"
    );
    println!("| m/s | filter | T_delta us | wrong, % of all | wrong, % of believed | good lost % | believed % |");
    println!("|---:|---|---:|---|---|---|---|");
    for speed_m_s in SPEEDS_M_S {
        let rooms: Vec<u64> = (first..first + rooms).collect();
        let found = sweep(&rooms, |&room| {
            let world = world(room, speed_m_s, sensors, period, physics)?;
            let options = Options { seed: Some(room), ..Options::periods(PERIODS) };
            let readings = simulate(&world, Method::Eeruf, &options).map_err(|error| error.to_string())?;
            all_figures(&readings, speed_m_s)
        });
        let found: Vec<Vec<Figures>> = found.into_iter().collect::<Result<_, String>>()?;
        for (place, (name, t_delta_us, _)) in FILTERS.iter().enumerate() {
            let column = |of: fn(&Figures) -> f64| spread(found.iter().map(|figures| of(&figures[place])));
            println!(
                "| {speed_m_s} | {name} | {t_delta_us} | {} | {} | {} | {} |",
                column(|figures| figures.wrong_of_all),
                column(|figures| figures.wrong_of_believed),
                column(|figures| figures.good_lost),
                column(|figures| figures.believed),
            );
        }
    }
    Ok(())
}

fn spread(values: impl Iterator<Item = f64>) -> String {
    Spread::of(values.map(|value| 100.0 * value)).map_or_else(String::new, |spread| {
        let [low, high] = spread.median_95;
        format!("{:.1} ({low:.1}-{high:.1}), {:.1}", spread.median, spread.p90)
    })
}
