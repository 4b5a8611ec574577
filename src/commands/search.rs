//! `eeruf search`: the paper's problem, waits on a grid.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use eeruf_core::MAX_SENSORS;
use eeruf_core::search::wait::{Budget, COUNT_WORDS, Objective, memory_words};
use eeruf_core::search::{Found, Outcome, Progress, SearchError, WaitSearch};
use eeruf_design::FoundJson;

use super::answer::Answer;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::waits::{WaitSpec, read_waits};
use crate::report::json::to_json;
use crate::report::search::{CountJson, describe};
use crate::report::watch::Watch;

/// Find tables of waits as the paper does: lags are given, waits lie on a grid.
///
/// The file gives sensors, period_us, wait_max_us, tick_us, t_delta_us, and if need be t_lag_us, min_interval_us,
/// neighbours, layout and criterion. Without an option it prints one table. Exit code 0 if there is a table, 1 if it is
/// proven that there is none, 2 for bad input.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The ring
    #[arg(value_name = "RING.toml")]
    file: PathBuf,
    /// Count all tables
    #[arg(long, conflicts_with = "best")]
    count: bool,
    /// Find the table with the largest smallest interval, or with the largest T_delta
    #[arg(long, value_enum, value_name = "WHAT")]
    best: Option<Best>,
    /// How many nodes to search at most
    #[arg(long, default_value_t = u64::MAX, hide_default_value = true, value_name = "NODES")]
    budget: u64,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// How many nodes it may cost to find out which requirement cannot be met.
const REASON_BUDGET: u64 = 1_000_000;
/// After how many nodes each it is looked whether to go on.
const WATCHED_EVERY: u32 = 1 << 12;

#[derive(Clone, Copy, ValueEnum)]
enum Best {
    Interval,
    TDelta,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let spec = read_waits(&args.file)?;
    let found = if args.count { count(args, &spec) } else { find(args, &spec) };
    let (answer, text) = found.map_err(|error| InputError::new(&args.file, None, error))?;
    if args.json {
        print_line(text)?;
    } else {
        tell(text)?;
    }
    Ok(answer)
}

/// Counts the tables, and says how many.
fn count(args: &Args, spec: &WaitSpec) -> Result<(Answer, String), SearchError> {
    let search = WaitSearch::new(&spec.problem())?;
    let began = Instant::now();
    let mut watch = Watch::new();
    let mut watcher = |progress: &Progress| watch.control_flow(|| nodes_so_far(progress));
    let mut budget = Budget::nodes_at_most(args.budget).watched(WATCHED_EVERY, &mut watcher);
    let count = search.count(None, &mut vec![0; COUNT_WORDS], &mut budget)?;
    let exact = count.outcome == Outcome::Exhausted;
    let none = exact && count.count == 0;
    let text = if args.json {
        to_json(&CountJson { count: count.count, at_least: !exact })
    } else {
        let at_least = if exact { "" } else { "at least " };
        let seconds = began.elapsed().as_secs_f64();
        let mut text = format!("{at_least}{} tables ({} nodes in {seconds:.3} s)\n", count.count, count.nodes);
        if none {
            let why = search.why_none(REASON_BUDGET, &mut vec![0; memory_words(spec.problem().sensors)])?;
            text += &format!("{why}\n");
        }
        text
    };
    Ok((if none { Answer::No } else { Answer::Yes }, text))
}

/// Finds one table, or the best, and prints it.
fn find(args: &Args, spec: &WaitSpec) -> Result<(Answer, String), SearchError> {
    let search = WaitSearch::new(&spec.problem())?;
    let began = Instant::now();
    let mut watch = Watch::new();
    let mut watcher = |progress: &Progress| watch.control_flow(|| nodes_so_far(progress));
    let mut budget = Budget::nodes_at_most(args.budget).watched(WATCHED_EVERY, &mut watcher);
    let mut memory = vec![0; memory_words(spec.problem().sensors)];
    let found: Found<MAX_SENSORS> = match args.best {
        Some(Best::Interval) => search.best(Objective::Interval, &mut memory, &mut budget)?,
        Some(Best::TDelta) => search.best(Objective::Separation, &mut memory, &mut budget)?,
        None => {
            let (outcome, schedule) = search.first(&mut memory, &mut budget)?;
            let (proven, nodes) = (outcome != Outcome::BudgetSpent, budget.nodes());
            Found { schedule, value: None, bound: None, proven, nodes }
        }
    };
    let seconds = began.elapsed().as_secs_f64();
    let none = found.schedule.is_none() && found.proven;
    let text = if args.json {
        to_json(&FoundJson::new(&found, seconds))
    } else {
        let what = match args.best {
            Some(Best::Interval) => "smallest interval ",
            Some(Best::TDelta) => "t_delta ",
            None => "a table",
        };
        let mut text = format!("{}\n", describe(what, &found, seconds));
        if none {
            text += &format!("{}\n", search.why_none(REASON_BUDGET, &mut memory)?);
        }
        text
    };
    Ok((if none { Answer::No } else { Answer::Yes }, text))
}

fn nodes_so_far(progress: &Progress) -> String {
    format!("{} nodes", progress.nodes)
}
