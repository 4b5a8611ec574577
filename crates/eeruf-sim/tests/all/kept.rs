//! Matrices and readings of flat worlds that must not change, bit for bit: under `plain`, and under `default` as it was
//! before worlds had heights and modules their own gain.

use std::f64::consts::{PI, TAU};

use eeruf_core::Micros;
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

use crate::random::{free_point, scene as random_scene};

fn room() -> Vec<Wall> {
    Wall::polyline(&[[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]]).collect()
}

fn room_with_poles() -> Scene {
    let poles = [[1.0, 1.0], [4.5, 1.2], [4.0, 3.2], [1.4, 3.0]].map(|[x, y]| Pole::new(x, y, 0.01));
    Scene::new(room(), poles.into(), Air::default()).unwrap()
}

/// Computes a digest of a list of whole numbers (FNV-1a).
fn digest(numbers: impl Iterator<Item = u64>) -> u64 {
    numbers
        .flat_map(u64::to_le_bytes)
        .fold(0xcbf2_9ce4_8422_2325, |digest, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Returns the number of readings, and a digest of their times, kinds and causes. Times are whole microseconds.
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
    let query = CrosstalkQuery::new(&scene, sensors, &transducer, limits, floor);
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

/// Returns a digest of readings to the last bit, with the bounces of their paths, for methods that believe everything,
/// so that no filter matters.
fn exactly(readings: &Readings) -> (usize, u64) {
    let numbers = (0..readings.len()).flat_map(|k| {
        let times = [&readings.fired_s, &readings.t_echo_us, &readings.earliest_us, &readings.reference_us]
            .map(|times| times[k].to_bits());
        let heard = readings.paths.get(readings.path[k] as usize);
        let path = heard.into_iter().flat_map(|path| {
            let ends = [path.emitter, path.receiver].map(|id| u64::from(id.robot) << 8 | u64::from(id.sensor));
            let bounces = path.bounces.iter().map(|bounce| match *bounce {
                Bounce::Wall(wall) => u64::from(wall),
                Bounce::Pole(pole) => 1 << 32 | u64::from(pole),
                Bounce::Edge(edge) => 2 << 32 | u64::from(edge),
                Bounce::Floor | Bounce::Ceiling => unreachable!("a flat world"),
            });
            ends.into_iter().chain(bounces)
        });
        times.into_iter().chain([readings.cause[k] as u64]).chain(path)
    });
    (readings.len(), digest(numbers))
}

/// Makes a corner of a hall: pillars, a thin and a thick pole, a panel, a door.
fn furnished() -> Scene {
    let corners =
        [[0.0, 0.0], [9.0, 0.0], [9.0, 6.0], [5.0, 6.0], [5.0, 7.5], [3.0, 7.5], [3.0, 6.0], [0.0, 6.0], [0.0, 0.0]];
    let mut walls: Vec<_> = Wall::polyline(&corners).collect();
    walls[4].faces = Faces::Open;
    walls.push(Wall::new(6.5, 3.9, 7.3, 4.2).with_faces(Faces::Both));
    walls.push(Wall::new(1.0, 4.6, 1.03, 4.6).with_faces(Faces::Both).with_material(Material::PAINTED));
    for [x, y] in [[2.0, 1.2], [4.5, 1.1], [7.2, 1.4]] {
        let a = 0.2;
        walls.extend(Wall::polyline(&[[x - a, y - a], [x - a, y + a], [x + a, y + a], [x + a, y - a], [x - a, y - a]]));
    }
    let poles = vec![Pole::new(3.2, 4.7, 0.01), Pole::new(5.4, 4.4, 0.25)];
    Scene::new(walls, poles, Air::default()).unwrap()
}

#[test]
fn paths_under_default_keep_every_bit() {
    let mut random = Random::new(41);
    let (mut tracer, mut paths, mut count, mut all) = (Tracer::new(), Paths::default(), 0, Vec::new());
    tracer.follow(&Physics { shadows: false, ..Physics::DEFAULT });
    for _ in 0..40 {
        let scene = random_scene(&mut random, 9);
        let (source, receivers) = (free_point(&mut random, &scene), [(); 3].map(|()| free_point(&mut random, &scene)));
        tracer.trace(&scene, source, &receivers, Limits::order(3), &mut paths).unwrap();
        count += paths.len();
        for k in 0..paths.len() {
            let numbers = [paths.length_m[k], paths.departure_rad[k], paths.arrival_rad[k], paths.amplitude[k]];
            all.push(u64::from(paths.receiver[k]));
            all.extend(numbers.map(f64::to_bits));
        }
    }
    assert_eq!((count, digest(all.into_iter())), (2195, 8_822_049_603_692_189_804));
}

#[test]
fn still_readings_under_default_keep_every_bit() {
    let world = Alcove::random(1).world().unwrap();
    let run = |method| exactly(&simulate(&world, method, &Options::periods(50)).unwrap());
    let found = [Method::Conventional, Method::Dither, Method::Sequential].map(run);
    assert_eq!(
        found,
        [(400, 10_261_707_914_260_042_133), (400, 175_592_989_826_885_751), (84, 1_331_307_300_083_401_418)]
    );
}

#[test]
fn still_readings_of_every_gain_keep_every_bit() {
    let gains = [GainProfile::Constant, GainProfile::SquareRoot, GainProfile::Linear, GainProfile::Stepped];
    let found = gains.map(|gain| {
        let pose = Pose::new(Vector::new(4.0, 3.0), 0.3);
        let module = Transducer { gain, beam: Beam::CutAt90, ..Transducer::HC_SR04 };
        let robot = Robot { window: Micros::from_millis(24), ..Robot::ring(pose, 12, TAU / 12.0, 0.15, module) };
        let world = World::new(furnished(), vec![robot], Noise::default()).and_then(|world| world.with_max_order(4));
        exactly(&simulate(&world.unwrap(), Method::Conventional, &Options::periods(20)).unwrap())
    });
    assert_eq!(
        found,
        [
            (240, 13_243_940_960_399_355_742),
            (240, 8_803_628_395_171_390_481),
            (240, 10_804_586_205_406_313_835),
            (240, 13_884_668_369_266_605_831)
        ]
    );
}

/// Simulates two robots in a furnished hall, the first one moving, under `default`.
fn two_robots(body: Option<Body>) -> Readings {
    let motion = Motion::Constant { velocity: Vector::new(0.3, -0.1), turn_rad_s: 0.4 };
    let module = Transducer { gain: GainProfile::Linear, ..Transducer::POLAROID_6500 };
    let first = Robot::ring(Pose::new(Vector::new(3.4, 3.2), 0.4), 8, TAU / 8.0, 0.2, Transducer::POLAROID_6500);
    let second = Robot::ring(Pose::new(Vector::new(6.2, 2.6), PI), 6, TAU / 6.0, 0.2, module);
    let second = Robot { start: Micros::new(7000), ..second };
    let robots = vec![Robot { motion, body, ..first }, Robot { body, ..second }];
    let world = World::new(furnished(), robots, Noise::default()).and_then(|world| world.with_max_order(4));
    simulate(&world.unwrap(), Method::Conventional, &Options::periods(20)).unwrap()
}

#[test]
fn moving_readings_under_default_keep_every_bit() {
    let found = [None, Some(Body::Disc(0.2)), Some(Body::Box(0.36, 0.3))].map(|body| exactly(&two_robots(body)));
    assert_eq!(
        found,
        [(280, 1_957_498_277_518_388_171), (280, 5_073_173_181_420_675_318), (280, 11_506_731_041_522_716_737)]
    );
}

#[test]
fn moving_alcoves_under_default_keep_every_bit() {
    let motion = Motion::Constant { velocity: Vector::new(0.0, 0.01), turn_rad_s: 0.02 };
    let found = [1, 2, 20_000].map(|number| {
        let alcove = Alcove::random(number);
        let robot = Robot { motion: motion.clone(), ..alcove.robot() };
        let world = World::new(alcove.scene().unwrap(), vec![robot], Noise::default()).unwrap();
        exactly(&simulate(&world, Method::Dither, &Options::periods(12)).unwrap())
    });
    assert_eq!(
        found,
        [(96, 13_100_553_117_458_852_796), (96, 11_102_481_705_054_291_634), (96, 12_181_244_833_678_059_115)]
    );
}
