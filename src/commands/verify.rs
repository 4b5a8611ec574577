//! `eeruf verify`: checks a schedule file against the paper's conditions.

use std::path::{Path, PathBuf};

use eeruf_core::{Criterion, Layout, Micros, Requirements};
use eeruf_design::atlas::{ATLAS, answer as answer_of};
use eeruf_design::{LayoutKey, LayoutName, RingSpec};
use eeruf_sim::AnySchedule;
use serde::Serialize;

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::ring::read_ring;
use crate::files::toml::read_schedule;
use crate::files::waits::CriterionKey;
use crate::report::verify::{ReportJson, describe};

/// Check a schedule: does crosstalk shift by more than 2 T_delta, and do neighbours keep their distance?
///
/// Prints the separation under both readings of Eqs. (13a), (13b), the largest T_delta, the smallest interval between
/// neighbours and the shortest time between two firings of one sensor, and names every violation. Exit code 0 if the
/// schedule meets everything asked for, 1 if not, 2 for bad input.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The schedule: period_us with t_lag_us, t_wait_a_us, t_wait_b_us, or with t_fire_a_us, t_fire_b_us
    #[arg(value_name = "SCHEDULE.toml")]
    file: PathBuf,
    /// T_delta in microseconds: readings that differ by no more are near-identical
    #[arg(long, default_value_t = 0, value_name = "US")]
    t_delta_us: u32,
    /// The least time between the firings of two neighbours, in microseconds
    #[arg(long, default_value_t = 0, value_name = "US")]
    min_interval_us: u32,
    /// Number of adjacent sensors that are neighbours
    #[arg(long, default_value_t = 4, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=64))]
    neighbours: u8,
    /// Arrangement of the sensors: line, ring, blocks, or the pairs of neighbours themselves, counted from 0: 0-1,1-2
    #[arg(long, default_value = "line", value_name = "LAYOUT", value_parser = layout)]
    layout: LayoutKey,
    /// Reading of (13a), (13b)
    #[arg(long, value_enum, default_value_t = CriterionKey::Exact)]
    criterion: CriterionKey,
    /// T_wind: how long a sensor listens, in microseconds
    #[arg(long, default_value_t = 0, value_name = "US")]
    window_us: u32,
    /// Also reject a sensor's own echo from the period before
    #[arg(long)]
    stale_echo: bool,
    /// Check it against the needs of this ring file, instead of the options above; the only way to check needs that
    /// differ from sensor to sensor
    #[arg(long, value_name = "RING.toml", conflicts_with_all = [
        "t_delta_us", "min_interval_us", "neighbours", "layout", "window_us", "stale_echo"
    ])]
    ring: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Parses a layout by its name, or by its pairs of neighbours.
fn layout(text: &str) -> Result<LayoutKey, String> {
    let sensor = |text: &str| text.trim().parse().ok();
    let pair = |pair: &str| {
        let ends = pair.split_once('-').and_then(|(x, y)| Some((sensor(x)?, sensor(y)?)));
        ends.ok_or_else(|| format!("`{pair}`; expected line, ring, blocks, or pairs of sensors such as 0-1,1-2"))
    };
    match text {
        "line" => Ok(LayoutKey::Named(LayoutName::Line)),
        "ring" => Ok(LayoutKey::Named(LayoutName::Ring)),
        "blocks" => Ok(LayoutKey::Named(LayoutName::Blocks)),
        pairs => pairs.split(',').map(pair).collect::<Result<_, _>>().map(LayoutKey::Pairs),
    }
}

impl Args {
    /// Returns the requirements given by options.
    fn requirements<'a>(&self, layout: Layout<'a>, criterion: Criterion) -> Requirements<'a> {
        Requirements {
            criterion,
            min_interval: Micros::new(self.min_interval_us),
            layout,
            window: Micros::new(self.window_us),
            stale_echo: self.stale_echo,
            ..Requirements::new(Micros::new(self.t_delta_us))
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let schedule = read_schedule(&args.file)?;
    let criterion = args.criterion.into();
    if let Some(file) = &args.ring {
        let spec = ring_of(file, schedule.sensors())?;
        // Where t_delta must cover motion, it must do so at the longest time between two firings.
        let spec = spec.covering(spec.t_delta_needed(&schedule));
        let requirements = Requirements { criterion, ..spec.problem().requirements };
        return answer(args, &schedule, &requirements, Known::of(&spec));
    }
    let layout = args.layout.owned(args.neighbours, schedule.sensors());
    let layout = layout.map_err(|message| InputError::new(&args.file, message))?;
    answer(args, &schedule, &args.requirements(layout.layout(), criterion), None)
}

/// The shortest period of the schedule's ring, from the atlas.
#[derive(Clone, Copy, Serialize)]
struct Known {
    shortest_us: u32,
    /// Bound of the period, from the certificate of the atlas's row.
    certified_us: u32,
}

impl Known {
    fn of(spec: &RingSpec) -> Option<Self> {
        let (row, schedule) = answer_of(ATLAS, &spec.problem())?;
        let certified_us = row.certified.saturating_mul(spec.tick.as_micros());
        Some(Self { shortest_us: schedule.period().as_micros(), certified_us })
    }

    /// Writes a line of the report.
    fn line(self, period: Micros) -> String {
        let Self { shortest_us, certified_us } = self;
        let is = if shortest_us < period.as_micros() { "possible" } else { "the shortest" };
        let proven = if certified_us < shortest_us {
            format!("proven, not certified: its certificate says that none is below {}", Micros::new(certified_us))
        } else {
            "proven".to_owned()
        };
        format!("\nA period of {} is {is} for this ring; {proven}.\n", Micros::new(shortest_us))
    }
}

/// The report, and the shortest period if the atlas has it.
#[derive(Serialize)]
struct Verified {
    #[serde(flatten)]
    report: ReportJson<String>,
    #[serde(flatten)]
    known: Option<Known>,
}

/// Prints the result.
fn answer(
    args: &Args,
    schedule: &AnySchedule,
    requirements: &Requirements<'_>,
    known: Option<Known>,
) -> Result<Answer, InputError> {
    let report = schedule.verify(requirements);
    let text = || {
        let shortest = known.map_or_else(String::new, |known| known.line(schedule.period()));
        describe(&args.file.display().to_string(), schedule, requirements, &report) + &shortest
    };
    show(args.json, || Verified { report: ReportJson::new(&report, |phase| phase.to_string()), known }, text)?;
    Ok(if report.ok() { Answer::Yes } else { Answer::No })
}

/// Reads the ring file of a schedule.
fn ring_of(file: &Path, sensors: usize) -> Result<RingSpec, InputError> {
    let spec = read_ring(file)?;
    if spec.sensors != sensors {
        let message = format!("{} sensors; expected the {sensors} of the schedule", spec.sensors);
        return Err(InputError::new(file, message));
    }
    Ok(spec)
}
