//! How long the scenes take that are expensive to follow sound in: a ring's matrix among walls and poles, a hall of
//! pillars, a world that moves, and Set II. The same file, built against another commit, prints that commit's times.
//!
//!     cargo run --release -p eeruf-sim --example time_scenes -- [SCENE [RUNS]]
//!
//! With the beginning of a scene's name only that one is timed, so many times.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::experiments::set_two::{SetTwoOptions, set_two};
use eeruf_sim::*;

/// The quickest of several runs of `work`, in milliseconds: so many, or as many as fit into a second, at least three.
fn quickest_ms(mut work: impl FnMut()) -> f64 {
    let (start, mut quickest, mut runs) = (Instant::now(), f64::INFINITY, 0);
    let asked = std::env::args().nth(2).and_then(|runs| runs.parse().ok());
    while asked.map_or(runs < 3 || start.elapsed().as_secs_f64() < 1.0, |asked: u32| runs < asked) {
        let before = Instant::now();
        work();
        quickest = quickest.min(before.elapsed().as_secs_f64() * 1e3);
        runs += 1;
    }
    quickest
}

fn room() -> Vec<Wall> {
    Wall::polyline(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]]).collect()
}

/// A ring of 24 in a room of four walls, with so many poles of 2 cm: its matrix of order 4.
fn matrix_ms(poles: usize) -> (f64, usize) {
    let places = [[1.0, 1.0], [4.5, 1.2], [4.0, 3.2], [1.4, 3.0]];
    let poles = places.iter().take(poles).map(|&[x, y]| Pole::new(x, y, 0.01)).collect();
    let scene = Scene::new(room(), poles, Air::default()).expect("a room");
    let ring: Vec<_> = ring_of(&Pose::new(Vector::new(2.7, 1.9), 0.1), 24, 0.3, 0.0, TAU / 24.0).collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    let (sensors, limits) = (&ring[..], Limits::order(4));
    let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
    let ms = quickest_ms(|| matrix.compute(&mut tracer, black_box(&query)).expect("in the room"));
    (ms, matrix.paths().len())
}

/// A hall with 256 square pillars, 1,028 walls: the matrix of a ring of 24 at order 3, per source.
fn hall_ms() -> (f64, usize) {
    let mut walls: Vec<_> = Wall::polyline(&[[0.0, 0.0], [48.0, 0.0], [48.0, 48.0], [0.0, 48.0], [0.0, 0.0]]).collect();
    for pillar in 0..256 {
        let (x, y) = (1.5 + 3.0 * f64::from(pillar % 16), 1.5 + 3.0 * f64::from(pillar / 16));
        let (a, b) = (0.2, 0.2 + 0.01 * f64::from(pillar % 7));
        walls.extend(Wall::polyline(&[[x - a, y - b], [x - a, y + b], [x + a, y + b], [x + a, y - b], [x - a, y - b]]));
    }
    let scene = Scene::new(walls, vec![], Air::default()).expect("a hall");
    let ring: Vec<_> = ring_of(&Pose::new(Vector::new(24.1, 24.05), 0.1), 24, 0.3, 0.0, TAU / 24.0).collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    let (sensors, limits) = (&ring[..], Limits { max_order: 6, max_length_m: 24.0 });
    let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
    let ms = quickest_ms(|| matrix.compute(&mut tracer, black_box(&query)).expect("in the hall"));
    (ms / 24.0, matrix.paths().len())
}

/// Set I's first alcove with a robot that creeps on: 100 periods.
fn moving_ms() -> (f64, usize) {
    let alcove = Alcove::random(1);
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    let robot = Robot { motion, ..alcove.robot() };
    let world = World::new(alcove.scene().expect("walls"), vec![robot], Noise::default())
        .and_then(|world| world.with_physics(Physics::PLAIN))
        .expect("free space");
    let mut readings = 0;
    let run = || simulate(&world, Method::Eeruf, &Options::periods(100)).expect("the scene is large enough").len();
    let ms = quickest_ms(|| readings = run());
    (ms, readings)
}

/// Two courses of Set II on one core.
fn set_two_ms() -> (f64, usize) {
    let options =
        SetTwoOptions { seeds: 2, methods: vec![Method::Eeruf], physics: Physics::PLAIN, ..SetTwoOptions::default() };
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    let mut finished = 0;
    let drive = || set_two(&options, &|_| true).expect("the courses have room").methods[0].1.finished;
    let ms = quickest_ms(|| finished = one_core.install(drive));
    (ms, finished)
}

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let time = |what: &str, scene: &dyn Fn() -> (f64, usize), counted: &str| {
        if what.starts_with(&only) {
            let (ms, count) = scene();
            println!("{what:44} {ms:10.3} ms  {count} {counted}");
        }
    };
    time("matrix of 24, order 4, no pole", &|| matrix_ms(0), "paths");
    time("matrix of 24, order 4, one pole", &|| matrix_ms(1), "paths");
    time("matrix of 24, order 4, four poles", &|| matrix_ms(4), "paths");
    time("hall of 1,028 walls, order 6, a source", &hall_ms, "paths");
    time("moving, 100 periods of 8", &moving_ms, "readings");
    time("Set II, 2 courses", &set_two_ms, "finished");
}
