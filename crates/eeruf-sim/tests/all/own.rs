//! Own firing methods and filters, schedules and scenes that change during a simulation.

use std::sync::Arc;

use eeruf_core::{EchoFilter, MAX_SENSORS, Micros, Phase, ReadingKind};
use eeruf_sim::*;

/// Makes an alcove in which sensors hear each other, and a robot in it.
fn alcove(robots: Vec<Robot>) -> Arc<World> {
    let walls = [[1.1, -0.9], [1.1, 0.9], [-0.8, 0.9], [-0.8, -0.9], [1.1, -0.9]];
    let scene = Scene::new(Wall::polyline(&walls).collect(), vec![], Air::default()).unwrap();
    Arc::new(World::new(scene, robots, Noise { bursts_per_s: 3.0, ..Noise::default() }).unwrap().with_seed(20_007))
}

fn robot() -> Robot {
    Robot::ring(Pose::rotation(0.2), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500)
}

fn open(world: &Arc<World>, method: Method, own: Own) -> Result<Simulation, SimulationError> {
    Simulation::with_own(Arc::clone(world), method, &Options::default(), own, Stop::default())
}

/// Sensor, period, phase, kind, cause, numbers by their bits, and path of a reading.
type Row = (SensorId, u32, u8, ReadingKind, Cause, [u64; 5], Option<HeardPath>);

/// Returns the columns of all readings.
fn columns(readings: &Readings) -> Vec<Row> {
    let row = |k: usize| {
        let times = [&readings.fired_s, &readings.t_echo_us, &readings.earliest_us, &readings.emitted_s];
        let [a, b, c, d] = times.map(|column| column[k].to_bits());
        let bits = [a, b, c, d, readings.reference_us[k].to_bits()];
        let path = readings.path_of(k).cloned();
        (readings.id(k), readings.period[k], readings.phase[k], readings.kind[k], readings.cause[k], bits, path)
    };
    (0..readings.len()).map(row).collect()
}

/// A firing method with a schedule of two phases.
struct ByTable(AnySchedule);

impl FiringMethod for ByTable {
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
        let phase = Phase((period % 2) as u8);
        let firings = (0..self.0.sensors()).filter_map(|sensor| Some((self.0.t_fire(phase, sensor)?, sensor as u8)));
        Ok(FiringPeriod { length: self.0.period(), phase, firings: firings.collect() })
    }
}

/// The paper's filter, of sensors that report up to `E` echoes.
struct Paper<const E: usize>(EchoFilter<MAX_SENSORS, E>);

impl<const E: usize> Filter for Paper<E> {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        let times: Vec<_> = firing.echoes.iter().map(Echo::t_echo).collect();
        let verdict = self.0.push_echoes(firing.reading.sensor, &times, firing.expected_change_us);
        let verdict = verdict.map_err(|error| error.to_string())?;
        let echo = firing.echoes.iter().find(|echo| Some(echo.t_echo()) == verdict.t_echo).copied();
        Ok(Filtered { kind: verdict.kind, echo })
    }
}

fn paper<const E: usize>() -> Paper<E> {
    Paper(EchoFilter::new(Micros::new(500), 2).unwrap())
}

/// A filter that believes the median of three readings; of two equal readings it believes the one that the method does.
#[derive(Default)]
struct Median(std::collections::HashMap<u8, ([Option<Echo>; 3], usize)>);

impl Filter for Median {
    fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
        let (last, count) = self.0.entry(firing.reading.sensor).or_default();
        let echo = firing.echoes.first().copied();
        last[*count % 3] = echo;
        *count += 1;
        if *count < 3 {
            let kind = if echo.is_some() { ReadingKind::First } else { ReadingKind::NoEcho };
            return Ok(Filtered { kind, echo });
        }
        let mut sorted = *last;
        sorted.sort_by_key(|echo| echo.map_or(Micros::MAX, |echo| echo.t_echo()));
        Ok(Filtered::accepted(sorted[1]))
    }
}

// A custom filter with the rule of a method gives the method's readings.
#[test]
fn own_filter_like_a_methods_gives_equal_readings() {
    let moving = Robot {
        motion: Motion::Constant { velocity: Vector::new(0.05, -0.03), turn_rad_s: 0.1 },
        odometry: true,
        ..robot()
    };
    for robot in [robot(), moving] {
        let world = alcove(vec![robot]);
        // Firing must be on time: unlike the ring, a filter does not know the actual firing times.
        let pairs: [(Method, Method, Own); 4] = [
            (Method::Eeruf, Method::Eeruf, Own::new().filter(0, paper::<1>())),
            (Method::Conventional, Method::Comparison, Own::new().filter(0, paper::<1>())),
            (Method::MultiEcho, Method::MultiEcho, Own::new().filter(0, paper::<8>())),
            (Method::Conventional, Method::Median, Own::new().filter(0, Median::default())),
        ];
        for (under, like, own) in pairs {
            let mine = open(&world, under, own).unwrap().step(2.0, |_| true).unwrap();
            let built_in = open(&world, like, Own::new()).unwrap().step(2.0, |_| true).unwrap();
            assert!(mine.len() > 200, "{}", mine.len());
            assert_eq!(columns(&mine), columns(&built_in), "{under} {like}");
        }
        // The comparison must differ from believing everything, or the test would show nothing.
        let believes_all = open(&world, Method::Conventional, Own::new()).unwrap().step(2.0, |_| true).unwrap();
        let compares = open(&world, Method::Comparison, Own::new()).unwrap().step(2.0, |_| true).unwrap();
        assert_ne!(columns(&believes_all), columns(&compares));
    }
}

// A custom firing method with the schedule of a method gives the method's readings.
#[test]
fn own_firing_like_a_methods_gives_equal_readings() {
    let table = table_i_d_for(8, robot().period, 4).unwrap();
    let clock = Robot { clock: Clock { drift_ppm: 80.0, ..Clock::default() }, ..robot() };
    for robot in [robot(), clock] {
        let world = alcove(vec![robot]);
        for method in [Method::Eeruf, Method::MultiEcho] {
            let mine = open(&world, method, Own::new().firing(0, ByTable(table))).unwrap().step(3.0, |_| true).unwrap();
            let built_in = open(&world, method, Own::new()).unwrap().step(3.0, |_| true).unwrap();
            assert!(mine.len() > 300, "{}", mine.len());
            assert_eq!(columns(&mine), columns(&built_in), "{method}");
        }
    }
}

#[test]
fn own_code_is_of_one_robot() {
    let beside = Robot { pose: Pose::new(Vector::new(0.4, 0.3), 0.9), ..robot() };
    let here = Robot { pose: Pose::new(Vector::new(-0.4, -0.3), 0.2), ..robot() };
    let world = alcove(vec![here, beside]);
    /// A filter that believes nothing.
    struct Sceptic;
    impl Filter for Sceptic {
        fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
            Ok(Filtered { kind: ReadingKind::Rejected, echo: firing.echoes.first().copied() })
        }
    }
    let all = open(&world, Method::Conventional, Own::new().filter(1, Sceptic)).unwrap().step(1.0, |_| true).unwrap();
    let believed = |robot: u16| (0..all.len()).filter(|&k| all.robot[k] == robot && all.is_accepted(k)).count();
    assert!(believed(0) > 100 && believed(1) == 0, "{} {}", believed(0), believed(1));
    let error = open(&world, Method::Eeruf, Own::new().filter(2, Sceptic)).err().unwrap();
    assert_eq!(error.to_string(), "robot 3; expected one of 2");
}

// An echo is distinguished from crosstalk even if a filter gives it another time.
#[test]
fn echo_differs_from_crosstalk_under_filter_times() {
    /// A filter that delays every echo by two microseconds.
    struct Late;
    impl Filter for Late {
        fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
            let later = |echo: &Echo| echo.at(echo.t_echo().saturating_add(Micros::new(2)));
            Ok(Filtered::accepted(firing.echoes.first().map(later)))
        }
    }
    let world = alcove(vec![robot()]);
    let late = open(&world, Method::Conventional, Own::new().filter(0, Late)).unwrap().step(2.0, |_| true).unwrap();
    let prompt = open(&world, Method::Conventional, Own::new()).unwrap().step(2.0, |_| true).unwrap();
    assert_eq!(late.cause, prompt.cause);
    assert!(late.cause.contains(&Cause::Own) && late.cause.contains(&Cause::Crosstalk));
    for (late, prompt) in late.t_echo_us.iter().zip(&prompt.t_echo_us) {
        assert!(late.is_nan() && prompt.is_nan() || late - prompt == 2.0);
    }
}

// An invalid period ends the simulation with the reason.
#[test]
fn unfireable_period_ends_the_simulation() {
    /// A firing method that is valid for three periods, and then invalid.
    struct Then(FiringPeriod);
    impl FiringMethod for Then {
        fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
            let good = (Micros::from_millis(50), vec![(Micros::ZERO, 0)]);
            let good = FiringPeriod { length: good.0, phase: Phase::A, firings: good.1 };
            Ok(if period < 3 { good } else { self.0.clone() })
        }
    }
    let ms = Micros::from_millis;
    let period = |length, phase, firings: &[(Micros, u8)]| FiringPeriod { length, phase, firings: firings.to_vec() };
    let refused = [
        (period(Micros::ZERO, Phase::A, &[]), "lasts 0 us; expected 1 us to 268435.456 ms"),
        (period(ms(60), Phase(8), &[]), "has phase 8; expected 0 to 7"),
        (period(ms(60), Phase::A, &[(ms(0), 8)]), "fires sensor 8; expected one of 8, counted from 0"),
        (period(ms(60), Phase::A, &[(ms(60), 1)]), "fires sensor 1 at 60 ms; expected a time before its end at 60 ms"),
        (
            period(ms(60), Phase::A, &[(ms(20), 2), (ms(40), 2)]),
            "fires sensor 2 at 40 ms, 20000 us after its last firing; expected 36 ms or more, for which it listens",
        ),
    ];
    for (bad, why) in refused {
        let mut simulation = open(&alcove(vec![robot()]), Method::Eeruf, Own::new().firing(0, Then(bad))).unwrap();
        assert_eq!(simulation.step(0.14, |_| true).unwrap().len(), 3);
        let error = simulation.step(1.0, |_| true).unwrap_err().to_string();
        assert_eq!(error, format!("at 0.150 s: the firing of robot 1: period 3 {why}"));
        // The simulation does not continue.
        assert!(simulation.step(1.0, |_| true).is_err());
    }
    // This sensor still listens across the end of a period.
    let soon = Then(period(ms(10), Phase::A, &[(ms(0), 0)]));
    let mut simulation = open(&alcove(vec![robot()]), Method::Eeruf, Own::new().firing(0, soon)).unwrap();
    let error = simulation.step(1.0, |_| true).unwrap_err().to_string();
    assert!(error.contains("period 4 fires sensor 0 at 0 us, 10000 us after"), "{error}");
}

// Errors of custom code are returned by the step, and the simulation goes on.
#[test]
fn errors_of_own_code_come_out_of_the_step() {
    struct Once(bool);
    impl Filter for Once {
        fn push(&mut self, firing: &FiredReading<'_>) -> Result<Filtered, OwnError> {
            if firing.reading.sensor == 3 && !core::mem::replace(&mut self.0, true) {
                Err("sensor 3 was not expected")?;
            }
            Ok(Filtered::accepted(firing.echoes.first().copied()))
        }
    }
    let world = alcove(vec![robot()]);
    let mut simulation = open(&world, Method::Conventional, Own::new().filter(0, Once(false))).unwrap();
    let error = simulation.step(1.0, |_| true).unwrap_err();
    assert!(error.to_string().ends_with("the filter of robot 1: sensor 3 was not expected"), "{error}");
    assert!(format!("{error:#}").contains("the filter of robot 0"), "{error:#}");
    let after = simulation.step(1.0, |_| true).unwrap();
    let whole = open(&world, Method::Conventional, Own::new()).unwrap().step(1.0, |_| true).unwrap();
    assert_eq!(after.len(), whole.len() - 1, "the reading that was not judged is lost, and no other");
    /// A firing method that plans nothing.
    struct Never;
    impl FiringMethod for Never {
        fn plan(&mut self, _period: u32) -> Result<FiringPeriod, OwnError> {
            Err("out of service".into())
        }
    }
    let error = open(&world, Method::Eeruf, Own::new().firing(0, Never)).err().unwrap();
    assert_eq!(error.to_string(), "at 0.000 s: the firing of robot 1: out of service");
}

// A ring changes to another schedule at the end of its period, and refuses an invalid one.
#[test]
fn ring_changes_schedule_at_its_periods_end() {
    let (fast, slow) = (Micros::from_millis(60), Micros::from_millis(120));
    let slow = table_i_d_for(8, slow, 4).unwrap();
    let world = alcove(vec![Robot { schedule: Some(table_i_d_for(8, fast, 4).unwrap()), ..robot() }]);
    for method in [Method::Eeruf, Method::MultiEcho, Method::Conventional, Method::Simultaneous] {
        let mut simulation = open(&world, method, Own::new()).unwrap();
        simulation.step(0.7, |_| true).unwrap();
        simulation.change_schedule(0, &slow).unwrap();
        simulation.step(1.0, |_| true).unwrap();
        let after = simulation.step(2.4, |_| true).unwrap();
        for sensor in 0..8 {
            let fired: Vec<_> = (0..after.len()).filter(|&k| after.sensor[k] == sensor).collect();
            assert!((19..=21).contains(&fired.len()), "{method}: {}", fired.len());
            for pair in fired.windows(2) {
                let phase = |k: usize| Phase(after.phase[k]);
                let at = |k: usize| f64::from(slow.t_fire(phase(k), sensor.into()).unwrap().as_micros()) * 1e-6;
                let between = after.fired_s[pair[1]] - after.fired_s[pair[0]];
                assert!((between - (0.12 + at(pair[1]) - at(pair[0]))).abs() < 2e-6, "{method}: {between}");
            }
        }
    }
    for method in [Method::Dither, Method::EerufImmediate, Method::Adaptive, Method::Flow] {
        let error = open(&world, method, Own::new()).unwrap().change_schedule(0, &slow).unwrap_err();
        assert_eq!(error, SimulationError::FixedSchedule { robot: 0, method });
    }
    let mut simulation = open(&world, Method::Eeruf, Own::new()).unwrap();
    let refused = [
        (simulation.change_schedule(1, &slow).unwrap_err(), "robot 2; expected one of 1"),
        (
            simulation.change_schedule(0, &table_i_d_for(7, fast, 4).unwrap()).unwrap_err(),
            "robot 1: a schedule of 7 sensors; expected one of 8",
        ),
    ];
    for (error, message) in refused {
        assert_eq!(error.to_string(), message);
    }
    let soon = table_i_d_for(8, Micros::from_millis(30), 4).unwrap();
    let error = simulation.change_schedule(0, &soon).unwrap_err().to_string();
    assert!(error.starts_with("robot 1, method eeruf: a listening window of 36 ms"), "{error}");
    let untouched = open(&world, Method::Eeruf, Own::new()).unwrap().step(1.0, |_| true).unwrap();
    assert_eq!(columns(&simulation.step(1.0, |_| true).unwrap()), columns(&untouched));
}

#[test]
fn obstacles_that_move_are_heard_where_they_are() {
    let post = |x: f64| {
        let wall = Wall::new(2.5, -5.0, 2.5, 5.0).with_faces(Faces::Both);
        Scene::new(vec![wall], vec![Pole::new(x, 0.0, 0.1)], Air::default()).unwrap()
    };
    let single = Robot::with_sensors(Pose::identity(), vec![Pose::identity()], Transducer::POLAROID_6500);
    let turning = Robot { motion: Motion::Constant { velocity: Vector::zeros(), turn_rad_s: 1e-6 }, ..single.clone() };
    for robot in [single, turning] {
        let world = World::new(post(1.1), vec![robot], Noise::NONE).unwrap().with_physics(Physics::PLAIN).unwrap();
        let mut simulation = open(&Arc::new(world), Method::Sequential, Own::new()).unwrap();
        for x in [1.1, 1.6, 2.1, 0.8] {
            simulation.change_scene(post(x)).unwrap();
            let reading = simulation.step_to_reading(1.0, |_| true).unwrap();
            assert!((reading.t_echo_us[0] * 343.2e-6 / 2.0 - (x - 0.1)).abs() < 1e-3, "{x}: {:?}", reading.t_echo_us);
        }
    }
}

// A scene in which a sensor is inside an object is refused, and the old scene stays.
#[test]
fn scene_with_a_sensor_inside_is_refused() {
    let scene = |poles| {
        let wall = Wall::new(2.0, -5.0, 2.0, 5.0).with_faces(Faces::Both);
        Scene::new(vec![wall], poles, Air::default()).unwrap()
    };
    let world = Arc::new(World::new(scene(vec![]), vec![robot()], Noise::NONE).unwrap());
    let mut simulation = open(&world, Method::Eeruf, Own::new()).unwrap();
    let error = simulation.change_scene(scene(vec![Pole::new(0.0, 0.0, 1.0)])).unwrap_err();
    assert!(matches!(error, SimulationError::Paths { error: PathsError::Inside { .. }, .. }), "{error}");
    let untouched = open(&world, Method::Eeruf, Own::new()).unwrap().step(1.0, |_| true).unwrap();
    assert_eq!(columns(&simulation.step(1.0, |_| true).unwrap()), columns(&untouched));
}
