//! Simulated readings per second on one core, in a static world with known paths, in a moving one, and in Set I with
//! all of its work; and the speed of the courses of Set II relative to real time.

use eeruf_benches::time;
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::experiments::set_two::{self as driven, SECOND_BEHIND, SetTwoOptions};
use eeruf_sim::{Method, Motion, Options, Physics, Robot, Vector, World, simulate};

/// Number of periods, large enough that finding the paths once is negligible.
const LONG: u32 = 20_000;

/// The default physics, then the presets that earlier versions have too.
const PHYSICS: [(&str, Physics); 2] = [("default", Physics::DEFAULT), ("plain", Physics::PLAIN)];

fn under(physics: Physics, world: Result<World, eeruf_sim::WorldError>) -> World {
    world.and_then(|world| world.with_physics(physics)).expect("the robot stands in free space")
}

fn still() {
    for (name, physics) in PHYSICS {
        let world = under(physics, Alcove::random(1).world());
        for method in [Method::Conventional, Method::Eeruf, Method::Adaptive, Method::MultiEcho] {
            let options = Options::periods(LONG);
            let readings = simulate(&world, method, &options).expect("Set I fits every method").len();
            time(&format!("still, {method}, {name}"), readings, || simulate(&world, method, &options));
        }
    }
}

fn set_one() {
    for (name, physics) in PHYSICS {
        time(&format!("set one, 8000 readings with paths, {name}"), 8000, || {
            let world = under(physics, Alcove::random(1).world());
            simulate(&world, Method::Eeruf, &Options::periods(1000))
        });
    }
}

fn moving() {
    let alcove = Alcove::random(1);
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    let robot = Robot { motion, ..alcove.robot() };
    for (name, physics) in PHYSICS {
        let scene = alcove.scene().expect("every random alcove has walls");
        let world = under(physics, World::new(scene, vec![robot.clone()], eeruf_sim::Noise::default()));
        time(&format!("moving, {name}"), 800, || simulate(&world, Method::Eeruf, &Options::periods(100)));
    }
}

/// Drives robots through courses. Elements are simulated milliseconds, so thousands per second mean times real time.
fn set_two() {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    let rooms = [("alone", None), ("beside a second robot", Some(SECOND_BEHIND))];
    for ((name, physics), (title, second_robot)) in PHYSICS.into_iter().flat_map(|of| rooms.map(|room| (of, room))) {
        for method in [Method::Sequential, Method::Conventional, Method::Eeruf, Method::MultiEcho] {
            let methods = vec![method.into()];
            let options = SetTwoOptions { seeds: 5, methods, second_robot, physics, ..SetTwoOptions::default() };
            let drive = || one_core.install(|| driven::set_two(&options, &|_| true).expect("the courses have room"));
            let simulated_s: f64 = drive().runs.iter().flatten().map(|run| run.time_s).sum();
            time(&format!("set two {title}, {method}, {name}, simulated ms"), (simulated_s * 1e3) as usize, drive);
        }
    }
}

fn main() {
    still();
    set_one();
    moving();
    set_two();
}
