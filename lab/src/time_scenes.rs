//! Times of scenes in which sound is expensive to trace: a ring's matrix among walls and poles, halls of pillars, a
//! world that moves, and Set II, under `default` and under `plain`. The same file, built against another commit, prints
//! that commit's times.
//!
//! ```text
//! cargo lab time-scenes [SCENE [RUNS]]
//! ```
//!
//! SCENE is the beginning of the only scene's name, RUNS the number of runs.

use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::experiments::set_two::{SECOND_BEHIND, SetTwoOptions, set_two};
use eeruf_sim::*;

/// Returns the shortest time of `work` in milliseconds, over the number of runs asked for, or over as many as fit into
/// a second, at least three.
fn quickest_ms(asked: Option<u32>, mut work: impl FnMut()) -> f64 {
    let (start, mut quickest, mut runs) = (Instant::now(), f64::INFINITY, 0);
    while asked.map_or(runs < 3 || start.elapsed().as_secs_f64() < 1.0, |asked| runs < asked) {
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

/// Times the matrix of order 4 for a ring of 24 in a room of four walls, with this many poles of 2 cm.
fn matrix_ms(poles: usize, asked: Option<u32>) -> (f64, usize) {
    let places = [[1.0, 1.0], [4.5, 1.2], [4.0, 3.2], [1.4, 3.0]];
    let poles = places.iter().take(poles).map(|&[x, y]| Pole::new(x, y, 0.01)).collect();
    let scene = Scene::new(room(), poles, Air::default()).expect("a room");
    let ring: Vec<_> = ring_of(&Pose::new(Vector::new(2.7, 1.9), 0.1), 24, 0.3, 0.0, TAU / 24.0).collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    let (sensors, limits) = (&ring[..], Limits::order(4));
    let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
    let ms = quickest_ms(asked, || matrix.compute(&mut tracer, black_box(&query)).expect("in the room"));
    (ms, matrix.paths().len())
}

/// Makes a hall with this many rows of square pillars: 1,028 walls with 16.
fn pillars(rows: u32) -> Vec<Wall> {
    let size_m = 3.0 * f64::from(rows);
    let corners = [[0.0, 0.0], [size_m, 0.0], [size_m, size_m], [0.0, size_m], [0.0, 0.0]];
    let mut walls: Vec<_> = Wall::polyline(&corners).collect();
    for pillar in 0..rows * rows {
        let (x, y) = (1.5 + 3.0 * f64::from(pillar % rows), 1.5 + 3.0 * f64::from(pillar / rows));
        let (a, b) = (0.2, 0.2 + 0.01 * f64::from(pillar % 7));
        walls.extend(Wall::polyline(&[[x - a, y - b], [x - a, y + b], [x + a, y + b], [x + a, y - b], [x - a, y - b]]));
    }
    walls
}

/// Times the matrix of a ring of 24 in a hall, at order 6, per source.
fn hall_ms(rows: u32, physics: Physics, asked: Option<u32>) -> (f64, usize) {
    let (size_m, walls) = (3.0 * f64::from(rows), pillars(rows));
    let scene = Scene::new(walls, vec![], Air::default()).expect("a hall");
    let ring: Vec<_> =
        ring_of(&Pose::new(Vector::new(0.5 * size_m + 0.1, 0.5 * size_m + 0.05), 0.1), 24, 0.3, 0.0, TAU / 24.0)
            .collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    tracer.follow(&physics);
    let (sensors, limits) = (&ring[..], Limits { max_order: 6, max_length_m: 24.0 });
    let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
    let ms = quickest_ms(asked, || matrix.compute(&mut tracer, black_box(&query)).expect("in the hall"));
    (ms / 24.0, matrix.paths().len())
}

/// Times Set I's first alcove with a slowly moving robot: 100 periods.
fn moving_ms(physics: Physics, room: Option<Room>, asked: Option<u32>) -> (f64, usize) {
    let alcove = Alcove::random(1);
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.0 };
    let robot = Robot { motion, ..alcove.robot() };
    let scene = alcove.scene().and_then(|scene| scene.with_room(room)).expect("walls");
    let world = World::new(scene, vec![robot], Noise::default())
        .and_then(|world| world.with_physics(physics))
        .expect("free space");
    let mut readings = 0;
    let run = || simulate(&world, Method::Eeruf, &Options::periods(100)).expect("the scene is large enough").len();
    let ms = quickest_ms(asked, || readings = run());
    (ms, readings)
}

/// Makes a ring of eight that drives at 0.2 m/s and turns.
fn driving(at: [f64; 2]) -> Robot {
    let ring = Robot::ring(Pose::new(Vector::from(at), 0.3), 8, TAU / 8.0, 0.2, Transducer::POLAROID_6500);
    Robot { motion: Motion::Constant { velocity: Vector::new(0.14, 0.14), turn_rad_s: 1.0 }, ..ring }
}

/// Times a reading, averaged over 20 periods of these robots in this scene, with sound followed up to this order.
fn reading_ms(scene: Scene, robots: Vec<Robot>, max_order: u32, asked: Option<u32>) -> (f64, usize) {
    let world = World::new(scene, robots, Noise::default())
        .and_then(|world| world.with_max_order(max_order))
        .and_then(|world| world.with_physics(Physics::DEFAULT))
        .expect("free space");
    let mut readings = 0;
    let run = || simulate(&world, Method::Eeruf, &Options::periods(20)).expect("the scene is large enough").len();
    let ms = quickest_ms(asked, || readings = run());
    (ms / readings as f64, readings)
}

/// Times a room with three poles of 10 cm.
fn poles_ms(asked: Option<u32>) -> (f64, usize) {
    let poles = [[1.0, 1.0], [4.5, 1.2], [4.0, 3.2]].map(|[x, y]| Pole::new(x, y, 0.05)).to_vec();
    let scene = Scene::new(room(), poles, Air::default()).expect("a room");
    reading_ms(scene, vec![driving([2.7, 1.9])], 6, asked)
}

/// Times a hall of 1,028 walls with two robots that have bodies.
fn bodies_ms(asked: Option<u32>) -> (f64, usize) {
    let robots = [[24.1, 24.05], [25.2, 24.6]].map(|at| Robot { body: Some(Body::Disc(0.19)), ..driving(at) });
    let scene = Scene::new(pillars(16), vec![], Air::default()).expect("a hall");
    reading_ms(scene, robots.to_vec(), 6, asked)
}

/// Times a building like a map of 2,000 by 2,000 cells of 5 cm: 20 by 20 rooms of 5 m with doors of 0.9 m and walls
/// that wave by up to 3 cm, 47,040 in all.
fn building_ms(asked: Option<u32>) -> (f64, usize) {
    let (mut drawn, mut walls) = (1_u32, Vec::new());
    for place in 0..840 {
        let (line, room, turned) = (place / 40, place / 2 % 20, place % 2 == 1);
        for part in [0..29, 40..69] {
            let corners: Vec<_> = part
                .map(|step| {
                    drawn = drawn.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    let across = 5.0 * f64::from(line) + 0.01 * f64::from(drawn >> 30);
                    let along = 5.0 * f64::from(room) + 0.1 + 0.07 * f64::from(step);
                    if turned { [across, along] } else { [along, across] }
                })
                .collect();
            walls.extend(Wall::polyline(&corners));
        }
    }
    let scene = Scene::new(walls, vec![], Air::default()).expect("a building");
    reading_ms(scene, vec![driving([52.4, 52.6])], 5, asked)
}

/// Times two courses of Set II on one core, with a second robot behind or alone.
fn set_two_ms(physics: Physics, second: bool, asked: Option<u32>) -> (f64, usize) {
    let second_robot = second.then_some(SECOND_BEHIND);
    let methods = vec![Method::Eeruf.into()];
    let options = SetTwoOptions { seeds: 2, methods, physics, second_robot, ..SetTwoOptions::default() };
    let one_core = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    let mut finished = 0;
    let drive = || set_two(&options, &|_| true).expect("the courses have room").methods[0].1.finished;
    let ms = quickest_ms(asked, || finished = one_core.install(drive));
    (ms, finished)
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let only = arguments.first().map_or("", String::as_str);
    let asked = arguments.get(1).map(|runs| runs.parse()).transpose()?;
    let time = |what: &str, scene: &dyn Fn() -> (f64, usize), counted: &str| {
        if what.starts_with(only) {
            let (ms, count) = scene();
            println!("{what:44} {ms:10.3} ms  {count} {counted}");
        }
    };
    time("matrix of 24, order 4, no pole", &|| matrix_ms(0, asked), "paths");
    time("matrix of 24, order 4, one pole", &|| matrix_ms(1, asked), "paths");
    time("matrix of 24, order 4, four poles", &|| matrix_ms(4, asked), "paths");
    for (name, physics) in [("default", Physics::DEFAULT), ("plain", Physics::PLAIN)] {
        time(&format!("hall of 1,028 walls, a source, {name}"), &|| hall_ms(16, physics, asked), "paths");
        time(&format!("hall of 4,100 walls, a source, {name}"), &|| hall_ms(32, physics, asked), "paths");
        time(&format!("moving, 100 periods of 8, {name}"), &|| moving_ms(physics, None, asked), "readings");
        time(&format!("moving, in a room, {name}"), &|| moving_ms(physics, Some(Room::DEFAULT), asked), "readings");
        time(&format!("Set II, 2 courses, {name}"), &|| set_two_ms(physics, false, asked), "finished");
        time(&format!("Set II, 2 courses, second robot, {name}"), &|| set_two_ms(physics, true, asked), "finished");
    }
    time("a reading among three poles", &|| poles_ms(asked), "readings");
    time("a reading of two with bodies, 1,028 walls", &|| bodies_ms(asked), "readings");
    time("a reading in a building of 47,040 walls", &|| building_ms(asked), "readings");
    Ok(())
}
