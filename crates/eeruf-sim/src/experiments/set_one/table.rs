//! Set I over many geometries: every method's figures, and how they spread.

use serde::Serialize;

use super::alcove::Alcove;
use super::figures::Figures;
use super::options::SetOneOptions;
use super::step::{self, Steps};
use crate::experiments::by_name::by_name;
use crate::experiments::conditions::Conditions;
use crate::experiments::error::{ExperimentError, numbers};
use crate::experiments::progress::Progress;
use crate::{
    acoustics::Physics,
    methods::Method,
    results::Summary,
    simulation::{Options, simulate_while},
    threads::sweep,
    world::{Robot, World, WorldError},
};

/// Set I over many geometries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetOne {
    /// The first geometry's number.
    pub first: u64,
    /// How many geometries.
    pub seeds: u64,
    /// Which effects the alcoves had.
    pub physics: Physics,
    /// Their height and the ring's gain.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// How many sensors the ring had.
    pub sensors: usize,
    /// The period, in microseconds.
    pub period_us: u32,
    /// How many periods each was simulated for.
    pub periods: u32,
    /// The methods in the order asked for, with their figures.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(Method, Figures)>,
}

/// Runs Set I: every geometry under each method, on all cores.
///
/// `keep_going` is called now and then, by several threads, with the share that is done, 0 to 1; when its answer is
/// `false` the run stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no geometries, more than there are numbers for, or no methods, for a ring that cannot be,
/// and if it was stopped.
///
/// ```
/// use eeruf_sim::{Method, experiments::set_one::{SetOneOptions, set_one}};
/// let methods = vec![Method::Conventional, Method::Eeruf];
/// let table = set_one(&SetOneOptions { seeds: 2, methods, ..SetOneOptions::default() }, &|_| true)?;
/// let [(_, conventional), (_, eeruf)] = table.methods[..] else { unreachable!() };
/// assert!(eeruf.wrong_of_all.unwrap().p90 < conventional.wrong_of_all.unwrap().p10);
/// # Ok::<(), eeruf_sim::experiments::ExperimentError>(())
/// ```
pub fn set_one(asked: &SetOneOptions, keep_going: &(dyn Fn(f64) -> bool + Sync)) -> Result<SetOne, ExperimentError> {
    let &SetOneOptions { first, seeds, readings, ref methods, physics, sensors, period, .. } = asked;
    let geometries: Vec<u64> = numbers(first, seeds)?.collect();
    if methods.is_empty() {
        return Err(ExperimentError::NoMethods);
    }
    let periods = readings.div_ceil(sensors.max(1) as u32);
    let progress = Progress::new(seeds.saturating_mul(methods.len() as u64), keep_going);
    let runs = sweep(&geometries, |&number| {
        let mut runs = Vec::with_capacity(methods.len());
        for &method in methods {
            runs.push(run(asked, number, method, periods, &progress)?);
            progress.one_done();
        }
        Ok(runs)
    });
    let runs: Vec<Vec<(Summary, Steps)>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let of = |column: usize| {
        let (summaries, steps): (Vec<_>, Vec<_>) = runs.iter().map(|run| run[column].clone()).unzip();
        Figures::of(&summaries, &steps)
    };
    let methods = methods.iter().enumerate().map(|(column, &method)| (method, of(column))).collect();
    let conditions = Conditions::of(asked.room.as_ref(), asked.transducer.gain);
    Ok(SetOne { first, seeds, physics, conditions, sensors, period_us: period.as_micros(), periods, methods })
}

/// An alcove and the robot before it, as a method has it in Set I; its seed there is the alcove's number.
///
/// # Errors
/// [`WorldError`] for a ring that cannot be.
pub fn world_of(asked: &SetOneOptions, alcove: &Alcove, method: Method) -> Result<World, WorldError> {
    let SetOneOptions { period, transducer, .. } = *asked;
    let plain = Robot { period, transducer, ..alcove.robot_of(asked.sensors) };
    let robot = match method {
        Method::MultiEcho => asked.multi_echo.of(plain),
        _ => plain,
    };
    World::new(alcove.scene()?.with_room(asked.room)?, vec![robot], asked.noise)?.with_physics(asked.physics)
}

/// One alcove under one method: as it is, and with its back wall going to and fro.
fn run(
    asked: &SetOneOptions,
    number: u64,
    method: Method,
    periods: u32,
    progress: &Progress<'_>,
) -> Result<(Summary, Steps), ExperimentError> {
    if !progress.go_on() {
        return Err(ExperimentError::Stopped);
    }
    let alcove = Alcove::random(number);
    let world = |alcove: &Alcove| world_of(asked, alcove, method).map(|world| world.with_seed(number));
    let best = asked.best.as_ref().map(|best| best.schedule);
    let options = Options { best, hopping: asked.hopping, ..Options::periods(periods) };
    let far = world(&alcove)?;
    let summary = simulate_while(&far, method, &options, |_| progress.go_on())?.summary();
    let steps = match asked.steps {
        0 => Steps::default(),
        steps => step::steps(&[far, world(&alcove.nearer())?], steps, method, &options, || progress.go_on())?,
    };
    Ok((summary, steps))
}
