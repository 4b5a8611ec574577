//! `eeruf lab experiment set-one`: eight sensors in front of three walls at right angles, over many alcoves.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use eeruf_core::Micros;
use eeruf_sim::best_schedule_for;
use eeruf_sim::experiments::set_one::{Alcove, SENSORS, SetOne, SetOneOptions, set_one, world_of};
use eeruf_sim::{Entry, GainProfile, Method, Options, Robot, Stop, Transducer};

use super::common::{BUDGET, Common, Watched, bad, designing, watched};
use super::shard::{Runs, runs_of};
use crate::commands::methods::chosen;
use crate::commands::show;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::mcap::{Stage, write_mcap};
use crate::report::draw;
use crate::report::experiment::set_one::{describe, describe_variations};
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
    #[arg(long = "method", value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Method>,
    /// Number of sensors on the ring
    #[arg(long, value_name = "N", default_value_t = SENSORS as u8)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=24))]
    sensors: u8,
    /// The period in microseconds
    #[arg(long, value_name = "US", default_value_t = 60_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(45_000..=1_000_000))]
    period_us: u32,
    /// Print instead how results vary with the receiver's gain, the floor of its pattern, and fading; by default for
    /// sequential, conventional, comparison, eeruf, flow and multi_echo
    #[arg(long, conflicts_with_all = ["svg", "png", "shard"])]
    vary: bool,
    /// Write the readings of the first alcove by all methods as MCAP, for Foxglove and Rerun, instead
    #[arg(long, value_name = "FILE.mcap", conflicts_with_all = ["vary", "svg", "png", "json", "shard"])]
    mcap: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let options = options(args)?;
    if args.vary {
        return vary(args, &options);
    }
    if let Some(file) = &args.mcap {
        return first_alcove(file, &options);
    }
    let block = |first, seeds, watched: Watched<'_>| {
        Ok(set_one(&SetOneOptions { first, seeds, ..options.clone() }, watched)?.runs)
    };
    let seeds = (options.first, options.seeds);
    let ran = args.common.in_blocks(("set-one", "alcoves"), || words(args), &options.methods, seeds, block)?;
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

/// Returns the arguments that decide what is run.
fn words(args: &Args) -> Vec<String> {
    let mut words = args.common.words(SetOneOptions::default().seeds);
    words.insert(0, "set-one".to_owned());
    let methods: Vec<_> = chosen(&args.methods, false).iter().map(Method::to_string).collect();
    let (sensors, period_us) = (args.sensors.to_string(), args.period_us.to_string());
    let own = [("--method", &methods.join(",")), ("--sensors", &sensors), ("--period-us", &period_us)];
    words.extend(own.into_iter().flat_map(|(option, value)| [option.to_owned(), value.clone()]));
    words
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

/// A variation of one setting: its name, and the change of the options.
type Variation = (&'static str, fn(SetOneOptions) -> SetOneOptions);

const VARIATIONS: [Variation; 8] = [
    ("as it is", |options| options),
    ("gain with the root of time", |options| gain(options, GainProfile::SquareRoot)),
    ("gain with time", |options| gain(options, GainProfile::Linear)),
    ("pattern's floor -22 dB", |options| floor(options, -22.0)),
    ("pattern's floor -34 dB", |options| floor(options, -34.0)),
    ("pattern's floor -40 dB", |options| floor(options, -40.0)),
    ("no fading", |options| fading(options, 0.0)),
    ("fading 3 dB", |options| fading(options, 3.0)),
];

fn gain(mut options: SetOneOptions, gain: GainProfile) -> SetOneOptions {
    options.transducer.gain = gain;
    options
}

fn floor(mut options: SetOneOptions, floor_db: f64) -> SetOneOptions {
    options.transducer.pattern_floor = 10f64.powf(floor_db / 20.0);
    options
}

fn fading(mut options: SetOneOptions, fading_db_rms: f64) -> SetOneOptions {
    options.noise.fading_db_rms = fading_db_rms;
    options
}

/// The methods that `--vary` shows by default.
const VARIED: [Method; 7] = [
    Method::Sequential,
    Method::SequentialVotes,
    Method::Conventional,
    Method::Comparison,
    Method::Eeruf,
    Method::Flow,
    Method::MultiEcho,
];

/// Runs Set I with one setting after another changed.
fn vary(args: &Args, options: &SetOneOptions) -> Result<(), InputError> {
    let methods = if args.methods.is_empty() { Entry::all(VARIED) } else { options.methods.clone() };
    let options = SetOneOptions { methods, steps: 0, ..options.clone() };
    let mut found = Vec::new();
    for (name, with) in VARIATIONS {
        let watched = watched(format!("{} alcoves, {name}", options.seeds));
        let table = set_one(&with(options.clone()), &watched).map_err(|error| bad("set-one")(&error))?;
        found.push((name, table));
    }
    let tables = || found.iter().map(|(name, table)| (*name, serde_json::json!(table)));
    Ok(show(args.common.json, || tables().collect::<BTreeMap<_, _>>(), || describe_variations(&found))?)
}
