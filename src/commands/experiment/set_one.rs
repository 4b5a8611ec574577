//! `eeruf lab experiment set-one`: eight sensors in front of three walls at right angles, over many alcoves.

use std::path::{Path, PathBuf};

use eeruf_core::Micros;
use eeruf_sim::best_schedule_for;
use eeruf_sim::experiments::set_one::{Alcove, SENSORS, SetOne, SetOneOptions, set_one, world_of};
use eeruf_sim::{Entry, Method, Options, Robot, Stop, Transducer};

use super::common::{BUDGET, Common, Watched, bad, designing};
use super::shard::{Runs, runs_of};
use crate::commands::methods::chosen;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::mcap::{Stage, write_mcap};
use crate::report::draw;
use crate::report::experiment::set_one::describe;
use crate::report::json::to_json;
use crate::report::watch::Watch;

/// Set I: eight sensors facing three perpendicular walls, each reading compared with the sensor's reading alone.
///
/// Every alcove is simulated by each method for the time of 8000 readings by the conventional one. Figures are
/// given as 10 % / median / 90 % of the alcoves.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Simulate only these methods, separated by commas: eeruf,sequential; by default all of the paper and ours
    #[arg(id = "method", long, value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Method>,
    /// Number of sensors on the ring
    #[arg(long, value_name = "N", default_value_t = SENSORS as u8)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=24))]
    sensors: u8,
    /// The period in microseconds
    #[arg(long, value_name = "US", default_value_t = 60_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(45_000..=1_000_000))]
    period_us: u32,
    /// Write the readings of the first alcove by all methods as MCAP, for Foxglove and Rerun, instead
    #[arg(long, value_name = "FILE.mcap", conflicts_with_all = ["svg", "png", "json", "shard"])]
    mcap: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let options = options(args)?;
    if let Some(file) = &args.mcap {
        return first_alcove(file, &options);
    }
    let block = |first, seeds, watched: Watched<'_>| {
        Ok(set_one(&SetOneOptions { first, seeds, ..options.clone() }, watched)?.runs)
    };
    let seeds = (options.first, options.seeds);
    let ran = args.common.in_blocks(("set-one", "alcoves"), &options.methods, seeds, block)?;
    let Some((seeds, runs)) = ran else { return Ok(()) };
    let options = SetOneOptions { seeds, ..options };
    print(args, &options, &SetOne::of(&options, runs))
}

/// Prints the undivided result from the runs of all parts.
pub(super) fn merged(args: &Args, file: &Path, runs: &Runs) -> Result<(), InputError> {
    let options = options(args)?;
    let runs = runs_of(&options.methods, options.seeds, file, runs)?;
    print(args, &options, &SetOne::of(&options, runs))
}

fn options(args: &Args) -> Result<SetOneOptions, InputError> {
    let mut options = SetOneOptions {
        first: args.common.first,
        physics: args.common.physics,
        room: args.common.room(),
        transducer: Transducer { gain: args.common.gain, ..Transducer::POLAROID_6500 },
        methods: Entry::all(chosen(&args.methods, false)),
        sensors: args.sensors.into(),
        period: Micros::new(args.period_us),
        ..SetOneOptions::default()
    };
    options.seeds = args.common.seeds.unwrap_or(options.seeds);
    let watch = Watch::new();
    let robot = Robot { period: options.period, ..Alcove::random(0).robot_of(options.sensors) };
    let best = best_schedule_for(&robot, BUDGET, |progress| watch.go_on(|| designing(progress)));
    options.best = Some(best.map_err(|error| bad("set-one")(&error))?);
    Ok(options)
}

fn print(args: &Args, options: &SetOneOptions, found: &SetOne) -> Result<(), InputError> {
    args.common.draw("set-one", || draw::set_one(found))?;
    match &options.best {
        Some(best) if !args.common.json => tell(describe(found, best))?,
        _ => print_line(to_json(found))?,
    }
    Ok(())
}

/// Writes the readings of the first alcove by each method, and the scene.
fn first_alcove(file: &Path, options: &SetOneOptions) -> Result<(), InputError> {
    let bad = bad("set-one");
    let alcove = Alcove::random(options.first);
    let mut runs = Vec::new();
    let mut stage = None;
    for entry in &options.methods {
        let world = world_of(options, &alcove, entry).map_err(|error| bad(&error))?;
        let best = options.best.as_ref().map(|best| best.schedule);
        let periods = options.readings.div_ceil(options.sensors as u32);
        let simulation = Options { best, seed: Some(options.first), ..Options::periods(periods) };
        let readings = entry.simulate(&world, &simulation, &Stop::default(), |_| true);
        runs.push(readings.map_err(|error| bad(&error))?);
        // The places of walls and robot do not depend on the method.
        stage.get_or_insert(world);
    }
    let Some(world) = stage else { return Ok(()) };
    write_mcap(file, &Stage::of(&world), &runs)
}
