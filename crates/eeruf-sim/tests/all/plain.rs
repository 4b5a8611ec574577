//! The preset `plain` is the physics that the simulator began with: numbers of matrices, readings and runs that it gave
//! then, and must give for ever.

use std::f64::consts::{PI, TAU};

use eeruf_core::Micros;
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

fn room() -> Vec<Wall> {
    Wall::polyline(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]]).collect()
}

fn room_with_poles() -> Scene {
    let poles = [[1.0, 1.0], [4.5, 1.2], [4.0, 3.2], [1.4, 3.0]].map(|[x, y]| Pole::new(x, y, 0.01));
    Scene::new(room(), poles.into(), Air::default()).unwrap()
}

/// What a list of whole numbers comes to (FNV-1a).
fn digest(numbers: impl Iterator<Item = u64>) -> u64 {
    numbers
        .flat_map(u64::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// How many readings there are, and what their times, kinds and causes come to. Times are whole microseconds.
fn of(readings: &Readings) -> (usize, u64) {
    let us = |time: f64| if time.is_nan() { u64::MAX } else { time as u64 };
    let numbers = (0..readings.len()).flat_map(|k| {
        [
            us(readings.t_echo_us[k]),
            us(readings.earliest_us[k]),
            us(readings.reference_us[k]),
            readings.kind[k] as u64,
            readings.cause[k] as u64,
        ]
    });
    (readings.len(), digest(numbers))
}

#[test]
fn a_matrix_of_24_sensors_among_walls_and_poles_is_what_it_was() {
    let scene = room_with_poles();
    let ring: Vec<_> = ring_of(&Pose::new(Vector::new(2.7, 1.9), 0.1), 24, 0.3, 0.0, TAU / 24.0).collect();
    let transducer = Transducer::POLAROID_6500;
    let floor = transducer.detection_floor(scene.air());
    let (sensors, limits) = (&ring[..], Limits::order(3));
    let mut matrix = CrosstalkMatrix::new();
    let query = CrosstalkQuery { scene: &scene, sensors, transducer: &transducer, limits, floor };
    matrix.compute(&mut Tracer::new(), &query).unwrap();
    let over_poles = matrix
        .paths()
        .iter()
        .filter(|path| matrix.bounces(path).iter().any(|bounce| matches!(bounce, Bounce::Pole(_))));
    let ends = matrix.paths().iter().flat_map(|path| [path.emitter, path.receiver, path.order].map(u64::from));
    let whole = (matrix.paths().len(), over_poles.count(), digest(ends));
    let length_m: f64 = matrix.paths().iter().map(|path| path.length_m).sum();
    let amplitude: f64 = matrix.paths().iter().map(|path| path.amplitude).sum();
    assert_eq!(whole, (330, 55, 9_285_349_746_820_596_295));
    assert!((length_m - 2_069.041_969_278_918_3).abs() < 1e-9, "{length_m}");
    assert!((amplitude / 1.174_839_432_697_455_2 - 1.0).abs() < 1e-12, "{amplitude}");
}

#[test]
fn readings_of_a_robot_that_stands_are_what_they_were() {
    let world = Alcove::random(1).world().and_then(|world| world.with_physics(Physics::PLAIN)).unwrap();
    for (method, expected) in [
        (Method::Conventional, 1_421_223_600_657_689_355),
        (Method::Eeruf, 7_350_724_768_670_167_218),
        (Method::MultiEcho, 6_458_855_026_664_563_605),
    ] {
        let readings = simulate(&world, method, &Options::periods(50)).unwrap();
        assert_eq!(of(&readings), (400, expected), "{method}");
    }
}

#[test]
fn readings_of_robots_that_move_among_poles_are_what_they_were() {
    let motion = Motion::Constant { velocity: Vector::new(0.2, 0.05), turn_rad_s: 0.3 };
    let spacing = 15f64.to_radians();
    let first = Robot::ring(Pose::new(Vector::new(2.0, 2.0), 0.4), 8, spacing, 0.3, Transducer::POLAROID_6500);
    let second = Robot { pose: Pose::new(Vector::new(4.5, 2.3), PI), start: Micros::new(7000), ..first.clone() };
    let robots = vec![Robot { motion, ..first }, second];
    let noise = Noise { bursts_per_s: 3.0, ..Noise::default() };
    let world = World::new(room_with_poles(), robots, noise)
        .and_then(|world| world.with_max_order(2))
        .and_then(|world| world.with_physics(Physics::PLAIN));
    let readings = simulate(&world.unwrap(), Method::Eeruf, &Options::periods(20)).unwrap();
    assert_eq!(of(&readings), (320, 16_764_655_212_575_297_470));
}
