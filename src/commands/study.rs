//! `eeruf study`: every firing method in one scene, side by side on the same seed, and who was fooled by whom.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use eeruf_files::Kind;
use eeruf_sim::experiments::measure::{Family, measure_in_scene};
use eeruf_sim::{
    Method, Options, Physics, SimulationError, Sketch, World, shortest_schedule_for, simulate_while, sweep,
};

use super::arguments::{is_picture, pictures};
use super::methods::chosen;
use super::rooms::{self, RoomArgs};
use super::{Answer, STUDY, show};
use crate::console::tell;
use crate::files::error::InputError;
use crate::files::firings::write_firings;
use crate::files::mcap::{Stage, write_mcap};
use crate::files::toml::read_world;
use crate::report::study::found::Study;
use crate::report::study::json::StudyJson;
use crate::report::study::{pictures as drawing, text};
use crate::report::three::Three;
use crate::report::watch::Watch;

/// Compare firing as sketches do, one by one and the recommended way in a scene, or for a ring in rooms.
///
/// Prints a row for each, and what to do: how soon the ring sees what steps before it (t95), how often foreign sound
/// stops the robot, how many sensors are blind, and how often it is right. In a scene 60 things appear (20 where
/// something moves), one at a time, before the first robot's sensors. A ring is judged as its file says it is used.
#[derive(clap::Args)]
#[command(after_long_help = every_method())]
pub(crate) struct Args {
    /// The scene; or a ring, which is judged in rooms
    #[arg(value_name = "SCENE.toml|RING.toml")]
    file: PathBuf,
    /// Print every method's tables too, and who fooled whom; of a ring every way, and the answer under other conditions
    #[arg(long)]
    all: bool,
    /// Number of the first robot's periods in tables, which it prints as --all does, and pictures; by default 2000, or
    /// 250 if anything moves
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    periods: Option<u32>,
    /// Draw SVG pictures of all methods into this folder; or their comparison alone, if the name ends in .svg or .png
    #[arg(long, value_name = "DIR|FILE", value_parser = pictures())]
    svg: Option<PathBuf>,
    /// Draw the same pictures as PNG
    #[arg(long, hide_short_help = true, value_name = "DIR|FILE", value_parser = pictures())]
    png: Option<PathBuf>,
    /// Write every firing of the first robot and what it heard as CSV, or MCAP if the name ends in .mcap, for `eeruf
    /// diagnose`; needs one --method
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Write all methods' readings as MCAP, for Foxglove and Rerun: ranges, poses, the scene and every reading's path
    #[arg(long, hide_short_help = true, value_name = "FILE.mcap")]
    mcap: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Print the tables of these methods alone, separated by commas: eeruf,sequential; by default three ways, and in
    /// JSON and pictures all that fit the scene
    #[arg(long = "method", value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Method>,
    /// Seed of the random numbers, a whole number; by default the scene's
    #[arg(long, hide_short_help = true, value_name = "SEED")]
    seed: Option<u64>,
    /// Simulated effects: plain or default (see docs/explanation/physics.md); by default the scene's
    #[arg(long, hide_short_help = true, value_name = "PRESET")]
    physics: Option<Physics>,
    #[command(flatten)]
    in_rooms: RoomArgs,
}

/// Every method with its description, for the help.
fn every_method() -> String {
    let row = |method: Method| format!("\n  {:<19} {}", method.as_str(), method.about());
    let rows = |of: fn(&Method) -> bool| Method::ALL.into_iter().filter(of).map(row).collect::<String>();
    let usual = rows(|method| !method.is_sketch() && !method.is_on_demand());
    let by_name = rows(|method| method.is_on_demand());
    let sketched = rows(|method| method.is_sketch() && !method.is_on_demand());
    let sketches = "Where the scene says `firing`, as rings are fired today";
    format!("Methods:{usual}\nBy --method alone:{by_name}\n{sketches}:{sketched}\n\n{STUDY}")
}

impl Args {
    /// Returns the first of these options that was given, to refuse it for a ring.
    fn of_scenes(&self) -> Option<&'static str> {
        let given = [
            ("--periods", self.periods.is_some()),
            ("--svg", self.svg.is_some()),
            ("--png", self.png.is_some()),
            ("--log", self.log.is_some()),
            ("--mcap", self.mcap.is_some()),
            ("--method", !self.methods.is_empty()),
            ("--seed", self.seed.is_some()),
            ("--physics", self.physics.is_some()),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(name, _)| name)
    }
}

const PERIODS: u32 = 2000;
/// Number of periods in moving scenes, whose paths are found again for every firing.
const PERIODS_IF_MOVING: u32 = 250;
/// Budget of nodes for the search for `eeruf_best`.
const BUDGET: u64 = 20_000;

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let refuse = |option: &str, of: &str| {
        let file = args.file.display();
        Err(InputError::new(option, format!("given with {file}; expected it with {of} alone")))
    };
    if Kind::of_file(&args.file) == Some(Kind::Ring) {
        return match args.of_scenes() {
            Some(option) => refuse(option, "a scene"),
            None => rooms::study(&args.in_rooms, &args.file, args.json, args.all),
        };
    }
    if let Some(option) = args.in_rooms.given() {
        return refuse(option, "a ring file");
    }
    let mut world = read_world(&args.file)?;
    if let Some(physics) = args.physics {
        world = world.with_physics(physics).map_err(|error| InputError::new(&args.file, error))?;
    }
    if args.log.is_some() && args.methods.len() != 1 {
        let message = format!("{} methods; expected one --method, whose firings it writes", args.methods.len());
        return Err(InputError::new("--log", message));
    }
    let has_tables = args.all || args.periods.is_some() || !args.methods.is_empty();
    let draws = args.svg.is_some() || args.png.is_some();
    let simulates = has_tables || draws || args.json || args.mcap.is_some();
    let watch = Watch::new();
    let mut text = String::new();
    if args.methods.is_empty() && !args.json {
        text = three_ways(args, &world, &watch)?;
    }
    if !simulates {
        tell(text + MORE)?;
        return Ok(Answer::Yes);
    }
    let study = study(args, &world, &{ watch })?;
    if let (Some(file), Some(readings)) = (&args.log, study.runs.first()) {
        write_firings(file, readings)?;
    }
    if let Some(file) = &args.mcap {
        write_mcap(file, &Stage::of(&world), &study.runs)?;
    }
    let mut drawn = String::new();
    for (folder, ending) in [(&args.svg, "svg"), (&args.png, "png")] {
        if let Some(folder) = folder {
            if is_picture(folder) {
                drawing::comparison(&study, folder)?;
                continue;
            }
            let count = drawing::pictures(folder, ending, &world, &study)?;
            drawn += &format!("{count} pictures in {}.{}", folder.display(), if has_tables { "\n" } else { " " });
        }
    }
    let tables = match has_tables {
        true => text::describe(&args.file, &world, &study),
        false => MORE.to_owned(),
    };
    show(args.json, || StudyJson::new(&args.file, &world, &study), || text + &drawn + &tables)?;
    Ok(Answer::Yes)
}

/// The hint at the option that prints the rest of the answer.
const MORE: &str = "`--all`: every method, and who fooled whom.\n";

/// Number of trials of each way for choosing votes, and again for the report; the second number is for moving scenes.
const TRIALS: u64 = 60;
const TRIALS_IF_MOVING: u64 = 20;

/// Writes the first answer: how soon the first robot sees what appears, and how often it stops for nothing.
fn three_ways(args: &Args, world: &World, watch: &Watch) -> Result<String, InputError> {
    let methods = [Method::Blocking, Method::Sequential, Method::InTurn].map(|method| (Family::OneByOne, method));
    let methods = [&methods[..], &[(Family::Flow, Method::Flow)]].concat();
    // Other things for each seed.
    let trials = if world.moves() { TRIALS_IF_MOVING } else { TRIALS };
    let first = (args.seed.unwrap_or(world.seed()) % (1 << 32)) * 2 * trials;
    let measured = |first: u64, part: f64| {
        let goes_on = |share: f64| watch.go_on(|| format!("three ways, {:.0} % done", 50.0 * (part + share)));
        measure_in_scene(world, &methods, first..first + trials, &goes_on)
            .map_err(|error| InputError::new(&args.file, error))
    };
    let (chosen, measured) = (measured(first, 0.0)?, measured(first + trials, 1.0)?);
    let sensors = world.robots().first().map_or(0, |robot| robot.sensors.len());
    let things = measured.under.iter().flat_map(|under| &under.places).filter(|place| place.thing.is_some()).count();
    let of = if world.robots().len() > 1 { " of robot 1" } else { "" };
    let title = format!("{}: {sensors} sensors{of}; {things} things appear before them.\n\n", args.file.display());
    let three = Three { chosen: &chosen, measured: &measured };
    Ok(title + &three.describe() + "For your ring: `eeruf design RING.toml --program arduino` (or c, rust, ..).\n")
}

fn study(args: &Args, world: &World, watch: &Watch) -> Result<Study, InputError> {
    let sketched = world.robots().iter().any(|robot| robot.firing != Sketch::default());
    let methods = chosen(&args.methods, sketched);
    let bad = |error: &dyn std::fmt::Display| InputError::new(&args.file, error);
    let best = if methods.contains(&Method::EerufBest) {
        let robot = world.robots().first().ok_or_else(|| bad(&"no robot"))?;
        let best = shortest_schedule_for(robot, BUDGET, |progress| {
            watch.go_on(|| format!("designing eeruf_best, {} nodes", progress.nodes))
        });
        Some(best.map_err(|error| bad(&error))?)
    } else {
        None
    };
    let periods = args.periods.unwrap_or(if world.moves() { PERIODS_IF_MOVING } else { PERIODS });
    let seed = args.seed.unwrap_or(world.seed());
    let options =
        Options { seed: Some(seed), best: best.as_ref().map(|best| best.schedule), ..Options::periods(periods) };
    let shares = Mutex::new(vec![0.0; methods.len()]);
    let jobs: Vec<_> = methods.iter().copied().enumerate().collect();
    let results = sweep(&jobs, |&(index, method)| {
        let readings = simulate_while(world, method, &options, |share| {
            let mut shares = shares.lock().unwrap_or_else(PoisonError::into_inner);
            shares[index] = share;
            let done = shares.iter().sum::<f64>() / shares.len() as f64;
            watch.go_on(|| format!("{periods} periods of {} methods, {:.0} % done", shares.len(), 100.0 * done))
        });
        (method, readings)
    });
    let (mut runs, mut left_out) = (vec![], vec![]);
    for (method, result) in results {
        match result {
            Ok(readings) => runs.push(readings),
            Err(SimulationError::Stopped) => left_out.push((method, "stopped by Ctrl-C".to_owned())),
            // The error of a method that was named, or one that concerns all methods, ends the command.
            Err(error) if !args.methods.is_empty() || matches!(error, SimulationError::Paths { .. }) => {
                return Err(bad(&error));
            }
            Err(error) => left_out.push((method, error.to_string())),
        }
    }
    if runs.is_empty() {
        return Err(bad(&"stopped by Ctrl-C before a method was done"));
    }
    Ok(Study { runs, left_out, best, periods, seed })
}
