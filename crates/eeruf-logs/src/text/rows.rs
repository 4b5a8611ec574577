//! Readings from the lines of a log whose shape is known.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use crate::options::{Options, RangeUnit, TimeUnit};
use crate::reading::{LogReading, Sensor};
use crate::sink::{Sink, Skipped};

use super::column::{Column, Role};
use super::lines::Line;
use super::plan::{MOST_SENSORS, Plan};
use super::sample::is_comment;
use super::shape::{self, Shape, is_rule};
use crate::names::{self, Meaning};
use crate::value::{self, Value};

pub(super) struct Rows<'a, 's, 'e> {
    file: &'a Path,
    options: &'a Options,
    plan: Plan,
    sink: &'s mut Sink<'e>,
    /// The sensor of each column.
    sensors: Vec<Option<usize>>,
    by_label: HashMap<String, usize>,
    /// Labels of sensors that occurred once.
    once: BTreeSet<String>,
    is_first: bool,
    others: u64,
    /// Rows of sensors that do not measure by sound.
    of_light: u64,
    unknown: BTreeSet<String>,
    /// Midnights since the log began.
    midnights: u64,
    latest_ns: u64,
    /// Nanoseconds lost by wraps of a 32-bit counter, and its time in the previous row.
    wrapped_ns: u64,
    counted_ns: u64,
}

/// The cells of a line, each with its column.
type Cells = Vec<(usize, String)>;

/// Reason why a line yields no reading.
enum Unread {
    /// The column has no role.
    Other,
    Damaged(String),
}

impl From<String> for Unread {
    fn from(why: String) -> Self {
        Self::Damaged(why)
    }
}

const DAY_NS: u64 = 86_400_000_000_000;

impl<'a, 's, 'e> Rows<'a, 's, 'e> {
    pub(super) fn new(file: &'a Path, plan: Plan, options: &'a Options, sink: &'s mut Sink<'e>) -> Self {
        let mut rows = Self {
            file,
            options,
            sensors: vec![None; plan.columns.len()],
            is_first: plan.is_first_cut,
            plan,
            sink,
            by_label: HashMap::new(),
            once: BTreeSet::new(),
            others: 0,
            of_light: 0,
            unknown: BTreeSet::new(),
            midnights: 0,
            latest_ns: 0,
            wrapped_ns: 0,
            counted_ns: 0,
        };
        if rows.plan.sensor.is_none() {
            for index in 0..rows.plan.columns.len() {
                if rows.plan.columns[index].role == Role::Range {
                    rows.sensors[index] = Some(rows.add(&rows.plan.columns[index].name.clone()));
                }
            }
        }
        rows
    }

    fn add(&mut self, name: &str) -> usize {
        self.sink.report.sensors.push(Sensor { topic: name.to_owned(), frame: String::new(), beam: None });
        self.sink.report.sensors.len() - 1
    }

    /// Reads one line.
    pub(super) fn line(&mut self, line: &Line) {
        let is_rule = self.plan.has_rules && is_rule(&line.text);
        if (is_comment(&line.text) || is_rule) && !line.is_too_long || line.number < self.plan.rows_from {
            return;
        }
        match self.cells(line).and_then(|(time, cells)| self.row(line, time, &cells)) {
            Ok(()) => {}
            Err(Unread::Other) => self.others += 1,
            Err(Unread::Damaged(why)) => {
                self.sink.damaged_line(self.file, line.number, format!("{why}; the line is left out"));
            }
        }
    }

    /// The time before a line, and its cells by column.
    fn cells(&mut self, line: &Line) -> Result<(Option<u64>, Cells), Unread> {
        let damaged = Unread::Damaged;
        if line.is_too_long {
            return Err(damaged("more than 65536 bytes without a line break".to_owned()));
        }
        if line.is_misfit {
            return Err(damaged(format!("`{}` is not in the form of the log", short(&line.text))));
        }
        let text = line.text.trim_matches([' ', '\u{feff}']);
        let is_bad = |letter: char| letter == '\u{fffd}' || (letter.is_control() && letter != '\t' && letter != '\n');
        let is_plain = text.bytes().all(|byte| (0x20..0x7f).contains(&byte) || byte == b'\t');
        if !is_plain && text.contains(is_bad) {
            return Err(damaged("bytes that are no text".to_owned()));
        }
        let (time, text) = if self.plan.has_prefix {
            match value::prefix(text) {
                Some((time, rest)) => (Some(time), rest),
                // Pandas prints the name of an index on a line of its own.
                None if self.is_header(text) || names::meaning(text) == Meaning::Time => return Err(Unread::Other),
                None => return Err(damaged(format!("`{}` has no time before it", short(text)))),
            }
        } else {
            (None, text)
        };
        let text = value::without_level(text);
        if std::mem::take(&mut self.is_first) {
            return Err(damaged(format!("`{}` is shorter than the others: its beginning may be cut off", short(text))));
        }
        let pairs = match self.plan.shape {
            Shape::Separated(separator) => {
                let cells = shape::separated(text, separator);
                let mut cells = cells.ok_or_else(|| damaged("a quotation mark that is not closed".to_owned()))?;
                if self.plan.header.as_ref() == Some(&cells) {
                    return Err(Unread::Other);
                }
                let width = self.plan.columns.len();
                while cells.len() > width && cells.last().is_some_and(String::is_empty) {
                    cells.pop();
                }
                // Lines that a reset repeats, and the end of a database's output, such as `(2 rows)`.
                let is_end = || {
                    text.starts_with('(') && text.ends_with(" rows)")
                        || cells.len() == 1 && text.contains(" rows in set")
                };
                let is_remark = || self.plan.greetings.contains(text) || is_end();
                let is_odd = cells.len() != width;
                if is_odd && names::is_place(text) && self.sink.report.messages > 0 && !is_remark() {
                    return Err(format!("`{}` between rows: what follows may be another sensor's", short(text)).into());
                }
                if is_odd && is_remark() || line.is_ended && (is_odd || width == 1) && self.is_sentence(text) {
                    return Err(Unread::Other);
                }
                if is_odd {
                    Err(format!("`{}`: number of cells {}; expected {width}", short(text), cells.len()))?;
                }
                cells.into_iter().enumerate().collect()
            }
            Shape::Json => {
                let pairs = shape::object(text).ok_or_else(|| {
                    let is_text = !text.contains(['{', '}', '[', ']', ':']);
                    if is_text { Unread::Other } else { damaged(format!("`{}` is no JSON object", short(text))) }
                })?;
                let has_lead = |name: &str| name == "topic" || name == "before";
                if !text.starts_with(['{', '['])
                    && pairs.first().is_some_and(|(name, _)| has_lead(name) && !self.plan.by_name.contains_key(name))
                {
                    return Err(damaged(format!("`{}`; expected an object, as in the other lines", short(text))));
                }
                self.by_name(pairs)
            }
            Shape::Keyed => {
                let Some(pairs) = shape::keyed(text).or_else(|| self.silence(text)) else {
                    let has_digit = text.contains(|letter: char| letter.is_ascii_digit());
                    let is_other = text.split_once(':').is_some_and(|(name, _)| names::meaning(name) == Meaning::Other);
                    let is_greeting = !text.contains([':', '=']) && line.is_ended && self.sink.report.messages == 0;
                    return Err(if (has_digit && !is_other && !is_greeting) || !line.is_ended {
                        damaged(format!("`{}`; expected pairs of name and value", short(text)))
                    } else {
                        Unread::Other
                    });
                };
                if let Some((name, _)) = pairs.iter().find(|(name, _)| !self.plan.by_name.contains_key(name)) {
                    return Err(damaged(format!("the name `{}`, which no other line has", short(name))));
                }
                if let Some(usual) = &self.plan.usual_names
                    && !pairs.iter().map(|(name, _)| name).eq(usual)
                {
                    Err(format!("`{}`; expected {}, as the other lines have", short(text), usual.join(", ")))?;
                }
                self.by_name(pairs)
            }
        };
        if let Some((index, last)) = pairs.last().filter(|_| self.plan.shape != Shape::Json) {
            self.ends_whole(line, *index, last)?;
        }
        Ok((time, pairs))
    }

    /// Returns true for a line that only reports silence, if each line has the range of one sensor.
    fn silence(&self, text: &str) -> Option<Vec<(String, String)>> {
        let [name] = self.plan.usual_names.as_deref()? else { return None };
        let text = text.trim_end_matches(['.', '!']).to_lowercase();
        let is_said = ["out of range", "no echo", "timeout", "time out", "echo timeout"].contains(&text.as_str());
        is_said.then(|| vec![(name.clone(), text)])
    }

    /// Returns true for words without a number, none of which is a sensor's name or a word for no echo.
    fn is_sentence(&self, text: &str) -> bool {
        let mut words = text.split(|letter: char| !letter.is_ascii_alphabetic());
        !text.contains(|letter: char| letter.is_ascii_digit() || ",;|\t:=\"".contains(letter))
            && words.any(|word| word.len() >= 5)
            && value::range(text, self.plan.decimal_comma).is_none()
            && self.plan.known.iter().all(|name| !text.contains(name.as_str()))
    }

    fn is_header(&self, text: &str) -> bool {
        let Shape::Separated(separator) = self.plan.shape else { return false };
        shape::separated(text, separator) == self.plan.header
    }

    fn by_name(&mut self, pairs: Vec<(String, String)>) -> Cells {
        let mut cells = vec![];
        for (name, text) in pairs {
            match self.plan.by_name.get(&name) {
                Some(&index) => cells.push((index, text)),
                None if self.unknown.len() < 16 => _ = self.unknown.insert(name),
                None => {}
            }
        }
        cells
    }

    /// Refuses a last line without a line break whose last value is shorter than others: it may be cut.
    fn ends_whole(&mut self, line: &Line, index: usize, last: &str) -> Result<(), Unread> {
        let column = &mut self.plan.columns[index];
        if !line.is_ended && last.len() < column.longest {
            Err(format!("`{}` ends without a line break and may be cut", short(&line.text)))?;
        }
        column.longest = column.longest.max(last.len());
        Ok(())
    }

    fn row(&mut self, line: &Line, before: Option<u64>, cells: &[(usize, String)]) -> Result<(), Unread> {
        let text = |index: usize| cells.iter().find(|cell| cell.0 == index).map(|cell| cell.1.as_str());
        let mut at_ns = before;
        for &(index, unit) in &self.plan.time {
            if let Some(own) = text(index).filter(|text| !text.is_empty()) {
                let name = &self.plan.columns[index].name;
                let bad = || format!("column {name}: `{}`; expected a time of zero or more", short(own));
                let ns = time_ns(own, unit, self.plan.decimal_comma).ok_or_else(bad)?;
                at_ns = Some(at_ns.filter(|_| before.is_none()).unwrap_or(0).saturating_add(ns));
            }
        }
        let limit = |role: Role| -> Option<f64> {
            let (index, column) = self.plan.columns.iter().enumerate().find(|(_, column)| column.role == role)?;
            let number = value::number(text(index)?, self.plan.decimal_comma)?;
            Some(number * column.unit.metres(self.options.speed_of_sound))
        };
        let (least, most) = (limit(Role::Least), limit(Role::Most).filter(|&most| most > 0.0));
        let is_known = |label: &&str| !label.is_empty() && !self.plan.foreign.contains(*label);
        let label = |index| text(index).filter(is_known).map(str::to_owned).ok_or(Unread::Other);
        let label = self.plan.sensor.map(label).transpose()?;
        if let Some((index, ultrasound)) = self.plan.medium
            && text(index).and_then(|own| value::number(own, false)).is_some_and(|number| number != ultrasound)
        {
            self.of_light += 1;
            return Err(Unread::Other);
        }
        let odd = |own| format!("the unit `{}`; expected one as in the rows before", short(own));
        let unit = self.plan.unit.and_then(text).map(|own| value::unit(own).ok_or_else(|| odd(own))).transpose()?;
        let mut found = vec![];
        let mut begun = vec![];
        for (index, own) in cells {
            let column = &self.plan.columns[*index];
            match column.role {
                Role::Range if own.is_empty() && self.plan.one_a_row => continue,
                Role::Range if own == "unavailable" => continue,
                Role::Range => {}
                Role::Empty if own.is_empty() => continue,
                Role::Empty => {
                    if value::range(own, self.plan.decimal_comma).is_none() {
                        continue;
                    }
                    begun.push(*index);
                }
                Role::Other if column.is_numeric && value::range(own, self.plan.decimal_comma).is_none() => {
                    Err(format!("column {}: `{}`; expected a number, as before", column.name, short(own)))?;
                }
                _ => continue,
            }
            let range_m = self.range_m(own, column, unit)?;
            let cell = |index: usize| text(index).map(str::to_owned);
            let none = self.plan.validity.iter().find_map(|of| of.of(*index, cell, self.plan.decimal_comma));
            found.push((*index, none.unwrap_or(range_m)));
        }
        if found.is_empty() {
            return Err(Unread::Other);
        }
        self.sink.one_time_a_row |= found.len() > 1;
        for index in begun {
            let name = self.plan.columns[index].name.clone();
            self.plan.columns[index].role = Role::Range;
            self.sensors[index] = Some(self.add(&name));
            let why =
                format!("a sensor whose first value is in line {}; the empty cells before do not count", line.number);
            self.sink.report.skipped.push(Skipped::new(name, why));
        }
        let at_ns = at_ns.map(|ns| self.after_midnight(ns)).map(|ns| self.after_wrap(ns));
        let sensor_of_row = label.map(|label| self.labelled(label)).transpose()?;
        self.sink.report.messages += 1;
        for (index, range_m) in found {
            let Some(sensor) = sensor_of_row.or(self.sensors[index]) else { continue };
            let reading = LogReading::new(sensor, at_ns, range_m, most.unwrap_or(self.options.no_echo_m));
            self.sink.reading(&LogReading { min_range_m: least.unwrap_or(0.0), ..reading });
        }
        Ok(())
    }

    /// Corrects times of day that begin again at midnight.
    fn after_midnight(&mut self, ns: u64) -> u64 {
        if ns >= DAY_NS {
            return ns;
        }
        let at = ns + self.midnights * DAY_NS;
        let falls_by = self.latest_ns.saturating_sub(at);
        if self.plan.has_prefix && falls_by > DAY_NS / 2 {
            self.midnights += 1;
        }
        self.latest_ns = ns + self.midnights * DAY_NS;
        self.latest_ns
    }

    /// Corrects 32-bit counters of milliseconds and microseconds that wrap.
    fn after_wrap(&mut self, ns: u64) -> u64 {
        /// The longest pause of a sensor; after a longer one it has restarted.
        const LONGEST_PAUSE_NS: u64 = 10_000_000_000;
        let [(_, TimeUnit::Ms | TimeUnit::Us)] = self.plan.time[..] else { return ns };
        let wrap_ns = (self.plan.time[0].1.said().1 as u64) << 32;
        let (at, latest) = (ns.saturating_add(self.wrapped_ns), self.counted_ns);
        let pause_ns = at.saturating_add(wrap_ns).checked_sub(latest);
        if at < latest && pause_ns.is_some_and(|ns| ns < LONGEST_PAUSE_NS) {
            self.wrapped_ns = self.wrapped_ns.saturating_add(wrap_ns);
        }
        self.counted_ns = ns.saturating_add(self.wrapped_ns);
        self.counted_ns
    }

    /// The sensor with this label; a label that the first lines do not have is accepted when it occurs again.
    fn labelled(&mut self, label: String) -> Result<usize, Unread> {
        if let Some(&sensor) = self.by_label.get(&label) {
            return Ok(sensor);
        }
        if !self.plan.known.contains(&label) && (self.once.len() >= 1024 || self.once.insert(label.clone())) {
            return Err(Unread::Damaged(format!("the sensor `{}`, which comes here first", short(&label))));
        }
        if self.by_label.len() >= MOST_SENSORS {
            return Err(Unread::Damaged(format!("the sensor `{}`; expected at most {MOST_SENSORS}", short(&label))));
        }
        let sensor = self.add(&label);
        self.by_label.insert(label, sensor);
        Ok(sensor)
    }

    /// The range in metres; infinite without an echo.
    fn range_m(&self, text: &str, column: &Column, of_row: Option<RangeUnit>) -> Result<f64, Unread> {
        let (name, unit) = (&column.name, column.unit);
        let no_echo = &self.plan.no_echo;
        if no_echo.words.iter().any(|word| text.eq_ignore_ascii_case(word)) {
            return Ok(f64::INFINITY);
        }
        let (number, own_unit) = match value::range(text, self.plan.decimal_comma) {
            Some((Value::Number(number), unit)) => (number, unit),
            Some((Value::NoEcho, _)) => return Ok(f64::INFINITY),
            Some((Value::TooClose, _)) => return Ok(f64::NEG_INFINITY),
            None => Err(format!("column {name}: `{}`; expected a range in {}", short(text), unit.name()))?,
        };
        if own_unit.is_some() && own_unit == column.repeated_unit {
            return Err(Unread::Other);
        }
        if own_unit.is_none() && column.needs_unit() {
            return Err(Unread::Damaged(format!("column {name}: `{}` has no unit, as the others have", short(text))));
        }
        if no_echo.numbers.contains(&number) || (no_echo.zero && number == 0.0) || (no_echo.negative && number < 0.0) {
            return Ok(f64::INFINITY);
        }
        let asked = self.options.table.range_unit;
        let range_m = number * asked.or(own_unit).or(of_row).unwrap_or(unit).metres(self.options.speed_of_sound);
        Ok(if range_m < 0.0 {
            f64::NEG_INFINITY
        } else if range_m >= self.options.no_echo_m {
            f64::INFINITY
        } else {
            range_m
        })
    }

    /// Reports the omitted parts.
    pub(super) fn end(self, left_out: u64) {
        let skipped = &mut self.sink.report.skipped;
        if left_out > 0 {
            let why = format!("{left_out} of its lines: a board, a monitor or a logger wrote them by itself");
            skipped.push(Skipped::new("the text", why));
        }
        if self.of_light > 0 {
            let column = self.plan.medium.map_or("", |(index, _)| &self.plan.columns[index].name);
            let why = "no ultrasound, by this column; --range reads them";
            skipped.push(Skipped { messages: self.of_light, ..Skipped::new(column, why) });
        }
        if self.others > self.of_light {
            let why = format!("{} lines without readings", self.others - self.of_light);
            skipped.push(Skipped::new("the text", why));
        }
        if !self.unknown.is_empty() {
            let names = self.unknown.into_iter().collect::<Vec<_>>().join(", ");
            skipped.push(Skipped::new(names, "names that the first lines do not have"));
        }
        if self.sink.report.sensors.is_empty() {
            let names: Vec<_> = self.plan.columns.iter().map(|column| short(&column.name)).collect();
            let why = match &names[..] {
                [] => "no line that holds a number".to_owned(),
                names => format!("columns {}, none of them a range", names.join(", ")),
            };
            skipped.push(Skipped::new(self.plan.form, why));
        }
    }
}

/// At most 40 letters of a text.
fn short(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}..", &text[..end]),
        None => text.to_owned(),
    }
}

fn time_ns(text: &str, unit: TimeUnit, decimal_comma: bool) -> Option<u64> {
    let scale = unit.said().1;
    // Whole nanoseconds since 1970 do not fit into a float.
    if let Ok(whole) = text.parse::<u64>() {
        return whole.checked_mul(scale as u64);
    }
    match value::number(text, decimal_comma) {
        Some(time) if time >= 0.0 && time * scale < 1.8e19 => Some((time * scale).round() as u64),
        Some(_) => None,
        None => value::calendar_ns(text).or_else(|| value::elapsed_ns(text)),
    }
}
