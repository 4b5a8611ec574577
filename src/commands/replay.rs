//! `eeruf replay`: runs the filter over recorded readings.

use std::path::{Path, PathBuf};

use eeruf_core::{Micros, ReadingKind};
use eeruf_files::Kind;
use eeruf_logs::{Counted, Judging, McapWriter, RangeJudge, Report, replay_flow};

use super::arguments::picture;
use super::log_args::{LogArgs, left_out, read_shown, tell_damage, warn_of_log};
use super::{Answer, show};
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::flow::read_flow;
use crate::files::implausible::{read_firings, warn};
use crate::files::write::write;
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::replay::{Column, Counts, Firing, Replay, table};
use crate::report::replay_flow::{FlowReplay, rows};

/// Run the filter over a log of real readings: which would it have accepted?
///
/// With --ring the log is one of firings, as `eeruf diagnose` reads it, of a ring that fires by flow: each reading is
/// judged again by the firings, with the robot's motion from a column `g`, and compared with the ring's own verdict,
/// if the log has it. Without --ring, it is any log that `eeruf logs` reads: MCAP, ROS 1 and ROS 2 bags, tables, lines
/// of pairs, JSON. A damaged log is read as far as possible; the rest is named, and the exit code is 2. A gap in a
/// sensor's times, or a clock that steps back, starts its comparison over. The last line says how the sensors fire,
/// and what agreement proves for that.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// T_delta in microseconds: consecutive readings that differ by no more are near-identical
    #[arg(long, value_name = "US", default_value_t = 0, required_unless_present = "ring", conflicts_with = "ring")]
    t_delta_us: u32,
    /// The ring that fired by flow, or its scene, for a log of firings
    #[arg(long, value_name = "RING.toml|SCENE.toml", conflicts_with_all = ["consecutive", "svg"])]
    ring: Option<PathBuf>,
    /// Number of consecutive readings that must agree
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=8))]
    consecutive: u8,
    #[command(flatten)]
    log: LogArgs,
    /// Write the log's ranges as MCAP, and beside each topic `TOPIC/accepted`: the accepted ranges, +Inf where nothing
    /// is in range, -Inf for too close (REP 117), and no message for a rejected one; for firings, CSV with the new
    /// verdict on each reading, and the echo believed from then on
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw what happened to each sensor over time, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture("readings"))]
    svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    /// Makes the arguments that `eeruf logs` passes on.
    pub(super) fn of(file: &Path, t_delta_us: u32, log: LogArgs, out: Option<PathBuf>, json: bool) -> Self {
        let file = file.to_owned();
        Self { file, t_delta_us, ring: None, consecutive: 2, log, out, svg: None, json }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    Kind::expect_log(&args.file)?;
    if let Some(ring) = &args.ring {
        return run_flow(args, ring);
    }
    if args.t_delta_us == 0 {
        let message = "0; expected 20 to 20000; no two echoes of one wall come at the same microsecond";
        warn(InputError::new("--t-delta-us", message))?;
    }
    let mut judging = judging(args)?;
    let (mut kinds, mut failed) = (Vec::<Vec<ReadingKind>>::new(), None);
    let report = read_shown(&args.file, &args.log.options()?, |report, reading| {
        if failed.is_some() {
            return;
        }
        match judging.push(&report.sensors, reading) {
            Ok(Some(kind)) if args.svg.is_some() => {
                kinds.resize_with(kinds.len().max(reading.sensor + 1), Vec::new);
                kinds[reading.sensor].push(kind);
            }
            Ok(_) => {}
            Err(error) => failed = Some(error),
        }
    })?;
    if let Some(error) = failed {
        return Err(error.into());
    }
    warn_of_log(&args.file, &report)?;
    let counted = judging.counted();
    judging.finish()?;
    if !report.sensors.is_empty() || args.json {
        print(args, &report, &counted, kinds)?;
    }
    tell_damage(&args.file, &report)?;
    Ok(Answer::Yes)
}

/// Judges the firings of a flow ring again.
fn run_flow(args: &Args, ring: &Path) -> Result<Answer, InputError> {
    let log = read_firings(&args.file)?;
    let replayed = replay_flow(&log, &read_flow(ring)?).map_err(|error| InputError::new(ring, error))?;
    if let Some(out) = &args.out {
        write(out, rows(&log, &replayed))?;
    }
    let flow = FlowReplay::of(&log, &replayed);
    show(args.json, || &flow, || flow.table(&args.file))?;
    match &log.damage {
        Some(damage) => Err(InputError::new(&args.file, damage)),
        None => Ok(Answer::Yes),
    }
}

fn judging(args: &Args) -> Result<Judging, InputError> {
    let judge = RangeJudge { t_delta: Micros::new(args.t_delta_us), consecutive: args.consecutive };
    let judging = Judging::new(judge, args.log.speed_of_sound, &args.file);
    let judging = judging.map_err(|error| InputError::new(&args.file, error))?;
    Ok(match args.out.as_deref() {
        None => judging,
        Some(out) => judging.writing(McapWriter::create(out)?),
    })
}

fn print(args: &Args, report: &Report, counted: &[Counted], kinds: Vec<Vec<ReadingKind>>) -> Result<(), InputError> {
    let names = report.names();
    let of_sensor = |(name, counted): (&String, &Counted)| Counts::of(Some(name), std::slice::from_ref(counted));
    let counts: Vec<_> = names.iter().zip(counted).map(of_sensor).collect();
    let total = Counts::of(None, counted);
    if let Some(file) = &args.svg {
        let column = |(name, kinds): (&String, Vec<ReadingKind>)| Column { name: name.clone(), kinds };
        let columns: Vec<_> = names.iter().zip(kinds).map(column).collect();
        draw::kinds_over_time(&columns, args.t_delta_us).save(file)?;
    }
    let t_delta_us = args.t_delta_us;
    let proves = report.firing.proves(Some(t_delta_us));
    if args.json {
        let damage = report.damage.iter().map(ToString::to_string).collect();
        let (skipped, warnings) = (left_out(report), report.warnings.clone());
        let firing = Some(Firing { pattern: report.firing.pattern.as_str(), proves });
        let replay = Replay { total, sensors: counts, damage, skipped, warnings, firing };
        print_line(to_json(&replay))?;
    } else {
        let table = table(&args.file, t_delta_us, &counts, &total);
        let skipped: String = left_out(report).iter().map(|skipped| format!("left out {skipped}\n")).collect();
        let guesses = guesses(report);
        tell(format!("{table}\n{guesses}{skipped}firing: {}: {proves}\n", report.firing.pattern.as_str()))?;
    }
    Ok(())
}

/// Writes one line of guesses; `eeruf logs` prints them in full.
fn guesses(report: &Report) -> String {
    if report.guesses.is_empty() {
        return String::new();
    }
    let said: Vec<_> = report.guesses.iter().map(|guess| format!("{}: {}", guess.what, guess.value)).collect();
    format!("guessed {}\n", said.join("; "))
}
