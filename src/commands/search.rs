//! `eeruf lab search`: the paper's problem of waits on a grid.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use eeruf_core::MAX_SENSORS;
use eeruf_core::search::{
    Budget, COUNT_WORDS, Found, FrontTable, Outcome, Progress, SearchError, WaitSearch, memory_words,
};
use eeruf_design::FoundJson;

use super::Answer;
use super::arguments::seconds;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::waits::{WaitSpec, read_waits};
use crate::report::json::to_json;
use crate::report::search::{CountJson, FrontJson, NOT_DECIDED, describe, describe_front};
use crate::report::watch::Watch;

/// Find tables of waits on a grid, with given lags, as the paper does.
///
/// The file gives sensors, period_us, wait_max_us, tick_us, t_delta_us, and optionally t_lag_us, min_interval_us,
/// neighbours, layout and criterion. Without an option it prints one table. Exit code 0 if there is a table, 1 if it is
/// proven that there is none, 2 for bad input, 3 if the budget or the time limit ended the search before either.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The ring
    #[arg(value_name = "RING.toml")]
    file: PathBuf,
    /// Count all tables
    #[arg(long, conflicts_with = "best")]
    count: bool,
    /// Find the table with the largest smallest interval, with the largest T_delta, with the shortest waits, or with
    /// the shortest period for these lags; pareto: all tables that no other beats in one of the first two without
    /// losing in the other; by default any table
    #[arg(long, value_enum, value_name = "WHAT")]
    best: Option<Best>,
    /// Largest number of nodes to search; by default no limit
    #[arg(long, default_value_t = u64::MAX, hide_default_value = true, value_name = "NODES")]
    budget: u64,
    /// Time limit of the command, in seconds; by default none
    #[arg(long, value_name = "S", value_parser = seconds)]
    time_limit: Option<Duration>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Search budget, in nodes, to find out which requirement cannot be met.
const REASON_BUDGET: u64 = 2_000_000;
/// Number of nodes between two checks for Ctrl-C and time.
const WATCHED_EVERY: u32 = 1 << 12;

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Best {
    Interval,
    TDelta,
    Waits,
    Period,
    Pareto,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let spec = read_waits(&args.file)?;
    let watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let found = match args.best {
        _ if args.count => count(args, &spec, &watch),
        Some(Best::Pareto) => front(args, &spec, &watch),
        best => find(args, &spec, best, &watch),
    };
    drop(watch);
    let (answer, text) = found.map_err(|error| InputError::new(&args.file, error))?;
    if args.json {
        print_line(text)?;
    } else {
        tell(text)?;
    }
    Ok(answer)
}

/// Returns the answer of a search, by whether it found a table and completed its proof.
fn answer(found: bool, proven: bool) -> Answer {
    match (found, proven) {
        (true, _) => Answer::Yes,
        (false, true) => Answer::No,
        (false, false) => Answer::NotDecided,
    }
}

/// Searches up to this many nodes, unless the user ends it.
fn within<T>(nodes: u64, watch: &Watch, search: impl FnOnce(&mut Budget<'_>) -> T) -> T {
    let mut watcher = |progress: &Progress| watch.control_flow(|| format!("{} nodes", progress.nodes));
    search(&mut Budget::nodes_at_most(nodes).watched(WATCHED_EVERY, &mut watcher))
}

/// Returns the reason why there is no table, in a line.
fn why_none(search: &WaitSearch, memory: &mut [u32], watch: &Watch) -> Result<String, SearchError> {
    Ok(format!("{}\n", within(REASON_BUDGET, watch, |budget| search.why_none(memory, budget))?))
}

/// Counts the tables and prints the number.
fn count(args: &Args, spec: &WaitSpec, watch: &Watch) -> Result<(Answer, String), SearchError> {
    let search = WaitSearch::new(&spec.problem())?;
    let began = Instant::now();
    let ((outcome, count), nodes) =
        within(args.budget, watch, |budget| (search.count(None, &mut vec![0; COUNT_WORDS], budget), budget.nodes()));
    let exact = outcome == Outcome::Exhausted;
    let answer = answer(count > 0, exact);
    if args.json {
        return Ok((answer, to_json(&CountJson { count, at_least: !exact })));
    }
    let at_least = if exact { "" } else { "at least " };
    let seconds = began.elapsed().as_secs_f64();
    let mut text = format!("{at_least}{count} tables ({nodes} nodes in {seconds:.3} s)\n");
    match answer {
        Answer::No => text += &why_none(&search, &mut vec![0; memory_words(spec.problem().sensors)], watch)?,
        Answer::NotDecided => text += NOT_DECIDED,
        Answer::Yes => {}
    }
    Ok((answer, text))
}

/// Finds one table, or the best, and prints it.
fn find(args: &Args, spec: &WaitSpec, best: Option<Best>, watch: &Watch) -> Result<(Answer, String), SearchError> {
    let search = WaitSearch::new(&spec.problem())?;
    let began = Instant::now();
    let mut memory = vec![0; memory_words(spec.problem().sensors)];
    let (what, found): (_, Found<MAX_SENSORS>) = within(args.budget, watch, |budget| match best {
        Some(Best::Interval) => Ok(("smallest interval ", search.best_interval(&mut memory, budget)?)),
        Some(Best::TDelta) => Ok(("t_delta ", search.best_t_delta(&mut memory, budget)?)),
        Some(Best::Waits) => Ok(("longest wait ", search.shortest_waits(&mut memory, budget)?)),
        Some(Best::Period) => Ok(("period ", search.shortest_period(&mut memory, budget)?)),
        Some(Best::Pareto) | None => {
            let outcome = search.first(&mut memory, budget)?;
            let (proven, nodes) = (outcome != Outcome::BudgetSpent, budget.nodes());
            let schedule = if let Outcome::Found(schedule) = outcome { Some(schedule) } else { None };
            Ok::<_, SearchError>(("a table", Found { schedule, value: None, bound: None, proven, nodes }))
        }
    })?;
    let seconds = began.elapsed().as_secs_f64();
    let answer = answer(found.schedule.is_some(), found.proven);
    if args.json {
        return Ok((answer, to_json(&FoundJson::new(&found, seconds))));
    }
    let mut text = format!("{}\n", describe(what, &found, seconds));
    if matches!(answer, Answer::No) {
        text += &why_none(&search, &mut memory, watch)?;
    }
    Ok((answer, text))
}

/// Follows the Pareto front of interval and `t_delta`, and prints its tables.
fn front(args: &Args, spec: &WaitSpec, watch: &Watch) -> Result<(Answer, String), SearchError> {
    let search = WaitSearch::new(&spec.problem())?;
    let began = Instant::now();
    let mut memory = vec![0; memory_words(spec.problem().sensors)];
    let mut tables: Vec<FrontTable<MAX_SENSORS>> = Vec::new();
    let (complete, nodes) = within(args.budget, watch, |budget| {
        loop {
            match search.next_on_front(tables.last(), &mut memory, budget)? {
                Outcome::Found(table) => tables.push(table),
                outcome => break Ok::<_, SearchError>((outcome == Outcome::Exhausted, budget.nodes())),
            }
        }
    })?;
    let seconds = began.elapsed().as_secs_f64();
    let answer = answer(!tables.is_empty(), complete);
    if args.json {
        return Ok((answer, to_json(&FrontJson::new(&tables, complete, nodes, seconds))));
    }
    let mut text = describe_front(&tables, complete, nodes, seconds);
    if matches!(answer, Answer::No) {
        text += &why_none(&search, &mut memory, watch)?;
    }
    Ok((answer, text))
}
