//! `eeruf diagnose`: faults of a ring, from its own log.

use std::path::{Path, PathBuf};

use eeruf_core::{Micros, Phase};
use eeruf_files::Kind;
use eeruf_logs::{FiringLog, Settings, Timing, diagnose_while, timing};
use eeruf_sim::AnySchedule;

use super::arguments::picture;
use super::log_args::positive;
use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::implausible::read_firings;
use crate::files::toml::read_schedule;
use crate::report::diagnose::{DiagnosisReport, describe, json, who_fools_whom};
use crate::report::watch::Watch;

/// Find in a ring's own log which sensors fool each other, and what is broken.
///
/// Prints the length and the certainty of each path, and the time from which it is heard; also the phases in which
/// sensors are blind, and what to change.
///
/// The log is CSV with the columns sensor, fired_us, period, phase and t_echo_us, one row for each firing: its time in
/// microseconds of one clock, and the raw time to the first echo, empty without one. Sensors, periods and phases
/// count from 0. A column `reading` may have the ring's verdict (`rejected`). `eeruf study --log` writes such a
/// log. Messages `eeruf_msgs/msg/Firing` in an MCAP file are read as well. A ring with random waits shows most;
/// with two phases, senders cannot be distinguished.
///
/// The exit code is 1 if something is broken.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// The fixed schedule that the ring fires by: for jitter, lateness and drift
    #[arg(long, value_name = "SCHEDULE.toml")]
    schedule: Option<PathBuf>,
    /// Largest difference between a reading and its path's prediction, in microseconds; by default four times the
    /// scatter of the log's readings, at least 75
    #[arg(long, value_name = "US", value_parser = clap::value_parser!(u32).range(1..=5000))]
    tolerance_us: Option<u32>,
    /// Longest travel time of sound to consider, in microseconds
    #[arg(long, value_name = "US", default_value_t = 80_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1000..=1_000_000))]
    max_travel_us: u32,
    /// Speed of sound in m/s, for the lengths of paths
    #[arg(long, default_value_t = 343.2, value_name = "M/S", value_parser = positive)]
    speed_of_sound: f64,
    /// Draw who fools whom, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture("pairs"))]
    svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    /// Makes the arguments that `eeruf logs` passes on.
    pub(super) fn of(file: &Path, schedule: Option<PathBuf>, json: bool) -> Self {
        Self {
            file: file.to_owned(),
            schedule,
            tolerance_us: None,
            max_travel_us: 80_000,
            speed_of_sound: 343.2,
            svg: None,
            json,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    Kind::expect_log(&args.file)?;
    let log = read_firings(&args.file)?;
    let measured = Settings::of(&log);
    let settings = Settings {
        tolerance_us: args.tolerance_us.unwrap_or(measured.tolerance_us),
        max_travel_us: args.max_travel_us,
        ..measured
    };
    let timing = timing_of(args, &log)?;
    let keep_going = Watch::new().asked(|| format!("{} firings", log.firings.len()));
    let diagnosis = diagnose_while(&log, &settings, &keep_going);
    drop(keep_going);
    let found = DiagnosisReport {
        file: &args.file,
        log: &log,
        diagnosis: &diagnosis,
        tolerance_us: settings.tolerance_us,
        timing,
        speed_of_sound: args.speed_of_sound,
    };
    if let Some(file) = &args.svg {
        who_fools_whom(&found).save(file)?;
    }
    show(args.json, || json(&found), || describe(&found))?;
    if let Some(damage) = &log.damage {
        return Err(InputError::new(&args.file, damage));
    }
    Ok(if diagnosis.faults.is_empty() { Answer::Yes } else { Answer::No })
}

/// Returns a function that gives the time of a sensor in a phase, in microseconds.
fn fires_at(schedule: &AnySchedule) -> impl Fn(u8, u8) -> Option<u32> {
    |sensor, phase| {
        let fires = if phase < 2 { schedule.t_fire(Phase(phase), sensor.into()) } else { None };
        fires.map(Micros::as_micros)
    }
}

fn timing_of(args: &Args, log: &FiringLog) -> Result<Option<Timing>, InputError> {
    let Some(file) = &args.schedule else { return Ok(None) };
    let schedule = read_schedule(file)?;
    let found = timing(log, schedule.period().as_micros(), fires_at(&schedule));
    found.map(Some).map_err(|error| InputError::new(&args.file, format!("against {}: {error}", file.display())))
}
