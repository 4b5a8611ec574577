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
    let (answer, text) = searched(args, &spec).map_err(|error| InputError::new(&args.file, error))?;
    if args.json {
        print_line(text)?;
    } else {
        tell(text)?;
    }
    Ok(answer)
}

/// Searches, and returns the answer, as JSON or as text; without a table the text says why there is none.
fn searched(args: &Args, spec: &WaitSpec) -> Result<(Answer, String), SearchError> {
    let watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let (search, mut memory) = (WaitSearch::new(&spec.problem())?, vec![0; memory_words(spec.problem().sensors)]);
    let found = within(args.budget, &watch, |budget| match args.best {
        _ if args.count => Ok(count(&search, budget)),
        Some(Best::Pareto) => front(&search, &mut memory, budget),
        best => find(&search, &mut memory, best, budget),
    })?;
    let answer = match (found.any, found.proven) {
        (true, _) => Answer::Yes,
        (false, true) => Answer::No,
        (false, false) => Answer::NotDecided,
    };
    if args.json {
        return Ok((answer, found.json));
    }
    let mut text = found.text;
    if matches!(answer, Answer::No) {
        // The requirement that cannot be met, in a line.
        let why = within(REASON_BUDGET, &watch, |budget| search.why_none(&mut memory, budget))?;
        text += &format!("{why}\n");
    }
    Ok((answer, text))
}

/// Result of a search: whether there is a table, whether no answer is missing, and both forms of the output.
struct Answered {
    any: bool,
    proven: bool,
    json: String,
    text: String,
}

/// Searches up to this many nodes, unless the user ends it.
fn within<T>(nodes: u64, watch: &Watch, search: impl FnOnce(&mut Budget<'_>) -> T) -> T {
    let mut watcher = |progress: &Progress| watch.control_flow(|| format!("{} nodes", progress.nodes));
    search(&mut Budget::nodes_at_most(nodes).watched(WATCHED_EVERY, &mut watcher))
}

/// Counts the tables.
fn count(search: &WaitSearch, budget: &mut Budget<'_>) -> Answered {
    let began = Instant::now();
    let (outcome, count) = search.count(None, &mut vec![0; COUNT_WORDS], budget);
    let (proven, nodes, seconds) = (outcome == Outcome::Exhausted, budget.nodes(), began.elapsed().as_secs_f64());
    let at_least = if proven { "" } else { "at least " };
    let mut text = format!("{at_least}{count} tables ({nodes} nodes in {seconds:.3} s)\n");
    if count == 0 && !proven {
        text += NOT_DECIDED;
    }
    Answered { any: count > 0, proven, json: to_json(&CountJson { count, at_least: !proven }), text }
}

/// Finds one table, or the best.
fn find(
    search: &WaitSearch,
    memory: &mut [u32],
    best: Option<Best>,
    budget: &mut Budget<'_>,
) -> Result<Answered, SearchError> {
    let began = Instant::now();
    let (what, found): (_, Found<MAX_SENSORS>) = match best {
        Some(Best::Interval) => ("smallest interval ", search.best_interval(memory, budget)?),
        Some(Best::TDelta) => ("t_delta ", search.best_t_delta(memory, budget)?),
        Some(Best::Waits) => ("longest wait ", search.shortest_waits(memory, budget)?),
        Some(Best::Period) => ("period ", search.shortest_period(memory, budget)?),
        Some(Best::Pareto) | None => {
            let outcome = search.first(memory, budget)?;
            let (proven, nodes) = (outcome != Outcome::BudgetSpent, budget.nodes());
            let schedule = if let Outcome::Found(schedule) = outcome { Some(schedule) } else { None };
            ("a table", Found { schedule, value: None, bound: None, proven, nodes })
        }
    };
    let seconds = began.elapsed().as_secs_f64();
    let (json, text) = (to_json(&FoundJson::new(&found, seconds)), format!("{}\n", describe(what, &found, seconds)));
    Ok(Answered { any: found.schedule.is_some(), proven: found.proven, json, text })
}

/// Follows the Pareto front of interval and `t_delta`.
fn front(search: &WaitSearch, memory: &mut [u32], budget: &mut Budget<'_>) -> Result<Answered, SearchError> {
    let began = Instant::now();
    let mut tables: Vec<FrontTable<MAX_SENSORS>> = Vec::new();
    let proven = loop {
        match search.next_on_front(tables.last(), memory, budget)? {
            Outcome::Found(table) => tables.push(table),
            outcome => break outcome == Outcome::Exhausted,
        }
    };
    let (nodes, seconds) = (budget.nodes(), began.elapsed().as_secs_f64());
    let json = to_json(&FrontJson::new(&tables, proven, nodes, seconds));
    Ok(Answered { any: !tables.is_empty(), proven, json, text: describe_front(&tables, proven, nodes, seconds) })
}
