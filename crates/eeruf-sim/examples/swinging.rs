//! Robots that swing before the alcoves of Set I: to and fro by 0.15 m at 0.5 m/s along their heading, while they turn
//! by 10 degrees to either side at 20 degrees/s.
//!
//! `cargo run --release -p eeruf-sim --example swinging -- [ALCOVES [FIRST [PHYSICS]]]`

use std::sync::Arc;

use eeruf_core::HoppingSettings;
use eeruf_sim::experiments::{Spread, set_one::Alcove};
use eeruf_sim::{Method, Noise, Options, Physics, Robot, Simulation, Stop, World, sweep};

/// Steps of a tenth of a second, half a minute of them.
const STEPS: usize = 300;
const STEP_S: f64 = 0.1;
const SPEED_M_S: f64 = 0.5;
const TURN_DEG_S: f64 = 20.0;
/// So many steps from the middle to an end: 0.15 m, and 10 degrees.
const STEPS_TO_END: usize = 3;
const STEPS_OF_TURN: usize = 5;

/// Forth to one end, back to the other, and to the middle again.
fn direction(step: usize, to_end: usize) -> f64 {
    if (to_end..3 * to_end).contains(&(step % (4 * to_end))) { -1.0 } else { 1.0 }
}

/// Shares of all readings that were believed and wrong, and of the good ones that were not believed; nothing if a
/// sensor would swing into a wall.
fn swing(alcove: &Alcove, number: u64, physics: Physics, method: Method, hopping: HoppingSettings) -> Option<[f64; 2]> {
    let robot = Robot { odometry: true, ..alcove.robot() };
    let world = World::new(alcove.scene().ok()?, vec![robot], Noise::default()).ok()?.with_physics(physics).ok()?;
    let options = Options { seed: Some(number), hopping, ..Options::default() };
    let mut simulation = Simulation::new(Arc::new(world), method, &options, Stop::default()).ok()?;
    let (mut readings, mut wrong, mut good, mut lost) = (0.0, 0.0, 0.0, 0.0);
    for step in 0..STEPS {
        let speed = SPEED_M_S * direction(step, STEPS_TO_END);
        let turn = TURN_DEG_S.to_radians() * direction(step, STEPS_OF_TURN);
        simulation.set_velocity(0, speed, turn).ok()?;
        let seen = simulation.step(STEP_S, |_| true).ok()?.summary();
        if seen.readings == 0 {
            continue;
        }
        let all = seen.readings as f64;
        let good_here = all * (1.0 - seen.wrong_before_filter);
        readings += all;
        wrong += all * seen.wrong_of_all;
        good += good_here;
        lost += good_here * seen.good_lost.unwrap_or(0.0);
    }
    Some([wrong / readings, lost / good])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default| arguments.next().map_or(Ok(default), |argument| argument.parse::<u64>());
    let (alcoves, first) = (number(200)?, number(20_000)?);
    let physics = arguments.next().map_or(Ok(Physics::DEFAULT), |name| name.parse::<Physics>())?;
    let numbers: Vec<u64> = (first..first + alcoves).collect();
    println!("{alcoves} alcoves from {first} on: median (95 % interval), 90 %.\n");
    println!("| method | alcoves | wrong, % of all | good lost % |\n|---|---:|---|---|");
    for (name, method, hopping) in [
        ("eeruf", Method::Eeruf, HoppingSettings::BALANCED),
        ("eeruf_hopping, balanced", Method::EerufHopping, HoppingSettings::BALANCED),
        ("eeruf_hopping, driving", Method::EerufHopping, HoppingSettings::DRIVING),
    ] {
        let found = sweep(&numbers, |&number| swing(&Alcove::random(number), number, physics, method, hopping));
        let found: Vec<[f64; 2]> = found.into_iter().flatten().collect();
        let column = |of: usize| {
            Spread::of(found.iter().map(|figures| 100.0 * figures[of])).map_or_else(String::new, |spread| {
                let [low, high] = spread.median_95;
                format!("{:.1} ({low:.1}-{high:.1}), {:.1}", spread.median, spread.p90)
            })
        };
        println!("| {name} | {} | {} | {} |", found.len(), column(0), column(1));
    }
    Ok(())
}
