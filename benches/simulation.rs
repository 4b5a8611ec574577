//! Number of readings a second that are simulated on one core: a static world with its paths known, one that moves, and
//! Set I with everything from the walls on; and how much faster than real time the courses of Set II are driven.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::experiments::set_two::{self as driven, SECOND_BEHIND, SetTwoOptions};
use eeruf_sim::{Method, Motion, Options, Physics, Robot, Vector, World, simulate};

/// Long enough that finding the paths once does not count.
const LONG: u32 = 20_000;

/// The default first, then the presets that earlier versions can be compared with.
const PHYSICS: [(&str, Physics); 2] = [("default", Physics::DEFAULT), ("plain", Physics::PLAIN)];

fn under(physics: Physics, world: Result<World, eeruf_sim::WorldError>) -> World {
    world.and_then(|world| world.with_physics(physics)).expect("the robot stands in free space")
}

fn still(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("still");
    group.sample_size(10);
    for (name, physics) in PHYSICS {
        let world = under(physics, Alcove::random(1).world());
        for method in [Method::Conventional, Method::Eeruf, Method::Adaptive, Method::MultiEcho] {
            let options = Options::periods(LONG);
            let readings = simulate(&world, method, &options).expect("Set I fits every method").len();
            group.throughput(Throughput::Elements(readings as u64));
            group.bench_function(format!("{method}, {name}"), |bencher| {
                bencher.iter(|| simulate(&world, method, &options));
            });
        }
    }
    group.finish();
}

fn set_one(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("set one, 8000 readings with paths");
    group.throughput(Throughput::Elements(8000));
    for (name, physics) in PHYSICS {
        group.bench_function(format!("eeruf, {name}"), |bencher| {
            bencher.iter(|| {
                let world = under(physics, Alcove::random(1).world());
                simulate(&world, Method::Eeruf, &Options::periods(1000))
            });
        });
    }
    group.finish();
}

fn moving(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("moving");
    group.sample_size(10);
    let alcove = Alcove::random(1);
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    let robot = Robot { motion, ..alcove.robot() };
    group.throughput(Throughput::Elements(800));
    for (name, physics) in PHYSICS {
        let scene = alcove.scene().expect("every random alcove has walls");
        let world = under(physics, World::new(scene, vec![robot.clone()], eeruf_sim::Noise::default()));
        group.bench_function(format!("eeruf, {name}"), |bencher| {
            bencher.iter(|| simulate(&world, Method::Eeruf, &Options::periods(100)));
        });
    }
    group.finish();
}

/// Robots driven through courses. Elements are simulated milliseconds, so that thousands a second are times real time.
fn set_two(criterion: &mut Criterion) {
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    let rooms = [("alone", None), ("beside a second robot", Some(SECOND_BEHIND))];
    for ((name, physics), (title, second_robot)) in PHYSICS.into_iter().flat_map(|of| rooms.map(|room| (of, room))) {
        let mut group = criterion.benchmark_group(format!("set two {title}, {name}, simulated ms"));
        group.sample_size(10);
        for method in [Method::Sequential, Method::Conventional, Method::Eeruf, Method::MultiEcho] {
            let methods = vec![method.into()];
            let options = SetTwoOptions { seeds: 5, methods, second_robot, physics, ..SetTwoOptions::default() };
            let drive = || one_core.install(|| driven::set_two(&options, &|_| true).expect("the courses have room"));
            let simulated_s: f64 = drive().runs.iter().flatten().map(|run| run.time_s).sum();
            group.throughput(Throughput::Elements((simulated_s * 1e3) as u64));
            group.bench_function(method.as_str(), |bencher| bencher.iter(drive));
        }
        group.finish();
    }
}

criterion_group!(benches, still, set_one, moving, set_two);
criterion_main!(benches);
