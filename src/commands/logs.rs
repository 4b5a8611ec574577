//! `eeruf logs`: what a log holds.

use std::fmt::Write as _;
use std::path::PathBuf;

use eeruf_files::Kind;
use eeruf_logs::{Doctor, Examination, Reading, Report, Verdict, read_log};
use serde::Serialize;

use super::Answer;
use super::log_args::{LogArgs, left_out, tell_damage, warn_of_log};
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::report::json::to_json;
use crate::report::table::markdown;

/// Recognise a log: its form, sensors and firing pattern, and whether sensors hear each other.
///
/// Each guess is printed with the option that overrides it.
///
/// Reads MCAP, ROS 1 and ROS 2 bags, tables with any separator, lines of pairs of name and value, JSON, what
/// `ros2 topic echo` prints, and each of them packed by gzip, bzip2 or zstd. `replay` reads the same, and Python's
/// `read_log`.
///
/// The exit code is 1 for crosstalk, 0 if none is seen, and 3 if the log cannot tell; 2 if it is not understood.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG")]
    file: PathBuf,
    #[command(flatten)]
    log: LogArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Found {
    form: String,
    sensors: Vec<Sensor>,
    guesses: Vec<Guess>,
    firing: Firing,
    crosstalk: Crosstalk,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    warnings: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    damage: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    skipped: Vec<String>,
}

#[derive(Serialize)]
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

#[derive(Serialize)]
struct Guess {
    what: String,
    value: String,
    option: String,
}

#[derive(Serialize)]
struct Firing {
    pattern: &'static str,
    period_us: Option<u64>,
    gap_us: Option<u64>,
    least_change_us: Option<u64>,
    why: String,
    proves: String,
}

/// The doctor's verdict; sensors count from 0.
#[derive(Serialize)]
struct Crosstalk {
    verdict: &'static str,
    fooled: Vec<usize>,
    pairs: Vec<(usize, usize)>,
    reasons: Vec<String>,
    record: Option<String>,
    notes: Vec<String>,
}

impl Sensor {
    fn count(&mut self, reading: &Reading) {
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
    Kind::expect_log(&args.file)?;
    let mut sensors: Vec<Sensor> = vec![];
    let options = args.log.options()?;
    let mut doctor = Doctor::new(options.speed_of_sound);
    let report = read_log(&args.file, &options, |report, reading| {
        doctor.push(reading);
        while sensors.len() < report.sensors.len() {
            sensors.push(Sensor {
                name: String::new(),
                readings: 0,
                echoes: 0,
                no_echo: 0,
                too_close: 0,
                invalid: 0,
                least_m: None,
                most_m: None,
            });
        }
        sensors[reading.sensor].count(reading);
    })?;
    warn_of_log(&args.file, &report)?;
    sensors.iter_mut().zip(report.names()).for_each(|(sensor, name)| sensor.name = name);
    let examination = doctor.examine(&report.firing, &report.names());
    let answer = match examination.verdict {
        Verdict::Crosstalk => Answer::No,
        Verdict::NoneSeen => Answer::Yes,
        Verdict::CannotTell => Answer::NotDecided,
    };
    let found = found(&report, sensors, examination);
    if args.json {
        print_line(to_json(&found))?;
    } else if !report.sensors.is_empty() {
        tell(describe(&args.file.display().to_string(), &found))?;
    }
    tell_damage(&args.file, &report)?;
    Ok(answer)
}

fn found(report: &Report, sensors: Vec<Sensor>, examination: Examination) -> Found {
    let Examination { verdict, fooled, pairs, reasons, record, notes } = examination;
    let guess = |guess: &eeruf_logs::Guess| Guess {
        what: guess.what.clone(),
        value: guess.value.clone(),
        option: guess.option.clone(),
    };
    let firing = &report.firing;
    Found {
        form: report.form.clone(),
        sensors,
        guesses: report.guesses.iter().map(guess).collect(),
        firing: Firing {
            pattern: firing.pattern.as_str(),
            period_us: firing.period_us,
            gap_us: firing.gap_us,
            least_change_us: firing.least_change_us,
            why: firing.why.clone(),
            proves: firing.proves(None),
        },
        crosstalk: Crosstalk { verdict: verdict.as_str(), fooled, pairs, reasons, record, notes },
        warnings: report.warnings.clone(),
        damage: report.damage.iter().map(ToString::to_string).collect(),
        skipped: left_out(report),
    }
}

fn describe(file: &str, found: &Found) -> String {
    let count = found.sensors.len();
    let mut text = format!("{file}: {}, {count} sensor{}\n", found.form, if count == 1 { "" } else { "s" });
    let metres = |range: Option<f64>| range.map_or("-".to_owned(), |range| format!("{range:.3}"));
    let rows = found.sensors.iter().map(|sensor| {
        let counts = [sensor.readings, sensor.echoes, sensor.no_echo].map(|count| count.to_string());
        let ranges = [metres(sensor.least_m), metres(sensor.most_m)];
        [&[sensor.name.clone()][..], &counts, &ranges].concat()
    });
    let header = ["sensor", "readings", "echoes", "no echo", "nearest m", "farthest m"];
    _ = write!(text, "{}", markdown(&header, rows));
    for Guess { what, value, option } in &found.guesses {
        _ = write!(text, "\nguessed {what}: {value} ({option})");
    }
    _ = write!(text, "\nfiring: {}: {}", found.firing.pattern, found.firing.proves);
    for skipped in &found.skipped {
        _ = write!(text, "\nleft out {skipped}");
    }
    let Crosstalk { verdict, fooled, reasons, record, notes, .. } = &found.crosstalk;
    let names: Vec<_> = fooled.iter().map(|&sensor| found.sensors[sensor].name.as_str()).collect();
    let at = if names.is_empty() { String::new() } else { format!(" at {}", names.join(", ")) };
    _ = write!(text, "\ncrosstalk: {}{at}", if *verdict == "crosstalk" { "yes" } else { verdict });
    reasons.iter().for_each(|reason| _ = write!(text, "\n- {reason}"));
    if let Some(record) = record {
        _ = write!(text, "\n- record {record}");
    }
    notes.iter().for_each(|note| _ = write!(text, "\nnote {note}"));
    text + "\n"
}
