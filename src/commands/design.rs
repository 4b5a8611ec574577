//! `eeruf design`: the shortest period for a ring, and why it is not shorter.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use clap::builder::PossibleValue;
use eeruf_core::Micros;
use eeruf_core::search::Progress;
use eeruf_design::atlas::ATLAS;
use eeruf_design::{CURVE_BUDGET, Effort, FoundJson, How, Need, NoDesign, RingDesign, RingSpec, RoomsAnswer, Way};
use eeruf_files::emit;
use serde::Serialize;

use super::arguments::{picture, seconds};
use super::certificate::Written;
use super::program::{self, ProgramArgs};
use super::rooms::{self, RoomArgs};
use super::{Answer, show};
use crate::console::{print, print_line, tell};
use crate::files::error::InputError;
use crate::files::ring::read_ring;
use crate::program::{flow_source, pulse_times, wrapped};
use crate::report::design::describe;
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::questions::{CurveJson, describe_curve, describe_fit, fit_json};
use crate::report::rooms::{RoomsOrNot, describe as describe_rooms, describe_all};
use crate::report::watch::Watch;

/// Say how to fire a ring, what that buys and how to get it.
///
/// The ring is fired one by one, in groups, in two phases and by flow in seeded rooms of eight kinds, as its file says
/// it is used: standing, driving at speed_m_s, turning at turn_deg_s, and with `others = true` beside another robot of
/// its make. The way recommended sees soonest what appears, of those with at most one false stop a minute; where that
/// is not sure, it is the simpler way. The answer lists what it depends on.
///
/// --program writes a folder that builds, and --emit rust, c and arduino the settings alone, for the way recommended,
/// or another --way. --period-only and --emit toml write the shortest
/// schedule of two phases. Among schedules of one period it prefers a larger T_delta, then a larger smallest interval,
/// then evener firing.
///
/// Four lines are enough for a ring file: sensors, module, layout and speed_m_s. The sensors' places (spacing_deg and
/// radius_m, or poses, or urdf and links) make the answer the robot's own. Instead of the module it may give times
/// (t_delta_us, min_interval_us, window_us), or the values that determine them (jitter_us, speed_m_s,
/// crosstalk_range_m, max_range_m, retrigger_us, temperature_c). Other keys are for sensors that are not all alike,
/// share lines or fire together, for slow controllers and for layouts: docs/reference/ring-files.md lists all. Sensors
/// count from 0. Pairs that module and places keep from hearing each other are not neighbours unless layout names them.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The ring
    #[arg(value_name = "RING.toml")]
    file: PathBuf,
    /// Print only the schedule, in this form; by default a description
    #[arg(long, value_enum, value_name = "FORM")]
    emit: Option<Form>,
    /// Print JSON, as --emit json does
    #[arg(long, conflicts_with = "emit")]
    json: bool,
    /// Draw the timing of two periods, as SVG or, if the name ends in .png, as PNG
    #[arg(long, hide_short_help = true, value_name = "FILE", value_parser = picture("timing"))]
    svg: Option<PathBuf>,
    /// Write a certificate that no period is shorter, or shorter than the bound where the search ended early; for
    /// checker/check_period.py
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// Largest number of nodes in the certificate's proof; if they do not suffice, it certifies the bound that they
    /// prove
    #[arg(long, hide_short_help = true, default_value_t = 1_000_000, value_name = "NODES")]
    certificate_budget: usize,
    /// Largest number of nodes to search before giving the best schedule so far; 50 million by default, 20,000 for each
    /// point of a curve
    #[arg(long, hide_short_help = true, value_name = "NODES")]
    budget: Option<u64>,
    /// Find out whether the ring's needs fit into this period, in microseconds, and the largest T_delta that fits; by
    /// default the shortest period is found. Exit code 1 if the needs do not fit, 3 if that was not decided
    #[arg(long, hide_short_help = true, value_name = "US", conflicts_with_all = ["certificate", "curve"])]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    period: Option<u32>,
    /// Print the shortest period for 20 values of one need, from a tenth of the ring's own to twice as much; by default
    /// for its own alone
    #[arg(long, hide_short_help = true, value_enum, value_name = "NEED",
          conflicts_with_all = ["certificate", "emit", "svg"])]
    curve: Option<CurveOf>,
    /// Search even where the atlas knows the shortest period
    #[arg(long, hide_short_help = true)]
    no_atlas: bool,
    /// Time limit of the command, in seconds, after which it gives the best schedule so far; by default none. The
    /// certificate gets the time that is left; without any, it states the bound that needs no search
    #[arg(long, hide_short_help = true, value_name = "S", value_parser = seconds)]
    time_limit: Option<Duration>,
    /// Print the shortest period of two phases too: its proof, its limits, and the schedule
    #[arg(long, conflicts_with_all = ["period", "curve", "program"])]
    proof: bool,
    /// Print every way under each condition too
    #[arg(long, conflicts_with_all = ["period", "curve", "program", "period_only"])]
    all: bool,
    /// Find the shortest period and judge nothing in rooms
    #[arg(long, conflicts_with_all = ["rooms", "places", "first"])]
    period_only: bool,
    #[command(flatten)]
    program: ProgramArgs,
    #[command(flatten)]
    in_rooms: RoomArgs,
}

impl Args {
    /// Form of the output that replaces the description.
    fn form(&self) -> Option<Form> {
        if self.json { Some(Form::Json) } else { self.emit }
    }
}

/// The need that a curve varies.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CurveOf {
    /// Largest difference between readings of one wall on a robot that stands
    #[value(name = "t_delta", alias = "t-delta")]
    TDelta,
    /// Range of the sensors
    Range,
    /// The least time between the firings of neighbours
    Interval,
}

impl CurveOf {
    fn need(self) -> Need {
        match self {
            Self::TDelta => Need::TDelta,
            Self::Range => Need::Range,
            Self::Interval => Need::Interval,
        }
    }
}

/// Form of the output that replaces the description.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Source(emit::Form),
    Json,
}

impl ValueEnum for Form {
    fn value_variants<'a>() -> &'a [Self] {
        use emit::Form::{Arduino, C, Rust, Toml};
        &[Self::Source(Toml), Self::Source(Rust), Self::Source(C), Self::Source(Arduino), Self::Json]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let (name, help) = match self {
            Self::Source(emit::Form::Toml) => ("toml", "A schedule file"),
            Self::Source(emit::Form::Rust) => ("rust", "A const that is checked when the firmware is compiled"),
            Self::Source(emit::Form::C) => ("c", "A C99 header, alone or for c/eeruf.h"),
            Self::Source(emit::Form::Arduino) => {
                ("arduino", "A file of an Arduino sketch, for the library in c/arduino: the constant RING")
            }
            Self::Json => ("json", "One object with schedule, value, bound, proof and nodes"),
        };
        Some(PossibleValue::new(name).help(help))
    }
}

/// The shortest period, and the ways of firing judged in rooms.
#[derive(Serialize)]
struct Answered<'a> {
    #[serde(flatten)]
    found: FoundJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<PeriodJson>,
    #[serde(flatten)]
    rooms: Option<RoomsOrNot<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    how: Option<How>,
    /// Pairs of neighbours, by number, that do not hear each other in their places.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    not_neighbours: &'a [(usize, usize)],
}

/// A summary of the shortest period, beside the ways of firing.
#[derive(Serialize)]
struct PeriodJson {
    value_us: Option<u32>,
    bound_us: Option<u32>,
    proven: bool,
    reason: Option<String>,
}

/// Default budget of nodes of a search.
const BUDGET: u64 = 50_000_000;

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let spec = read_ring(&args.file)?;
    if let Some(period) = args.period {
        return fit(args, &spec, Micros::new(period));
    }
    if let Some(curve) = args.curve {
        return curve_of(args, &spec, curve.need());
    }
    let began = Instant::now();
    let watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let mut control = |progress: &Progress| {
        let how_far = || {
            let (bound, best) = (progress.bound.unwrap_or(0), progress.best.unwrap_or(0));
            format!("{} nodes, period at least {bound} and at most {best} ticks of {}", progress.nodes, spec.tick)
        };
        watch.control_flow(how_far)
    };
    let atlas = if args.no_atlas { "" } else { ATLAS };
    let search = Effort { budget: args.budget.unwrap_or(BUDGET), what_if: args.form().is_none(), atlas };
    let design = match spec.shortest(&search, &mut control) {
        Ok(design) => design,
        Err(NoDesign::Search(error)) => return Err(InputError::new(&args.file, error)),
        Err(none) => {
            tell(format!("{}: {none}\n", args.file.display()))?;
            return Ok(Answer::No);
        }
    };
    let seconds = began.elapsed().as_secs_f64();
    watch.forget_interrupt();
    if let Some(language) = args.program.program {
        return program::run(&args.program, (&args.file, language), &design, &args.in_rooms, &watch);
    }
    let prove = |_| Written::new(&design, args.certificate_budget, &watch);
    let certificate = args.certificate.as_ref().map(prove);
    watch.forget_interrupt();
    let judges = !args.period_only && matches!(args.form(), None | Some(Form::Json));
    let rooms = judges.then(|| rooms::judged(&args.in_rooms, &spec, Some(&design), args.all, &watch)).transpose()?;
    // A schedule file holds a table, which flow has not.
    let emits = !args.period_only && matches!(args.form(), Some(Form::Source(form)) if form != emit::Form::Toml);
    let way = emits.then(|| args.program.fires(&design, &args.in_rooms, &watch)).transpose()?;
    drop(watch);
    let best = rooms.as_ref().and_then(|rooms| rooms.as_ref().ok()?.best.as_ref());
    let how = best.map(|best| design.spec.how(best)).transpose();
    let how = how.map_err(|why| InputError::new(&args.file, why))?.flatten();
    let requirements = design.spec.problem().requirements;
    if let Some(file) = &args.svg {
        draw::timing_diagram(&design.schedule, &requirements).save(file)?;
    }
    let certified = match (&args.certificate, certificate) {
        (Some(file), Some(written)) => {
            let bounding = design.bounding.t_delta;
            let t_delta = spec.speed_mm_s.map_or(String::new(), |_| format!(", for a t_delta of {bounding}"));
            written.write(file, &t_delta)?
        }
        _ => Answer::Yes,
    };
    match args.form() {
        Some(Form::Json) => {
            let found = design.json(seconds);
            let FoundJson { value_us, bound_us, proven, .. } = found;
            let period = PeriodJson { value_us, bound_us, proven, reason: found.reason.clone() };
            let period = rooms.is_some().then_some(period);
            let rooms = rooms.as_ref().map(RoomsOrNot::of);
            print_line(to_json(&Answered { found, period, rooms, how, not_neighbours: &spec.not_neighbours }))?;
        }
        Some(Form::Source(form)) => {
            let table = || form.table(&design.schedule, &design.spec.table_requirements(), &design.spec.modules);
            print(match &way {
                Some(Ok((way, robot))) if *way != Way::TwoPhases => {
                    let flow = design.spec.fired(*way, robot, 1).map_err(|why| InputError::new(&args.file, why))?;
                    let words = wrapped(&way.in_words(&flow.turns));
                    let comment: String = words.iter().map(|line| form.comment(line)).collect();
                    comment + &flow_source(&design.spec, form, &flow)
                }
                Some(Err(why)) => form.comment(&format!("Not judged in rooms: {why}")) + &table(),
                _ => table(),
            })?;
        }
        None => {
            let name = args.file.display().to_string();
            let period = || describe(&name, &spec, &design, seconds);
            tell(match &rooms {
                None => period(),
                Some(rooms) => {
                    let mut text = describe_rooms(&name, rooms) + &how_to(&name, &spec, how.as_ref(), rooms);
                    if args.all {
                        text += &describe_all(rooms);
                    }
                    text + &if args.proof { format!("\n{}", period()) } else { more(&design, args.all) }
                }
            })?;
        }
    }
    Ok(certified)
}

/// The answer's second part: how to fire by a way, and the command that writes its program.
fn how_to(name: &str, spec: &RingSpec, how: Option<&How>, rooms: &Result<RoomsAnswer, String>) -> String {
    let (Some(how), Ok(answer)) = (how, rooms) else { return String::new() };
    let list = |sensors: &[u8]| sensors.iter().map(|x| (x + 1).to_string()).collect::<Vec<_>>().join(", ");
    let mut text = format!("\nHow: {}", how.in_words);
    match &how.groups[..] {
        [] if spec.sensors > 1 && !how.order.is_empty() => text += &format!(" Order: {}.", list(&how.order)),
        [] => {}
        groups => {
            let groups = groups.iter().map(|group| list(group)).collect::<Vec<_>>().join("; ");
            text += &format!(" Groups: {groups}.");
        }
    }
    for assumed in &answer.assumed {
        text += &format!("\nAssumed: {assumed}.");
    }
    let languages = if how.order.is_empty() { "" } else { " (or rust, c, micropython, ros2)" };
    let get = match pulse_times(spec) {
        _ if spec.modules.is_empty() => {
            "name the module in the file, as `module = \"hc-sr04\"`; then --program arduino".to_owned()
        }
        Ok(_) => format!("eeruf design {name} --program arduino{languages}"),
        Err(why) => {
            format!(
                "eeruf design {name} --way {} --emit rust (or c, arduino): settings of a ring\nNo program: {why}",
                how.way
            )
        }
    };
    format!("{text}\n\nTo get it: {get}\n")
}

/// Writes the answer's end: what was left out, and the options that print it.
fn more(design: &RingDesign, all: bool) -> String {
    let period = design.schedule.period();
    let proven = if design.found.proven { ", proven" } else { "" };
    let all = if all { "" } else { "; --all: every way" };
    format!("--proof: the shortest period of two phases ({period}{proven}) and its schedule{all}\n")
}

/// Answers `--period`.
fn fit(args: &Args, spec: &RingSpec, period: Micros) -> Result<Answer, InputError> {
    let began = Instant::now();
    let watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let mut control = |progress: &Progress| watch.control_flow(|| format!("{} nodes", progress.nodes));
    let fit = spec
        .fit(period, args.budget.unwrap_or(BUDGET), &mut control)
        .map_err(|error| InputError::new(&args.file, error))?;
    drop(watch);
    let seconds = began.elapsed().as_secs_f64();
    let requirements = fit.spec.problem().requirements;
    let answer = match fit.fits {
        Some(true) => Answer::Yes,
        Some(false) => Answer::No,
        None => Answer::NotDecided,
    };
    // Only a schedule that meets the needs goes into firmware.
    let schedule = fit.schedule.filter(|_| fit.fits == Some(true));
    if let (Some(file), Some(schedule)) = (&args.svg, &schedule) {
        draw::timing_diagram(schedule, &requirements).save(file)?;
    }
    match (args.form(), &schedule) {
        (Some(Form::Json), _) => print_line(to_json(&fit_json(&fit, seconds)))?,
        (Some(Form::Source(form)), Some(schedule)) => {
            print(form.table(schedule, &fit.spec.table_requirements(), &fit.spec.modules))?;
        }
        (Some(_), None) => tell(format!("{}: no schedule of {period} that meets all needs\n", args.file.display()))?,
        (None, _) => tell(describe_fit(&args.file.display().to_string(), spec, period, &fit, seconds))?,
    }
    Ok(answer)
}

/// Answers `--curve`.
fn curve_of(args: &Args, spec: &RingSpec, need: Need) -> Result<Answer, InputError> {
    let began = Instant::now();
    let watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let mut control = |progress: &Progress| watch.control_flow(|| format!("{} nodes of a point", progress.nodes));
    let atlas = if args.no_atlas { "" } else { ATLAS };
    let search = Effort { budget: args.budget.unwrap_or(CURVE_BUDGET), what_if: false, atlas };
    let points = spec.curve(need, &search, &mut control).map_err(|error| InputError::new(&args.file, error))?;
    drop(watch);
    let seconds = began.elapsed().as_secs_f64();
    let text = || describe_curve(&args.file.display().to_string(), spec, need, &points, seconds);
    show(args.json, || CurveJson::new(need, &points, seconds), text)?;
    Ok(Answer::Yes)
}
