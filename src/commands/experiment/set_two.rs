//! `eeruf lab experiment set-two`: a LabMate drives through a course of thin poles, over many courses.

use std::path::{Path, PathBuf};

use eeruf_core::Micros;
use eeruf_sim::LabMate;
use eeruf_sim::best_schedule_for;
use eeruf_sim::experiments::set_two::{
    Course, OdometryNoise, Pilots, SECOND_AHEAD, SECOND_BEHIND, SetTwo, SetTwoOptions, drive, set_two,
};
use eeruf_sim::{Entry, Method, Point, Robot};

use super::common::{BUDGET, Common, Watched, bad, designing, watched};
use super::shard::{Runs, runs_of};
use crate::commands::methods::chosen;
use crate::commands::show;
use crate::files::error::InputError;
use crate::files::mcap::{Stage, write_mcap};
use crate::report::draw;
use crate::report::experiment::set_two::{describe, describe_pilots};
use crate::report::watch::{Watch, was_stopped};

/// Set II: a LabMate drives through a course of 8 mm poles, about 1.6 m apart, steered by what its eight sensors
/// read.
///
/// The ring fills a histogram grid (HIMM), and the vector field histogram steers. Every method drives the same seeded
/// courses.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Drive by these methods only, separated by commas; by default sequential, far_groups, conventional, comparison,
    /// eeruf, eeruf_best, adaptive, flow and multi_echo
    #[arg(id = "method", long, value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Method>,
    /// Pilots: each method's own, found by the same search for each; one shared by all, found earlier by
    /// the score of eeruf; or the published settings, with and without the growth rate operator. Several are printed
    /// side by side
    #[arg(id = "pilot", long, value_name = "PILOT,..", value_delimiter = ',', default_value = "own")]
    pilots: Vec<Pilots>,
    /// Let another robot with 24 sensors fire 24 times in 80 ms in a corner of the lab: behind the start, or ahead,
    /// where all sensors face it; by default there is none
    #[arg(long, value_name = "WHERE", num_args = 0..=1, default_missing_value = "behind")]
    second_robot: Option<Corner>,
    /// The platform's highest speed in m/s
    #[arg(long, value_name = "M/S", default_value_t = 1.0, value_parser = speed)]
    speed: f64,
    /// Do not tell the ring the changes to expect from the robot's own motion, and compare within 500 us instead
    #[arg(long)]
    no_odometry: bool,
    /// Let the robot know its exact place; by default wheels slip and are measured with errors, and it is off by a
    /// decimetre or so at the end
    #[arg(long)]
    exact_odometry: bool,
    /// Give the robots bodies: a square for the platform, with the ring on its edge, and a disc for the second robot,
    /// an obstacle to sound and to the platform. The pilots were tuned without
    #[arg(long)]
    bodies: bool,
    /// Drive the first course alone, by one --method, and write its readings as MCAP, for Foxglove and Rerun
    #[arg(long, value_name = "FILE.mcap", conflicts_with_all = ["svg", "png", "json", "shard"])]
    mcap: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Corner {
    Behind,
    Ahead,
}

impl Corner {
    fn position(self) -> Point {
        match self {
            Self::Behind => SECOND_BEHIND,
            Self::Ahead => SECOND_AHEAD,
        }
    }
}

const SEEDS: u64 = 100;
/// `T_delta` that suffices for a robot at 1 m/s: 2 v dt / c is at most 0.434 ms.
const PAPERS_T_DELTA: Micros = Micros::new(500);

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if (0.1..=5.0).contains(&speed) => Ok(speed),
        _ => Err("expected 0.1 to 5".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let bad = bad("set-two");
    let options = options(args)?;
    let pilots = &args.pilots[..];
    if let Some(file) = &args.mcap {
        let ([entry], [pilots]) = (&options.methods[..], pilots) else {
            return Err(bad(&"--mcap needs one --method and one --pilot, whose first course is written"));
        };
        let options = SetTwoOptions { pilots: *pilots, ..options.clone() };
        let watched = watched(format!("course {}", options.first));
        let driven = drive(&options, entry, options.first, &watched).map_err(|error| bad(&error))?;
        return write_mcap(file, &Stage::driven(&driven.world, &driven.run.track), &[driven.readings]);
    }
    let is_part = args.common.shard.is_some();
    if pilots.len() > 1 && (is_part || args.common.draws_one()) {
        let of = if is_part { "--shard" } else { "a file for --svg or --png" };
        return Err(bad(&format!("{} pilots; {of} takes one", pilots.len())));
    }
    let mut each = Vec::new();
    for &pilots in pilots {
        let options = SetTwoOptions { pilots, ..options.clone() };
        let block = |first, seeds, watched: Watched<'_>| {
            let mut runs = set_two(&SetTwoOptions { first, seeds, ..options.clone() }, watched)?.runs;
            for run in runs.iter_mut().flatten().filter(|_| is_part) {
                // Only pictures need the tracks and grids, which take far more memory than the rest.
                (run.track, run.grid) = (vec![], vec![]);
            }
            Ok(runs)
        };
        let seeds = (options.first, options.seeds);
        let ran = args.common.in_blocks(("set-two", "courses"), &options.methods, seeds, block)?;
        let Some((seeds, runs)) = ran else { return Ok(()) };
        let found = SetTwo::of(&SetTwoOptions { seeds, ..options }, runs);
        args.common.draw(&picture_name(args.second_robot, pilots), || draw::courses(&found))?;
        each.push(found);
        if was_stopped() {
            break;
        }
    }
    print(args, &each)
}

/// Prints the undivided result from the runs of all parts.
pub(super) fn merged(args: &Args, file: &Path, runs: &Runs) -> Result<(), InputError> {
    let mut options = options(args)?;
    options.pilots = args.pilots.first().copied().unwrap_or_default();
    let runs = runs_of(&options.methods, options.seeds, file, runs)?;
    print(args, &[SetTwo::of(&options, runs)])
}

fn options(args: &Args) -> Result<SetTwoOptions, InputError> {
    let mut options = SetTwoOptions {
        seeds: args.common.seeds.unwrap_or(SEEDS),
        first: args.common.first,
        physics: args.common.physics,
        room: args.common.room(),
        gain: args.common.gain,
        bodies: args.bodies,
        second_robot: args.second_robot.map(Corner::position),
        labmate: LabMate { speed_max_m_s: args.speed, ..LabMate::default() },
        odometry: !args.no_odometry,
        odometry_noise: if args.exact_odometry { OdometryNoise::NONE } else { OdometryNoise::default() },
        t_delta: if args.no_odometry { PAPERS_T_DELTA } else { SetTwoOptions::default().t_delta },
        ..SetTwoOptions::default()
    };
    if !args.methods.is_empty() {
        options.methods = Entry::all(chosen(&args.methods, false));
    }
    if options.methods.iter().any(|entry| entry.method() == Method::EerufBest) {
        let watch = Watch::new();
        let robot = Robot { t_delta: options.t_delta, ..Course::random(0).robot() };
        let best = best_schedule_for(&robot, BUDGET, |progress| watch.go_on(|| designing(progress)));
        options.best = Some(best.map_err(|error| bad("set-two")(&error))?);
    }
    Ok(options)
}

fn print(args: &Args, each: &[SetTwo]) -> Result<(), InputError> {
    match each {
        [found] => show(args.common.json, || found, || describe(found))?,
        _ => show(args.common.json, || each, || describe_pilots(each))?,
    }
    Ok(())
}

fn picture_name(second_robot: Option<Corner>, pilots: Pilots) -> String {
    let corner = second_robot.map_or("", |corner| match corner {
        Corner::Behind => "-second-behind",
        Corner::Ahead => "-second-ahead",
    });
    let pilot = if pilots == Pilots::Own { String::new() } else { format!("-{pilots}") };
    format!("set-two{corner}{pilot}")
}
