//! Set I over many geometries: every method's figures and their spread.

use serde::Serialize;

use super::alcove::Alcove;
use super::figures::{Figures, Run};
use super::options::SetOneOptions;
use super::step::{self, Steps};
use crate::experiments::by_name::{by_name, named, transposed};
use crate::experiments::conditions::Conditions;
use crate::experiments::error::{ExperimentError, distinct, numbers};
use crate::experiments::progress::Progress;
use crate::{
    acoustics::Physics,
    methods::Method,
    simulation::{Entry, Options},
    threads::{Stop, sweep},
    world::{Robot, World, WorldError},
};

/// Set I over many geometries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetOne {
    /// The first geometry's number.
    pub first: u64,
    /// Number of geometries.
    pub seeds: u64,
    /// Effects in the alcoves.
    pub physics: Physics,
    /// The rooms' height and the ring's gain.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// Number of sensors in the ring.
    pub sensors: usize,
    /// The period, in microseconds.
    pub period_us: u32,
    /// Number of periods for which each geometry was simulated.
    pub periods: u32,
    /// The methods in the order asked for, with their figures.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(String, Figures)>,
    /// For each method, the result in each geometry.
    #[serde(skip)]
    pub runs: Vec<Vec<Run>>,
}

/// Runs Set I: every geometry under each method, on all cores.
///
/// Several threads sometimes call `keep_going` with the finished share, 0 to 1; if it returns `false`, the run stops.
/// The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no geometries, more than there are numbers for, no methods or two of one name, for an
/// invalid ring, and if `keep_going` stopped it.
///
/// ```
/// use eeruf_sim::{Entry, Method, experiments::set_one::{SetOneOptions, set_one}};
/// let methods = Entry::all([Method::Conventional, Method::Eeruf]);
/// let table = set_one(&SetOneOptions { seeds: 2, methods, ..SetOneOptions::default() }, &|_| true)?;
/// let [(_, conventional), (_, eeruf)] = &table.methods[..] else { unreachable!() };
/// assert!(eeruf.wrong_of_all.unwrap().p90 < conventional.wrong_of_all.unwrap().p10);
/// # Ok::<(), eeruf_sim::experiments::ExperimentError>(())
/// ```
pub fn set_one(asked: &SetOneOptions, keep_going: &(dyn Fn(f64) -> bool + Sync)) -> Result<SetOne, ExperimentError> {
    let geometries: Vec<u64> = numbers(asked.first, asked.seeds)?.collect();
    distinct(&asked.methods)?;
    let progress = Progress::new(asked.seeds.saturating_mul(asked.methods.len() as u64), keep_going);
    let runs = sweep(&geometries, |&number| {
        let mut runs = Vec::with_capacity(asked.methods.len());
        for entry in &asked.methods {
            runs.push(run(asked, number, entry, &progress)?);
            progress.one_done();
        }
        Ok(runs)
    });
    let runs: Vec<Vec<Run>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    Ok(SetOne::of(asked, transposed(asked.methods.len(), runs)))
}

impl SetOne {
    /// Makes the table from finished runs: for each method one run for each geometry.
    pub fn of(asked: &SetOneOptions, runs: Vec<Vec<Run>>) -> Self {
        let &SetOneOptions { first, seeds, physics, sensors, period, .. } = asked;
        let methods = named(&asked.methods, runs.iter().map(|runs| Figures::of(runs)));
        let (conditions, period_us) = (Conditions::of(asked.room.as_ref(), asked.transducer.gain), period.as_micros());
        let periods = periods(asked);
        Self { first, seeds, physics, conditions, sensors, period_us, periods, methods, runs }
    }
}

/// Returns the number of periods for which each geometry is simulated.
fn periods(asked: &SetOneOptions) -> u32 {
    asked.readings.div_ceil(asked.sensors.max(1) as u32)
}

/// Makes an alcove and its robot with a method's settings; the world's seed is the alcove's number.
///
/// # Errors
/// [`WorldError`] for an invalid ring.
pub fn world_of(asked: &SetOneOptions, alcove: &Alcove, entry: &Entry) -> Result<World, WorldError> {
    let SetOneOptions { period, transducer, .. } = *asked;
    let plain = Robot { period, transducer, ..alcove.robot_of(asked.sensors) };
    let robot = match entry.method() {
        Method::MultiEcho => asked.multi_echo.of(plain),
        _ => plain,
    };
    World::new(alcove.scene()?.with_room(asked.room)?, vec![entry.robot(robot)], asked.noise)?
        .with_physics(asked.physics)
}

/// Runs one alcove with one method: unchanged, and with its back wall moving back and forth.
fn run(asked: &SetOneOptions, number: u64, entry: &Entry, progress: &Progress<'_>) -> Result<Run, ExperimentError> {
    if !progress.go_on() {
        return Err(ExperimentError::Stopped);
    }
    let alcove = Alcove::random(number);
    let world = |alcove: &Alcove| world_of(asked, alcove, entry).map(|world| world.with_seed(number));
    let best = asked.best.as_ref().map(|best| best.schedule);
    let options = Options { best, ..Options::periods(periods(asked)) };
    let far = world(&alcove)?;
    let summary = entry.simulate(&far, &options, &Stop::default(), |_| progress.go_on())?.summary();
    let steps = match asked.steps {
        0 => Steps::default(),
        steps => step::steps(&[far, world(&alcove.nearer())?], steps, entry, &options, || progress.go_on())?,
    };
    Ok(Run { seed: number, summary, steps })
}
