//! Set II over many courses: every method's figures, and the speed that each bears.

use eeruf_core::Micros;
use serde::{Serialize, Serializer, ser::SerializeMap};

use super::{
    course::Course,
    pilot::{Ending, Pilot, Piloting, Run},
};
use crate::{
    best::Best,
    events,
    experiments::{ExperimentError, going::Going},
    labmate::LabMate,
    method::Method,
    plane::Point,
    robot::Robot,
    simulate::{Options, sweep},
};

/// For how long a robot may try.
const TIME_S: f64 = 40.0;

/// How many readings [`Method::MultiEcho`] compares. Chance makes pairs of many echoes agree, the more the more foreign sound
/// there is; three running agree by chance far more rarely, and a sensor that hears past foreign sound can afford them.
pub const MULTI_ECHO_CONSECUTIVE: u8 = 3;

/// What is asked of Set II.
#[derive(Clone, Debug, PartialEq)]
pub struct SetTwoOptions {
    /// How many courses. 100 to begin with.
    pub seeds: u64,
    /// The first course's number, so that whoever tunes something need not do so on the courses that it is tried on. 0 to
    /// begin with.
    pub first: u64,
    /// The methods.
    pub methods: Vec<Method>,
    /// What [`Method::EerufBest`] fires by, see [`best_for`](crate::best::best_for).
    pub best: Option<Best>,
    /// Where another robot stands that fires 24 times in 80 ms, if there is one.
    pub second_robot: Option<Point>,
    /// The platform.
    pub labmate: LabMate,
    /// Whether the robot tells its ring by how much readings should change from its own motion.
    pub odometry: bool,
    /// `T_delta`. With odometry it need not leave room for motion, and chance agrees the more rarely the smaller it is.
    pub t_delta: Micros,
    /// How it steers.
    pub piloting: Piloting,
}

impl Default for SetTwoOptions {
    fn default() -> Self {
        Self {
            seeds: 100,
            first: 0,
            methods: vec![
                Method::Sequential,
                Method::Conventional,
                Method::Comparison,
                Method::Eeruf,
                Method::EerufBest,
                Method::Adaptive,
                Method::MultiEcho,
            ],
            best: None,
            second_robot: None,
            labmate: LabMate::default(),
            odometry: true,
            t_delta: Micros::new(150),
            piloting: Piloting::default(),
        }
    }
}

/// Set II over many courses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetTwo {
    /// How many courses.
    pub seeds: u64,
    /// Where another robot stood and fired, in metres.
    pub second_robot_m: Option<[f64; 2]>,
    /// The platform's highest speed in m/s.
    pub speed_m_s: f64,
    /// The methods in the order asked for, with their figures.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(Method, Figures)>,
    /// For each method, what came of each course.
    #[serde(skip)]
    pub runs: Vec<Vec<Run>>,
}

/// A method's figures over all courses; shares are fractions of 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// How many courses.
    pub courses: usize,
    /// How many were finished without contact.
    pub finished: usize,
    /// In how many the robot touched something.
    pub contacts: usize,
    /// In how many it was stuck, or too slow.
    pub timed_out: usize,
    /// Way over time of all courses together, in m/s.
    pub mean_speed_m_s: f64,
    /// The highest speed in any course, in m/s.
    pub top_speed_m_s: f64,
    /// How near a pole came to the robot's outline: the mean over the courses, in metres.
    pub nearest_m: f64,
    /// Share of all readings that were accepted and wrong.
    pub wrong_of_all: f64,
    /// Share of all readings that were not accepted.
    pub rejected: f64,
    /// Echoes entered into the grid where nothing is, in each course on average.
    pub phantom_echoes: f64,
    /// Cells of the grid that are certain in the end though nothing is there, in each course on average.
    pub phantom_cells: f64,
    /// Share of the poles that the robot came within 1 m of that it never saw.
    pub poles_missed: f64,
    /// Accepted readings in a second, all sensors together.
    pub readings_per_s: f64,
}

impl Figures {
    fn of(runs: &[Run]) -> Self {
        let ended = |ending| runs.iter().filter(|run| run.ending == ending).count();
        let sum = |value: fn(&Run) -> f64| runs.iter().map(value).sum::<f64>();
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let courses = runs.len() as f64;
        let (readings, rejected) = (sum(|run| run.readings.into()), sum(|run| run.rejected.into()));
        Self {
            courses: runs.len(),
            finished: ended(Ending::Finished),
            contacts: ended(Ending::Contact),
            timed_out: ended(Ending::TimeOut),
            mean_speed_m_s: share(sum(|run| run.way_m), sum(|run| run.time_s)),
            top_speed_m_s: runs.iter().map(|run| run.top_speed_m_s).fold(0.0, f64::max),
            nearest_m: share(sum(|run| if run.nearest_m.is_finite() { run.nearest_m } else { 0.0 }), courses),
            wrong_of_all: share(sum(|run| run.wrong.into()), readings),
            rejected: share(rejected, readings),
            phantom_echoes: share(sum(|run| run.phantom_echoes.into()), courses),
            phantom_cells: share(sum(|run| run.phantom_cells.into()), courses),
            poles_missed: share(sum(|run| run.poles_missed.into()), sum(|run| run.poles_passed.into())),
            readings_per_s: share(readings - rejected, sum(|run| run.time_s)),
        }
    }
}

/// Runs Set II: every course by every method, on all cores. `keep_going` is called now and then, by several threads, with the
/// share that is done, 0 to 1; when its answer is `false` the run stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no courses or no methods, and if it was stopped.
///
/// ```
/// use eeruf_sim::{Method, experiments::set_two::{SetTwoOptions, set_two}};
/// let options = SetTwoOptions { seeds: 2, methods: vec![Method::Eeruf], ..SetTwoOptions::default() };
/// let found = set_two(&options, &|_| true)?;
/// assert_eq!(found.methods[0].1.courses, 2);
/// # Ok::<(), eeruf_sim::experiments::ExperimentError>(())
/// ```
pub fn set_two(options: &SetTwoOptions, keep_going: &(dyn Fn(f64) -> bool + Sync)) -> Result<SetTwo, ExperimentError> {
    if options.seeds == 0 {
        return Err(ExperimentError::NoSeeds);
    }
    if options.methods.is_empty() {
        return Err(ExperimentError::NoMethods);
    }
    let jobs: Vec<(Method, u64)> = options
        .methods
        .iter()
        .flat_map(|&method| (options.first..options.first + options.seeds).map(move |number| (method, number)))
        .collect();
    let going = Going::new(jobs.len() as u64, keep_going);
    let runs = sweep(&jobs, |&(method, number)| {
        let run = drive(options, method, number, &going)?;
        going.one_done();
        Ok(run)
    });
    if going.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let mut runs = runs.into_iter();
    let mut by_method = Vec::new();
    for _ in &options.methods {
        by_method.push(runs.by_ref().take(options.seeds as usize).collect::<Result<Vec<_>, ExperimentError>>()?);
    }
    let methods = options.methods.iter().zip(&by_method).map(|(&method, runs)| (method, Figures::of(runs))).collect();
    let SetTwoOptions { seeds, second_robot, .. } = *options;
    let second_robot_m = second_robot.map(|at| [at.x, at.y]);
    Ok(SetTwo { seeds, second_robot_m, speed_m_s: options.labmate.speed_max_m_s, methods, runs: by_method })
}

/// One course by one method.
fn drive(options: &SetTwoOptions, method: Method, number: u64, going: &Going<'_>) -> Result<Run, ExperimentError> {
    if !going.go_on() {
        return Err(ExperimentError::Stopped);
    }
    let course = Course::random(number);
    let consecutive = if method == Method::MultiEcho { MULTI_ECHO_CONSECUTIVE } else { 2 };
    let robot = Robot { odometry: options.odometry, t_delta: options.t_delta, consecutive, ..course.robot() };
    let world = course.world(robot, options.second_robot)?;
    let mut piloting = options.piloting;
    piloting.vfh.speed_max_m_s = options.labmate.speed_max_m_s;
    let mut pilot = Pilot::new(&world, number, options.labmate, piloting, TIME_S);
    let period_s = f64::from(world.robots()[0].period.as_micros()) * 1e-6;
    let simulation =
        Options { best: options.best.map(|best| best.schedule), ..Options::periods((TIME_S / period_s).ceil() as u32) };
    events::run(&world, method, &simulation, &mut pilot, |_| going.go_on())?;
    Ok(pilot.finish())
}

/// One speed of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpeedStep {
    /// The platform's highest speed, in m/s.
    pub speed_m_s: f64,
    /// For each method, the share of courses finished without contact.
    #[serde(serialize_with = "by_name")]
    pub finished: Vec<(Method, f64)>,
    /// For each method, the mean speed in m/s.
    #[serde(serialize_with = "by_name")]
    pub mean_speed_m_s: Vec<(Method, f64)>,
}

/// Runs Set II at several top speeds.
///
/// # Errors
/// As [`set_two`].
pub fn speed_sweep(
    options: &SetTwoOptions,
    speeds_m_s: &[f64],
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Vec<SpeedStep>, ExperimentError> {
    let mut steps = Vec::new();
    for (place, &speed_m_s) in speeds_m_s.iter().enumerate() {
        let share = |done: f64| keep_going((place as f64 + done) / speeds_m_s.len() as f64);
        let labmate = LabMate { speed_max_m_s: speed_m_s, ..options.labmate };
        let found = set_two(&SetTwoOptions { labmate, ..options.clone() }, &share)?;
        let each = |value: fn(&Figures) -> f64| found.methods.iter().map(|(method, of)| (*method, value(of))).collect();
        steps.push(SpeedStep {
            speed_m_s,
            finished: each(|of| of.finished as f64 / of.courses as f64),
            mean_speed_m_s: each(|of| of.mean_speed_m_s),
        });
    }
    Ok(steps)
}

fn by_name<S: Serializer, T: Serialize>(entries: &[(Method, T)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(entries.len()))?;
    for (method, entry) in entries {
        map.serialize_entry(method, entry)?;
    }
    map.end()
}
