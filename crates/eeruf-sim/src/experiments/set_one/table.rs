//! Set I over many geometries: every method's figures, and how they spread.

use eeruf_core::Micros;
use serde::Serialize;

use super::alcove::{Alcove, SENSORS};
use crate::experiments::by_name::by_name;
use crate::experiments::error::ExperimentError;
use crate::experiments::progress::Progress;
use crate::experiments::spread::Spread;
use crate::{
    methods::{BestSchedule, Method},
    results::Summary,
    simulation::{Options, simulate_while},
    threads::sweep,
    world::{Robot, World, WorldError},
};

/// How many readings the paper has of one set-up (Sec. 4): of the conventional method, and of all others in that time.
pub const READINGS: u32 = 8000;

/// `T_delta` of [`Method::MultiEcho`]. With up to eight echoes a firing, pairs of them agree by accident in proportion
/// to `T_delta`: at the 0.5 ms of the other methods every tenth reading is such a pair. Those 0.5 ms are for motion; a
/// robot that stands, or that knows how it moves, needs no more than jitter asks for: 15 us rms at either end, times
/// five.
pub const MULTI_ECHO_T_DELTA: Micros = Micros::new(100);

/// How many readings [`Method::MultiEcho`] compares, and for how long it waits for an echo that is missing. Where
/// several echoes are known, one that fades must not be taken for gone, or what lies behind it is believed: with two
/// readings and no patience 10 % of the readings are wrong for that reason. The price is that a new echo is believed
/// after five periods.
pub const MULTI_ECHO_CONSECUTIVE: u8 = 5;
/// See [`MULTI_ECHO_CONSECUTIVE`].
pub const MULTI_ECHO_PATIENCE: u8 = 12;

/// Set I over many geometries.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetOne {
    /// How many geometries.
    pub seeds: u64,
    /// How many periods of 60 ms each was simulated for.
    pub periods: u32,
    /// The methods in the order asked for, with their figures.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(Method, Figures)>,
}

/// A method's figures over all geometries; shares are fractions of 1, as in [`Summary`]. `None` where no geometry has a
/// value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Share of all readings that were accepted and wrong.
    pub wrong_of_all: Option<Spread>,
    /// The part of it that foreign or stale sound caused.
    pub crosstalk_of_all: Option<Spread>,
    /// Share of the accepted readings that were wrong.
    pub wrong_of_accepted: Option<Spread>,
    /// Share of all readings that would have been wrong without a filter.
    pub wrong_before_filter: Option<Spread>,
    /// Share of all readings that were not accepted.
    pub rejected: Option<Spread>,
    /// Share of the good readings that were not accepted.
    pub good_lost: Option<Spread>,
    /// Median age of the last accepted reading, in milliseconds.
    pub age_ms: Option<Spread>,
    /// The age that 99 % of the last accepted readings do not exceed, in milliseconds.
    pub age_p99_ms: Option<Spread>,
    /// Accepted readings in a second, all sensors together.
    pub readings_per_s: Option<Spread>,
    /// Mean number of sensors, of eight, that never had a reading accepted.
    pub starved: f64,
}

impl Figures {
    fn of(summaries: &[Summary]) -> Self {
        let spread = |value: fn(&Summary) -> Option<f64>| Spread::of(summaries.iter().filter_map(value));
        let blind: usize = summaries.iter().map(|summary| summary.starved).sum();
        Self {
            wrong_of_all: spread(|s| Some(s.wrong_of_all)),
            crosstalk_of_all: spread(|s| Some(s.crosstalk_of_all)),
            wrong_of_accepted: spread(|s| s.wrong_of_accepted),
            wrong_before_filter: spread(|s| Some(s.wrong_before_filter)),
            rejected: spread(|s| Some(s.rejected)),
            good_lost: spread(|s| s.good_lost),
            age_ms: spread(|s| Some(s.age_ms.median)),
            age_p99_ms: spread(|s| Some(s.age_ms.p99)),
            readings_per_s: spread(|s| Some(s.readings_per_s)),
            starved: blind as f64 / summaries.len().max(1) as f64,
        }
    }
}

/// Runs Set I: geometries 0 to `seeds`, each under every method for as long as `readings` readings of the conventional
/// method take ([`READINGS`] in the paper), on all cores. `best` is what [`Method::EerufBest`] fires by, see
/// [`best_schedule_for`](crate::best_schedule_for).
///
/// `keep_going` is called now and then, by several threads, with the share that is done, 0 to 1; when its answer is
/// `false` the run stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no geometries or no methods, and if it was stopped.
///
/// ```
/// use eeruf_sim::{Method, experiments::set_one::{READINGS, set_one}};
/// let table = set_one(2, READINGS, &[Method::Conventional, Method::Eeruf], None, &|_| true)?;
/// let [(_, conventional), (_, eeruf)] = table.methods[..] else { unreachable!() };
/// assert!(eeruf.wrong_of_all.unwrap().p90 < conventional.wrong_of_all.unwrap().p10);
/// # Ok::<(), eeruf_sim::experiments::ExperimentError>(())
/// ```
pub fn set_one(
    seeds: u64,
    readings: u32,
    methods: &[Method],
    best: Option<&BestSchedule>,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<SetOne, ExperimentError> {
    if seeds == 0 {
        return Err(ExperimentError::NoSeeds);
    }
    if methods.is_empty() {
        return Err(ExperimentError::NoMethods);
    }
    let periods = readings.div_ceil(SENSORS as u32);
    let options = Options { best: best.map(|best| best.schedule), ..Options::periods(periods) };
    let progress = Progress::new(seeds * methods.len() as u64, keep_going);
    let geometries: Vec<u64> = (0..seeds).collect();
    let runs = sweep(&geometries, |&number| {
        if !progress.go_on() {
            return Err(ExperimentError::Stopped);
        }
        let alcove = Alcove::random(number);
        let standard = alcove.world()?;
        let robot = Robot {
            t_delta: MULTI_ECHO_T_DELTA,
            consecutive: MULTI_ECHO_CONSECUTIVE,
            patience: MULTI_ECHO_PATIENCE,
            ..alcove.robot()
        };
        let patient = World::new(alcove.scene().map_err(WorldError::from)?, vec![robot], standard.noise())?;
        let mut summaries = Vec::with_capacity(methods.len());
        for &method in methods {
            let world = if method == Method::MultiEcho { &patient } else { &standard };
            let readings = simulate_while(world, method, &options, |_| progress.go_on())?;
            summaries.push(readings.summary());
            progress.one_done();
        }
        Ok(summaries)
    });
    let runs: Vec<Vec<Summary>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let of = |column: usize| Figures::of(&runs.iter().map(|run| run[column]).collect::<Vec<_>>());
    let methods = methods.iter().enumerate().map(|(column, &method)| (method, of(column))).collect();
    Ok(SetOne { seeds, periods, methods })
}
