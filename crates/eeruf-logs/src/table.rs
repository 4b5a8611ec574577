//! Reads CSV with a header: a column of ranges for each sensor, or one column with ranges and one that says whose.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;

use crate::error::LogError;
use crate::options::Options;
use crate::reading::{Reading, Sensor};
use crate::sink::Sink;

/// What a column is.
enum Column {
    Range(usize),
    /// Without a value so far, in so many rows.
    Unknown(u64),
    Other,
}

/// Reads a CSV file.
pub(crate) fn read(file: &Path, options: &Options, sink: &mut Sink<'_>) -> Result<(), LogError> {
    let opened = File::open(file).map_err(|error| LogError::new(file, error))?;
    read_from(opened, file, options, sink)
}

/// As [`read`], from wherever it comes; `file` stands in errors.
pub(crate) fn read_from(input: impl Read, file: &Path, options: &Options, sink: &mut Sink<'_>) -> Result<(), LogError> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(input);
    let bad = |error: csv::Error| LogError::at_line(file, error.position().map(csv::Position::line), error);
    let header = reader.headers().map_err(|error| LogError::new(file, error))?.clone();
    let mut rows = Rows::new(file, &header, options, sink)?;
    let mut row = StringRecord::new();
    while reader.read_record(&mut row).map_err(bad)? {
        rows.row(&row)?;
    }
    rows.end();
    if rows.sink.report.sensors.is_empty() {
        return Err(LogError::new(
            file,
            "no readings; expected a header and rows with a range in metres for each sensor",
        ));
    }
    Ok(())
}

struct Rows<'a, 's, 'e> {
    file: &'a Path,
    header: &'a StringRecord,
    options: &'a Options,
    columns: Vec<Column>,
    time: Option<usize>,
    sensor: Option<usize>,
    metres: f64,
    sink: &'s mut Sink<'e>,
}

impl<'a, 's, 'e> Rows<'a, 's, 'e> {
    fn new(
        file: &'a Path,
        header: &'a StringRecord,
        options: &'a Options,
        sink: &'s mut Sink<'e>,
    ) -> Result<Self, LogError> {
        let find = |name: &String| {
            let names: Vec<_> = header.iter().collect();
            let expected = || LogError::new(file, format!("no column `{name}`; expected one of: {}", names.join(", ")));
            names.iter().position(|column| column == name).ok_or_else(expected)
        };
        let table = &options.table;
        let time = table.time.as_ref().map(find).transpose()?;
        let sensor = table.sensor.as_ref().map(find).transpose()?;
        let ranges = table.ranges.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        if sensor.is_some() && ranges.len() != 1 {
            let message = format!("{} columns with ranges; with a column of sensors expected is one", ranges.len());
            return Err(LogError::new(file, message));
        }
        let column = |index| {
            let asked = if ranges.is_empty() { time != Some(index) } else { ranges.contains(&index) };
            if asked { Column::Unknown(0) } else { Column::Other }
        };
        let columns = (0..header.len()).map(column).collect();
        let metres = table.range_unit.metres(options.speed_of_sound);
        Ok(Self { file, header, options, columns, time, sensor, metres, sink })
    }

    fn row(&mut self, row: &StringRecord) -> Result<(), LogError> {
        let at_ns = self.time(row)?;
        self.sink.report.messages += 1;
        for index in 0..self.columns.len() {
            let text = row.get(index).unwrap_or_default();
            let sensor = match self.columns[index] {
                Column::Other => continue,
                Column::Range(sensor) => sensor,
                Column::Unknown(_) if self.sensor.is_some() => self.named(row),
                Column::Unknown(ref mut empty) if text.is_empty() => {
                    *empty += 1;
                    continue;
                }
                Column::Unknown(empty) => {
                    // Asked for by name it is a range, and an error if it is none.
                    if self.options.table.ranges.is_empty() && text.parse::<f64>().is_err() {
                        self.columns[index] = Column::Other;
                        continue;
                    }
                    let sensor = self.add(self.header.get(index).unwrap_or_default());
                    self.columns[index] = Column::Range(sensor);
                    let nothing = self.reading(sensor, 0, f64::INFINITY);
                    (0..empty).for_each(|_| self.sink.reading(&nothing));
                    sensor
                }
            };
            let range_m = self.range_m(row, index, text)?;
            let reading = self.reading(sensor, at_ns, range_m);
            self.sink.reading(&reading);
        }
        Ok(())
    }

    /// A sensor that was asked for by name and never heard anything is one all the same.
    fn end(&mut self) {
        for index in 0..self.columns.len() {
            if let Column::Unknown(empty @ 1..) = self.columns[index]
                && !self.options.table.ranges.is_empty()
            {
                let sensor = self.add(self.header.get(index).unwrap_or_default());
                let nothing = self.reading(sensor, 0, f64::INFINITY);
                (0..empty).for_each(|_| self.sink.reading(&nothing));
            }
        }
    }

    fn add(&mut self, name: &str) -> usize {
        self.sink.report.sensors.push(Sensor { topic: name.to_owned(), frame: String::new(), beam: None });
        self.sink.report.sensors.len() - 1
    }

    /// The sensor that a row names.
    fn named(&mut self, row: &StringRecord) -> usize {
        let name = self.sensor.and_then(|column| row.get(column)).unwrap_or_default();
        let known = self.sink.report.sensors.iter().position(|sensor| sensor.topic == name);
        known.unwrap_or_else(|| self.add(name))
    }

    fn reading(&self, sensor: usize, at_ns: u64, range_m: f64) -> Reading {
        Reading {
            sensor,
            at_ns,
            radiation: 0,
            field_of_view_rad: 0.0,
            min_range_m: 0.0,
            max_range_m: self.options.no_echo_m,
            range_m,
            variance: None,
        }
    }

    fn bad(&self, row: &StringRecord, index: usize, expected: &str) -> LogError {
        let (name, text) = (self.header.get(index).unwrap_or_default(), row.get(index).unwrap_or_default());
        let line = row.position().map(csv::Position::line);
        LogError::at_line(self.file, line, format!("column {name}: `{text}`; expected {expected}"))
    }

    fn time(&self, row: &StringRecord) -> Result<u64, LogError> {
        let Some(index) = self.time else { return Ok(0) };
        let text = row.get(index).unwrap_or_default();
        let scale = self.options.table.time_unit.nanoseconds();
        // Whole nanoseconds since 1970 do not fit into a float.
        if let (Ok(whole), true) = (text.parse::<u64>(), scale <= 1e9) {
            return Ok(whole.saturating_mul(scale as u64));
        }
        match text.parse::<f64>() {
            Ok(time) if time >= 0.0 && time.is_finite() => Ok((time * scale).round() as u64),
            _ => Err(self.bad(row, index, "a time of zero or more")),
        }
    }

    /// The range in metres; infinite without echo.
    fn range_m(&self, row: &StringRecord, index: usize, text: &str) -> Result<f64, LogError> {
        if text.is_empty() {
            return Ok(f64::INFINITY);
        }
        let unit = self.options.table.range_unit;
        let Ok(value) = text.parse::<f64>() else {
            return Err(self.bad(row, index, &format!("a range in {}", unit.name())));
        };
        let range_m = value * self.metres;
        if range_m.is_nan() || range_m >= self.options.no_echo_m {
            return Ok(f64::INFINITY);
        }
        if value < 0.0 {
            return Err(self.bad(row, index, &format!("a range of zero {} or more", unit.name())));
        }
        Ok(range_m)
    }
}
