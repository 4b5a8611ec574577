//! Tables of flow beside one by one, with and without a median of three: figures with 95 % intervals, and rows as CSV.
//!
//! `cargo lab flow-tables courses|robots|rooms [--ring RING.toml] [--first N] [--count N] [--csv FILE]`. Settings were
//! chosen on scenes numbered below 2,000; figures are reported from number 20,000 on. Each table appends its rows to
//! the file.

mod courses;
mod robots;
mod rooms;

use std::fs::File;
use std::io::Write;

use eeruf_core::Micros;
use eeruf_design::RingSpec;
use eeruf_sim::experiments::{FIRST, Spread};
use eeruf_sim::{Entry, Method, Robot};

/// A figure with its 95 % interval.
#[derive(Clone, Copy)]
pub(crate) struct Cell([f64; 3]);

impl Cell {
    fn new(value: f64, [low, high]: [f64; 2]) -> Self {
        Self([value, low, high])
    }

    /// Returns the mean of percentages.
    fn mean(values: impl IntoIterator<Item = f64>) -> Self {
        Spread::of(values).map_or(Self([f64::NAN; 3]), |of| Self::new(of.mean, of.mean_95))
    }

    fn median(values: impl IntoIterator<Item = f64>) -> Self {
        Spread::of(values).map_or(Self([f64::NAN; 3]), |of| Self::new(of.median, of.median_95))
    }

    /// Returns the 90th percentile.
    fn p90(values: impl IntoIterator<Item = f64>) -> Self {
        Spread::of(values).map_or(Self([f64::NAN; 3]), |of| Self::new(of.p90, of.p90_95))
    }

    /// Returns the 10th percentile.
    fn p10(values: impl IntoIterator<Item = f64>) -> Self {
        let Self([value, low, high]) = Self::p90(values.into_iter().map(|value| -value));
        Self([-value, -high, -low])
    }
}

/// Figures of ways of firing under conditions.
pub(crate) struct Table {
    name: &'static str,
    head: &'static [&'static str],
    digits: usize,
    rows: Vec<(String, String, Vec<Cell>)>,
}

impl Table {
    fn new(name: &'static str, digits: usize, head: &'static [&'static str]) -> Self {
        println!("| condition | way | {} |\n|---|---|{}", head.join(" | "), "---:|".repeat(head.len()));
        Self { name, head, digits, rows: vec![] }
    }

    /// Prints a row and stores it.
    fn row(&mut self, condition: impl Into<String>, way: impl Into<String>, cells: Vec<Cell>) {
        let (condition, way, digits) = (condition.into(), way.into(), self.digits);
        let words = cells.iter().map(|Cell([value, low, high])| match value.is_nan() {
            true => "-".to_owned(),
            false => format!("{value:.digits$} ({low:.digits$}..{high:.digits$})"),
        });
        println!("| {condition} | {way} | {} |", words.collect::<Vec<_>>().join(" | "));
        self.rows.push((condition, way, cells));
    }

    fn append(&self, file: &str) -> std::io::Result<()> {
        let mut out = File::options().create(true).append(true).open(file)?;
        if out.metadata()?.len() == 0 {
            writeln!(out, "table,condition,way,figure,value,low,high")?;
        }
        for (condition, way, cells) in &self.rows {
            for (figure, Cell(three)) in self.head.iter().zip(cells) {
                let three = three.map(|number| format!("{number:.*}", self.digits)).join(",");
                writeln!(out, "{},{condition},{way},{figure},{three}", self.name)?;
            }
        }
        Ok(())
    }
}

/// The command's arguments.
#[derive(clap::Args)]
pub(crate) struct Asked {
    #[arg(value_enum)]
    part: Part,
    /// The ring
    #[arg(long, value_name = "FILE", default_value = "rings/hc-sr04-8.toml")]
    ring: String,
    /// Number of the first course, placing or room
    #[arg(long, default_value_t = FIRST)]
    first: u64,
    /// Number of courses, of placings of a condition, or of rooms of a kind
    #[arg(long, default_value_t = 200)]
    count: u64,
    /// Append the rows to this file; by default to none
    #[arg(long, value_name = "FILE")]
    csv: Option<String>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Part {
    Courses,
    Robots,
    Rooms,
}

impl Asked {
    /// Returns the robot of the ring's file.
    fn robot(&self) -> Result<Robot, Box<dyn std::error::Error>> {
        let spec = RingSpec::from_text(&std::fs::read_to_string(&self.ring)?).map_err(|error| error.to_string())?;
        let robot = spec.room_robot()?.robot;
        let period = robot.module_rest().max(robot.audible).max(robot.window).saturating_add(Micros::new(1));
        Ok(Robot { period, odometry: true, ..robot })
    }
}

/// Returns one by one, one by one with a median of three, and flow as recommended.
fn usual() -> Vec<Entry> {
    vec![
        Entry::new("one by one", Method::Sequential),
        Entry::new("one by one, median", Method::SequentialMedian),
        Entry::new("flow", Method::Flow),
    ]
}

pub(crate) fn main(asked: &Asked) -> crate::Answer {
    let Asked { part, ring, first, count, csv } = asked;
    let (name, table): (_, fn(&Asked) -> _) = match part {
        Part::Courses => ("courses", courses::table),
        Part::Robots => ("robots", robots::table),
        Part::Rooms => ("rooms", rooms::table),
    };
    println!("{name}: {count} from {first} on, {ring}.\n");
    let table = table(asked)?;
    if let Some(file) = csv {
        table.append(file)?;
    }
    Ok(())
}
