//! The event simulation: Set I, ground truth, motion, clocks, bursts, random numbers.

use std::f64::consts::FRAC_PI_2;

use eeruf_core::{Micros, ReadingKind};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

const C: f64 = 343.2;

/// Makes a world under `plain`, whose times have closed forms: an echo is heard when it begins.
fn world(walls: Vec<Wall>, robots: Vec<Robot>, noise: Noise) -> World {
    let world = World::new(Scene::new(walls, vec![], Air::default()).unwrap(), robots, noise);
    world.and_then(|world| world.with_physics(Physics::PLAIN)).unwrap()
}

/// Makes a wall across the y axis that reflects downwards.
fn wall_at(y: f64) -> Wall {
    Wall::new(9.0, y, -9.0, y).with_material(Material::PERFECT)
}

/// Makes a robot at the origin with a single sensor that looks along the y axis.
fn single() -> Robot {
    Robot::with_sensors(Pose::rotation(FRAC_PI_2), vec![Pose::identity()], Transducer::POLAROID_6500)
}

fn run(world: &World, method: Method, periods: u32) -> Readings {
    simulate(world, method, &Options::periods(periods)).unwrap()
}

/// Returns the median over random geometries of Set I of a share, in per cent.
fn set_one(physics: Physics, method: Method, value: fn(&Summary) -> f64) -> f64 {
    let alcoves: Vec<u64> = (0..80).collect();
    let mut shares = sweep(&alcoves, |&number| {
        let world = Alcove::random(number).world().unwrap().with_physics(physics).unwrap();
        100.0 * value(&run(&world, method, 1000).summary())
    });
    quantile(&mut shares, 0.5)
}

#[test]
fn set_one_eeruf_removes_crosstalk_comparison_does_not() {
    let of = |method, value| set_one(Physics::PLAIN, method, value);
    let conventional = of(Method::Conventional, |summary| summary.wrong_of_all);
    let comparison = of(Method::Comparison, |summary| summary.wrong_of_all);
    let eeruf = of(Method::Eeruf, |summary| summary.wrong_of_all);
    let crosstalk = of(Method::Eeruf, |summary| summary.crosstalk_of_all);
    let rejected = of(Method::Eeruf, |summary| summary.rejected);
    assert!(conventional > 25.0 && conventional < 50.0, "{conventional}");
    assert!(comparison > 15.0 && comparison < conventional, "{comparison}");
    // Most of the rest are a sensor's own echoes that are barely audible.
    assert!(eeruf < 3.0 && crosstalk < 1.0, "{eeruf} {crosstalk}");
    assert!(rejected > 25.0 && rejected < 75.0, "{rejected}");
}

// With slow fading, edges and range walk too, it is alternation that removes crosstalk.
#[test]
fn alternation_removes_crosstalk_under_full_physics() {
    let crosstalk = |method| set_one(Physics::DEFAULT, method, |summary| summary.crosstalk_of_all);
    let (conventional, comparison) = (crosstalk(Method::Conventional), crosstalk(Method::Comparison));
    let eeruf = crosstalk(Method::Eeruf);
    assert!(conventional > 25.0 && comparison > 0.8 * conventional, "{conventional} {comparison}");
    assert!(eeruf < 1.0, "{eeruf}");
}

#[test]
fn a_robot_that_is_alone_reads_the_same_with_a_body_and_without() {
    for physics in [Physics::PLAIN, Physics::DEFAULT] {
        let alcove = Alcove::random(3);
        let times = |body| {
            let robot = Robot { body, ..alcove.robot() };
            let world = World::new(alcove.scene().unwrap(), vec![robot], Noise::default()).unwrap();
            let readings = run(&world.with_physics(physics).unwrap(), Method::Conventional, 100);
            readings.t_echo_us.iter().map(|us| us.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(times(None), times(Some(Body::Disc(0.3))), "{physics}");
    }
}

#[test]
fn a_sensor_that_fires_alone_in_quiet_air_is_never_wrong() {
    for number in 0..20 {
        let alcove = Alcove::random(number);
        let world = World::new(alcove.scene().unwrap(), vec![alcove.robot()], Noise::NONE).unwrap();
        let summary = run(&world, Method::Sequential, 100).summary();
        // With one by one, the room is not always silent when the next sensor fires.
        assert!(summary.wrong_of_all <= 0.1, "{number}: {summary:?}");
        let one = Robot { sensors: vec![alcove.robot().sensors[3]], ..alcove.robot() };
        let alone = World::new(alcove.scene().unwrap(), vec![one], Noise::NONE).unwrap();
        for method in [Method::Conventional, Method::Sequential, Method::Median] {
            // The farthest audible sound takes 62 ms and could outlast a period of 60 ms.
            assert_eq!(run(&alone, method, 100).summary().wrong_of_all, 0.0, "{number} {method}");
        }
    }
}

/// Makes two sensors 0.4 m apart that face a wall 2 m away; the second fires 15 ms after the first.
fn two_before_a_wall() -> World {
    let sensors = vec![Pose::new(Vector::new(0.0, 0.2), 0.0), Pose::new(Vector::new(0.0, -0.2), 0.0)];
    let robot = Robot::with_sensors(Pose::rotation(FRAC_PI_2), sensors, Transducer::POLAROID_6500);
    world(vec![wall_at(3.0)], vec![robot], Noise::NONE)
}

#[test]
fn every_reading_knows_to_the_microsecond_what_caused_it() {
    let world = two_before_a_wall();
    let readings = run(&world, Method::Conventional, 10);
    assert_eq!(readings.len(), 20);
    let own_us = (2.0 * 3.0 / C * 1e6).floor();
    let crossed_us = (0.4f64.hypot(6.0) / C * 1e6).floor();
    for reading in 0..readings.len() {
        let first = readings.sensor[reading] == 0;
        // The second sensor counts the first one's sound from its own firing, 15 ms later.
        let (t_echo, cause, emitter, order) =
            if first { (own_us, Cause::Own, 0, 1) } else { (crossed_us - 15_000.0, Cause::Crosstalk, 0, 1) };
        assert_eq!(readings.kind[reading], ReadingKind::Accepted);
        assert_eq!(readings.t_echo_us[reading], t_echo, "{reading}");
        assert_eq!(readings.cause[reading], cause);
        assert!((readings.reference_us[reading] - 6.0 / C * 1e6).abs() < 1e-3);
        let path = readings.path_of(reading).unwrap();
        assert_eq!((path.emitter.sensor, path.receiver, path.order), (emitter, readings.id(reading), order));
        assert_eq!(*path.bounces, [Bounce::Wall(0)]);
        let sent = readings.fired_s[reading] - if first { 0.0 } else { 0.015 };
        assert!((readings.emitted_s[reading] - sent).abs() < 1e-12);
    }
    let rows = readings.attribution(500.0);
    assert_eq!(rows.len(), 1);
    let [receiver, emitter] = [1, 0].map(|sensor| SensorId { robot: 0, sensor });
    assert_eq!((rows[0].receiver, rows[0].emitter, rows[0].cause), (receiver, Some(emitter), Cause::Crosstalk));
    assert_eq!((rows[0].wrong, rows[0].accepted, rows[0].order), (10, 10, Some(1)));
}

#[test]
fn the_figures_of_two_sensors_before_a_wall_are_known() {
    let world = two_before_a_wall();
    let conventional = run(&world, Method::Conventional, 10).summary();
    assert_eq!((conventional.wrong_of_all, conventional.wrong_of_accepted), (0.5, Some(0.5)));
    assert_eq!((conventional.rejected, conventional.good_lost), (0.0, Some(0.0)));
    assert_eq!((conventional.crosstalk_of_all, conventional.starved), (0.5, 0));
    assert!((conventional.readings_per_s - 2.0 / 0.06).abs() < 1e-9);
    assert!((conventional.age_ms.median - 60.0).abs() < 1e-9);
    let sequential = run(&world, Method::Sequential, 10).summary();
    assert_eq!((sequential.wrong_of_all, sequential.wrong_before_filter), (0.0, 0.0));
    assert_eq!(run(&world, Method::Eeruf, 100).summary().wrong_of_all, 0.0);
}

#[test]
fn good_readings_of_a_moving_robot_differ_by_2_v_dt_over_c() {
    let v = 0.5;
    let mut robot = single();
    robot.motion = Motion::Constant { velocity: Vector::new(0.0, v), turn_rad_s: 0.0 };
    robot.t_delta = Micros::new(300);
    let world = world(vec![wall_at(5.0)], vec![robot.clone()], Noise::NONE);
    for method in [Method::Conventional, Method::Eeruf] {
        let readings = run(&world, method, 40);
        for pair in 1..readings.len() {
            let dt = readings.fired_s[pair] - readings.fired_s[pair - 1];
            let change = readings.t_echo_us[pair] - readings.t_echo_us[pair - 1];
            // The formula holds to first order in v / c, and the clock counts whole microseconds.
            let expected = -2e6 * v * dt / C;
            assert!((change - expected).abs() < 2.0, "{method}: {change} {expected}");
        }
        assert_eq!(readings.summary().wrong_of_all, 0.0);
    }
    // At that speed over such a period no reading passes, unless odometry gives the expected change.
    robot.motion = Motion::Constant { velocity: Vector::new(0.0, 1.0), turn_rad_s: 0.0 };
    for (odometry, accepted) in [(false, 0), (true, 38)] {
        let robot = Robot { odometry, ..robot.clone() };
        let scene = Scene::new(vec![wall_at(5.0)], vec![], Air::default()).unwrap();
        let world = World::new(scene, vec![robot], Noise::NONE).unwrap().with_physics(Physics::PLAIN).unwrap();
        assert_eq!(run(&world, Method::Comparison, 39).summary().accepted, accepted);
    }
}

#[test]
fn a_robot_that_turns_sees_the_wall_come_and_go() {
    let mut robot = single();
    robot.motion = Motion::Constant { velocity: Vector::zeros(), turn_rad_s: 1.0 };
    let world = world(vec![wall_at(2.0)], vec![robot], Noise::NONE);
    let readings = run(&world, Method::Conventional, 100);
    let heard: Vec<_> = readings.reference_us.iter().map(|us| !us.is_nan()).collect();
    assert!(heard[0] && !heard[50]);
    assert_eq!(readings.summary().wrong_of_all, 0.0);
}

#[test]
fn a_fast_clock_reads_longer_times_and_fires_sooner() {
    let mut robot = single();
    robot.clock = Clock { offset_us: u32::MAX - 100_000, drift_ppm: 500.0 };
    let world = world(vec![wall_at(3.0)], vec![robot], Noise::NONE);
    let readings = run(&world, Method::Conventional, 1000);
    // A true clock counts 1000 periods in 60 s.
    assert_eq!(readings.len(), 1001);
    let expected = (6.0 / C * 1e6 * 1.0005_f64).floor();
    assert!(readings.t_echo_us.iter().all(|&us| (us - expected).abs() <= 1.0));
    assert!((readings.fired_s[1000] - 60.0 / 1.0005).abs() < 1e-6);
}

#[test]
fn crosstalk_between_robots_wanders_with_their_clocks() {
    let [one, mut other] = [-0.2, 0.2].map(|x| Robot { pose: Pose::new(Vector::new(x, 0.0), FRAC_PI_2), ..single() });
    other.clock.drift_ppm = 300.0;
    other.start = Micros::new(3_000);
    let world = world(vec![wall_at(3.0)], vec![one, other], Noise::NONE);
    let readings = run(&world, Method::Conventional, 300);
    let robots = &readings.robot;
    let of = |robot| (0..readings.len()).filter(move |&reading| robots[reading] == robot);
    // The first robot fires 3 ms before the second, which therefore hears it 3 ms early at first, and later less so:
    // its clock gains 18 us in a period.
    let fooled: Vec<_> = of(1).filter(|&reading| readings.cause[reading] == Cause::Crosstalk).collect();
    assert!((160..=170).contains(&fooled.len()), "{}", fooled.len());
    let change = readings.t_echo_us[fooled[100]] - readings.t_echo_us[fooled[0]];
    assert!((change - 1800.0).abs() < 5.0, "{change}");
    assert!(of(0).take(150).all(|reading| readings.cause[reading] == Cause::Own));
}

#[test]
fn bursts_from_outside_are_heard_and_the_filter_refuses_them() {
    let noise = Noise { bursts_per_s: 10.0, burst_db: 20.0, ..Noise::NONE };
    let world = world(vec![wall_at(5.0)], vec![single()], noise);
    let conventional = run(&world, Method::Conventional, 1000);
    let bursts = conventional.cause.iter().filter(|&&cause| cause == Cause::External).count();
    // A burst comes between blanking and the echo at 29 ms with a probability of 10/s times 26.8 ms, about 23 %.
    assert!((190..290).contains(&bursts), "{bursts}");
    let eeruf = run(&world, Method::Eeruf, 1000).summary();
    assert!(conventional.summary().wrong_of_all > 0.15 && eeruf.wrong_of_all < 0.01);
}

// An equal seed gives equal readings on any number of threads.
#[test]
fn equal_seeds_give_equal_readings_on_any_threads() {
    let jobs: Vec<(u64, Method)> = (0..4).flat_map(|number| Method::ALL.map(|method| (number, method))).collect();
    let all = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            sweep(&jobs, |&(number, method)| {
                let world = Alcove::random(number).world().unwrap();
                let readings = run(&world, method, 50);
                let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                (bits(&readings.t_echo_us), bits(&readings.fired_s), readings.cause, readings.path, readings.kind)
            })
        })
    };
    assert_eq!(all(1), all(2));
    let world = Alcove::random(1).world().unwrap();
    let other = Options { seed: Some(2), ..Options::periods(50) };
    let (a, b) = (run(&world, Method::Eeruf, 50), simulate(&world, Method::Eeruf, &other).unwrap());
    assert_ne!(a.t_echo_us, b.t_echo_us);
}

#[test]
fn every_method_runs_on_one_sensor_and_on_64() {
    for sensors in [1, 64] {
        let robot = Robot {
            period: Micros::from_millis(200),
            ..Robot::ring(Pose::identity(), sensors, 0.09, 0.3, Transducer::HC_SR04)
        };
        let room = Wall::polyline(&[[-3.0, -2.0], [3.0, -2.0], [3.0, 2.5], [-3.0, 2.5], [-3.0, -2.0]]).collect();
        let scene = Scene::new(room, vec![], Air::default()).unwrap();
        let world = World::new(scene, vec![robot], Noise::default()).unwrap().with_max_order(2).unwrap();
        for method in Method::ALL {
            let readings = run(&world, method, 12);
            assert!(readings.len() >= sensors, "{method}");
            assert!(readings.t_echo_us.iter().all(|us| us.is_nan() || (117.0..=36_000.0).contains(us)), "{method}");
        }
    }
}

#[test]
fn a_simulation_stops_when_it_is_told_to() {
    let world = Alcove::random(0).world().unwrap();
    let stopped = simulate_while(&world, Method::Eeruf, &Options::periods(1_000_000), |share| share < 1e-6);
    assert_eq!(stopped.unwrap_err(), SimulationError::Stopped);
}

#[test]
fn what_a_method_cannot_do_is_said_once() {
    let robot = Robot { window: Micros::from_millis(58), ..Alcove::random(0).robot() };
    let world = World::new(Alcove::random(0).scene().unwrap(), vec![robot], Noise::NONE).unwrap();
    let error = simulate(&world, Method::Eeruf, &Options::default()).unwrap_err().to_string();
    assert!(error.starts_with("robot 1, method eeruf: a listening window of 58 ms;"), "{error}");
    let median = Options { median_of: 0, ..Options::default() };
    let error = simulate(&world, Method::Median, &median).unwrap_err().to_string();
    assert_eq!(error, "the median of 0 readings; expected 1 to 15");
}
