//! Set II over many courses: every method's figures, and the highest speed of each.

use serde::Serialize;

use super::course::Course;
use super::figures::Figures;
use super::options::SetTwoOptions;
use super::pilot::Pilot;
use super::run::Run;
use crate::experiments::by_name::{by_name, named, transposed};
use crate::experiments::conditions::Conditions;
use crate::experiments::error::{ExperimentError, distinct, numbers};
use crate::experiments::progress::Progress;
use crate::{
    acoustics::Physics,
    methods::Method,
    navigation::LabMate,
    results::Readings,
    simulation::{self, Entry, Options, SimulationError},
    threads::{Stop, sweep},
    tracing::PathsError,
    world::{Robot, World},
};

/// Time limit of a course, in seconds.
const TIME_S: f64 = 40.0;

/// Number of readings that [`Method::MultiEcho`] compares. With many echoes, pairs agree by accident, and more so the
/// more foreign sound there is. Three in a row do so far more rarely, and a sensor that reports several echoes has
/// enough readings for them.
pub const MULTI_ECHO_CONSECUTIVE: u8 = 3;

/// Set II over many courses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetTwo {
    /// The first course's number.
    pub first: u64,
    /// The pilot, see [`Pilots::as_str`](super::Pilots::as_str).
    pub pilot: &'static str,
    /// The simulated effects in the lab.
    pub physics: Physics,
    /// The height and the robot's gain.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// True if robots had bodies.
    pub bodies: bool,
    /// Number of courses.
    pub seeds: u64,
    /// Position of another robot that fired, in metres; `None` without one.
    pub second_robot_m: Option<[f64; 2]>,
    /// The platform's highest speed in m/s.
    pub speed_m_s: f64,
    /// The methods in the order asked for, with their figures.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(String, Figures)>,
    /// Outcomes of each method, course by course.
    #[serde(skip)]
    pub runs: Vec<Vec<Run>>,
}

/// Runs Set II: every course by every method, on all cores. Several threads sometimes call `keep_going` with the
/// finished share, 0 to 1; if it returns `false`, the run stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no courses, more than there are numbers for, or no methods, and if `keep_going` stopped it.
///
/// ```
/// use eeruf_sim::{Entry, Method, experiments::set_two::{SetTwoOptions, set_two}};
/// let options = SetTwoOptions { seeds: 2, methods: Entry::all([Method::Eeruf]), ..SetTwoOptions::default() };
/// let found = set_two(&options, &|_| true)?;
/// assert_eq!(found.methods[0].1.courses, 2);
/// # Ok::<(), eeruf_sim::experiments::ExperimentError>(())
/// ```
pub fn set_two(options: &SetTwoOptions, keep_going: &(dyn Fn(f64) -> bool + Sync)) -> Result<SetTwo, ExperimentError> {
    let courses: Vec<u64> = numbers(options.first, options.seeds)?.collect();
    distinct(&options.methods)?;
    let jobs: Vec<(u64, &Entry)> =
        courses.iter().flat_map(|&number| options.methods.iter().map(move |entry| (number, entry))).collect();
    let progress = Progress::new(jobs.len() as u64, keep_going);
    let runs = sweep(&jobs, |&(number, entry)| {
        let run = run_course(options, entry, number, &progress)?;
        progress.one_done();
        Ok(run)
    });
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let mut runs = runs.into_iter().collect::<Result<Vec<_>, ExperimentError>>()?.into_iter();
    let each = courses.iter().map(|_| runs.by_ref().take(options.methods.len()).collect()).collect();
    Ok(SetTwo::of(options, transposed(options.methods.len(), each)))
}

impl SetTwo {
    /// Makes the table from finished runs: for each method one run for each course.
    pub fn of(options: &SetTwoOptions, runs: Vec<Vec<Run>>) -> Self {
        let methods = named(&options.methods, runs.iter().map(|runs| Figures::of(runs)));
        let &SetTwoOptions { first, seeds, second_robot, pilots, physics, bodies, .. } = options;
        let second_robot_m = second_robot.map(|at| [at.x, at.y]);
        let (pilot, speed_m_s) = (pilots.as_str(), options.labmate.speed_max_m_s);
        let conditions = Conditions::of(options.room.as_ref(), options.gain);
        Self { first, pilot, physics, conditions, bodies, seeds, second_robot_m, speed_m_s, methods, runs }
    }
}

/// Runs one course by one method.
fn run_course(
    options: &SetTwoOptions,
    entry: &Entry,
    number: u64,
    progress: &Progress<'_>,
) -> Result<Run, ExperimentError> {
    if !progress.go_on() {
        return Err(ExperimentError::Stopped);
    }
    Ok(drive(options, entry, number, &|_| progress.go_on())?.run)
}

/// A drive of one course by one method, with all readings.
#[derive(Debug)]
pub struct Drive {
    /// Walls, poles and robots; `run.track` has the way of the first robot.
    pub world: World,
    /// Readings of the robots' sensors; empty if bodies are on and one touched something.
    pub readings: Readings,
    /// The outcome.
    pub run: Run,
}

/// Drives one course by one method. `keep_going` is called from time to time with the elapsed share of the time limit,
/// 0 to 1; if it returns `false`, the drive stops.
///
/// # Errors
/// [`ExperimentError`] for an invalid ring, and if `keep_going` stopped it.
pub fn drive(
    options: &SetTwoOptions,
    entry: &Entry,
    number: u64,
    keep_going: &dyn Fn(f64) -> bool,
) -> Result<Drive, ExperimentError> {
    let (course, method) = (Course::random(number), entry.method());
    let consecutive = if method == Method::MultiEcho { MULTI_ECHO_CONSECUTIVE } else { 2 };
    let robot = if options.bodies { course.robot_with_body(&options.labmate) } else { course.robot() };
    let robot = Robot { consecutive, ..options.robot(robot) };
    let world = course
        .world(entry.robot(robot), options.second_robot)?
        .with_room(options.room)?
        .with_physics(options.physics)?;
    let mut piloting = options.pilots.of(method);
    piloting.vfh.speed_max_m_s = options.labmate.speed_max_m_s;
    let mut pilot = Pilot::new(&world, number, options, piloting, TIME_S);
    let period_s = f64::from(world.robots()[0].period.as_micros()) * 1e-6;
    let simulation = Options {
        best: options.best.as_ref().map(|best| best.schedule),
        ..Options::periods((TIME_S / period_s).ceil() as u32)
    };
    let (own, simulation, stop) = (entry.own(&world.robots()[..1])?, entry.options(simulation), Stop::default());
    let readings = match simulation::run(&world, method, &simulation, own, &mut pilot, &stop, keep_going) {
        // A sensor on the platform's edge, or another robot's body, touched something between two steps of the pilot.
        Err(SimulationError::Paths { error: PathsError::Inside { .. } | PathsError::Body { .. }, .. })
            if options.bodies =>
        {
            pilot.touched();
            let sensors = world.robots().iter().map(|robot| robot.sensors.len()).sum();
            Readings::new(method, 0.0, sensors)
        }
        ran => ran?,
    };
    let run = pilot.finish();
    Ok(Drive { world, readings, run })
}

/// One top speed of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedStep {
    /// The platform's highest speed, in m/s.
    pub speed_m_s: f64,
    /// For each method, the share of courses finished without contact.
    #[serde(serialize_with = "by_name", rename = "finished_of_all")]
    pub finished: Vec<(String, f64)>,
    /// 95 % confidence interval of that share for each method, by Wilson.
    #[serde(serialize_with = "by_name")]
    pub finished_95: Vec<(String, [f64; 2])>,
    /// For each method, the mean speed in m/s.
    #[serde(serialize_with = "by_name")]
    pub mean_speed_m_s: Vec<(String, f64)>,
}

/// Runs Set II at several top speeds.
///
/// # Errors
/// See [`set_two`].
pub fn speed_sweep(
    options: &SetTwoOptions,
    speeds_m_s: &[f64],
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Vec<SpeedStep>, ExperimentError> {
    let mut steps = Vec::new();
    for (step, &speed_m_s) in speeds_m_s.iter().enumerate() {
        let share = |done: f64| keep_going((step as f64 + done) / speeds_m_s.len() as f64);
        let labmate = LabMate { speed_max_m_s: speed_m_s, ..options.labmate };
        let found = set_two(&SetTwoOptions { labmate, ..options.clone() }, &share)?;
        let each =
            |value: fn(&Figures) -> f64| found.methods.iter().map(|(method, of)| (method.clone(), value(of))).collect();
        steps.push(SpeedStep {
            speed_m_s,
            finished: each(|of| of.finished as f64 / of.courses as f64),
            finished_95: found.methods.iter().map(|(method, of)| (method.clone(), of.finished_95)).collect(),
            mean_speed_m_s: each(|of| of.mean_speed_m_s),
        });
    }
    Ok(steps)
}
