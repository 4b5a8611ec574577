//! Cost of each effect of the physics: Set I's first alcove with a robot that stands, and with one that moves.
//!
//! `cargo lab time-physics [EFFECT stands|moves]`: with both, one run of that
//! alone, for counting instructions.

use std::time::Instant;

use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

/// One effect alone, all, and all but one.
const EFFECTS: [(&str, Physics); 8] = [
    ("plain", Physics::PLAIN),
    ("shadows", Physics { shadows: true, ..Physics::PLAIN }),
    ("edges", Physics { edges: true, ..Physics::PLAIN }),
    ("narrow_panels", Physics { narrow_panels: true, ..Physics::PLAIN }),
    ("range_walk", Physics { range_walk: true, ..Physics::PLAIN }),
    ("fading_time_s", Physics { fading_time_s: 1.0, ..Physics::PLAIN }),
    ("without_panels", Physics { narrow_panels: false, ..Physics::DEFAULT }),
    ("default", Physics::DEFAULT),
];

/// The robot's motion by its name, and how many periods are run.
fn motions() -> [(&'static str, Motion, u32); 2] {
    let creeping = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    [("stands", Motion::Still, 2000), ("moves", creeping, 50)]
}

fn run(world: &World, periods: u32) {
    simulate(world, Method::Eeruf, &Options::periods(periods)).expect("the scene is large enough");
}

/// The quickest of several runs, in milliseconds.
fn quickest_ms(world: &World, periods: u32) -> f64 {
    let runs = (0..15).map(|_| {
        let before = Instant::now();
        run(world, periods);
        before.elapsed().as_secs_f64() * 1e3
    });
    runs.fold(f64::INFINITY, f64::min)
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let alcove = Alcove::random(1);
    let pole = Pole::new(0.2, 1.0, 0.004);
    let walls = alcove.scene()?.walls().to_vec();
    let world = |motion: &Motion, physics: Physics| {
        let scene = Scene::new(walls.clone(), vec![pole], Air::default())?;
        let robot = Robot { motion: motion.clone(), ..alcove.robot() };
        World::new(scene, vec![robot], Noise::default())?.with_max_order(3)?.with_physics(physics)
    };
    if let [effect, motion] = arguments {
        let (_, physics) = EFFECTS.iter().find(|(name, _)| name == effect).ok_or("no such effect")?;
        let motions = motions();
        let (_, motion, periods) =
            motions.iter().find(|(name, ..)| name == motion).ok_or("expected stands or moves")?;
        run(&world(motion, *physics)?, *periods);
        return Ok(());
    }
    println!("{:14} {:>14} {:>14}", "", "stands, ms", "moves, ms");
    for (name, physics) in EFFECTS {
        let [stands, moves] = motions().map(|(_, motion, periods)| (world(&motion, physics), periods));
        let [stands, moves] = [quickest_ms(&stands.0?, stands.1), quickest_ms(&moves.0?, moves.1)];
        println!("{name:14} {stands:14.2} {moves:14.2}");
    }
    Ok(())
}
