//! `eeruf replay`: what the filter makes of recorded readings.

use std::path::PathBuf;

use eeruf_core::{EchoFilter, Micros};

use super::answer::Answer;
use crate::files::error::InputError;
use crate::files::log::{RangeScale, read_log};
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::replay::{Column, Counts, Replay, table};

/// Run the filter over a log of real readings: which would it have accepted?
///
/// The log is a CSV file with a header. A column is a sensor if the first value in it is a number: the range in metres.
/// Other columns are ignored. Each row is one firing of every sensor. An empty value, or one of no-echo-m or more, is
/// no echo.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG.csv")]
    file: PathBuf,
    /// T_delta: consecutive readings that differ by no more are near-identical
    #[arg(long, value_name = "N")]
    t_delta_us: u32,
    /// In m/s, to turn ranges back into echo times
    #[arg(long, default_value_t = 343.2, value_name = "C", value_parser = positive)]
    speed_of_sound: f64,
    /// The range in metres from which on a value means that there was no echo
    #[arg(long, default_value_t = 5.0, value_name = "M", value_parser = positive)]
    no_echo_m: f64,
    /// How many readings running must agree
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=8))]
    consecutive: u8,
    /// Draw what happened to each sensor over time, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("expected a number above zero".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let columns = filtered(args)?;
    if let Some(file) = &args.svg {
        draw::kinds_over_time(&columns, args.t_delta_us).save(file)?;
    }
    let counts: Vec<_> = columns.iter().map(Counts::of).collect();
    let total = counts.iter().fold(Counts::default(), Counts::plus);
    if args.json {
        println!("{}", to_json(&Replay { total, sensors: counts }));
    } else {
        println!("{}", table(&args.file, args.t_delta_us, &counts, &total));
    }
    Ok(Answer::Yes)
}

/// What the filter makes of each column.
fn filtered(args: &Args) -> Result<Vec<Column>, InputError> {
    let bad = |error: &dyn std::fmt::Display| InputError::new(&args.file, None, error);
    let scale = RangeScale { speed_of_sound: args.speed_of_sound, no_echo_m: args.no_echo_m };
    let mut columns = vec![];
    for log in read_log(&args.file, &scale)? {
        let mut filter =
            EchoFilter::<1>::new(Micros::new(args.t_delta_us), args.consecutive).map_err(|error| bad(&error))?;
        let mut kinds = vec![];
        for t_echo in log.t_echo {
            kinds.push(filter.push(0, t_echo).map_err(|error| bad(&error))?.kind);
        }
        columns.push(Column { name: log.name, kinds });
    }
    Ok(columns)
}
