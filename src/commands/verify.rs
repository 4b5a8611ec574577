//! `eeruf verify`: holds a schedule file against the conditions of the paper.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use eeruf_core::{Criterion, Layout, Micros, Requirements, hopping::HoppingListening};
use eeruf_design::{LayoutKey, LayoutName, PhaseSchedule, RingSpec};
use eeruf_sim::AnySchedule;

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::ring::read_ring;
use crate::files::toml::{FoundSchedule, read_any_schedule};
use crate::report::phases;
use crate::report::verify::{ReportJson, describe};

/// Check a schedule: does crosstalk shift by more than 2 T_delta, and do neighbours keep their distance?
///
/// Prints the separation under both readings of Eqs. (13a), (13b), the largest T_delta, the smallest interval between
/// neighbours and the shortest time between two firings of one sensor, and names every violation. Exit code 0 if the
/// schedule meets everything asked for, 1 if not, 2 for bad input.
///
/// A schedule of many phases, for a ring that hops in time, is checked for all pairs of phases and all ages of sound.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The schedule: period_us with t_lag_us, t_wait_a_us, t_wait_b_us, or with t_fire_a_us, t_fire_b_us; of many
    /// phases: period_us with step_us, phases, t_lag_us, or with t_fire_us, a list for each phase
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
    #[arg(long, value_enum, default_value_t = CriterionArg::Exact)]
    criterion: CriterionArg,
    /// T_wind: how long a sensor listens, in microseconds
    #[arg(long, default_value_t = 0, value_name = "US")]
    window_us: u32,
    /// Also reject a sensor's own echo from the period before
    #[arg(long)]
    stale_echo: bool,
    /// Hold it against what this ring file asks for, instead of the options above; the only way to ask for what differs
    /// from sensor to sensor
    #[arg(long, value_name = "RING.toml", conflicts_with_all = [
        "t_delta_us", "min_interval_us", "neighbours", "layout", "window_us", "stale_echo"
    ])]
    ring: Option<PathBuf>,
    /// Many phases: crosstalk need move by T_delta and this margin alone, which is all that jitter and lateness may
    /// use, in microseconds; by default 2 T_delta + 1
    #[arg(long, value_name = "US")]
    margin_us: Option<u32>,
    /// Many phases: for how long a sensor is deaf after it has fired, in microseconds
    #[arg(long, default_value_t = 0, value_name = "US")]
    blanking_us: u32,
    /// Many phases: after how long no sound is heard any more, in microseconds; by default the window
    #[arg(long, value_name = "US")]
    reach_us: Option<u32>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum CriterionArg {
    /// The form that suffices to reject all crosstalk
    Exact,
    /// As printed, with an outer absolute value
    Paper,
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
    /// The requirements that the options state.
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
    let schedule = match read_any_schedule(&args.file)? {
        FoundSchedule::Two(schedule) => schedule,
        FoundSchedule::Many(schedule) => return many_phases(args, &schedule),
    };
    let of_many_phases = [
        ("--margin-us", args.margin_us),
        ("--blanking-us", Some(args.blanking_us).filter(|us| *us > 0)),
        ("--reach-us", args.reach_us),
    ];
    if let Some((option, us)) = of_many_phases.into_iter().find_map(|(option, us)| Some((option, us?))) {
        let file = args.file.display();
        let message = format!("{us}; expected a schedule of many phases, with step_us or t_fire_us; {file} has two");
        return Err(InputError::new(option, message));
    }
    let criterion = match args.criterion {
        CriterionArg::Exact => Criterion::Exact,
        CriterionArg::Paper => Criterion::Paper,
    };
    if let Some(file) = &args.ring {
        let spec = ring_of(file, schedule.sensors())?;
        // Where t_delta must cover motion, it must do so at the longest time between two firings.
        let spec = spec.covering(spec.t_delta_needed(&schedule));
        let requirements = Requirements { criterion, ..spec.problem().requirements };
        return answer(args, &schedule, &requirements);
    }
    let layout = args.layout.owned(args.neighbours, schedule.sensors());
    let layout = layout.map_err(|message| InputError::new(&args.file, message))?;
    answer(args, &schedule, &args.requirements(layout.layout(), criterion))
}

/// Prints what was found.
fn answer(args: &Args, schedule: &AnySchedule, requirements: &Requirements<'_>) -> Result<Answer, InputError> {
    let report = schedule.verify(requirements);
    let text = || describe(&args.file.display().to_string(), schedule, requirements, &report);
    show(args.json, || ReportJson::new(&report, |phase| phase.to_string()), text)?;
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

fn many_phases(args: &Args, schedule: &PhaseSchedule) -> Result<Answer, InputError> {
    let bad = |message: String| InputError::new(&args.file, message);
    if matches!(args.criterion, CriterionArg::Paper) {
        return Err(InputError::new("--criterion", "paper; expected exact, or --margin-us US, for many phases"));
    }
    let criterion = args.margin_us.map_or(Criterion::Exact, |margin| Criterion::Margin(Micros::new(margin)));
    let (spec, layout);
    let requirements = if let Some(file) = &args.ring {
        spec = ring_of(file, schedule.sensors())?;
        spec.phase_requirements(criterion)
    } else {
        layout = args.layout.owned(args.neighbours, schedule.sensors()).map_err(bad)?;
        args.requirements(layout.layout(), criterion)
    };
    let requirements = Requirements {
        blanking: Micros::new(args.blanking_us),
        audible: args.reach_us.map(Micros::new),
        ..requirements
    };
    let (window, most) = (requirements.window, HoppingListening::MAX_WINDOW);
    if window == Micros::ZERO {
        return Err(InputError::new(
            "--window-us",
            "0; expected how long a sensor listens: without it nothing is heard",
        ));
    }
    if schedule.hopping().is_some() && window > most {
        let (window, most) = (window.as_micros(), most.as_micros());
        return Err(InputError::new("--window-us", format!("{window}; expected at most {most} for a ring that hops")));
    }
    let report = schedule.verify(&requirements);
    let text = || phases::describe(&args.file.display().to_string(), schedule, &requirements, &report);
    show(args.json, || ReportJson::new(&report, |phase| phase.0), text)?;
    Ok(if report.ok() { Answer::Yes } else { Answer::No })
}
