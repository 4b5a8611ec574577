//! `eeruf design`: the shortest period for a ring, and why it is not shorter.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use comfy_table::{Table, presets};
use eeruf_core::search::{Control, PeriodProblem, Preferred, Progress, SearchError, ShortestPeriod, design};
use eeruf_core::tables::TABLE_I_D;
use eeruf_core::{Layout, MAX_SENSORS, Micros, Phase, Requirements};
use serde::Serialize;

use crate::Answer;
use crate::draw;
use crate::input::{AnySchedule, InputError, ScheduleFile, to_json};
use crate::ring_file::{RingSpec, read_ring};
use crate::timing;
use crate::watch::Watch;

/// Find the schedule with the shortest period for a ring of sensors, and prove that none is shorter.
///
/// The ring file says how many sensors there are (sensors, layout, neighbours) and what they need: t_delta_us,
/// min_interval_us, window_us; or jitter_us and speed_m_s, crosstalk_range_m, max_range_m and retrigger_us, temperature_c.
/// Among all schedules with that period it prefers a larger T_delta, then a larger smallest interval, then evener
/// firing. Exit code 0 if there is a schedule, 1 if there is none, 2 for bad input.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The ring
    #[arg(value_name = "RING.toml")]
    file: PathBuf,
    /// Print only the schedule, in this form
    #[arg(long, value_enum, value_name = "FORM")]
    emit: Option<Form>,
    /// The same as --emit json
    #[arg(long, conflicts_with = "emit")]
    json: bool,
    /// Draw the timing of two periods, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// How many nodes to search at most before giving the best schedule so far
    #[arg(long, default_value_t = 50_000_000, value_name = "NODES")]
    budget: u64,
    /// On how many threads to search; the answer is the same
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    threads: u8,
}

impl Args {
    /// What to print instead of a description.
    fn form(&self) -> Option<Form> {
        if self.json { Some(Form::Json) } else { self.emit }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// A schedule file
    Toml,
    /// A const that is checked when the firmware is compiled
    Rust,
    /// A C99 header
    C,
    /// One object with schedule, value, bound, proof and nodes
    Json,
}

/// How many nodes the choice among the shortest schedules may cost.
const PREFERENCE_BUDGET: u64 = 100_000;
/// How many nodes it may cost to find out what one need, relaxed, would bring.
const WHAT_IF_BUDGET: u64 = 20_000;

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let spec = read_ring(&args.file)?;
    let bad = |error: SearchError| InputError::new(&args.file, None, error);
    let began = Instant::now();
    let mut watch = Watch::new();
    let Some(design) = find(&spec, args, &mut watch).map_err(bad)? else {
        println!(
            "{}: no schedule: good readings change more from period to period, the more sensors at this speed must be \
             kept apart; expected fewer sensors or a lower speed_m_s",
            args.file.display()
        );
        return Ok(Answer::No);
    };
    let seconds = began.elapsed().as_secs_f64();
    drop(watch);
    let requirements = spec.needs(design.t_delta).requirements;
    if let Some(file) = &args.svg {
        draw::timing_diagram(&design.schedule, &requirements).save(file)?;
    }
    match args.form() {
        Some(Form::Toml) => print!("{}", design.schedule.to_toml()),
        Some(Form::Rust) => print!("{}", design.schedule.to_rust(&requirements)),
        Some(Form::C) => print!("{}", design.schedule.to_c(&requirements)),
        Some(Form::Json) => println!("{}", to_json(&FoundJson::new(&design, seconds))),
        None => print!("{}", describe(&args.file.display().to_string(), &spec, &requirements, &design, seconds)),
    }
    Ok(Answer::Yes)
}

/// A schedule for a ring file.
struct RingDesign {
    schedule: AnySchedule,
    /// What `t_delta` has to cover, motion included.
    t_delta: Micros,
    designed: ShortestPeriod<MAX_SENSORS>,
    preferred: Option<Preferred<MAX_SENSORS>>,
    /// Only if the design is to be described.
    what_if: Vec<WhatIf>,
}

/// Finds the shortest period, and the preferred schedule with it; `None` if the robot is too fast for any.
///
/// If `t_delta` must cover motion, it depends on the period, which depends on it: longer periods need a larger `t_delta`,
/// which needs longer periods. Starting from a robot that stands, this climbs to the first pair that agrees.
fn find(spec: &RingSpec, args: &Args, watch: &mut Watch) -> Result<Option<RingDesign>, SearchError> {
    let mut memory = vec![0; design::memory_words(spec.sensors)];
    let mut control = |progress: &Progress| {
        let how_far = || {
            let (bound, best) = (progress.bound.unwrap_or(0), progress.best.unwrap_or(0));
            format!("{} nodes, period at least {bound} and at most {best} ticks of {}", progress.nodes, spec.tick)
        };
        if watch.go_on(how_far) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let mut t_delta = spec.t_delta;
    loop {
        let needs = spec.needs(t_delta);
        let designed: ShortestPeriod<MAX_SENSORS> = if args.threads > 1 {
            needs.shortest_on_threads(args.budget, args.threads.into(), &mut control)?
        } else {
            needs.shortest(args.budget, &mut memory, &mut control)?
        };
        let preferred = if designed.found.proven {
            Some(needs.prefer(&designed, PREFERENCE_BUDGET, &mut memory, &mut control)?)
        } else {
            None
        };
        let Some(schedule) = preferred.map_or(designed.found.schedule, |preferred| Some(preferred.schedule)) else {
            return Ok(None);
        };
        let needed = t_delta_needed(spec, &schedule);
        let allowed = schedule.verify(&needs.requirements).max_t_delta();
        if allowed >= Some(needed) {
            let described = args.form().is_none() && designed.found.proven;
            let what_if = if described { what_if(&needs, &mut memory, &mut control)? } else { Vec::new() };
            let t_delta = needed.max(t_delta);
            return Ok(Some(RingDesign { schedule, t_delta, designed, preferred, what_if }));
        }
        // Past this point a second of silence would not be enough either.
        if needed > Micros::from_millis(1000) {
            return Ok(None);
        }
        t_delta = needed;
    }
}

/// Jitter, and `2 v dt / c` for the longest `dt` of the schedule.
fn t_delta_needed(spec: &RingSpec, schedule: &AnySchedule) -> Micros {
    let speed = u64::from(spec.speed_mm_s.unwrap_or(0));
    let change = 2 * speed * u64::from(schedule.max_refire().as_micros());
    let change = change.div_ceil(u64::from(spec.c.mm_per_s()).max(1));
    spec.t_delta.saturating_add(Micros::new(u32::try_from(change).unwrap_or(u32::MAX)))
}

/// Found, as Python names it.
#[derive(Serialize)]
struct FoundJson {
    schedule: ScheduleFile,
    value_us: Option<u32>,
    bound_us: Option<u32>,
    proven: bool,
    nodes: u64,
    seconds: f64,
    reason: String,
}

impl FoundJson {
    fn new(design: &RingDesign, seconds: f64) -> Self {
        let found = &design.designed.found;
        Self {
            schedule: ScheduleFile::from(&design.schedule),
            value_us: found.value.map(Micros::as_micros),
            bound_us: found.bound.map(Micros::as_micros),
            proven: found.proven,
            nodes: found.nodes,
            seconds,
            reason: design.reason(),
        }
    }
}

impl RingDesign {
    fn reason(&self) -> String {
        self.designed.explanation().to_string()
    }
}

fn describe(name: &str, spec: &RingSpec, requirements: &Requirements<'_>, design: &RingDesign, seconds: f64) -> String {
    let RingDesign { schedule, designed, preferred, what_if, .. } = design;
    let found = &designed.found;
    let report = schedule.verify(requirements);
    let period = schedule.period();
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    let proof = if found.proven {
        "proven: no schedule is shorter".to_owned()
    } else {
        format!("not proven: it may be as short as {}", found.bound.unwrap_or(period))
    };
    table.add_row(["period", &period.to_string(), &proof]);
    let best = |proven: Option<bool>| match proven {
        Some(true) => ", and no schedule of this period has more",
        Some(false) => ", the best found",
        None => "",
    };
    table.add_row([
        "t_delta".to_owned(),
        report.max_t_delta().map_or_else(|| "none".to_owned(), |t_delta| t_delta.to_string()),
        format!("needed: {}{}", requirements.t_delta, best(preferred.map(|p| p.t_delta_proven))),
    ]);
    if let Some(interval) = report.min_interval() {
        table.add_row([
            "smallest interval".to_owned(),
            interval.value.to_string(),
            format!("needed: {}{}", requirements.min_interval, best(preferred.map(|p| p.min_interval_proven))),
        ]);
    }
    table.add_row([
        "listening".to_owned(),
        requirements.window.to_string(),
        format!(
            "{:.2} m; no sensor fires again within {}",
            f64::from(spec.c.distance_mm(requirements.window)) / 1000.0,
            report.min_refire()
        ),
    ]);
    let speed = schedule.max_speed_mm_s(report.max_t_delta().unwrap_or(Micros::ZERO), spec.c.mm_per_s());
    table.add_row([
        "motion".to_owned(),
        format!("{:.2} m/s", f64::from(speed) / 1000.0),
        format!("before good readings differ by more than t_delta ({} at most between firings)", schedule.max_refire()),
    ]);
    let rate = |period: f64| 1e6 / period;
    let one_by_one = f64::from(requirements.window.as_micros()) * spec.sensors as f64;
    let us = f64::from(period.as_micros());
    table.add_row([
        "readings".to_owned(),
        format!("{:.1} a second", rate(us)),
        format!("of each sensor; {:.1} times one by one ({:.1} a second)", one_by_one / us, rate(one_by_one)),
    ]);
    if let Some(paper) = papers_period_us(spec, requirements) {
        table.add_row([
            String::new(),
            String::new(),
            format!("{:.2} times Table I-d scaled to the same needs ({:.1} a second)", paper / us, rate(paper)),
        ]);
    }
    table.add_row([
        "search".to_owned(),
        format!("{:.1} ms", 1000.0 * seconds),
        format!("{} nodes, and {} for the choice", found.nodes, preferred.map_or(0, |p| p.nodes)),
    ]);

    let mut text = format!("{name}: {} sensors, {}\n{table}\n", spec.sensors, requirements.layout);
    _ = writeln!(text, "\nNot shorter because of {}.", design.reason());
    if !what_if.is_empty() {
        _ = writeln!(text, "\n{}", ways_to_get_faster(what_if, period));
    }
    text.push('\n');
    text += &timing::diagram(schedule, requirements.window);
    _ = writeln!(text, "\n{}", schedule.to_toml());
    text
}

/// What one need, relaxed, would bring.
struct WhatIf {
    /// The relaxed need, in words.
    need: String,
    /// The shortest period with it, or the shortest found.
    period: Option<Micros>,
    proven: bool,
}

/// Relaxes one need after the other by a tenth, or by one tick if that is more, or by one neighbour.
fn what_if(
    needs: &PeriodProblem<'_>,
    memory: &mut [i32],
    control: &mut impl Control,
) -> Result<Vec<WhatIf>, SearchError> {
    let Requirements { t_delta, min_interval, window, layout, .. } = needs.requirements;
    let tick = needs.tick.as_micros().max(1);
    // In whole ticks, as others are rounded up to them.
    let less = |time: Micros| {
        let us = time.as_micros();
        Micros::new((us - us / 10).min(us.saturating_sub(1)) / tick * tick)
    };
    let (shorter, listening) = (less(min_interval), less(window));
    let separation = less(needs.requirements.separation()).as_micros();
    let nearer = Micros::new(separation.saturating_sub(1) / 2);
    let mut cases = Vec::new();
    if shorter < min_interval {
        let relaxed = Requirements { min_interval: shorter, ..needs.requirements };
        cases.push((format!("{shorter} instead of {min_interval} between neighbours"), relaxed));
    }
    if nearer < t_delta {
        cases.push((
            format!("t_delta of {nearer} instead of {t_delta}"),
            Requirements { t_delta: nearer, ..needs.requirements },
        ));
    }
    if Micros::ZERO < listening && listening < window {
        let relaxed = Requirements { window: listening, ..needs.requirements };
        cases.push((format!("listening for {listening} instead of {window}"), relaxed));
    }
    let fewer = match layout {
        Layout::Line(n) if n > 1 => Some((n, Layout::Line(n - 1))),
        Layout::Ring(n) if n > 1 => Some((n, Layout::Ring(n - 1))),
        _ => None,
    };
    if let Some((n, layout)) = fewer {
        cases.push((
            format!("any {} instead of {n} adjacent sensors apart", n - 1),
            Requirements { layout, ..needs.requirements },
        ));
    }
    let answer = |(need, requirements)| {
        let relaxed = PeriodProblem { requirements, ..*needs };
        let found = relaxed.shortest::<MAX_SENSORS>(WHAT_IF_BUDGET, memory, control)?.found;
        Ok(WhatIf { need, period: found.value, proven: found.proven })
    };
    cases.into_iter().map(answer).collect()
}

/// What the designer may change to get faster.
fn ways_to_get_faster(cases: &[WhatIf], period: Micros) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for WhatIf { need, period: with, proven } in cases {
        let verdict = match with {
            Some(with) if *with < period && *proven => format!("{with}"),
            Some(with) if *with < period => format!("{with} or less"),
            _ if *proven => "no shorter".to_owned(),
            _ => "not found out".to_owned(),
        };
        table.add_row([need, &verdict]);
    }
    format!("To get faster than {period}, one change at a time:\n{table}")
}

/// The period to which Table I-d, cut to this many sensors, has to be scaled to meet the same requirements.
fn papers_period_us(spec: &RingSpec, requirements: &Requirements<'_>) -> Option<f64> {
    if spec.sensors > TABLE_I_D.sensors() {
        return None;
    }
    let cut = |phase| TABLE_I_D.t_wait(phase).get(..spec.sensors);
    let table = AnySchedule::from_slices(
        TABLE_I_D.period(),
        TABLE_I_D.t_lag().get(..spec.sensors)?,
        [cut(Phase::A)?, cut(Phase::B)?],
    )
    .ok()?;
    let report = table.verify(requirements);
    let ratio = |needed: Micros, has: Micros| f64::from(needed.as_micros()) / f64::from(has.as_micros());
    let mut scale = ratio(requirements.window, report.min_refire());
    if let Some(max_t_delta) = report.max_t_delta() {
        scale = scale.max(ratio(requirements.separation(), Micros::new(2 * max_t_delta.as_micros() + 1)));
    }
    if let Some(interval) = report.min_interval() {
        scale = scale.max(ratio(requirements.min_interval, interval.value));
    }
    Some(scale * f64::from(TABLE_I_D.period().as_micros()))
}
