//! Robots that swing before the alcoves of Set I: to and fro by 0.15 m at 0.5 m/s along their heading, while they turn
//! by 10 degrees to either side at 20 degrees/s. Beside what each method loses stands what is lost to whoever wants two
//! readings that agree since the echo came to be from where it is, though it knew whose each is and how it moves.
//!
//! `cargo lab swinging [ALCOVES [FIRST [PHYSICS [SPEED [TURN]]]]]`, with
//! speeds in m/s and degrees/s.

use std::sync::Arc;

use eeruf_sim::experiments::{Spread, set_one::Alcove};
use eeruf_sim::{DEFAULT_TOLERANCE_US, Method, Noise, Options, Physics, Robot, Simulation, Stop, World, sweep};

/// Steps of a tenth of a second, half a minute of them.
const STEPS: usize = 300;
const STEP_S: f64 = 0.1;
/// Number of steps from the middle to an end: 0.15 m, and 10 degrees.
const STEPS_TO_END: usize = 3;
const STEPS_OF_TURN: usize = 5;

/// Surroundings in which the robots swing, and their speed.
#[derive(Clone, Copy)]
struct Around {
    physics: Physics,
    speed_m_s: f64,
    turn_deg_s: f64,
}

/// Forth to one end, back to the other, and to the middle again.
fn direction(step: usize, to_end: usize) -> f64 {
    if (to_end..3 * to_end).contains(&(step % (4 * to_end))) { -1.0 } else { 1.0 }
}

/// From one firing to the next the sensor's own echo moves by less, unless it comes from somewhere else: 0.5 m/s for
/// three periods, as long as quiet may keep it from firing, is 0.5 ms.
const ELSEWHERE_US: f64 = 600.0;

/// A sensor's own echo at its last firing, and whether it was heard since it came from there.
#[derive(Clone, Copy)]
struct Own {
    t_echo_us: f64,
    heard: bool,
}

impl Own {
    const NONE: Self = Self { t_echo_us: f64::NAN, heard: false };

    /// Takes in a firing, heard rightly or not; whether it is the first that heard the echo from where it comes now.
    fn is_first(&mut self, t_echo_us: f64, good: bool) -> bool {
        let stays = match (self.t_echo_us.is_nan(), t_echo_us.is_nan()) {
            (false, false) => (self.t_echo_us - t_echo_us).abs() <= ELSEWHERE_US,
            (before, now) => before && now,
        };
        let heard = stays && self.heard;
        *self = Self { t_echo_us, heard: heard || good };
        good && !heard
    }
}

/// Shares of all readings that were believed and wrong; of the good ones, those not believed, and those that were the
/// first since the sensor's own echo came from where it did. Nothing if a sensor would swing into a wall.
fn swing(number: u64, world: Around, method: Method) -> Option<[f64; 3]> {
    let Around { physics, speed_m_s, turn_deg_s } = world;
    let alcove = Alcove::random(number);
    let robot = Robot { odometry: true, ..alcove.robot() };
    let mut own = vec![Own::NONE; robot.sensors.len()];
    let world = World::new(alcove.scene().ok()?, vec![robot], Noise::default()).ok()?.with_physics(physics).ok()?;
    let options = Options { seed: Some(number), ..Options::default() };
    let mut simulation = Simulation::new(Arc::new(world), method, &options, Stop::default()).ok()?;
    let (mut readings, mut wrong, mut good, mut lost, mut first) = (0, 0, 0, 0, 0);
    for step in 0..STEPS {
        let speed = speed_m_s * direction(step, STEPS_TO_END);
        let turn = turn_deg_s.to_radians() * direction(step, STEPS_OF_TURN);
        simulation.set_velocity(0, speed, turn).ok()?;
        let seen = simulation.step(STEP_S, |_| true).ok()?;
        readings += seen.len();
        for reading in 0..seen.len() {
            let believed = seen.is_accepted(reading);
            let is_good = seen.is_good(reading, DEFAULT_TOLERANCE_US);
            wrong += usize::from(believed && seen.is_wrong(reading, DEFAULT_TOLERANCE_US));
            good += usize::from(is_good);
            lost += usize::from(is_good && !believed);
            let own = &mut own[usize::from(seen.sensor[reading])];
            first += usize::from(own.is_first(seen.reference_us[reading], is_good));
        }
    }
    let share = |part: usize, all: usize| part as f64 / all.max(1) as f64;
    Some([share(wrong, readings), share(lost, good), share(first, good)])
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let mut arguments = arguments.iter();
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (alcoves, first) = (number(200)?, number(20_000)?);
    let physics = arguments.next().map_or(Ok(Physics::DEFAULT), |name| name.parse::<Physics>())?;
    let mut speed = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<f64>());
    let world = Around { physics, speed_m_s: speed(0.5)?, turn_deg_s: speed(20.0)? };
    let numbers: Vec<u64> = (first..first + alcoves).collect();
    println!("{alcoves} alcoves from {first} on: median (95 % interval), 90 %.\n");
    println!(
        "| method | alcoves | wrong, % of all | good lost % | first of their place, % of good |\n|---|---:|---|---|---|"
    );
    for (name, method) in [("eeruf", Method::Eeruf), ("flow", Method::Flow), ("flow_multi_echo", Method::FlowMultiEcho)]
    {
        let found = sweep(&numbers, |&number| swing(number, world, method));
        let found: Vec<[f64; 3]> = found.into_iter().flatten().collect();
        let column = |of: usize| {
            Spread::of(found.iter().map(|figures| 100.0 * figures[of])).map_or_else(String::new, |spread| {
                let [low, high] = spread.median_95;
                format!("{:.1} ({low:.1}-{high:.1}), {:.1}", spread.median, spread.p90)
            })
        };
        println!("| {name} | {} | {} | {} | {} |", found.len(), column(0), column(1), column(2));
    }
    Ok(())
}
