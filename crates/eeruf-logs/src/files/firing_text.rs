//! Firing logs in text: tables with any separator. A damaged line yields no firing, and is named.

use std::io::Read;
use std::ops::Range;
use std::path::Path;

use eeruf_core::ReadingKind;

use crate::firings::{Firing, FiringLog};
use crate::text::{Line, Separator, Source, is_comment, separated};
use crate::value::{is_no_echo, number, prefix};
use eeruf_files::FileError;

/// The largest number of sensors on a ring.
pub(crate) const MAX_SENSORS: u8 = 64;

/// The columns to read; a table needs the first five.
const NAMES: [&str; 8] = ["sensor", "fired_us", "period", "phase", "t_echo_us", "reading", "sends", "g"];
const NEEDED: usize = 5;

/// The kind with this spelling in logs.
pub(crate) fn kind_of(spelled: &str) -> Option<ReadingKind> {
    ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == spelled)
}

/// A column's name in the form for comparisons.
fn same_name(name: &str) -> String {
    name.trim().trim_start_matches('#').trim().to_lowercase().replace([' ', '-'], "_")
}

/// Reads a log in text; `file` is used in errors.
pub(crate) fn read(input: impl Read, file: &Path) -> Result<FiringLog, FileError> {
    let failed = |error: std::io::Error| FileError::reading(file, &error);
    let mut source = Source::new(Box::new(input)).map_err(failed)?;
    let mut sample = vec![];
    while sample.len() < 200 {
        let Some(line) = source.next().map_err(failed)? else { break };
        sample.push(line);
    }
    let mut rows = Rows::of(&sample).map_err(|message| FileError::new(file, message))?;
    sample.iter().for_each(|line| rows.line(line));
    while let Some(line) = source.next().map_err(failed)? {
        rows.line(&line);
    }
    rows.log(file)
}

/// A table, and its firings so far.
struct Rows {
    names: Vec<String>,
    /// The places of [`NAMES`].
    columns: [Option<usize>; 8],
    separator: Separator,
    has_prefix: bool,
    log: FiringLog,
    /// Number of wraps of a 32-bit clock, times 2^32.
    wraps: i64,
    last: Option<i64>,
    /// Length of the longest last cell.
    longest: usize,
    damaged: u64,
    first_damage: Option<(u64, String)>,
}

impl Rows {
    /// A table whose header is the first line that is not a comment; a comment may name the clock.
    fn of(sample: &[Line]) -> Result<Self, String> {
        let first = sample.iter().find(|line| !is_comment(&line.text)).map_or("", |line| line.text.trim());
        let stripped = prefix(first).map(|(_, rest)| rest).filter(|rest| rest.to_lowercase().contains("sensor"));
        let names = |separator: Separator| -> Vec<String> {
            let cells = separated(stripped.unwrap_or(first), separator).unwrap_or_default();
            cells.iter().map(|name| same_name(name)).collect()
        };
        let found =
            |&separator: &Separator| names(separator).iter().filter(|name| NAMES.contains(&name.as_str())).count();
        let separator = Separator::ALL.into_iter().rev().max_by_key(found).unwrap_or(Separator::Comma);
        let names = names(separator);
        let columns = NAMES.map(|name| names.iter().position(|column| column == name));
        if let Some(missing) = columns[..NEEDED].iter().position(Option::is_none) {
            return Err(format!(
                "no column `{}`; expected {}; `eeruf logs` says what else the file holds",
                NAMES[missing],
                NAMES[..NEEDED].join(", ")
            ));
        }
        let comment = sample.iter().find_map(|line| line.text.trim().strip_prefix('#')).unwrap_or_default();
        let clock = comment.trim().trim_start_matches("clock:").trim();
        Ok(Self {
            names,
            columns,
            separator,
            has_prefix: stripped.is_some(),
            log: FiringLog::new(if clock.is_empty() { "unnamed" } else { clock }, vec![]),
            wraps: 0,
            last: None,
            longest: 0,
            damaged: 0,
            first_damage: None,
        })
    }

    fn line(&mut self, line: &Line) {
        if is_comment(&line.text) && !line.is_too_long {
            return;
        }
        if let Err(why) = self.row(line) {
            self.damaged += 1;
            self.first_damage.get_or_insert((line.number, why));
        }
    }

    fn row(&mut self, line: &Line) -> Result<(), String> {
        if line.is_too_long || line.text.contains('\u{fffd}') {
            return Err("bytes that are no text".to_owned());
        }
        let text = line.text.trim_matches([' ', '\u{feff}']);
        let text = if self.has_prefix { prefix(text).map_or(text, |found| found.1) } else { text };
        let cells = separated(text, self.separator).ok_or("a quotation mark that is not closed")?;
        if cells.iter().map(|cell| same_name(cell)).eq(self.names.iter().cloned()) {
            return Ok(());
        }
        if cells.len() != self.names.len() {
            return Err(format!("{} cells; expected {}", cells.len(), self.names.len()));
        }
        let last = cells.last().map_or(0, String::len);
        if !line.is_ended && last < self.longest {
            return Err("it ends without a line break and may be cut".to_owned());
        }
        self.longest = self.longest.max(last);
        let text = |name: usize| self.columns[name].map_or("", |column| cells[column].as_str());
        let bad =
            |name: usize, expected: &str| format!("column {}: `{}`; expected {expected}", NAMES[name], text(name));
        let within = |name: usize, range: Range<f64>, expected: &str| {
            let number = number(text(name), self.separator != Separator::Comma);
            number.filter(|number| range.contains(number)).ok_or_else(|| bad(name, expected))
        };
        let t_echo_us = match text(4) {
            echo if is_no_echo(echo) => None,
            _ => Some(within(4, 0.0..4e9, "microseconds, or nothing")?.round() as u32),
        };
        let sends = match text(6) {
            "0" => false,
            "" | "1" => true,
            _ => return Err(bad(6, "0 or 1")),
        };
        let g_us_ms = match text(7) {
            "" => None,
            _ => Some(within(7, 0.0..1e6, "microseconds for each millisecond, 0 to 1e6")? as f32),
        };
        let sensor = text(0).parse().ok().filter(|&sensor| sensor < MAX_SENSORS);
        let mut firing = Firing {
            g_us_ms,
            sensor: sensor.ok_or_else(|| bad(0, "0 to 63"))?,
            fired_us: within(1, 0.0..9e15, "microseconds, 0 to 9e15")?.round() as i64 + self.wraps,
            period: text(2).parse().map_err(|_| bad(2, "a number from 0"))?,
            phase: text(3).parse().map_err(|_| bad(3, "0 to 255"))?,
            t_echo_us,
            reading: kind_of(text(5)),
        };
        if self.last.is_some_and(|last| last - firing.fired_us > 1 << 31) {
            self.wraps += 1 << 32;
            firing.fired_us += 1 << 32;
        }
        self.last = Some(firing.fired_us);
        if sends { &mut self.log.firings } else { &mut self.log.listened }.push(firing);
        Ok(())
    }

    fn log(self, file: &Path) -> Result<FiringLog, FileError> {
        if self.log.firings.is_empty() {
            return Err(match self.first_damage {
                Some((line, why)) => FileError::new(file, why).at_line(Some(line)),
                None => FileError::new(file, "0 firings; expected one or more"),
            });
        }
        let damage = self.first_damage.map(|(line, why)| match self.damaged {
            1 => format!("line {line} is left out: {why}"),
            damaged => format!("{damaged} lines are left out, first line {line}: {why}"),
        });
        let FiringLog { clock, firings, listened, .. } = self.log;
        Ok(FiringLog { listened, damage, ..FiringLog::new(&clock, firings) })
    }
}
