//! `eeruf design`: the shortest period for a ring, and why it is not shorter.

use std::fmt;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use eeruf_core::search::{Control, Progress, design};
use eeruf_core::search::{PeriodProblem, SearchError, ShortestPeriod};
use eeruf_core::{Layout, MAX_SENSORS, Micros, Requirements};
use eeruf_sim::AnySchedule;

use super::answer::Answer;
use super::certificate;
use crate::files::error::InputError;
use crate::files::ring::{RingSpec, read_ring};
use crate::files::write::write;
use crate::report::design::{RingDesign, WhatIf, describe};
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::watch::Watch;

/// Find the schedule with the shortest period for a ring of sensors, and prove that none is shorter.
///
/// The ring file says how many sensors there are (sensors, layout, neighbours) and what they need: t_delta_us,
/// min_interval_us, window_us; or jitter_us and speed_m_s, crosstalk_range_m, max_range_m and retrigger_us,
/// temperature_c.
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
    /// Write a certificate that no period is shorter, or shorter than the bound where the search ended early; for
    /// eeruf-check and checker/check_period.py
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// How many nodes the certificate's proof may have; if they do not suffice, it certifies the bound that they prove
    #[arg(long, default_value_t = 1_000_000, value_name = "NODES", requires = "certificate")]
    certificate_budget: usize,
    /// How many nodes to search at most before giving the best schedule so far
    #[arg(long, default_value_t = 50_000_000, value_name = "NODES")]
    budget: u64,
    /// How long to search at most before giving the best schedule so far, in seconds; as long again for the certificate
    #[arg(long, value_name = "S", value_parser = seconds)]
    time_limit: Option<Duration>,
}

/// A time that may have a fraction.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .ok_or_else(|| "expected seconds above 0".to_owned())
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
    let mut watch = Watch::ending_after(args.time_limit.unwrap_or(Duration::MAX));
    let design = match find(&spec, args, &mut watch).map_err(bad)? {
        Ok(design) => design,
        Err(none) => {
            println!("{}: {none}", args.file.display());
            return Ok(Answer::No);
        }
    };
    let seconds = began.elapsed().as_secs_f64();
    watch.begin_again();
    let prove = |_| certificate::prove(&spec, &design, args.certificate_budget, &mut watch);
    let certificate = args.certificate.as_ref().map(prove);
    drop(watch);
    let requirements = spec.problem(design.t_delta).requirements;
    if let Some(file) = &args.svg {
        draw::timing_diagram(&design.schedule, &requirements).save(file)?;
    }
    let certified = match (&args.certificate, certificate) {
        (Some(file), Some(Ok(text))) => {
            write(file, &text)?;
            let t_delta = spec.speed_mm_s.map_or(String::new(), |_| format!(", for a t_delta of {}", design.t_delta));
            eprintln!("{}: {}{t_delta}", file.display(), certificate::claim(&text, &design));
            Answer::Yes
        }
        (Some(file), Some(Err(why))) => {
            eprintln!("eeruf: {}: not written: {why}", file.display());
            Answer::No
        }
        _ => Answer::Yes,
    };
    match args.form() {
        Some(Form::Toml) => print!("{}", design.schedule.to_toml()),
        Some(Form::Rust) => print!("{}", design.schedule.to_rust(&requirements)),
        Some(Form::C) => print!("{}", design.schedule.to_c(&requirements)),
        Some(Form::Json) => println!("{}", to_json(&design.json(seconds))),
        None => print!("{}", describe(&args.file.display().to_string(), &spec, &requirements, &design, seconds)),
    }
    Ok(certified)
}

/// Why a robot that moves gets no schedule.
#[derive(Clone, Copy)]
enum NoSchedule {
    TooFast,
    EndedEarly,
}

impl fmt::Display for NoSchedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooFast => {
                "no schedule: good readings change more from period to period, the more sensors at this speed must be \
                 kept apart; expected fewer sensors or a lower speed_m_s"
            }
            Self::EndedEarly => {
                "no schedule yet: the search ended before its proof, and what it had found is too slow for this speed; \
                 expected a larger --budget or --time-limit"
            }
        })
    }
}

/// Finds the shortest period, and the preferred schedule with it.
///
/// If `t_delta` must cover motion, it depends on the period, and the period on it: longer periods need a larger
/// `t_delta`, which needs longer periods. Starting from a robot that stands, this climbs to the first pair that agrees.
fn find(spec: &RingSpec, args: &Args, watch: &mut Watch) -> Result<Result<RingDesign, NoSchedule>, SearchError> {
    let mut memory = vec![0; design::memory_words(spec.sensors)];
    let mut control = |progress: &Progress| {
        let how_far = || {
            let (bound, best) = (progress.bound.unwrap_or(0), progress.best.unwrap_or(0));
            format!("{} nodes, period at least {bound} and at most {best} ticks of {}", progress.nodes, spec.tick)
        };
        watch.control_flow(how_far)
    };
    let mut t_delta = spec.t_delta;
    loop {
        let problem = spec.problem(t_delta);
        let designed: ShortestPeriod<MAX_SENSORS> = problem.shortest(args.budget, &mut memory, &mut control)?;
        let preferred = if designed.found.proven {
            Some(problem.prefer(&designed, PREFERENCE_BUDGET, &mut memory, &mut control)?)
        } else {
            None
        };
        let none = if designed.found.proven { NoSchedule::TooFast } else { NoSchedule::EndedEarly };
        let Some(schedule) = preferred.map_or(designed.found.schedule, |preferred| Some(preferred.schedule)) else {
            return Ok(Err(none));
        };
        let needed = t_delta_needed(spec, &schedule);
        let allowed = schedule.verify(&problem.requirements).max_t_delta();
        if allowed >= Some(needed) {
            let described = args.form().is_none() && designed.found.proven;
            let what_if = if described { what_if(&problem, &mut memory, &mut control)? } else { Vec::new() };
            let t_delta = needed.max(t_delta);
            return Ok(Ok(RingDesign { schedule, t_delta, designed, preferred, what_if }));
        }
        // Past this point a second of silence would not be enough either.
        if needed > Micros::from_millis(1000) {
            return Ok(Err(none));
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

/// Relaxes one need after the other by a tenth, or by one tick if that is more, or by one neighbour.
fn what_if(
    problem: &PeriodProblem<'_>,
    memory: &mut [i32],
    control: &mut impl Control,
) -> Result<Vec<WhatIf>, SearchError> {
    let Requirements { t_delta, min_interval, window, layout, .. } = problem.requirements;
    let tick = problem.tick.as_micros().max(1);
    // In whole ticks, as others are rounded up to them.
    let less = |time: Micros| {
        let us = time.as_micros();
        Micros::new((us - us / 10).min(us.saturating_sub(1)) / tick * tick)
    };
    let (shorter, listening) = (less(min_interval), less(window));
    let separation = less(problem.requirements.separation()).as_micros();
    let nearer = Micros::new(separation.saturating_sub(1) / 2);
    let mut cases = Vec::new();
    if shorter < min_interval {
        let relaxed = Requirements { min_interval: shorter, ..problem.requirements };
        cases.push((format!("{shorter} instead of {min_interval} between neighbours"), relaxed));
    }
    if nearer < t_delta {
        cases.push((
            format!("t_delta of {nearer} instead of {t_delta}"),
            Requirements { t_delta: nearer, ..problem.requirements },
        ));
    }
    if Micros::ZERO < listening && listening < window {
        let relaxed = Requirements { window: listening, ..problem.requirements };
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
            Requirements { layout, ..problem.requirements },
        ));
    }
    let answer = |(need, requirements)| {
        let relaxed = PeriodProblem { requirements, ..*problem };
        let found = relaxed.shortest::<MAX_SENSORS>(WHAT_IF_BUDGET, memory, control)?.found;
        Ok(WhatIf { need, period: found.value, proven: found.proven })
    };
    cases.into_iter().map(answer).collect()
}
