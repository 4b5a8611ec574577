//! `eeruf search`: the paper's problem, waits on a grid.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use eeruf_core::search::wait::{Budget, COUNT_WORDS, Objective, memory_words};
use eeruf_core::search::{Found, Outcome, Progress, SearchError, WaitSearch};
use eeruf_core::{MAX_SENSORS, Micros};
use serde::Serialize;

use crate::Answer;
use crate::input::{InputError, ScheduleFile, to_json};
use crate::ring_file::{WaitSpec, read_waits};
use crate::watch::Watch;

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
    best: Option<What>,
    /// How many nodes to search at most
    #[arg(long, default_value_t = u64::MAX, hide_default_value = true, value_name = "NODES")]
    budget: u64,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// How many nodes it may cost to find out which need cannot be met.
const REASON_BUDGET: u64 = 1_000_000;

#[derive(Clone, Copy, ValueEnum)]
enum What {
    Interval,
    TDelta,
}

/// What `--count` prints.
#[derive(Serialize)]
struct CountJson {
    count: u128,
    /// Absent where the count is exact.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    at_least: bool,
}

/// Found, as Python names it.
#[derive(Serialize)]
struct FoundJson {
    schedule: Option<ScheduleFile>,
    value_us: Option<u32>,
    bound_us: Option<u32>,
    proven: bool,
    nodes: u64,
    seconds: f64,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let spec = read_waits(&args.file)?;
    answer(args, &spec).map_err(|error| InputError::new(&args.file, None, error))
}

fn answer(args: &Args, spec: &WaitSpec) -> Result<Answer, SearchError> {
    let search = WaitSearch::new(&spec.needs())?;
    let began = Instant::now();
    let mut watch = Watch::new();
    let mut watcher = |progress: &Progress| {
        if watch.go_on(|| format!("{} nodes", progress.nodes)) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let mut budget = Budget::nodes_at_most(args.budget).watched(1 << 12, &mut watcher);
    if args.count {
        let count = search.count(None, &mut vec![0; COUNT_WORDS], &mut budget)?;
        let exact = count.outcome == Outcome::Exhausted;
        if args.json {
            println!("{}", to_json(&CountJson { count: count.count, at_least: !exact }));
        } else {
            let at_least = if exact { "" } else { "at least " };
            println!(
                "{at_least}{} tables ({} nodes in {:.3} s)",
                count.count,
                count.nodes,
                began.elapsed().as_secs_f64()
            );
            if exact && count.count == 0 {
                println!("{}", search.why_none(REASON_BUDGET, &mut vec![0; memory_words(spec.needs().sensors)])?);
            }
        }
        return Ok(if exact && count.count == 0 { Answer::No } else { Answer::Yes });
    }
    let mut memory = vec![0; memory_words(spec.needs().sensors)];
    let found: Found<MAX_SENSORS> = match args.best {
        Some(What::Interval) => search.best(Objective::Interval, &mut memory, &mut budget)?,
        Some(What::TDelta) => search.best(Objective::Separation, &mut memory, &mut budget)?,
        None => {
            let (outcome, schedule) = search.first(&mut memory, &mut budget)?;
            let (proven, nodes) = (outcome != Outcome::BudgetSpent, budget.nodes());
            Found { schedule, value: None, bound: None, proven, nodes }
        }
    };
    let seconds = began.elapsed().as_secs_f64();
    if args.json {
        let us = |time: Option<Micros>| time.map(Micros::as_micros);
        println!(
            "{}",
            to_json(&FoundJson {
                schedule: found.schedule.as_ref().map(ScheduleFile::from),
                value_us: us(found.value),
                bound_us: us(found.bound),
                proven: found.proven,
                nodes: found.nodes,
                seconds,
            })
        );
    } else {
        describe(args, &found, seconds);
        if found.schedule.is_none() && found.proven {
            println!("{}", search.why_none(REASON_BUDGET, &mut memory)?);
        }
    }
    Ok(if found.schedule.is_none() && found.proven { Answer::No } else { Answer::Yes })
}

fn describe(args: &Args, found: &Found<MAX_SENSORS>, seconds: f64) {
    let cost = format!("{} nodes in {seconds:.3} s", found.nodes);
    let Some(schedule) = &found.schedule else {
        let verdict = if found.proven { "there is no such table: all were searched" } else { "no table found yet" };
        println!("{verdict} ({cost})");
        return;
    };
    let what = match args.best {
        Some(What::Interval) => "smallest interval ",
        Some(What::TDelta) => "t_delta ",
        None => "a table",
    };
    let value = found.value.map_or_else(String::new, |value| value.to_string());
    let proof = match (found.value, found.bound) {
        (Some(_), _) if found.proven => ", and no table has a larger one".to_owned(),
        (Some(_), Some(bound)) => format!(", at most {bound}"),
        _ => String::new(),
    };
    println!("{what}{value}{proof} ({cost})\n\n{}", schedule.to_toml());
}
