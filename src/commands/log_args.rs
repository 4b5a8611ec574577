//! The options of commands that read logs of ranges.

use std::path::Path;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use eeruf_files::FileError;
use eeruf_logs::{FieldChoice, LogReading, Options, RangeUnit, Report, Table, TimeUnit, read_log};

use crate::files::error::InputError;
use crate::files::implausible::warn;
use crate::report::watch::Watch;

/// Options for reading a log. Those that are not given are guessed, and `eeruf logs` lists each guess.
#[derive(Clone, clap::Args)]
#[command(next_help_heading = "The log")]
pub(crate) struct LogArgs {
    /// Speed of sound in m/s, to turn ranges back into echo times
    #[arg(long, hide_short_help = true, default_value_t = 343.2, value_name = "M/S", value_parser = positive)]
    pub(crate) speed_of_sound: f64,
    /// Text: the range in metres from which on a value means that there was no echo
    #[arg(long, hide_short_help = true, default_value_t = 5.0, value_name = "M", value_parser = positive)]
    no_echo_m: f64,
    /// Text: a value that means no echo, a number in the log's unit or a word; may be given several times. By default
    /// 0, numbers below 0, and a repeated greatest number
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true)]
    no_echo: Vec<String>,
    /// Text: the names of the columns in order, with commas between; `-` leaves one out; by default
    /// the log's header
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Text: the column with the time; by default guessed
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// Text: the unit of the time; by default guessed
    #[arg(long, hide_short_help = true, value_name = "UNIT", value_parser = unit(&TimeUnit::NAMES))]
    time_unit: Option<TimeUnit>,
    /// Text: a column with ranges; may be given several times; by default guessed
    #[arg(long, value_name = "COLUMN")]
    range: Vec<String>,
    /// Text: the unit of the ranges; ms and us are milli- and microseconds from firing to echo; by default guessed
    #[arg(long, hide_short_help = true, value_name = "UNIT", value_parser = unit(&RangeUnit::NAMES))]
    range_unit: Option<RangeUnit>,
    /// Text: the column with the sensor of each row; needs one column with ranges; by default
    /// guessed
    #[arg(long, hide_short_help = true, value_name = "COLUMN")]
    sensor: Option<String>,
    /// Bags: read this topic only, whatever its type; may be given several times; by default all topics with ranges
    #[arg(long, value_name = "TOPIC")]
    topic: Vec<String>,
    /// Bags: read numbers of a field as ranges in a unit, such as `--field /sonars distance_mm[] mm`; by default
    /// ranges are messages of their own types
    #[arg(long, hide_short_help = true, num_args = 3, value_names = ["TOPIC", "FIELD", "UNIT"])]
    field: Vec<String>,
}

/// Reads the name of a unit.
fn unit<T: Copy + Send + Sync>(known: &'static [(&'static str, T)]) -> impl TypedValueParser<Value = T> {
    let of = |name: String| known.iter().find(|unit| unit.0 == name).expect("one of the possible values").1;
    PossibleValuesParser::new(known.iter().map(|unit| unit.0)).map(of)
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("expected a number above zero".to_owned()),
    }
}

impl LogArgs {
    /// Returns the options in the reader's form.
    pub(crate) fn options(&self) -> Result<Options, InputError> {
        let field = |parts: &[String]| -> Result<FieldChoice, InputError> {
            let unit = RangeUnit::NAMES.iter().find(|unit| unit.0.eq_ignore_ascii_case(&parts[2]));
            let known = RangeUnit::NAMES.map(|unit| unit.0).join(", ");
            let wrong = || format!("{}: unit `{}`; expected one of {known}", parts[0], parts[2]);
            let unit = unit.ok_or_else(|| InputError::new("--field", wrong()))?.1;
            Ok(FieldChoice { topic: parts[0].clone(), path: parts[1].clone(), unit })
        };
        let table = Table {
            columns: self.columns.clone(),
            ranges: self.range.clone(),
            range_unit: self.range_unit,
            time: self.time.clone(),
            time_unit: self.time_unit,
            sensor: self.sensor.clone(),
        };
        Ok(Options {
            table,
            speed_of_sound: self.speed_of_sound,
            no_echo_m: self.no_echo_m,
            no_echo: self.no_echo.clone(),
            topics: self.topic.clone(),
            fields: self.field.chunks(3).map(field).collect::<Result<_, InputError>>()?,
            judged: false,
        })
    }
}

/// Reads a log and shows the progress.
pub(crate) fn read_shown(
    file: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    let (watch, mut count) = (Watch::unstoppable(), 0_u64);
    read_log(file, options, |report, reading| {
        count += 1;
        if count.is_multiple_of(4096) {
            watch.go_on(|| format!("{count} readings"));
        }
        each(report, reading);
    })
}

/// Warns of readings that seem wrong.
///
/// # Errors
/// The first of the warnings, if they are denied.
pub(crate) fn warn_of_log(file: &Path, report: &Report) -> Result<(), InputError> {
    report.warnings.iter().try_for_each(|warning| warn(InputError::new(file, warning)))
}

/// Fails if a part of the log could not be read, or if no sensor was found, with the reason.
pub(crate) fn tell_damage(file: &Path, report: &Report) -> Result<(), InputError> {
    match &report.damage[..] {
        [] => {}
        [first, rest @ ..] => {
            let is_said = first.message().contains("expected ");
            let first = if is_said { first.clone() } else { first.clone().and("expected a whole and undamaged log") };
            let more = || format!("places that cannot be read, beyond this one: {}", rest.len());
            return Err(if rest.is_empty() { first } else { first.and(more()) }.into());
        }
    }
    if report.sensors.is_empty() {
        let mut found = left_out(report);
        // The columns of a text tell more than its form.
        if report.skipped.iter().any(|topic| topic.why.contains("--range")) {
            found.retain(|said| said.contains("--range"));
        }
        let found = if found.is_empty() { "nothing".to_owned() } else { found.join("; ") };
        let message = format!("{}: no sensors; expected ranges; found {found}", report.form);
        return Err(InputError::new(file, message));
    }
    Ok(())
}

/// Lists the parts of a log left out, with reasons.
pub(crate) fn left_out(report: &Report) -> Vec<String> {
    let said = report.skipped.iter().map(|topic| match topic.messages {
        0 => format!("{}: {}", topic.topic, topic.why),
        messages => format!("{}: {messages} messages with {}", topic.topic, topic.why),
    });
    said.collect()
}
