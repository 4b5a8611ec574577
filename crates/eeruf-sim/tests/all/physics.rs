//! Hearing between robots, bodies, and fading that does not depend on the order of queries.

use std::f64::consts::{FRAC_PI_2, PI};

use eeruf_sim::*;

const C: f64 = 343.2;

/// Makes a robot with a single sensor that looks ahead.
fn single(x: f64, y: f64, heading: f64) -> Robot {
    let pose = Pose::new(Vector::new(x, y), heading);
    Robot::with_sensors(pose, vec![Pose::identity()], Transducer::POLAROID_6500)
}

fn open_air(robots: Vec<Robot>) -> Result<World, WorldError> {
    World::new(Scene::new(vec![], vec![], Air::default())?, robots, Noise::NONE)
}

fn run(world: &World) -> Readings {
    simulate(world, Method::Conventional, &Options::periods(20)).unwrap()
}

/// Returns the number of readings of the first robot that came from the second.
fn heard_of_the_second(other: Transducer) -> usize {
    let facing = Robot { transducer: other, ..single(2.0, 0.0, PI) };
    let readings = run(&open_air(vec![single(0.0, 0.0, 0.0), facing]).unwrap());
    let crosstalk = |k: &usize| readings.robot[*k] == 0 && readings.cause[*k] == Cause::Crosstalk;
    (0..readings.len()).filter(crosstalk).count()
}

#[test]
fn unlike_transducers_hear_each_other_if_their_bands_overlap() {
    let same = Transducer::POLAROID_6500;
    let expected = heard_of_the_second(same);
    assert!(expected > 15, "{expected}");
    // The other transducer may listen and send in any way.
    for other in [
        Transducer { gain: GainProfile::Linear, ..same },
        Transducer { max_range_m: 5.0, ..same },
        Transducer { blanking_s: 1e-3, ..same },
        Transducer { radius_m: 8e-3, ..same },
        Transducer { frequency_hz: 47_000.0, ..same },
    ] {
        assert_eq!(heard_of_the_second(other), expected, "{other:?}");
    }
    assert_eq!(heard_of_the_second(Transducer { frequency_hz: 46_000.0, ..same }), 0);
    assert_eq!(heard_of_the_second(Transducer::HC_SR04), 0);
}

// A path between two kinds of transducers has the sender's pattern at its start and the listener's at its end.
#[test]
fn path_has_senders_and_listeners_patterns() {
    let scene = Scene::new(vec![], vec![], Air::default()).unwrap();
    let sending = Transducer { frequency_hz: 48_000.0, beam: Beam::CutAt90, ..Transducer::HC_SR04 };
    let hearing = Transducer::POLAROID_6500;
    let (emitter, listener) = (Pose::rotation(0.1), Pose::new(Vector::new(1.5, 0.0), PI - 0.05));
    let limits = Limits::order(0);
    let listeners = [listener];
    let query = CrosstalkQuery::new(&scene, &listeners, &hearing, limits, 0.0);
    let (mut matrix, mut tracer) = (CrosstalkMatrix::new(), Tracer::new());
    matrix.compute_between(&[emitter], &sending, &mut tracer, &query).unwrap();
    let k = sending.wave_number(Air::default());
    let patterns = Piston::new(k, sending.radius_m).pattern(0.1) * Piston::new(k, hearing.radius_m).pattern(0.05);
    let air = 10f64.powf(-Air::default().absorption_db_per_m(48_000.0) * 1.5 / 20.0) / 1.5;
    assert!((matrix.paths()[0].amplitude / (patterns * air) - 1.0).abs() < 1e-12);
}

/// Returns the reading of the first robot's sensor alone, as a distance in metres.
fn sees(world: &World) -> f64 {
    let readings = run(world);
    let first = (0..readings.len()).find(|&k| readings.robot[k] == 0).unwrap();
    readings.reference_us[first] * 1e-6 * C / 2.0
}

/// Makes a world of a sensor before a wall under `plain`, where the echo's time gives the distance.
fn before_a_wall(robots: Vec<Robot>) -> Result<World, WorldError> {
    let wall = Wall::new(4.0, -5.0, 4.0, 5.0).with_faces(Faces::Both);
    World::new(Scene::new(vec![wall], vec![], Air::default())?, robots, Noise::NONE)?.with_physics(Physics::PLAIN)
}

// A robot with a body reflects and shades sound of others, but not its own.
#[test]
fn body_reflects_and_shades_for_others_alone() {
    let triangle = Outline::new(&[[-0.3, -0.4], [0.5, 0.0], [-0.3, 0.4]]).unwrap();
    let watcher = Robot { body: Some(Body::Disc(0.2)), ..single(0.0, 0.0, 0.0) };
    let with = |body| sees(&before_a_wall(vec![watcher.clone(), Robot { body, ..single(2.0, 0.0, 0.0) }]).unwrap());
    assert!((with(None) - 4.0).abs() < 1e-3, "transparent, and its own body is no echo");
    assert!((with(Some(Body::Disc(0.3))) - 1.7).abs() < 1e-3);
    assert!((with(Some(Body::Box(0.6, 1.0))) - 1.7).abs() < 1e-3);
    assert!((with(Some(Body::Polygon(triangle))) - 1.7).abs() < 1e-3, "its flat back");
    // The body shades the wall, and its slanting side sends the echo elsewhere.
    let turned = Robot { body: Some(Body::Box(1.0, 1.0)), ..single(2.0, 0.0, 0.5) };
    assert!(sees(&before_a_wall(vec![watcher, turned]).unwrap()).is_nan());
}

#[test]
fn a_body_shades_one_robot_from_another() {
    let crosstalk = |body| {
        let between = Robot { transducer: Transducer::HC_SR04, body, ..single(1.0, 0.0, FRAC_PI_2) };
        let readings = run(&open_air(vec![single(0.0, 0.0, 0.0), single(2.0, 0.0, PI), between]).unwrap());
        readings.cause.iter().filter(|&&cause| cause == Cause::Crosstalk).count()
    };
    assert!(crosstalk(None) > 15);
    assert_eq!(crosstalk(Some(Body::Disc(0.3))), 0);
    assert_eq!(crosstalk(Some(Body::Box(0.3, 0.3))), 0);
}

// A body moves with its robot, and a contact ends the run.
#[test]
fn moving_body_ends_the_run_where_it_touches() {
    let coming = |velocity: f64, body| Robot {
        motion: Motion::Constant { velocity: Vector::new(velocity, 0.0), turn_rad_s: 0.0 },
        body: Some(body),
        ..single(2.0, 0.0, 0.0)
    };
    let world = |velocity, body| before_a_wall(vec![single(0.0, 0.0, 0.0), coming(velocity, body)]).unwrap();
    for body in [Body::Disc(0.3), Body::Box(0.6, 0.6)] {
        let readings = run(&world(-0.5, body));
        let own: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
        for &k in &own {
            let distance_m = 1.7 - 0.5 * readings.fired_s[k];
            assert!((readings.reference_us[k] * 1e-6 * C / 2.0 - distance_m).abs() < 2e-3, "{body:?}, {k}");
        }
    }
    let error =
        simulate(&world(2.0, Body::Disc(0.3)), Method::Conventional, &Options::periods(60)).unwrap_err().to_string();
    let expected = "s: the body of robot 2 touches a wall, a pole, another robot's body or one of its sensors; \
                    expected it clear of them";
    assert!(error.ends_with(expected), "{error}");
}

#[test]
fn bodies_and_sensors_that_are_inside_something_are_refused() {
    let refused = |world: Result<World, WorldError>| world.unwrap_err().to_string();
    let disc = |radius_m, x| Robot { body: Some(Body::Disc(radius_m)), ..single(x, 0.0, 0.0) };
    assert_eq!(
        refused(before_a_wall(vec![disc(0.3, 3.8)])),
        "robot 1 touches wall 0; expected it to stand free at its pose"
    );
    assert_eq!(
        refused(before_a_wall(vec![disc(0.3, 0.0), disc(0.3, 0.5)])),
        "the bodies of robots 1 and 2 overlap; expected them apart"
    );
    let reaching =
        Robot { sensors: vec![Pose::translation(0.6, 0.0)], body: Some(Body::Disc(0.2)), ..single(3.4, 0.0, 0.0) };
    assert_eq!(
        refused(before_a_wall(vec![reaching.clone()])),
        "robot 1: sensor 1 is inside wall 0; expected it in the open"
    );
    assert_eq!(
        refused(open_air(vec![reaching, disc(0.3, 4.0)])),
        "robot 1: sensor 1 is inside robot 2; expected it in the open"
    );
    assert!(refused(open_air(vec![disc(-1.0, 0.0)])).contains("body"));
}

/// Simulates a moving robot, alone or beside another that it cannot hear but whose paths are searched for in between.
fn moving(physics: Physics, beside: bool) -> Readings {
    let room = Wall::polyline(&[[-3.0, -2.0], [3.0, -2.0], [3.0, 2.0], [-3.0, 2.0], [-3.0, -2.0]]).collect();
    let motion = Motion::Constant { velocity: Vector::new(0.1, 0.02), turn_rad_s: 0.2 };
    let ring = |x, transducer| Robot::ring(Pose::new(Vector::new(x, 0.0), 0.3), 4, 0.26, 0.3, transducer);
    let mut robots = vec![Robot { motion, ..ring(-1.0, Transducer::POLAROID_6500) }];
    if beside {
        robots.push(ring(1.0, Transducer::HC_SR04));
    }
    let world = World::new(Scene::new(room, vec![], Air::default()).unwrap(), robots, Noise::default()).unwrap();
    let world = world.with_max_order(2).and_then(|world| world.with_physics(physics)).unwrap();
    simulate(&world, Method::Eeruf, &Options::periods(40)).unwrap()
}

#[test]
fn chance_does_not_depend_on_which_paths_were_met_before() {
    let of_the_first = |readings: &Readings| -> Vec<u64> {
        let own = (0..readings.len()).filter(|&k| readings.robot[k] == 0);
        own.map(|k| readings.earliest_us[k].to_bits()).collect()
    };
    let times = |physics, beside| of_the_first(&moving(physics, beside));
    assert_eq!(times(Physics::DEFAULT, false), times(Physics::DEFAULT, true));
    assert_ne!(times(Physics::PLAIN, false), times(Physics::PLAIN, true), "plain numbers paths as it meets them");
}

#[test]
fn a_robot_that_stands_sees_an_echo_fade_slowly() {
    let wall = Wall::new(5.0, -5.0, 5.0, 5.0).with_faces(Faces::Both);
    let steps = |fading_time_s: f64| {
        let noise = Noise { fading_db_rms: 3.0, jitter_us_rms: 0.0, ..Noise::NONE };
        let scene = Scene::new(vec![wall], vec![], Air::default()).unwrap();
        let physics = Physics { fading_time_s, ..Physics::DEFAULT };
        let world = World::new(scene, vec![single(0.0, 0.0, 0.0)], noise).and_then(|world| world.with_physics(physics));
        // Faint echoes are heard later, so that the fading can be read from the times.
        let readings = simulate(&world.unwrap(), Method::Conventional, &Options::periods(400)).unwrap();
        let (times, mut step, mut spread) = (&readings.earliest_us, 0.0, 0.0);
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        for pair in times.windows(2) {
            step += (pair[1] - pair[0]).powi(2);
            spread += 2.0 * (pair[1] - mean).powi(2);
        }
        step / spread
    };
    // The mean square of a step over twice the variance is one minus the correlation between readings 60 ms apart.
    let (slow, fast) = (steps(1.0), steps(1e-3));
    assert!(slow < 0.05, "{slow}");
    assert!((fast - 1.0).abs() < 0.2, "{fast}");
}
