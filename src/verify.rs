//! `eeruf verify`: holds a schedule file against the conditions of the paper.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::str::FromStr;

use clap::ValueEnum;
use comfy_table::{Table, presets};
use eeruf_core::{Criterion, Interval, Layout, MAX_SENSORS, Micros, Requirements, Verification};
use serde::Serialize;

use crate::Answer;
use crate::input::{AnySchedule, InputError, read_schedule, to_json};

/// Check a schedule: do crosstalk readings always move by more than 2 T_delta, and do neighbours keep their distance?
///
/// Prints the separation under both readings of Eqs. (13a), (13b), the largest T_delta, the smallest interval between
/// neighbours and the shortest time between two firings of one sensor, and names every violation. Exit code 0 if the
/// schedule meets everything asked for, 1 if not, 2 for bad input.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The schedule: period_us with t_lag_us, t_wait_a_us, t_wait_b_us, or with t_fire_a_us, t_fire_b_us
    #[arg(value_name = "SCHEDULE.toml")]
    file: PathBuf,
    /// T_delta: readings that differ by no more are near-identical
    #[arg(long, default_value_t = 0, value_name = "N")]
    t_delta_us: u32,
    /// The least time between the firings of two neighbours
    #[arg(long, default_value_t = 0, value_name = "N")]
    min_interval_us: u32,
    /// How many adjacent sensors are neighbours
    #[arg(long, default_value_t = 4, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=64))]
    neighbours: u8,
    /// How the sensors stand: line, ring, blocks, or the pairs of neighbours themselves, counted from 0: 0-1,1-2
    #[arg(long, default_value = "line", value_name = "LAYOUT")]
    layout: LayoutArg,
    /// How to read (13a), (13b)
    #[arg(long, value_enum, default_value_t = CriterionArg::Exact)]
    criterion: CriterionArg,
    /// T_wind: how long a sensor listens
    #[arg(long, default_value_t = 0, value_name = "N")]
    window_us: u32,
    /// Also reject a sensor's own echo from the period before
    #[arg(long)]
    stale_echo: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum CriterionArg {
    /// What rejecting all crosstalk needs
    Exact,
    /// As printed, with an outer absolute value
    Paper,
}

/// The layout as the command line gives it.
#[derive(Clone, Debug, PartialEq, Eq)]
enum LayoutArg {
    Line,
    Ring,
    Blocks,
    Pairs(Box<[u64; MAX_SENSORS]>),
}

impl FromStr for LayoutArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "line" => return Ok(Self::Line),
            "ring" => return Ok(Self::Ring),
            "blocks" => return Ok(Self::Blocks),
            _ => {}
        }
        let mut rows = Box::new([0; MAX_SENSORS]);
        for pair in text.split(',') {
            let sensor = |text: &str| text.trim().parse().ok().filter(|&sensor: &usize| sensor < MAX_SENSORS);
            let ends = pair.split_once('-').and_then(|(x, y)| Some((sensor(x)?, sensor(y)?)));
            let (x, y) = ends.ok_or_else(|| {
                format!("`{pair}`; expected line, ring, blocks, or pairs of sensors from 0 to 63 such as 0-1,1-2")
            })?;
            rows[x] |= 1 << y;
        }
        Ok(Self::Pairs(rows))
    }
}

impl LayoutArg {
    fn layout(&self, neighbours: u8) -> Layout<'_> {
        match self {
            Self::Line => Layout::Line(neighbours),
            Self::Ring => Layout::Ring(neighbours),
            Self::Blocks => Layout::Blocks(neighbours),
            Self::Pairs(rows) => Layout::Graph(rows.as_slice()),
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let schedule = read_schedule(&args.file)?;
    let requirements = Requirements {
        t_delta: Micros::new(args.t_delta_us),
        criterion: match args.criterion {
            CriterionArg::Exact => Criterion::Exact,
            CriterionArg::Paper => Criterion::Paper,
        },
        min_interval: Micros::new(args.min_interval_us),
        layout: args.layout.layout(args.neighbours),
        window: Micros::new(args.window_us),
        stale_echo: args.stale_echo,
    };
    let report = schedule.verify(&requirements);
    if args.json {
        println!("{}", to_json(&ReportJson::from(&report)));
    } else {
        print!("{}", describe(&args.file.display().to_string(), &schedule, &requirements, &report));
    }
    Ok(if report.ok() { Answer::Yes } else { Answer::No })
}

/// The report with the names that Python uses; sensors from 0.
#[derive(Serialize)]
struct ReportJson {
    ok: bool,
    separation_us: Option<u32>,
    max_t_delta_us: Option<u32>,
    min_interval_us: Option<u32>,
    min_refire_us: u32,
    violations: Vec<ViolationJson>,
}

#[derive(Serialize)]
struct ViolationJson {
    kind: &'static str,
    sensors: (u8, u8),
    phases: (String, String),
    value_us: u32,
    required_us: u32,
    source: &'static str,
}

impl From<&Verification<'_, MAX_SENSORS>> for ReportJson {
    fn from(report: &Verification<'_, MAX_SENSORS>) -> Self {
        let violations = report.violations().map(|violation| ViolationJson {
            kind: violation.kind.as_str(),
            sensors: violation.sensors,
            phases: (violation.phases.0.to_string(), violation.phases.1.to_string()),
            value_us: violation.value.as_micros(),
            required_us: violation.required.as_micros(),
            source: violation.kind.source(),
        });
        Self {
            ok: report.ok(),
            separation_us: report.separation().map(|separation| separation.value.as_micros()),
            max_t_delta_us: report.max_t_delta().map(Micros::as_micros),
            min_interval_us: report.min_interval().map(|interval| interval.value.as_micros()),
            min_refire_us: report.min_refire().as_micros(),
            violations: violations.collect(),
        }
    }
}

/// How many violations to print before counting the rest.
const PRINTED_VIOLATIONS: usize = 10;

fn describe(
    name: &str,
    schedule: &AnySchedule,
    requirements: &Requirements<'_>,
    report: &Verification<'_, MAX_SENSORS>,
) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    let us = |time: Micros| format!("{} us", time.as_micros());
    for criterion in [Criterion::Paper, Criterion::Exact] {
        let chosen = if criterion == requirements.criterion { "" } else { " (not asked for)" };
        let (value, who) = match schedule.separation(criterion) {
            Some(separation) => {
                (us(separation.value), format!("sensors {} and {}", separation.sensors.0 + 1, separation.sensors.1 + 1))
            }
            None => ("-".to_owned(), "a single sensor".to_owned()),
        };
        table.add_row([format!("separation, criterion {criterion}{chosen}"), value, who]);
    }
    let t_delta = report.max_t_delta().map_or_else(|| "none".to_owned(), us);
    table.add_row(["largest t_delta", &t_delta, "2 t_delta + 1 us <= separation"]);
    for (label, layout) in layouts(requirements.layout) {
        let (value, who) = match schedule.min_interval(layout) {
            Some(interval) => (us(interval.value), describe_interval(interval)),
            None => ("-".to_owned(), "no neighbours".to_owned()),
        };
        table.add_row([format!("smallest interval, {label}"), value, who]);
    }
    table.add_row(["shortest time between two firings of a sensor", &us(report.min_refire()), "T_wind at most"]);

    let mut text = format!("{name}: {} sensors, period {}\n{table}\n", schedule.sensors(), us(schedule.period()));
    let violations: Vec<_> = report.violations().collect();
    for violation in violations.iter().take(PRINTED_VIOLATIONS) {
        _ = writeln!(text, "  - {violation}");
    }
    if violations.len() > PRINTED_VIOLATIONS {
        _ = writeln!(text, "  - and {} more", violations.len() - PRINTED_VIOLATIONS);
    }
    _ = match violations.len() {
        0 => writeln!(text, "verified for t_delta = {}", us(requirements.t_delta)),
        n => writeln!(text, "not verified for t_delta = {}: {n} violations", us(requirements.t_delta)),
    };
    text
}

/// The layout asked for first, then the other two common ones for comparison.
fn layouts(asked: Layout<'_>) -> Vec<(String, Layout<'_>)> {
    let label = |layout| match layout {
        Layout::Line(n) => format!("line of {n}"),
        Layout::Ring(n) => format!("ring of {n}"),
        Layout::Blocks(n) => format!("blocks of {n}"),
        Layout::Graph(_) => "the pairs given".to_owned(),
    };
    let others = match asked {
        Layout::Line(n) | Layout::Ring(n) | Layout::Blocks(n) => {
            vec![Layout::Line(n), Layout::Ring(n), Layout::Blocks(n)]
        }
        Layout::Graph(_) => vec![],
    };
    let mut all = vec![(label(asked), asked)];
    for other in others.into_iter().filter(|&other| other != asked) {
        all.push((label(other) + " (not asked for)", other));
    }
    all
}

fn describe_interval(interval: Interval) -> String {
    let (x, y) = (interval.sensors.0 + 1, interval.sensors.1 + 1);
    if interval.phases.0 == interval.phases.1 {
        format!("sensors {x} and {y} in phase {}", interval.phases.0)
    } else {
        format!("sensors {x} and {y} from phase {} to {}", interval.phases.0, interval.phases.1)
    }
}
