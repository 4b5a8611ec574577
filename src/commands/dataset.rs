//! `eeruf lab dataset`: simulated readings with the cause of each.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use eeruf_sim::experiments::set_one::{Alcove, SetOneOptions, world_of};
use eeruf_sim::experiments::set_two::{SetTwoOptions, drive};
use eeruf_sim::{Method, Options, Physics, World, simulate_while, sweep, world_file};
use serde_json::json;

use super::Answer;
use crate::console::tell;
use crate::files::error::InputError;
use crate::files::truth::{readings_csv, track_csv};
use crate::files::write::{make_folder, write};
use crate::report::json::to_json;
use crate::report::watch::Watch;

/// Write simulated readings with ground truth, in alcoves and on courses of poles.
///
/// Each reading comes with the sensor's reading alone and with the source of its sound.
///
/// docs/how-to/dataset.md is its data card. The same arguments write the same files.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder to create
    #[arg(value_name = "OUT")]
    out: PathBuf,
    /// Number of alcoves of Set I
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(..=1000))]
    alcoves: u64,
    /// Number of courses of Set II
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(..=1000))]
    courses: u64,
    /// Number of the first alcove and of the first course
    #[arg(long, value_name = "N", default_value_t = 60_000)]
    first: u64,
    /// Number of periods of 60 ms in each alcove
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    periods: u32,
    /// Simulated effects: plain, or default (see docs/explanation/physics.md)
    #[arg(long, value_name = "PRESET", default_value = "default")]
    physics: Physics,
}

/// The methods: one that believes everything, the paper's, and flow.
const METHODS: [Method; 3] = [Method::Conventional, Method::Eeruf, Method::Flow];

/// One file of readings.
#[derive(Clone, Copy)]
enum Job {
    Alcove(u64, Method),
    Course(u64, Method),
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let end = |count: u64| {
        let refused = || format!("{}; expected at most {}", args.first, u64::MAX - count);
        args.first.checked_add(count).ok_or_else(|| InputError::new("--first", refused()))
    };
    let (alcoves, courses) = (args.first..end(args.alcoves)?, args.first..end(args.courses)?);
    if alcoves.is_empty() && courses.is_empty() {
        return Err(InputError::new("--alcoves", "0, and --courses: 0; expected one or more of either"));
    }
    let each = |number: u64| METHODS.map(|method| (number, method));
    let mut jobs: Vec<_> = alcoves.flat_map(each).map(|(number, method)| Job::Alcove(number, method)).collect();
    jobs.extend(courses.flat_map(each).map(|(number, method)| Job::Course(number, method)));
    let (watch, done) = (Watch::new(), AtomicUsize::new(0));
    let go_on = |is_done: bool| {
        let done = done.fetch_add(usize::from(is_done), Ordering::Relaxed);
        watch.go_on(|| format!("{done} of {} files", jobs.len()))
    };
    let written = sweep(&jobs, |&job| {
        match job {
            Job::Alcove(number, method) => alcove(args, number, method, &|_| go_on(false))?,
            Job::Course(number, method) => course(args, number, method, &|_| go_on(false))?,
        }
        go_on(true);
        Ok::<_, InputError>(())
    });
    written.into_iter().collect::<Result<Vec<_>, _>>()?;
    let about = json!({
        "about": "simulated ultrasonic rings with ground truth; docs/how-to/dataset.md of eeruf says what is in it",
        "eeruf": env!("CARGO_PKG_VERSION"),
        "physics": args.physics.name(),
        "first": args.first, "alcoves": args.alcoves, "courses": args.courses, "periods": args.periods,
        "methods": METHODS.map(Method::as_str),
        "licence": "CC0-1.0",
    });
    write(&args.out.join("dataset.json"), to_json(&about) + "\n")?;
    tell(format!("{} files of readings in {}.\n", jobs.len(), args.out.display()))?;
    Ok(Answer::Yes)
}

fn folder(args: &Args, kind: &str, number: u64) -> Result<PathBuf, InputError> {
    let folder = args.out.join(kind).join(number.to_string());
    make_folder(&folder)?;
    Ok(folder)
}

fn alcove(args: &Args, number: u64, method: Method, go_on: &dyn Fn(f64) -> bool) -> Result<(), InputError> {
    let folder = folder(args, "alcoves", number)?;
    let bad = |error: &dyn std::fmt::Display| InputError::new(&folder, error);
    let options = SetOneOptions { physics: args.physics, ..SetOneOptions::default() };
    let world = world_of(&options, &Alcove::random(number), &method.into());
    let world = world.map_err(|error| bad(&error))?.with_seed(number);
    if method == METHODS[0] {
        write(&folder.join("scene.toml"), scene_file(&world))?;
    }
    let readings =
        simulate_while(&world, method, &Options::periods(args.periods), go_on).map_err(|error| bad(&error))?;
    write(&file(&folder, method), readings_csv(&readings))
}

fn course(args: &Args, number: u64, method: Method, go_on: &dyn Fn(f64) -> bool) -> Result<(), InputError> {
    let folder = folder(args, "courses", number)?;
    let bad = |error: &dyn std::fmt::Display| InputError::new(&folder, error);
    let options = SetTwoOptions { physics: args.physics, ..SetTwoOptions::default() };
    let driven = drive(&options, &method.into(), number, go_on).map_err(|error| bad(&error))?;
    if method == METHODS[0] {
        write(&folder.join("scene.toml"), scene_file(&driven.world))?;
    }
    write(&folder.join(format!("{method}-track.csv")), track_csv(&driven.run.track))?;
    write(&file(&folder, method), readings_csv(&driven.readings))
}

fn scene_file(world: &World) -> String {
    let (noise, physics) = (world.noise(), world.physics());
    world_file(world.scene(), world.robots(), &noise, &physics, world.max_order(), world.seed(), world.faults())
}

fn file(folder: &Path, method: Method) -> PathBuf {
    folder.join(format!("{method}.csv"))
}
