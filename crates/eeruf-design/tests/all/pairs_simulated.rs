//! Pairs of features (limits of single sensors, several echoes, adaptation), from ring file to simulated readings.

use std::f64::consts::TAU;

use eeruf_core::Micros;
use eeruf_design::{Effort, RingSpec};
use eeruf_sim::{Air, Cause, Method, Noise, Options, Pose, Readings, Robot, Scene, Transducer, Wall, World, simulate};

const CAR: &str = include_str!("../../../../rings/car-12.toml");
const PAPER: &str = include_str!("../../../../rings/paper-12.toml");

fn spec(text: &str) -> RingSpec {
    RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The robot of a ring file with the schedule of two phases found for it, in a corridor 3 m wide with external noise,
/// `bursts_per_s`; if that is 0, there are no walls either.
fn corridor(spec: &RingSpec, bursts_per_s: f64) -> World {
    let circle = Robot::ring(Pose::identity(), spec.sensors, TAU / spec.sensors as f64, 0.2, Transducer::HC_SR04);
    let of_layout = || Robot::of_ring(&spec.robot_ring(), Pose::identity(), Some(circle.sensors)).expect("a robot");
    let mut robot = spec.room_robot().map_or_else(|_| of_layout(), |of_file| of_file.robot);
    let design = spec.shortest(&Effort::default(), &mut ()).expect("a schedule");
    robot.schedule = Some(design.schedule);
    robot.period = design.schedule.period();
    let mut walls = vec![Wall::new(-9.0, -1.5, 9.0, -1.5), Wall::new(9.0, 1.5, -9.0, 1.5)];
    walls.truncate(if bursts_per_s > 0.0 { 2 } else { 0 });
    let scene = Scene::new(walls, vec![], Air::default()).expect("a scene");
    let noise = Noise { bursts_per_s, burst_db: 40.0, jitter_us_rms: 10.0, ..Noise::default() };
    World::new(scene, vec![robot], noise).expect("a world")
}

fn run(world: &World, method: Method, options: &Options) -> Readings {
    simulate(world, method, options).unwrap_or_else(|error| panic!("{method}: {error}"))
}

/// The longest time between consecutive firings of sensor 0 in the last tenth of the readings, in microseconds.
fn last_period(readings: &Readings) -> f64 {
    let fired: Vec<_> = (0..readings.len()).filter(|&k| readings.sensor[k] == 0).map(|k| readings.fired_s[k]).collect();
    let last = &fired[fired.len() * 9 / 10..];
    last.windows(2).map(|pair| 1e6 * (pair[1] - pair[0])).fold(0.0, f64::max)
}

/// Checks that each sensor hears as far as its own window, that enough is accepted, and that at most one reading in
/// `of` is foreign. Between two walls the share depends on which of several equal schedules the search takes.
fn are_right(spec: &RingSpec, readings: &Readings, of: usize) {
    let requirements = spec.problem().requirements;
    for k in 0..readings.len() {
        let window = requirements.window_of(readings.sensor[k].into()).as_micros();
        assert!(
            !(readings.t_echo_us[k] > f64::from(window)),
            "sensor {}: {}",
            readings.sensor[k],
            readings.t_echo_us[k]
        );
    }
    let accepted: Vec<_> = (0..readings.len()).filter(|&k| readings.is_accepted(k)).collect();
    let foreign = accepted.iter().filter(|&&k| readings.cause[k] == Cause::Crosstalk).count();
    assert!(accepted.len() > readings.len() / 10, "{} of {}", accepted.len(), readings.len());
    assert!(foreign * of <= accepted.len(), "{foreign} of {}", accepted.len());
}

/// The share of readings that are accepted.
fn accepted(readings: &Readings) -> f64 {
    (0..readings.len()).filter(|&k| readings.is_accepted(k)).count() as f64 / readings.len() as f64
}

/// Checks that noise slows the ring down to the last rung of its ladder, and that the readings pass [`are_right`].
fn slows_down(spec: &RingSpec, noisy: &Readings, calm: &Readings, period: Micros, of: usize) {
    let period = f64::from(period.as_micros());
    let (slow, fast) = (last_period(noisy) / period, last_period(calm) / period);
    assert!(slow > 1.55 && fast < 1.2, "{slow} {fast}");
    are_right(spec, noisy, of);
}

#[test]
fn car_with_limits_and_several_echoes() {
    let spec = spec(CAR);
    let world = corridor(&spec, 10.0);
    let several = run(&world, Method::MultiEcho, &Options::periods(200));
    are_right(&spec, &several, 2);
    // Behind a burst there is the wall.
    let one = run(&world, Method::Eeruf, &Options::periods(200));
    assert!(accepted(&several) > accepted(&one) + 0.02, "{} {}", accepted(&several), accepted(&one));
}

#[test]
fn car_with_limits_adapts() {
    let spec = spec(CAR);
    let [calm, noisy] = [0.0, 40.0].map(|bursts_per_s| {
        let world = corridor(&spec, bursts_per_s);
        (run(&world, Method::Adaptive, &Options::periods(400)), world.robots()[0].period)
    });
    slows_down(&spec, &noisy.0, &calm.0, calm.1, 10);
}

#[test]
fn ring_with_several_echoes_adapts() {
    let spec = spec(PAPER);
    let [calm, noisy] = [0.0, 60.0].map(|bursts_per_s| {
        let world = corridor(&spec, bursts_per_s);
        (run(&world, Method::AdaptiveMultiEcho, &Options::periods(400)), world.robots()[0].period)
    });
    slows_down(&spec, &noisy.0, &calm.0, calm.1, 5);
}
