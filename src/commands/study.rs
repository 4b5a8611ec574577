//! `eeruf study`: every firing method in one scene, side by side on the same seed, and who was fooled by whom.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use eeruf_files::Kind;
use eeruf_sim::{
    Method, Options, Physics, SimulationError, Sketch, World, shortest_schedule_for, simulate_while, sweep,
};

use super::arguments::picture_folder;
use super::methods::chosen;
use super::rooms::{self, RoomArgs};
use super::{Answer, STUDY, show};
use crate::files::error::InputError;
use crate::files::firings::write_firings;
use crate::files::mcap::{Stage, write_mcap};
use crate::files::toml::read_world;
use crate::report::study::found::Study;
use crate::report::study::json::StudyJson;
use crate::report::study::{pictures, text};
use crate::report::watch::Watch;

/// Simulate every firing method in a scene: which readings are wrong, and who fools whom.
#[derive(clap::Args)]
#[command(after_long_help = every_method())]
pub(crate) struct Args {
    /// The scene; or a ring, which is judged in rooms
    #[arg(value_name = "SCENE.toml|RING.toml")]
    file: PathBuf,
    /// Number of the first robot's periods; by default 2000, or 250 if anything moves
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    periods: Option<u32>,
    /// Draw SVG pictures into this folder: scene, timing, readings and methods
    #[arg(long, value_name = "DIR", value_parser = picture_folder())]
    svg: Option<PathBuf>,
    /// Draw the same pictures as PNG
    #[arg(long, value_name = "DIR", value_parser = picture_folder())]
    png: Option<PathBuf>,
    /// Write every firing of the first robot and what it heard as CSV, or MCAP if the name ends in .mcap, for `eeruf
    /// diagnose`; needs one --method
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,
    /// Write all methods' readings as MCAP, for Foxglove and Rerun: ranges, poses, the scene and every reading's path
    #[arg(long, value_name = "FILE.mcap")]
    mcap: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Simulate only these methods, separated by commas: eeruf,sequential; by default all that fit the scene
    #[arg(long = "method", value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Method>,
    /// Seed of all that is random, a whole number; by default the scene's
    #[arg(long, value_name = "SEED")]
    seed: Option<u64>,
    /// Effects that are simulated: plain or default (see docs/explanation/physics.md); by default the scene's
    #[arg(long, value_name = "PRESET")]
    physics: Option<Physics>,
    #[command(flatten)]
    in_rooms: RoomArgs,
}

/// Every method with what it does, for the help.
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
    /// Returns the first option that was given and means nothing for a ring.
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
/// Paths have to be found again for every firing then.
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
            None => rooms::study(&args.in_rooms, &args.file, args.json),
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
    let study = study(args, &world)?;
    if let (Some(file), Some(readings)) = (&args.log, study.runs.first()) {
        write_firings(file, readings)?;
    }
    if let Some(file) = &args.mcap {
        write_mcap(file, &Stage::of(&world), &study.runs)?;
    }
    for (folder, ending) in [(&args.svg, "svg"), (&args.png, "png")] {
        if let Some(folder) = folder {
            pictures::pictures(folder, ending, &world, &study)?;
        }
    }
    let text = || text::describe(&args.file, &world, &study);
    show(args.json, || StudyJson::new(&args.file, &world, &study), text)?;
    Ok(Answer::Yes)
}

fn study(args: &Args, world: &World) -> Result<Study, InputError> {
    let sketched = world.robots().iter().any(|robot| robot.firing != Sketch::default());
    let methods = chosen(&args.methods, sketched);
    let bad = |error: &dyn std::fmt::Display| InputError::new(&args.file, error);
    let mut watch = Watch::new();
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
    let shared = Mutex::new((watch, vec![0.0; methods.len()]));
    let jobs: Vec<_> = methods.iter().copied().enumerate().collect();
    let results = sweep(&jobs, |&(index, method)| {
        let readings = simulate_while(world, method, &options, |share| {
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let (watch, shares) = &mut *shared;
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
            Err(SimulationError::Stopped) => return Err(bad(&"stopped by Ctrl-C")),
            // Asked for by name, or nothing to do with the method: then it is the answer to the question.
            Err(error) if !args.methods.is_empty() || matches!(error, SimulationError::Paths { .. }) => {
                return Err(bad(&error));
            }
            Err(error) => left_out.push((method, error.to_string())),
        }
    }
    Ok(Study { runs, left_out, best, periods, seed })
}
