//! `eeruf replay`: what the filter makes of recorded readings.

use std::io::Read;
use std::path::PathBuf;

use comfy_table::{CellAlignment, Table, presets};
use eeruf_core::{EchoFilter, Micros, ReadingKind, Tally};
use serde::Serialize;

use crate::Answer;
use crate::draw;
use crate::input::{InputError, to_json};

/// Run the filter over a log of real readings: which would it have believed?
///
/// The log is a CSV file with a header. A column is a sensor if the first value in it is a number: the range in metres. Other
/// columns are ignored. Each row is one firing of every sensor. An empty value, or one of no-echo-m or more, is no echo.
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

/// What the filter made of one sensor's readings, one for each row.
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) kinds: Vec<ReadingKind>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let log = std::fs::File::open(&args.file).map_err(|error| InputError::new(&args.file, None, error))?;
    let columns = filter(args, log)?;
    if let Some(file) = &args.svg {
        draw::kinds_over_time(&columns, args.t_delta_us).save(file)?;
    }
    let counts: Vec<_> = columns.iter().map(Counts::of).collect();
    let total = counts.iter().fold(Counts::default(), Counts::plus);
    if args.json {
        println!("{}", to_json(&Replay { total, sensors: counts }));
    } else {
        println!("{}", table(args, &counts, &total));
    }
    Ok(Answer::Yes)
}

fn filter(args: &Args, log: impl Read) -> Result<Vec<Column>, InputError> {
    let bad = |line, message: &dyn std::fmt::Display| InputError::new(&args.file, line, message);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(log);
    let header = reader.headers().map_err(|error| bad(None, &error))?.clone();
    let rows = reader
        .records()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| bad(error.position().map(csv::Position::line), &error))?;
    let mut columns = vec![];
    for (place, name) in header.iter().enumerate() {
        let values = || rows.iter().map(|row| row.get(place).unwrap_or_default());
        let first = values().find(|text| !text.is_empty());
        if first.is_none_or(|text| text.parse::<f64>().is_err()) {
            continue;
        }
        let mut filter =
            EchoFilter::<1>::new(Micros::new(args.t_delta_us), args.consecutive).map_err(|error| bad(None, &error))?;
        let mut kinds = vec![];
        for (row, text) in rows.iter().zip(values()) {
            let line = row.position().map(csv::Position::line);
            let t_echo = echo_time(args, text)
                .map_err(|expected| bad(line, &format!("column {name}: `{text}`; expected {expected}")))?;
            let verdict = filter.push(0, t_echo).map_err(|error| bad(line, &error))?;
            kinds.push(verdict.kind);
        }
        columns.push(Column { name: name.to_owned(), kinds });
    }
    if columns.is_empty() {
        return Err(bad(None, &"no readings; expected a header and rows with a range in metres for each sensor"));
    }
    Ok(columns)
}

/// The echo time of a range in metres: `2 d / c`, rounded to the microsecond.
fn echo_time(args: &Args, text: &str) -> Result<Option<Micros>, &'static str> {
    if text.is_empty() {
        return Ok(None);
    }
    let range_m: f64 = text.parse().map_err(|_| "a range in metres")?;
    if range_m.is_nan() || range_m >= args.no_echo_m {
        return Ok(None);
    }
    if range_m < 0.0 {
        return Err("a range of zero metres or more");
    }
    let us = (2e6 * range_m / args.speed_of_sound).round();
    if us >= f64::from(u32::MAX) {
        return Err("a range that sound covers within an hour");
    }
    Ok(Some(Micros::new(us as u32)))
}

/// What `--json` prints.
#[derive(Serialize)]
struct Replay {
    total: Counts,
    sensors: Vec<Counts>,
}

/// How often each kind occurred.
#[derive(Clone, Default, Serialize)]
struct Counts {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    accepted: u64,
    rejected: u64,
    /// Agreed with the one before, but not yet with enough: only where more than two are compared.
    #[serde(skip_serializing_if = "is_zero")]
    repeated: u64,
    first: u64,
    no_echo: u64,
    clear: u64,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Counts {
    fn of(column: &Column) -> Self {
        let mut tally = Tally::<u32>::default();
        for &kind in &column.kinds {
            tally.count(kind);
        }
        let of = |kind| tally.of(kind).into();
        Self {
            name: Some(column.name.clone()),
            accepted: of(ReadingKind::Accepted),
            rejected: of(ReadingKind::Rejected),
            repeated: of(ReadingKind::Repeated),
            first: of(ReadingKind::First),
            no_echo: of(ReadingKind::NoEcho),
            clear: of(ReadingKind::Clear),
        }
    }

    fn plus(self, other: &Self) -> Self {
        Self {
            name: None,
            accepted: self.accepted + other.accepted,
            rejected: self.rejected + other.rejected,
            repeated: self.repeated + other.repeated,
            first: self.first + other.first,
            no_echo: self.no_echo + other.no_echo,
            clear: self.clear + other.clear,
        }
    }

    fn row(&self) -> Vec<String> {
        let compared = self.accepted + self.rejected + self.repeated;
        let rate = if compared == 0 {
            "-".to_owned()
        } else {
            format!("{:.1} %", 100.0 * self.rejected as f64 / compared as f64)
        };
        let mut row = vec![self.name.clone().unwrap_or_else(|| "total".to_owned())];
        row.extend([self.accepted, self.rejected, self.first, self.no_echo, self.clear].map(|n| n.to_string()));
        row.insert(3, rate);
        row
    }
}

fn table(args: &Args, counts: &[Counts], total: &Counts) -> String {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header(["sensor", "accepted", "rejected", "rejection rate", "first", "no echo", "clear"]);
    for counts in counts.iter().chain([total]) {
        table.add_row(counts.row());
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("{}: t_delta {} us, {} sensors\n{table}", args.file.display(), args.t_delta_us, counts.len())
}
