//! Rust's answers and their durations, for comparison with Python. Prints one JSON object.
//!
//! ```text
//! cargo lab rust-side paths    every critical path of the shared corpus
//! cargo lab rust-side times    seconds of one call of `design`, `paths` and `push_many`'s work and of one step
//! ```
//!
//! `benches/python/overhead.py` times the same calls from Python; `tests/python/test_corpus.py` compares the paths bit
//! for bit.

use std::{hint::black_box, sync::Arc, time::Instant};

use eeruf_core::{EchoFilter, Layout, MAX_SENSORS, Micros, Requirements};
use eeruf_period::PeriodProblem;
use eeruf_sim::{
    Air, Filter, Filtered, FiredReading, Method, Noise, Options, Own, OwnError, Pose, Robot, Scene, Simulation, Stop,
    Transducer, Wall, World,
};
use serde_json::{Map, Value, json};

use crate::corpus;

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let answer = match arguments.first().map(String::as_str) {
        Some("paths") => paths(),
        Some("times") => times(),
        _ => return Err("expected paths or times".into()),
    };
    println!("{answer}");
    Ok(())
}

fn paths() -> Value {
    let mut answer = Map::new();
    for case in corpus::corpus()["cases"].as_array().expect("cases") {
        let order = case["max_order"].as_u64().expect("an order") as u32;
        let scene = corpus::scene(case);
        let source = corpus::point(&case["source"]);
        let found = scene.paths(source, &corpus::receivers(case), order, f64::INFINITY).expect("a scene of the corpus");
        let walls: Vec<Vec<i64>> =
            (0..found.len()).map(|path| found.bounces(path).iter().map(|bounce| bounce.number()).collect()).collect();
        let columns = json!({
            "receiver": found.receiver,
            "length_m": found.length_m,
            "order": found.order,
            "departure_rad": found.departure_rad,
            "arrival_rad": found.arrival_rad,
            "amplitude": found.amplitude,
            "walls": walls,
        });
        answer.insert(case["id"].as_str().expect("an id").to_owned(), columns);
    }
    Value::Object(answer)
}

/// Returns the time of each call that `overhead.py` measures too, in seconds.
fn times() -> Value {
    let wall = Scene::new(vec![Wall::new(5.0, 2.0, -5.0, 2.0)], vec![], Air::default()).expect("a wall");
    let alcove = [[0.85, 0.0], [0.85, 1.39], [-0.85, 1.39], [-0.85, 0.0]];
    let alcove = Scene::new(Wall::polyline(&alcove).collect(), vec![], Air::default()).expect("three walls");
    let eight: Vec<_> = (0..8).map(|k| eeruf_sim::Point::new(0.05 * f64::from(k), 0.3)).collect();
    let source = eeruf_sim::Point::new(0.0, 0.2);
    json!({
        "design, 2 sensors": seconds(|| design_of(2)),
        "design, 4 sensors": seconds(|| design_of(4)),
        "paths, wall": seconds(|| wall.paths(source, &eight[..1], 1, f64::INFINITY)),
        "paths, alcove": seconds(|| alcove.paths(source, &eight, 3, f64::INFINITY)),
        "push_many, 1,000,000": million(),
        "step, one reading": step(Own::new),
        "step, own filter": step(|| Own::new().filter(0, Everything)),
    })
}

/// A filter that believes every echo.
struct Everything;

impl Filter for Everything {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        Ok(Filtered::accepted(firing.echoes.first().copied()))
    }
}

/// Times one step that yields a reading, on average over 10,000, in a simulation of a ring before a wall.
fn step(own: impl Fn() -> Own) -> f64 {
    const STEPS: u32 = 10_000;
    let ahead = Pose::rotation(1.57);
    let robot = Robot::ring(ahead, 8, 0.26, 0.3, Transducer::POLAROID_6500);
    let scene = Scene::new(vec![Wall::new(5.0, 2.0, -5.0, 2.0)], vec![], Air::default()).expect("a wall");
    let world = Arc::new(World::new(scene, vec![robot], Noise::default()).expect("a robot before a wall"));
    let many = || {
        let (options, stop) = (Options::default(), Stop::default());
        let started = Simulation::with_own(Arc::clone(&world), Method::Eeruf, &options, own(), stop);
        let mut simulation = started.expect("a ring that fires");
        for _ in 0..STEPS {
            black_box(simulation.step_to_reading(1.0, |_| true).expect("a reading"));
        }
    };
    seconds(many) / f64::from(STEPS)
}

/// Does the work of `eeruf.design`: finds the shortest period and the preferred schedule.
fn design_of(sensors: usize) -> Micros {
    let requirements = Requirements {
        min_interval: Micros::from_millis(15),
        layout: Layout::Line(4),
        window: Micros::from_millis(36),
        ..Requirements::new(Micros::new(999))
    };
    let needs = PeriodProblem { sensors: black_box(sensors), requirements, tick: Micros::from_millis(1) };
    let shortest = needs.shortest(50_000_000, &mut ()).expect("a small ring");
    black_box(needs.prefer(&shortest.schedule, 30_000, &mut ()).expect("a small ring"));
    shortest.period()
}

/// Times a million readings of 8 sensors, one by one.
fn million() -> f64 {
    let echoes: Vec<f64> = (0..1_000_000).map(|k| 9_000.0 + f64::from(k * 7 % 600)).collect();
    seconds(|| {
        let mut filter = EchoFilter::<MAX_SENSORS>::new(Micros::new(500), 2).expect("two readings");
        let mut kinds = Vec::with_capacity(echoes.len());
        for row in echoes.chunks_exact(8) {
            for (sensor, &us) in (0..).zip(row) {
                let echo = (!us.is_nan()).then(|| Micros::new(us.round() as u32));
                kinds.push(filter.push(sensor, echo).expect("a sensor").kind as u8);
            }
        }
        kinds
    })
}

/// Returns the shortest time of many runs over half a second.
fn seconds<T>(mut run: impl FnMut() -> T) -> f64 {
    let (mut best, begin) = (f64::INFINITY, Instant::now());
    while begin.elapsed().as_secs_f64() < 0.5 {
        let start = Instant::now();
        black_box(run());
        best = best.min(start.elapsed().as_secs_f64());
    }
    best
}
