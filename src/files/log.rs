//! Logs of real readings: CSV with a header, one row for each firing of every sensor.

use std::io::Read;
use std::path::Path;

use eeruf_core::Micros;

use super::error::InputError;

/// One sensor's echo times, and the line of the file that each stands on.
pub(crate) struct LogColumn {
    pub(crate) name: String,
    pub(crate) t_echo: Vec<Option<Micros>>,
}

/// How to turn a range into an echo time.
pub(crate) struct RangeScale {
    /// In m/s.
    pub(crate) speed_of_sound: f64,
    /// From this range on, in metres, a value means that there was no echo.
    pub(crate) no_echo_m: f64,
}

/// Reads a log. A column is a sensor if its first value is a number, the range in metres; other columns are ignored.
pub(crate) fn read_log(file: &Path, scale: &RangeScale) -> Result<Vec<LogColumn>, InputError> {
    let log = std::fs::File::open(file).map_err(|error| InputError::new(file, None, error))?;
    read_log_from(log, file, scale)
}

/// As [`read_log`], from wherever it comes; `file` stands in errors.
pub(crate) fn read_log_from(log: impl Read, file: &Path, scale: &RangeScale) -> Result<Vec<LogColumn>, InputError> {
    let bad = |line, message: &dyn std::fmt::Display| InputError::new(file, line, message);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(log);
    let header = reader.headers().map_err(|error| bad(None, &error))?.clone();
    let rows = reader
        .records()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| bad(error.position().map(csv::Position::line), &error))?;
    let mut columns = vec![];
    for (index, name) in header.iter().enumerate() {
        let values = || rows.iter().map(|row| row.get(index).unwrap_or_default());
        let first = values().find(|text| !text.is_empty());
        if first.is_none_or(|text| text.parse::<f64>().is_err()) {
            continue;
        }
        let mut t_echo = vec![];
        for (row, text) in rows.iter().zip(values()) {
            let line = row.position().map(csv::Position::line);
            t_echo.push(
                scale
                    .echo_time(text)
                    .map_err(|expected| bad(line, &format!("column {name}: `{text}`; expected {expected}")))?,
            );
        }
        columns.push(LogColumn { name: name.to_owned(), t_echo });
    }
    if columns.is_empty() {
        return Err(bad(None, &"no readings; expected a header and rows with a range in metres for each sensor"));
    }
    Ok(columns)
}

impl RangeScale {
    /// The echo time of a range in metres: `2 d / c`, rounded to the microsecond.
    fn echo_time(&self, text: &str) -> Result<Option<Micros>, &'static str> {
        if text.is_empty() {
            return Ok(None);
        }
        let range_m: f64 = text.parse().map_err(|_| "a range in metres")?;
        if range_m.is_nan() || range_m >= self.no_echo_m {
            return Ok(None);
        }
        if range_m < 0.0 {
            return Err("a range of zero metres or more");
        }
        let us = (2e6 * range_m / self.speed_of_sound).round();
        if us >= f64::from(u32::MAX) {
            return Err("a range that sound covers within an hour");
        }
        Ok(Some(Micros::new(us as u32)))
    }
}
