//! Open simulations: step by step, steered from outside, stopped, and limited by the available memory.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eeruf_sim::*;

fn room_with(poles: Vec<Pole>, robots: Vec<Robot>) -> World {
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0]];
    let scene = Scene::new(Wall::polyline(&corners).collect(), poles, Air::default()).unwrap();
    World::new(scene, robots, Noise { bursts_per_s: 3.0, ..Noise::default() }).unwrap()
}

fn robot_at(x: f64) -> Robot {
    Robot::ring(Pose::new(Vector::new(x, 0.3), 0.2), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500)
}

/// Sensor, period, times by their bits, cause and path of a reading.
type Row = (SensorId, u32, [u64; 5], Cause, Option<HeardPath>);

fn rows(parts: &[Readings]) -> Vec<Row> {
    let of_part = |part: &Readings| -> Vec<_> {
        let times = |k: usize| [part.fired_s[k], part.t_echo_us[k], part.earliest_us[k], part.reference_us[k]];
        let row = |k: usize| {
            let [a, b, c, d] = times(k).map(f64::to_bits);
            let bits = [a, b, c, d, part.emitted_s[k].to_bits()];
            (part.id(k), part.period[k], bits, part.cause[k], part.path_of(k).cloned())
        };
        (0..part.len()).map(row).collect()
    };
    parts.iter().flat_map(of_part).collect()
}

// The blocks of a simulation together equal the whole simulation, bit for bit.
#[test]
fn blocks_of_a_simulation_equal_the_simulation() {
    for motion in [Motion::Still, Motion::Constant { velocity: Vector::new(0.05, -0.03), turn_rad_s: 0.1 }] {
        let world = Arc::new(room_with(vec![], vec![robot_at(-0.8), Robot { motion, ..robot_at(0.7) }]));
        let options = Options { seed: Some(5), ..Options::periods(40) };
        let whole = simulate(&world, Method::Conventional, &options).unwrap();
        let mut simulation =
            Simulation::ending(Arc::clone(&world), Method::Conventional, &options, Own::new(), Stop::default())
                .unwrap();
        let mut blocks = Vec::new();
        while !simulation.is_over() {
            blocks.push(simulation.step_periods(7, |_| true).unwrap());
        }
        assert_eq!(blocks.len(), 6);
        assert_eq!(rows(&blocks), rows(std::slice::from_ref(&whole)));
        let duration_s: f64 = blocks.iter().map(|block| block.duration_s).sum();
        assert!((duration_s - whole.duration_s).abs() < 1e-9);
    }
}

#[test]
fn readings_of_short_steps_keep_no_more_room() {
    let world = Arc::new(room_with(vec![], vec![robot_at(0.0)]));
    let mut simulation = Simulation::new(world, Method::Eeruf, &Options::default(), Stop::default()).unwrap();
    for _ in 0..5 {
        let step = simulation.step(0.06, |_| true).unwrap();
        let Readings { robot, period, kind, t_echo_us, path, emitted_s, .. } = &step;
        let room = [robot.capacity(), period.capacity(), kind.capacity(), t_echo_us.capacity(), path.capacity()];
        assert!(
            room.into_iter().chain([emitted_s.capacity()]).max() <= Some(2 * step.len()),
            "{} readings",
            step.len()
        );
        assert!(step.len() > 2 && step.len() < 20);
    }
}

// Steps to the next reading together equal the whole simulation, bit for bit.
#[test]
fn steps_to_next_reading_equal_the_simulation() {
    for motion in [Motion::Still, Motion::Constant { velocity: Vector::new(0.05, -0.03), turn_rad_s: 0.1 }] {
        let world = Arc::new(room_with(vec![], vec![robot_at(-0.8), Robot { motion, ..robot_at(0.7) }]));
        let options = Options { seed: Some(5), ..Options::periods(20) };
        let whole = simulate(&world, Method::Conventional, &options).unwrap();
        let mut simulation =
            Simulation::ending(Arc::clone(&world), Method::Conventional, &options, Own::new(), Stop::default())
                .unwrap();
        let (mut steps, mut time_s) = (Vec::new(), 0.0);
        while !simulation.is_over() {
            let step = simulation.step_to_reading(1.0, |_| true).unwrap();
            // Two sensors may be read at one moment, each when it has heard something or its window ends.
            assert!(step.len() <= 2 && simulation.time_s() >= time_s);
            let listened = |fired_s: &f64| (0.002..0.0361).contains(&(simulation.time_s() - fired_s));
            assert!(step.fired_s.iter().all(listened), "{} {:?}", simulation.time_s(), step.fired_s);
            time_s = simulation.time_s();
            steps.push(step);
        }
        assert_eq!(rows(&steps), rows(std::slice::from_ref(&whole)));
        assert!(steps.len() > 100, "{}", steps.len());
    }
    // No reading comes while all sensors are blanked.
    let mut simulation = Simulation::new(
        Arc::new(room_with(vec![], vec![robot_at(0.0)])),
        Method::Eeruf,
        &Options::default(),
        Stop::default(),
    )
    .unwrap();
    assert_eq!(simulation.step_to_reading(0.002, |_| true).unwrap().len(), 0);
    assert_eq!(simulation.time_s(), 0.002);
    assert_eq!(simulation.step_to_reading(-1.0, |_| true).unwrap_err().to_string(), "seconds is -1; expected 0 to 1e9");
}

// A steered robot drives on its given arc, and its sensors hear from there.
#[test]
fn steered_robot_drives_its_arc_and_hears_there() {
    let world = Arc::new(room_with(vec![], vec![robot_at(0.0)]));
    let mut simulation = Simulation::new(world, Method::Eeruf, &Options::default(), Stop::default()).unwrap();
    let before = simulation.step(0.6, |_| true).unwrap();
    simulation.set_velocity(0, 0.5, PI).unwrap();
    // A quarter of a circle of radius v / w.
    simulation.step(0.5, |_| true).unwrap();
    let moment = simulation.moment(0).unwrap();
    let (radius, heading) = (0.5 / PI, 0.2_f64);
    let expected = Vector::new(0.0, 0.3)
        + radius
            * Vector::new((heading + FRAC_PI_2).sin() - heading.sin(), heading.cos() - (heading + FRAC_PI_2).cos());
    assert!((moment.pose.translation.vector - expected).norm() < 1e-12);
    assert!((moment.pose.rotation.angle() - heading - FRAC_PI_2).abs() < 1e-12);
    simulation.set_velocity(0, 0.0, 0.0).unwrap();
    simulation.step(0.1, |_| true).unwrap();
    let after = simulation.step(0.6, |_| true).unwrap();
    let alone = |readings: &Readings| readings.reference_us[..8].iter().map(|us| us.to_bits()).collect::<Vec<_>>();
    assert_ne!(alone(&before), alone(&after));
    assert!((simulation.time_s() - 1.8).abs() < 1e-9 && !simulation.is_over());
}

#[test]
fn what_cannot_be_simulated_is_said_and_nothing_is_lost() {
    let world = Arc::new(room_with(vec![], vec![robot_at(0.0)]));
    let mut simulation =
        Simulation::new(Arc::clone(&world), Method::Eeruf, &Options::default(), Stop::default()).unwrap();
    let refused = [
        (simulation.step(-1.0, |_| true).unwrap_err(), "seconds is -1; expected 0 to 1e9"),
        (simulation.step(f64::NAN, |_| true).unwrap_err(), "seconds is NaN; expected 0 to 1e9"),
        (simulation.set_velocity(1, 0.0, 0.0).unwrap_err(), "robot 2; expected one of 1"),
        (simulation.set_velocity(0, 51.0, 0.0).unwrap_err(), "v_m_s is 51; expected -50 to 50"),
    ];
    for (error, message) in refused {
        assert_eq!(error.to_string(), message);
    }
    assert_eq!(simulation.step(0.12, |_| false).unwrap_err(), SimulationError::Stopped);
    // A stopped step has no effect.
    assert_eq!(simulation.step(0.24, |_| true).unwrap().len(), 8 * 4);
    let error = simulate(&world, Method::Eeruf, &Options::periods(u32::MAX)).unwrap_err();
    assert!(matches!(error, SimulationError::Memory { readings } if readings > 30_000_000_000), "{error}");
}

#[test]
fn two_robots_in_one_place_are_refused() {
    let scene = Scene::new(vec![Wall::new(5.0, 2.0, -5.0, 2.0)], vec![], Air::default()).unwrap();
    let error = World::new(scene, vec![robot_at(0.0), robot_at(0.5)], Noise::default()).unwrap_err();
    let message = "robots 1 and 2 are 0.500 m apart; expected more than 0.600 m, the sum of their radii";
    assert_eq!(error.to_string(), message);
}

// A query about thousands of poles stops when asked to.
#[test]
fn question_about_many_poles_stops_when_asked() {
    let pole = |k: i32| Pole::new(f64::from(k % 50) * 0.07 - 1.8, f64::from(k / 50) * 0.07 - 1.8, 0.004);
    let world = room_with(
        (0..2500).map(pole).collect(),
        vec![Robot::ring(Pose::new(Vector::new(1.85, 1.85), 0.0), 1, 0.0, 0.0, Transducer::POLAROID_6500)],
    );
    let mut tracer = Tracer::new();
    let stop = tracer.stop.clone();
    let began = Instant::now();
    let stopper = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(200));
        stop.stop();
        Instant::now()
    });
    let receivers: Vec<_> = (0..20).map(|k| Point::new(1.7, 0.01 * f64::from(k))).collect();
    let mut paths = Paths::default();
    let source = Point::new(-1.9, -1.9);
    let traced = tracer.trace(world.scene(), source, &receivers, Limits::order(6), &mut paths);
    let (ended, stopped) = (Instant::now(), stopper.join().unwrap());
    assert_eq!(traced, Err(PathsError::Stopped));
    assert!(paths.is_empty());
    // Without the stop the query takes many seconds.
    assert!(ended - stopped < Duration::from_secs(5), "{:?} after {:?}", ended - stopped, stopped - began);
}

// A flow ring takes the changes of its own motion for crosstalk unless it hears how the robot moves.
#[test]
fn flow_ring_of_a_steered_robot_accepts_echoes_while_driving() {
    let world = Arc::new(room_with(vec![], vec![robot_at(-1.0)]));
    let mut simulation = Simulation::new(world, Method::Flow, &Options::default(), Stop::default()).unwrap();
    simulation.set_velocity(0, 0.3, 0.1).unwrap();
    let readings = simulation.step(3.0, |_| true).unwrap();
    let echoes = (0..readings.len()).filter(|&k| readings.is_accepted(k) && readings.t_echo_us[k].is_finite());
    assert!(3 * echoes.count() > readings.len());
}
