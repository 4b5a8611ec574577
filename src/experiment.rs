//! `eeruf experiment`: Section 4 of the paper as two commands, with its own figures beside those found here.

mod set_one;
mod set_two;

use std::fmt;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use comfy_table::{CellAlignment, Table, presets};
use eeruf_sim::experiments::Spread;

use crate::Answer;
use crate::input::InputError;
use crate::watch::Watch;

/// Repeat an experiment of the paper over many seeded geometries or courses, by every method.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    set: Set,
}

#[derive(clap::Subcommand)]
enum Set {
    SetOne(set_one::Args),
    SetTwo(set_two::Args),
}

/// What both sets are asked.
#[derive(clap::Args)]
struct Common {
    /// How many geometries or courses
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: Option<u64>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Draw SVG pictures into this folder
    #[arg(long, value_name = "DIR")]
    svg: Option<PathBuf>,
    /// Draw the same pictures as PNG
    #[arg(long, value_name = "DIR")]
    png: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    match &args.set {
        Set::SetOne(args) => set_one::run(args)?,
        Set::SetTwo(args) => set_two::run(args)?,
    }
    Ok(Answer::Yes)
}

/// An experiment has no file; what is wrong with it is said after its name.
fn bad(set: &'static str) -> impl Fn(&dyn fmt::Display) -> InputError {
    move |error| InputError::new(set.as_ref(), None, error)
}

/// Watches a run of several threads.
fn watched(what: String) -> impl Fn(f64) -> bool + Sync {
    let watch = Mutex::new(Watch::new());
    move |done| {
        let mut watch = watch.lock().unwrap_or_else(PoisonError::into_inner);
        watch.go_on(|| format!("{what}, {:.0} % done", 100.0 * done))
    }
}

/// A table in Markdown, numbers to the right.
fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header(header.iter().copied());
    table.add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("{table}\n")
}

/// A share in per cent, with as many digits as tell something.
fn percent(share: f64) -> String {
    let digits = usize::from(share < 0.0995);
    format!("{:.digits$}", 100.0 * share)
}

/// 10 %, median and 90 % of shares, in per cent.
fn percents(spread: Option<Spread>) -> String {
    spread.map_or_else(
        || "-".to_owned(),
        |Spread { p10, median, p90 }| format!("{} / {} / {}", percent(p10), percent(median), percent(p90)),
    )
}

/// The median alone.
fn median(spread: Option<Spread>, digits: usize) -> String {
    spread.map_or_else(|| "-".to_owned(), |spread| format!("{:.digits$}", spread.median))
}
