//! What each effect of the physics costs: Set I's first alcove with a robot that stands, and with one that moves.
//!
//! `cargo run --release -p eeruf-sim --example time_physics`

use std::time::Instant;

use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

/// The quickest of several runs, in milliseconds.
fn quickest_ms(world: &World, periods: u32) -> f64 {
    let runs = (0..15).map(|_| {
        let before = Instant::now();
        simulate(world, Method::Eeruf, &Options::periods(periods)).expect("the scene is large enough");
        before.elapsed().as_secs_f64() * 1e3
    });
    runs.fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), WorldError> {
    let alcove = Alcove::random(1);
    let pole = Pole::new(0.2, 1.0, 0.004);
    let walls = alcove.scene()?.walls().to_vec();
    let world = |motion: Motion, physics: Physics| {
        let scene = Scene::new(walls.clone(), vec![pole], Air::default())?;
        let robot = Robot { motion, ..alcove.robot() };
        World::new(scene, vec![robot], Noise::default())?.with_max_order(3)?.with_physics(physics)
    };
    let creeping = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    println!("{:14} {:>14} {:>14}", "", "stands, ms", "moves, ms");
    for (name, physics) in [
        ("plain", Physics::PLAIN),
        ("shadows", Physics { shadows: true, ..Physics::PLAIN }),
        ("edges", Physics { edges: true, ..Physics::PLAIN }),
        ("narrow_panels", Physics { narrow_panels: true, ..Physics::PLAIN }),
        ("range_walk", Physics { range_walk: true, ..Physics::PLAIN }),
        ("fading_time_s", Physics { fading_time_s: 1.0, ..Physics::PLAIN }),
        ("default", Physics::DEFAULT),
        ("without panels", Physics { narrow_panels: false, ..Physics::DEFAULT }),
    ] {
        let stands = quickest_ms(&world(Motion::Still, physics)?, 2000);
        let moves = quickest_ms(&world(creeping.clone(), physics)?, 50);
        println!("{name:14} {stands:14.2} {moves:14.2}");
    }
    Ok(())
}
