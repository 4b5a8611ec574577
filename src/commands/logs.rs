//! `eeruf logs`: finds out from any log whether sensors read each other's sound.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use eeruf_files::Kind;
use eeruf_logs::{Doctor, Examination, FiringLog, LogReading, LogVerdict, Pattern, Report, Settings, diagnose_while};
use serde::Serialize;
use serde_json::{Value, json as object};

use super::log_args::{LogArgs, left_out, read_shown, tell_damage, warn_of_log};
use super::{Answer, diagnose as by_schedule, replay, survey};
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::report::json::to_json;
use crate::report::table::{counted, markdown};
use crate::report::watch::Watch;

/// Find out whether a log's sensors read each other's sound, which ones, what to do, and why.
///
/// Reads a file, or a pipe with `-`: lines of a serial monitor, tables, JSON, MCAP, ROS 1 and ROS 2 bags, ArduPilot's
/// .BIN and .tlog, PX4's .ulg, or firings of a ring, each also compressed by gzip, bzip2 or zstd. Every guess is
/// printed with the option that overrides it.
///
/// With --schedule the log is one of firings, and its paths and timing are printed; --ring-out reads a measuring run,
/// and --accepted counts the readings that the filter would have accepted.
///
/// The exit code is 1 for crosstalk, 0 if none is seen, and 3 if the log cannot tell; 2 if the log is not understood.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log, or - for standard input
    #[arg(value_name = "LOG")]
    file: PathBuf,
    #[command(flatten)]
    log: LogArgs,
    /// For a log of firings: the ring's fixed schedule, to find who fools whom, drift and jitter
    #[arg(long, value_name = "SCHEDULE.toml", conflicts_with_all = ["ring_out", "out", "accepted"])]
    schedule: Option<PathBuf>,
    /// A measuring run: write a ring file for `design`, in which sensors that hear each other are neighbours
    #[arg(long, value_name = "RING.toml", conflicts_with_all = ["out", "accepted"])]
    ring_out: Option<PathBuf>,
    /// Write the ranges as MCAP, and for each topic `TOPIC/accepted` with the accepted ones
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Count what the filter would have accepted of each sensor
    #[arg(long)]
    accepted: bool,
    /// With --accepted or --out: T_delta in microseconds, within which two readings agree
    #[arg(long, value_name = "US", default_value_t = 500)]
    t_delta_us: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Default, Serialize)]
struct Sensor {
    name: String,
    readings: u64,
    echoes: u64,
    no_echo: u64,
    too_close: u64,
    invalid: u64,
    least_m: Option<f64>,
    most_m: Option<f64>,
}

impl Sensor {
    fn count(&mut self, reading: &LogReading) {
        self.readings += 1;
        match reading.echo() {
            eeruf_logs::Echo::At(range_m) => {
                self.echoes += 1;
                self.least_m = Some(self.least_m.map_or(range_m, |least| least.min(range_m)));
                self.most_m = Some(self.most_m.map_or(range_m, |most| most.max(range_m)));
            }
            eeruf_logs::Echo::Nothing => self.no_echo += 1,
            eeruf_logs::Echo::TooClose => self.too_close += 1,
            eeruf_logs::Echo::Invalid => self.invalid += 1,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    if args.schedule.is_some() {
        return by_schedule::run(&by_schedule::Args::of(&args.file, args.schedule.clone(), args.json));
    }
    if args.ring_out.is_some() {
        return survey::run(&survey::Args::of(&args.file, args.ring_out.clone(), args.json));
    }
    if args.out.is_some() || args.accepted {
        let (log, out) = (args.log.clone(), args.out.clone());
        return replay::run(&replay::Args::of(&args.file, args.t_delta_us, log, out, args.json));
    }
    Kind::expect_log(&args.file)?;
    let mut sensors: Vec<Sensor> = vec![];
    let options = args.log.options()?;
    let mut doctor = Doctor::new(options.speed_of_sound);
    let report = read_shown(&args.file, &options, |report, reading| {
        doctor.push(reading);
        sensors.resize_with(report.sensors.len(), Sensor::default);
        sensors[reading.sensor].count(reading);
    })?;
    warn_of_log(&args.file, &report)?;
    sensors.iter_mut().zip(report.names()).for_each(|(sensor, name)| sensor.name = name);
    let mut examination = doctor.examine(&report.firing, &report.names());
    if matches!(report.firing.pattern, Pattern::Several | Pattern::Flow)
        && let Ok(log) = FiringLog::read(&args.file)
    {
        by_firings(&log, &report.names(), &mut examination);
    }
    let answer = match examination.verdict {
        LogVerdict::Crosstalk => Answer::No,
        LogVerdict::NoneSeen => Answer::Yes,
        LogVerdict::CannotTell => Answer::NotDecided,
    };
    if args.json {
        print_line(to_json(&json(&report, &sensors, &examination)))?;
    } else if !report.sensors.is_empty() {
        let answer = examination.answer(&report.firing, &report.names());
        tell(format!("{answer}\n\n{}", describe(&args.file, &report, &sensors)))?;
    }
    tell_damage(&args.file, &report)?;
    Ok(answer)
}

/// Adds pairs of sensors with crosstalk, from a log of firings with changing lags.
fn by_firings(log: &FiringLog, names: &[String], found: &mut Examination) {
    /// Share of a sensor's readings that must surely be another's sound for the sensor to count as fooled.
    const FOOLED: f64 = 0.05;
    let keep_going = Watch::new().asked(|| format!("{} firings", log.firings.len()));
    let diagnosis = diagnose_while(log, &Settings::of(log), &keep_going);
    drop(keep_going);
    // Names in such a log are the numbers of its sensors.
    let place = |sensor: u8| names.iter().position(|name| *name == sensor.to_string());
    for of in diagnosis.hearing.iter().filter(|of| of.foreign.value() >= FOOLED) {
        let Some(sensor) = place(of.sensor) else { continue };
        let mut by: Vec<_> = diagnosis.paths.iter().filter(|path| path.receiver == of.sensor).collect();
        by.retain(|path| path.sender != of.sensor);
        by.sort_by_key(|path| std::cmp::Reverse(path.readings));
        let by: Vec<_> = by.iter().take(3).filter_map(|path| names.get(place(path.sender)?)).cloned().collect();
        found.fooled.push(sensor);
        let share = 100.0 * of.foreign.value();
        found.reasons.push(format!(
            "{}: {share:.0} % of the readings are another's sound, most of {}: the time from its firing stays",
            names[sensor],
            by.join(", ")
        ));
    }
    if !found.fooled.is_empty() {
        (found.verdict, found.record) = (LogVerdict::Crosstalk, None);
        found.reasons.remove(0);
    } else if diagnosis.moved && found.record.is_some() {
        found.record = Some("a minute of a robot that stands".to_owned());
    }
}

/// Output of `--json`; sensors count from 0.
fn json(report: &Report, sensors: &[Sensor], found: &Examination) -> Value {
    let suspect =
        |of: &eeruf_logs::Suspect| object!({"sensor": of.sensor, "by": of.by, "reason": of.reason, "test": of.test});
    let guess = |of: &eeruf_logs::Guess| object!({"what": of.what, "value": of.value, "option": of.option});
    let firing = &report.firing;
    object!({
        "form": report.form,
        "sensors": sensors,
        "guesses": report.guesses.iter().map(guess).collect::<Vec<_>>(),
        "firing": {
            "pattern": firing.pattern.as_str(), "period_us": firing.period_us, "gap_us": firing.gap_us,
            "least_change_us": firing.least_change_us, "why": firing.why, "proves": firing.proves(None),
        },
        "crosstalk": {
            "verdict": found.verdict.as_str(), "fooled": found.fooled, "pairs": found.pairs,
            "suspects": found.suspects.iter().map(suspect).collect::<Vec<_>>(), "reasons": found.reasons,
            "record": found.record, "notes": found.notes,
        },
        "warnings": report.warnings,
        "damage": report.damage.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "skipped": left_out(report),
    })
}

/// Describes how the log was read.
fn describe(file: &Path, report: &Report, sensors: &[Sensor]) -> String {
    let (count, file) = (counted(sensors.len(), "sensor"), file.display());
    let mut text = format!("{file}: {}, {count}\n", report.form);
    let metres = |range: Option<f64>| range.map_or("-".to_owned(), |range| format!("{range:.3}"));
    let rows = sensors.iter().map(|sensor| {
        let counts = [sensor.readings, sensor.echoes, sensor.no_echo].map(|count| count.to_string());
        let ranges = [metres(sensor.least_m), metres(sensor.most_m)];
        [&[sensor.name.clone()][..], &counts, &ranges].concat()
    });
    let header = ["sensor", "readings", "echoes", "no echo", "nearest m", "farthest m"];
    _ = write!(text, "{}", markdown(&header, rows));
    for eeruf_logs::Guess { what, value, option } in &report.guesses {
        _ = write!(text, "\nguessed {what}: {value} ({option})");
    }
    _ = write!(text, "\nfiring: {}: {}", report.firing.pattern.as_str(), report.firing.proves(None));
    for skipped in left_out(report) {
        _ = write!(text, "\nleft out {skipped}");
    }
    text + "\n"
}
