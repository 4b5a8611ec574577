//! Firing logs in text: tables with any separator. A damaged line yields no firing, and is named.

use std::io::Read;
use std::path::Path;

use eeruf_core::ReadingKind;

use crate::firings::{Firing, FiringLog};
use crate::text::{Line, Separator, Source, is_comment, separated};
use crate::value::{is_no_echo, number, prefix};
use eeruf_files::FileError;

/// The largest number of sensors on a ring.
pub(crate) const MAX_SENSORS: u8 = 64;

const NEEDED: [&str; 5] = ["sensor", "fired_us", "period", "phase", "t_echo_us"];
/// The columns to read.
const NAMES: [&str; 8] = ["sensor", "fired_us", "period", "phase", "t_echo_us", "reading", "sends", "g"];

/// The kind with this spelling in logs.
pub(crate) fn kind_of(spelled: &str) -> Option<ReadingKind> {
    ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == spelled)
}

/// The columns of a table.
struct Header {
    names: Vec<String>,
    separator: Separator,
    has_prefix: bool,
    needed: [usize; 5],
    reading: Option<usize>,
    sends: Option<usize>,
    motion: Option<usize>,
}

/// The reason why a line yields no firing: a column, if one is at fault, and what is wrong.
type Wrong = (Option<usize>, String);

impl Header {
    /// Columns from the first line that is not a comment.
    fn of(sample: &[Line]) -> Result<Self, String> {
        let first = sample.iter().find(|line| !is_comment(&line.text)).map_or("", |line| line.text.trim());
        let stripped = prefix(first).map(|(_, rest)| rest).filter(|rest| rest.to_lowercase().contains("sensor"));
        let has_prefix = stripped.is_some();
        let names = |separator: Separator| {
            let cells = separated(stripped.unwrap_or(first), separator).unwrap_or_default();
            cells.iter().map(|name| same_name(name)).collect::<Vec<_>>()
        };
        let found =
            |&separator: &Separator| names(separator).iter().filter(|name| NAMES.contains(&name.as_str())).count();
        let separator = Separator::ALL.into_iter().rev().max_by_key(found).unwrap_or(Separator::Comma);
        let names = names(separator);
        let column = |name: &str| names.iter().position(|column| column == name);
        let mut needed = [0; 5];
        for (place, name) in needed.iter_mut().zip(NEEDED) {
            *place = column(name).ok_or_else(|| {
                format!(
                    "no column `{name}`; expected sensor, fired_us, period, phase, t_echo_us; `eeruf logs` says what \
                     else the file holds"
                )
            })?;
        }
        let [reading, sends, motion] = ["reading", "sends", "g"].map(column);
        Ok(Self { separator, has_prefix, needed, reading, sends, motion, names })
    }

    /// The cells of a line; `None` for the header itself.
    fn cells(&self, line: &Line) -> Result<Option<Vec<String>>, Wrong> {
        let wrong = |why: String| (None, why);
        if line.is_too_long || line.text.contains('\u{fffd}') {
            return Err(wrong("bytes that are no text".to_owned()));
        }
        let text = line.text.trim_matches([' ', '\u{feff}']);
        let text = if self.has_prefix { prefix(text).map_or(text, |found| found.1) } else { text };
        let cells =
            separated(text, self.separator).ok_or_else(|| wrong("a quotation mark that is not closed".to_owned()))?;
        if cells.iter().map(|cell| same_name(cell)).eq(self.names.iter().cloned()) {
            return Ok(None);
        }
        if cells.len() != self.names.len() {
            return Err(wrong(format!("{} cells; expected {}", cells.len(), self.names.len())));
        }
        Ok(Some(cells))
    }

    /// The firing of a row, and whether its sensor sent.
    fn firing(&self, cells: &[String]) -> Result<(Firing, bool), Wrong> {
        let decimal_comma = self.separator != Separator::Comma;
        let text = |column: usize| cells.get(column).map_or("", String::as_str);
        let bad = |column: usize, expected: &str| (Some(column), format!("`{}`; expected {expected}", text(column)));
        let [sensor, fired, period, phase, echo] = self.needed;
        let fired_us = number(text(fired), decimal_comma).filter(|us| (0.0..9e15).contains(us));
        let t_echo_us = match text(echo) {
            text if is_no_echo(text) => None,
            text => {
                let us = number(text, decimal_comma).filter(|us| (0.0..4e9).contains(us));
                Some(us.ok_or_else(|| bad(echo, "microseconds, or nothing"))?.round() as u32)
            }
        };
        let sends = match self.sends {
            Some(column) => match text(column) {
                "0" => false,
                "" | "1" => true,
                _ => return Err(bad(column, "0 or 1")),
            },
            None => true,
        };
        let made = self.reading.map(text).unwrap_or_default();
        let g_us_ms = match self.motion.filter(|&column| !text(column).is_empty()) {
            None => None,
            Some(column) => {
                let g = number(text(column), decimal_comma).filter(|g| (0.0..1e6).contains(g));
                Some(g.ok_or_else(|| bad(column, "microseconds for each millisecond, 0 to 1e6"))? as f32)
            }
        };
        let known_sensor = text(sensor).parse().ok().filter(|&sensor| sensor < MAX_SENSORS);
        let firing = Firing {
            g_us_ms,
            sensor: known_sensor.ok_or_else(|| bad(sensor, "0 to 63"))?,
            fired_us: fired_us.ok_or_else(|| bad(fired, "microseconds, 0 to 9e15"))?.round() as i64,
            period: text(period).parse().map_err(|_| bad(period, "a number from 0"))?,
            phase: text(phase).parse().map_err(|_| bad(phase, "0 to 255"))?,
            t_echo_us,
            reading: kind_of(made),
        };
        Ok((firing, sends))
    }
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
    let header = Header::of(&sample);
    let header = header.map_err(|message| FileError::new(file, message))?;
    let clock = sample.iter().find_map(|line| line.text.trim().strip_prefix('#')).unwrap_or_default().trim();
    let clock = clock.trim_start_matches("clock:").trim();
    let mut rows = Rows::new(header, if clock.is_empty() { "unnamed" } else { clock });
    sample.iter().for_each(|line| rows.line(line));
    while let Some(line) = source.next().map_err(failed)? {
        rows.line(&line);
    }
    rows.log(file)
}

/// The firings so far.
struct Rows {
    header: Header,
    clock: String,
    firings: Vec<Firing>,
    listened: Vec<Firing>,
    /// Number of wraps of a 32-bit clock, times 2^32.
    wraps: i64,
    last: i64,
    /// Length of the longest last cell.
    longest: usize,
    damaged: u64,
    first_damage: Option<(u64, String)>,
}

impl Rows {
    fn new(header: Header, clock: &str) -> Self {
        Self {
            header,
            clock: clock.to_owned(),
            firings: vec![],
            listened: vec![],
            wraps: 0,
            last: i64::MIN,
            longest: 0,
            damaged: 0,
            first_damage: None,
        }
    }

    fn line(&mut self, line: &Line) {
        if is_comment(&line.text) && !line.is_too_long {
            return;
        }
        if let Err((column, why)) = self.row(line) {
            self.damaged += 1;
            let why = match column.and_then(|column| self.header.names.get(column)) {
                Some(name) => format!("column {name}: {why}"),
                None => why,
            };
            self.first_damage.get_or_insert((line.number, why));
        }
    }

    fn row(&mut self, line: &Line) -> Result<(), Wrong> {
        let Some(cells) = self.header.cells(line)? else { return Ok(()) };
        let last = cells.last().map_or(0, String::len);
        if !line.is_ended && last < self.longest {
            return Err((None, "it ends without a line break and may be cut".to_owned()));
        }
        self.longest = self.longest.max(last);
        let (mut firing, sends) = self.header.firing(&cells)?;
        firing.fired_us += self.wraps;
        if self.last != i64::MIN && self.last - firing.fired_us > 1 << 31 {
            self.wraps += 1 << 32;
            firing.fired_us += 1 << 32;
        }
        self.last = firing.fired_us;
        if sends { &mut self.firings } else { &mut self.listened }.push(firing);
        Ok(())
    }

    fn log(self, file: &Path) -> Result<FiringLog, FileError> {
        if self.firings.is_empty() {
            return Err(match self.first_damage {
                Some((line, why)) => FileError::new(file, why).at_line(Some(line)),
                None => FileError::new(file, "0 firings; expected one or more"),
            });
        }
        let damage = self.first_damage.map(|(line, why)| match self.damaged {
            1 => format!("line {line} is left out: {why}"),
            damaged => format!("{damaged} lines are left out, first line {line}: {why}"),
        });
        Ok(FiringLog { listened: self.listened, damage, ..FiringLog::new(&self.clock, self.firings) })
    }
}
