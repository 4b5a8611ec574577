//! Logs of firings: for each, who fired when, and what was heard. `study --log` writes them, firmware can, and
//! [`diagnose`](crate::diagnose()) reads them; so do surveys.
//!
//! ```text
//! # clock: simulation
//! sensor,fired_us,period,phase,t_echo_us,reading
//! 0,15000,0,0,5872,rejected
//! 4,15000,0,0,,no_echo
//! ```
//!
//! CSV with these columns in any order; others are ignored. Times are in microseconds of one clock, which the first
//! line may name; one of 32 bits may wrap. `t_echo_us` is the raw echo time, from firing to the first edge, empty
//! without echo. `reading` is what the ring made of it (`rejected`, `accepted`, `ambiguous`, ..) and may be missing.
//! Sensors, periods and phases count from 0. The log of a hopping ring also says how its tracker weighed each reading,
//! in columns `given`, `solo`, `steady`, `changes` and `expected_us`: see [`Weighed`]. A log without `fired_us` can be
//! put onto a fixed schedule ([`align`](crate::align())). Rows may come in any order that is at most 2^31 us out. Where
//! a column `sends` is 0 the sensor only listened from then on, as some can.
//!
//! The same in MCAP is a message `eeruf_msgs/msg/Firing` of ROS 2 for each row, which
//! [`McapWriter::firing`](crate::McapWriter::firing) writes, or one `eeruf.Firing` in JSON, with the columns as its
//! fields and the clock's name as a field `clock`.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;

use eeruf_core::ReadingKind;

use crate::error::LogError;
use crate::weighed::{Columns, Weighed, kind_named};

/// One firing of one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Firing {
    /// The sensor, from 0.
    pub sensor: u8,
    /// When it fired, in microseconds of the log's clock.
    pub fired_us: i64,
    /// The period, from 0.
    pub period: u32,
    /// The phase, from 0.
    pub phase: u8,
    /// From firing to the first echo, in microseconds; `None` without echo.
    pub t_echo_us: Option<u32>,
    /// Whether the ring rejected the reading or found it ambiguous, if the log says what it made of it.
    pub rejected: Option<bool>,
    /// How the tracker of a hopping ring weighed the reading, if the log says so.
    pub weighed: Option<Weighed>,
}

/// A log of firings, in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FiringLog {
    /// Which clock the times are of.
    pub clock: String,
    /// The firings, in order of time.
    pub firings: Vec<Firing>,
    /// What sensors heard that listened without firing: `fired_us` is when they began to.
    pub listened: Vec<Firing>,
    /// Whether the log does not say when sensors fired: `fired_us` is 0 then, see [`align`](crate::align()).
    pub lacks_instants: bool,
    /// What of the file could not be read, if that is so.
    pub damage: Option<String>,
}

impl Firing {
    /// What the ring made of the reading, as logs spell it.
    pub(crate) fn reading(&self) -> &'static str {
        match (self.weighed.as_ref().and_then(|weighed| weighed.kind), self.rejected) {
            (Some(kind), _) => kind.as_str(),
            (None, Some(true)) => "rejected",
            (None, Some(false)) => "other",
            (None, None) => "",
        }
    }
}

/// Returns true if a reading that logs spell so was compared and is not believed.
pub(crate) fn was_rejected(made: &str) -> bool {
    kind_named(made).is_some_and(ReadingKind::is_rejected)
}

/// The most sensors of a ring.
pub(crate) const MAX_SENSORS: u8 = 64;

impl FiringLog {
    /// Puts firings in order of time.
    pub fn new(clock: &str, mut firings: Vec<Firing>) -> Self {
        firings.sort_by_key(|firing| firing.fired_us);
        Self { clock: clock.to_owned(), firings, ..Self::default() }
    }

    /// Reads a log in CSV from wherever it comes; `file` stands in errors.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_from(input: impl Read, file: &Path) -> Result<Self, LogError> {
        let mut input = BufReader::new(input);
        let mut clock = String::new();
        let starts_with_remark = input.fill_buf().map_err(|error| LogError::new(file, error))?.first() == Some(&b'#');
        if starts_with_remark {
            input.read_line(&mut clock).map_err(|error| LogError::new(file, error))?;
        }
        let clock = clock.trim_start_matches('#').trim().trim_start_matches("clock:").trim();
        let clock = if clock.is_empty() { "unnamed" } else { clock };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(input);
        let header = reader.headers().map_err(|error| LogError::new(file, error))?.clone();
        let column = |name: &str| header.iter().position(|column| column == name);
        let needed = |name: &str| {
            column(name).ok_or_else(|| {
                LogError::new(file, format!("no column `{name}`; expected sensor, fired_us, period, phase, t_echo_us"))
            })
        };
        let [sensor, period] = [needed("sensor")?, needed("period")?];
        let [phase, echo] = [needed("phase")?, needed("t_echo_us")?];
        let (fired, reading, sends) = (column("fired_us"), column("reading"), column("sends"));
        let weighed = Columns::of(&header).map_err(|message| LogError::new(file, message))?;
        let mut lacks_instants = fired.is_none();
        // The line that the first remark took.
        let before = u64::from(starts_with_remark);
        let (mut firings, mut listened, mut wraps, mut last, mut number) = (Vec::new(), Vec::new(), 0_i64, i64::MIN, 0);
        for row in reader.records() {
            let row = row
                .map_err(|error| LogError::at_line(file, error.position().map(|place| place.line() + before), error))?;
            let bad = |column: usize, expected: &str| {
                let line = row.position().map(|place| place.line() + before);
                let (name, text) = (&header[column], row.get(column).unwrap_or_default());
                LogError::at_line(file, line, format!("column {name}: `{text}`; expected {expected}"))
            };
            let text = |column: usize| row.get(column).unwrap_or_default();
            let fired_us: f64 = match fired.map(|fired| (fired, text(fired))) {
                None | Some((_, "")) => {
                    lacks_instants = true;
                    0.0
                }
                Some((fired, text)) => {
                    let us = text.parse().ok().filter(|us| (0.0..9e15).contains(us));
                    us.ok_or_else(|| bad(fired, "microseconds, 0 to 9e15"))?
                }
            };
            let mut fired_us = fired_us.round() as i64 + wraps;
            if last != i64::MIN && last - fired_us > 1 << 31 {
                wraps += 1 << 32;
                fired_us += 1 << 32;
            }
            last = fired_us;
            let t_echo_us = match text(echo) {
                "" => None,
                text => match text.parse::<f64>() {
                    Ok(us) if (0.0..4e9).contains(&us) => Some(us.round() as u32),
                    Ok(us) if us.is_nan() => None,
                    _ => return Err(bad(echo, "microseconds, or nothing")),
                },
            };
            let known_sensor = text(sensor).parse().ok().filter(|&sensor| sensor < MAX_SENSORS);
            let rows = match sends.map(text) {
                Some("0") => &mut listened,
                None | Some("" | "1") => &mut firings,
                Some(_) => return Err(bad(sends.unwrap_or_default(), "0 or 1")),
            };
            let made = reading.map(text).unwrap_or_default();
            let weighed = weighed.as_ref().map(|columns| columns.read(&row, made, number)).transpose();
            number += 1;
            rows.push(Firing {
                weighed: weighed.map_err(|(column, expected)| bad(column, expected))?.flatten(),
                sensor: known_sensor.ok_or_else(|| bad(sensor, "0 to 63"))?,
                fired_us,
                period: text(period).parse().map_err(|_| bad(period, "a number from 0"))?,
                phase: text(phase).parse().map_err(|_| bad(phase, "0 to 255"))?,
                t_echo_us,
                rejected: Some(made).filter(|made| !made.is_empty()).map(was_rejected),
            });
        }
        if firings.is_empty() {
            return Err(LogError::new(file, "no firings"));
        }
        if lacks_instants {
            firings.iter_mut().chain(&mut listened).for_each(|firing| firing.fired_us = 0);
            firings.sort_by_key(|firing| firing.period);
        }
        Ok(Self { listened, lacks_instants, ..Self::new(clock, firings) })
    }

    /// Writes the log as it is read. What the ring made of a reading is written as `rejected` or `other`, unless the
    /// kind is known.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, mut output: impl Write) -> std::io::Result<()> {
        let sends = if self.listened.is_empty() { "" } else { ",sends" };
        let is_weighed = self.firings.iter().any(|firing| firing.weighed.is_some());
        let weighed = if is_weighed { Columns::HEADER } else { "" };
        writeln!(output, "# clock: {}", self.clock)?;
        writeln!(output, "sensor,fired_us,period,phase,t_echo_us,reading{weighed}{sends}")?;
        for (rows, sends) in [(&self.firings, ",1"), (&self.listened, ",0")] {
            let sends = if self.listened.is_empty() { "" } else { sends };
            for firing in rows {
                let Firing { sensor, fired_us, period, phase, t_echo_us, ref weighed, .. } = *firing;
                let fired_us = if self.lacks_instants { String::new() } else { fired_us.to_string() };
                let echo = t_echo_us.map(|us| us.to_string()).unwrap_or_default();
                let reading = firing.reading();
                write!(output, "{sensor},{fired_us},{period},{phase},{echo},{reading}")?;
                match weighed {
                    Some(weighed) => write!(output, "{}", weighed.fields())?,
                    None if is_weighed => write!(output, "{}", Columns::EMPTY)?,
                    None => {}
                }
                writeln!(output, "{sends}")?;
            }
        }
        Ok(())
    }

    /// How many sensors the ring has, as far as the log shows: one more than the highest number.
    pub fn sensors(&self) -> usize {
        let rows = self.firings.iter().chain(&self.listened);
        rows.map(|firing| usize::from(firing.sensor) + 1).max().unwrap_or(0)
    }
}
