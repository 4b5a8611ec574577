//! How many readings a second are simulated on one core: a static world with its paths known, one that moves, and Set I with
//! everything from the walls on.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Method, Motion, Options, Robot, Vector, World, simulate};

/// Long enough that finding the paths once does not count.
const LONG: u32 = 20_000;

fn still(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("still");
    group.sample_size(10);
    let world = Alcove::random(1).world().expect("every random alcove has room");
    for method in [Method::Conventional, Method::Eeruf, Method::Adaptive, Method::MultiEcho] {
        let options = Options::periods(LONG);
        let readings = simulate(&world, method, &options).expect("Set I fits every method").len();
        group.throughput(Throughput::Elements(readings as u64));
        group.bench_function(method.as_str(), |bencher| bencher.iter(|| simulate(&world, method, &options)));
    }
    group.finish();
}

fn set_one(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("set one, 8000 readings with paths");
    group.throughput(Throughput::Elements(8000));
    group.bench_function("eeruf", |bencher| {
        bencher.iter(|| {
            let world = Alcove::random(1).world().expect("every random alcove has room");
            simulate(&world, Method::Eeruf, &Options::periods(1000))
        });
    });
    group.finish();
}

fn moving(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("moving");
    group.sample_size(10);
    let alcove = Alcove::random(1);
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    let robot = Robot { motion, ..alcove.robot() };
    let scene = alcove.scene().expect("every random alcove has walls");
    let world = World::new(scene, vec![robot], eeruf_sim::Noise::default()).expect("it starts in free space");
    group.throughput(Throughput::Elements(800));
    group.bench_function("eeruf", |bencher| {
        bencher.iter(|| simulate(&world, Method::Eeruf, &Options::periods(100)));
    });
    group.finish();
}

criterion_group!(benches, still, set_one, moving);
criterion_main!(benches);
