//! Sounds that reach a receiver within a burst of each other, compared with waveforms added sample by sample.

use std::f64::consts::TAU;

use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

const MODULE: Transducer = Transducer::POLAROID_6500;
const ADDING: Physics = Physics { interference: true, ..Physics::PLAIN };

/// Makes a world of one sensor at this distance from a long wall and at this height, turned from the wall by an angle,
/// with only floor and ceiling besides.
fn before_a_wall([distance_m, height_m, heading_rad]: [f64; 3], gain: GainProfile, physics: Physics) -> World {
    let wall = Wall::new(distance_m, -20.0, distance_m, 20.0);
    let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap().with_room(Some(Room::DEFAULT)).unwrap();
    let sensor =
        Robot::with_sensors(Pose::rotation(heading_rad), vec![Pose::identity()], Transducer { gain, ..MODULE });
    let robot = Robot { heights_m: vec![height_m], ..sensor };
    World::new(scene, vec![robot], Noise::NONE).unwrap().with_physics(physics).unwrap()
}

/// Returns travel time in seconds and amplitude relative to the threshold for each image of the sensor in wall, floor
/// and ceiling, down to 10 dB below the threshold.
fn images([distance_m, height_m, heading_rad]: [f64; 3]) -> Vec<(f64, f64)> {
    let air = Air::default();
    let (c, ceiling_m) = (air.speed_of_sound(), Room::DEFAULT.ceiling_m);
    let piston = MODULE.piston(air);
    let (low, high) = (2.0 * height_m, 2.0 * (ceiling_m - height_m));
    // Each entry has the image's height above the sensor and the reflection of its bounces at floor and ceiling.
    let [floor, ceiling] = [Room::DEFAULT.floor.reflection, Room::DEFAULT.ceiling.reflection];
    let rises = [
        (0.0, 1.0),
        (low, floor),
        (high, ceiling),
        (low + high, floor * ceiling),
        (low + high, floor * ceiling),
        (2.0 * low + high, floor * floor * ceiling),
        (low + 2.0 * high, floor * ceiling * ceiling),
        (2.0 * (low + high), (floor * ceiling).powi(2)),
        (2.0 * (low + high), (floor * ceiling).powi(2)),
    ];
    rises
        .map(|(rise_m, reflection)| {
            let length_m = rise_m.hypot(2.0 * distance_m);
            let off_axis_rad = (heading_rad.cos() * 2.0 * distance_m / length_m).acos();
            let pattern = piston.pattern(off_axis_rad).powi(2);
            let loss = 10f64.powf(-air.absorption_db_per_m(MODULE.frequency_hz) * length_m / 20.0);
            let amplitude = Material::SMOOTH.reflection * reflection * pattern * loss / length_m;
            (length_m / c, amplitude / MODULE.detection_floor(air))
        })
        .into_iter()
        .filter(|sound| sound.1 >= 10f64.powf(-0.5))
        .collect()
}

/// Returns the time in seconds at which the sum of all waves, sampled every 50 ns, crosses the threshold.
fn heard_at(sounds: &[(f64, f64)], threshold: impl Fn(f64) -> f64) -> Option<f64> {
    let burst_s = MODULE.burst_s();
    let level = |time_s: f64| {
        let (mut cos, mut sin) = (0.0, 0.0);
        for &(delay_s, amplitude) in sounds {
            let age = (time_s - delay_s) / burst_s;
            let envelope = amplitude * (1.0 - (age - 1.0).abs()).max(0.0);
            let phase = TAU * MODULE.frequency_hz * (time_s - delay_s);
            (cos, sin) = (cos + envelope * phase.cos(), sin + envelope * phase.sin());
        }
        cos.hypot(sin)
    };
    let first_s = sounds.iter().map(|sound| sound.0).fold(f64::INFINITY, f64::min).max(MODULE.blanking_s);
    let loud = |time_s: f64| level(time_s) >= threshold(time_s);
    (0..200_000).map(|k| first_s + 50e-9 * f64::from(k)).find(|&time_s| loud(time_s))
}

fn reads_us(world: &World) -> f64 {
    let readings = simulate(world, Method::Sequential, &Options::periods(2)).unwrap();
    assert!(
        readings.reference_us[0].is_nan() && readings.earliest_us[0].is_nan() || {
            (readings.reference_us[0] - readings.earliest_us[0]).abs() < 1.5
        }
    );
    readings.earliest_us[0]
}

#[test]
fn readings_low_above_a_floor_are_those_of_added_waves() {
    let mut random = Random::new(5);
    let (mut moved, mut silent) = (0, 0);
    for number in 0..300 {
        let place = [random.between(0.6, 5.8), random.between(0.03, 0.4), random.between(0.0, 0.5)];
        let read = reads_us(&before_a_wall(place, GainProfile::Constant, ADDING));
        match heard_at(&images(place), |_| 1.0) {
            None => {
                silent += 1;
                assert!(read.is_nan(), "{number}: {read}");
            }
            // The clock counts whole microseconds.
            Some(heard_s) => assert!((read - 1e6 * heard_s).abs() < 1.5, "{number}: {read} {heard_s}"),
        }
        let alone = Physics { range_walk: true, ..Physics::PLAIN };
        let alone = reads_us(&before_a_wall(place, GainProfile::Constant, alone));
        moved += u32::from(!((read - alone).abs() < 20.0));
    }
    assert!(moved > 30 && silent < 150, "{moved} of 300 move, {silent} are silent");
}

// The gain at the beginning of the first sound applies to the whole sum.
#[test]
fn threshold_of_a_sum_follows_the_gain() {
    let mut random = Random::new(6);
    for _ in 0..60 {
        let place = [random.between(1.0, 5.0), random.between(0.03, 0.3), random.between(0.0, 0.2)];
        let gain = GainProfile::Linear;
        let full_s = 2.0 * MODULE.max_range_m / Air::default().speed_of_sound();
        let sounds = images(place);
        let first_s = sounds.first().map_or(0.0, |sound| sound.0);
        let threshold = 1.0 / gain_at(gain, first_s, full_s);
        let read = reads_us(&before_a_wall(place, gain, ADDING));
        match heard_at(&sounds, |_| threshold) {
            None => assert!(read.is_nan(), "{place:?}: {read}"),
            Some(heard_s) => assert!((read - 1e6 * heard_s).abs() < 1.5, "{place:?}: {read} {heard_s}"),
        }
    }
}

// An echo far from all others is heard as without interference.
#[test]
fn lone_echo_reads_as_without_interference() {
    for distance_m in [0.7, 2.0, 5.0, 5.8] {
        let world = |physics| {
            let wall = Wall::new(distance_m, -20.0, distance_m, 20.0);
            let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
            let robot = Robot::with_sensors(Pose::identity(), vec![Pose::identity()], MODULE);
            World::new(scene, vec![robot], Noise::NONE).unwrap().with_physics(physics).unwrap()
        };
        let alone = reads_us(&world(Physics { range_walk: true, ..Physics::PLAIN }));
        assert!((reads_us(&world(ADDING)) - alone).abs() < 1.5, "{distance_m} {alone}");
    }
}

/// Returns the percentage of first echoes that are followed within a burst by another at most 10 dB fainter.
fn overlapping(room: Option<f64>) -> f64 {
    let (mut firsts, mut with_another) = (0, 0);
    for number in 0..60 {
        let alcove = Alcove::random(number);
        let scene = alcove.scene().unwrap().with_room(room.map(|_| Room::DEFAULT)).unwrap();
        let robot = Robot { heights_m: vec![room.unwrap_or(0.3); alcove.robot().sensors.len()], ..alcove.robot() };
        let world = World::new(scene, vec![robot], Noise::NONE).unwrap();
        let matrix = world.ring_paths_above(0, 6, 10f64.powf(-0.5)).unwrap();
        let c = world.scene().air().speed_of_sound();
        let floor = MODULE.detection_floor(world.scene().air());
        for sensor in 0..matrix.sensors() {
            let own = matrix.between(sensor, sensor);
            let heard = |path: &&CriticalPath| path.length_m / c >= MODULE.blanking_s && path.amplitude >= floor;
            let Some(first) = own.iter().find(heard) else { continue };
            let near = |path: &&CriticalPath| {
                let behind_s = (path.length_m - first.length_m) / c;
                *path != first
                    && (0.0..MODULE.burst_s()).contains(&behind_s)
                    && path.amplitude >= 10f64.powf(-0.5) * first.amplitude
            };
            firsts += 1;
            with_another += u32::from(own.iter().any(|path| near(&path)));
        }
    }
    100.0 * f64::from(with_another) / f64::from(firsts)
}

#[test]
fn low_robots_hear_most_echoes_together_with_another() {
    let found = [None, Some(0.15), Some(0.3), Some(0.5)].map(overlapping);
    println!("flat, 0.15, 0.3, 0.5 m above the floor: {found:.1?} %");
    let [flat, low, middle, high] = found;
    assert!(flat < 12.0 && low > 60.0 && middle < 40.0 && high < 15.0, "{found:?}");
}
