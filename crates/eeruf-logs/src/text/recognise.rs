//! Recognises a text log from its first lines: its shape, header, units, no-echo values and times.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use crate::options::{Options, RangeUnit};
use crate::sink::Skipped;
use eeruf_files::FileError;

use super::column::{Column, Role};
use super::lines::Line;
use super::plan::{MOST_SENSORS, Plan, guess};
use super::sample::{Stripped, is_comment, shape_of, strip, usual};
use super::shape::{self, Separator, Shape, is_underline};
use crate::names::{self, Meaning};
use crate::value;

/// Recognises a log from its first lines.
pub(super) fn recognise(
    file: &Path,
    sample: &[Line],
    (records, is_of_objects): (Option<&str>, bool),
    options: &Options,
) -> Result<Plan, FileError> {
    let Stripped { lines, has_prefix, has_rules } = strip(sample);
    let (shape, decimal_comma) = if is_of_objects { (Shape::Json, false) } else { shape_of(&lines) };
    let mut plan = Plan { shape, has_prefix, has_rules, decimal_comma, ..Plan::default() };
    let units = match shape {
        Shape::Separated(separator) => plan.table(file, sample, &lines, separator, options)?,
        Shape::Keyed | Shape::Json => {
            plan.named(&lines);
            vec![]
        }
    };
    plan.form = match shape {
        _ if let Some(form) = records => form.to_owned(),
        Shape::Json => "JSON, an object a line".to_owned(),
        Shape::Keyed => "text, pairs of name and value".to_owned(),
        Shape::Separated(Separator::None) => "text, one value a line".to_owned(),
        Shape::Separated(separator) => format!("a table, columns parted by {}", separator.name()),
    };
    if has_prefix {
        plan.guesses.push(guess("time", "before each line, as a serial monitor or a logger writes it", "--time"));
    }
    plan.roles(file, &lines, options)?;
    plan.one_a_row = plan.is_one_a_row(&lines);
    plan.range_units(&units, options);
    plan.no_echoes(options);
    plan.times(options);
    plan.by_name = plan.columns.iter().enumerate().map(|(index, column)| (column.name.clone(), index)).collect();
    Ok(plan)
}

/// Columns that `ros2 topic echo --csv` prints for a Range; the last one exists since Iron.
const ECHOED_RANGE: [&str; 9] = [
    "header.stamp.sec",
    "header.stamp.nanosec",
    "header.frame_id",
    "radiation_type",
    "field_of_view",
    "min_range",
    "max_range",
    "range",
    "variance",
];

fn is_echoed_range(rows: &[(u64, Vec<String>)], width: usize) -> bool {
    let is_one = |row: &Vec<String>| {
        let number = |index: usize| value::number(row.get(index)?, false);
        let whole = |index: usize, most: f64| {
            number(index).is_some_and(|number| number.fract() == 0.0 && (0.0..=most).contains(&number))
        };
        let limits = number(4).is_some() && number(5).zip(number(6)).is_some_and(|(least, most)| least < most);
        row.len() == width && whole(0, 1e10) && whole(1, 1e9) && number(2).is_none() && whole(3, 1.0) && limits
    };
    let fit = rows.iter().filter(|(_, row)| is_one(row)).count();
    (8..=9).contains(&width) && !rows.is_empty() && fit * 10 >= rows.len() * 8
}

impl Plan {
    /// Finds header, names and rows of a table; returns the units of a row of units.
    fn table(
        &mut self,
        file: &Path,
        sample: &[Line],
        lines: &[(u64, &str)],
        separator: Separator,
        options: &Options,
    ) -> Result<Vec<Option<RangeUnit>>, FileError> {
        let comma = self.decimal_comma;
        let rows: Vec<_> =
            lines.iter().filter_map(|&(number, text)| Some((number, shape::separated(text, separator)?))).collect();
        let is_number = |text: &String| value::with_unit(text, comma).is_some() || value::calendar_ns(text).is_some();
        // Numbers may be names of columns, beside one that is called a time.
        let names_row = rows.iter().position(|(_, row)| row.len() > 1 && row.iter().any(is_number));
        let names_row = names_row.filter(|&at| {
            let is_time = |text: &String| !is_number(text) && names::meaning(text) == Meaning::Time;
            let (_, names) = &rows[at];
            let below = rows[at + 1..].iter().filter(|(_, row)| row.len() == names.len());
            let Some(place) = names.iter().position(is_time) else { return false };
            let mut below = below.map(|(_, row)| is_number(&row[place])).take(3);
            below.next() == Some(true) && below.all(|number| number)
        });
        let names_row = names_row.map(|at| &rows[at].1);
        let has_number =
            |row: &[String]| row.iter().any(is_number) && names_row.is_none_or(|names| names.as_slice() != row);
        let width = usual(rows.iter().filter(|(_, row)| has_number(row)).map(|(_, row)| row.len()));
        let first = rows.iter().position(|(_, row)| row.len() == width && has_number(row)).unwrap_or(rows.len());
        let is_header = |row: &[String]| {
            !has_number(row) && row.iter().any(|text| text.contains(char::is_alphabetic) && !value::is_no_echo(text))
        };
        let mut before = &rows[..first];
        while let [rest @ .., (_, cells)] = before
            && width > 1
            && is_underline(cells)
        {
            before = rest;
        }
        let is_near = |row: &Vec<String>| width <= row.len() + 1;
        let header = before.iter().rposition(|(_, row)| is_header(row) && row.len() == width);
        let mut header = header.or_else(|| before.iter().rposition(|(_, row)| is_header(row) && is_near(row)));
        let (mut units, mut other_units) = (vec![], vec![]);
        // Names, units and what was done with the values, a row each, as loggers of weather stations write them.
        let is_whole = |row: &Vec<String>| row.len() == width && is_header(row);
        let is_names = |row: &Vec<String>| {
            let distinct: BTreeSet<_> = row.iter().filter(|name| !name.is_empty()).collect();
            is_whole(row) && distinct.len() == width
        };
        let lengths = |row: &Vec<String>| row.iter().filter(|text| value::unit(text).is_some()).count();
        let top = before.iter().position(|(_, row)| is_names(row));
        if let Some((top, rest)) = top.and_then(|top| Some((top, before.get(top + 1..)?)))
            && header.is_some_and(|at| at > top)
            && rest.iter().all(|(_, row)| is_whole(row))
            && let Some((_, row)) = rest.iter().max_by_key(|(_, row)| lengths(row)).filter(|(_, row)| lengths(row) > 0)
        {
            units = row.iter().map(|text| value::unit(text)).collect();
            other_units = row.iter().map(|text| !text.is_empty() && value::unit(text).is_none()).collect();
            header = Some(top);
        }
        let mut names: Option<Vec<String>> = header.map(|at| before[at].1.clone());
        // Names that come again are parted by the row above.
        if let Some((names, at)) = names.as_mut().zip(header.filter(|&at| at > 0))
            && names.iter().filter(|name| !name.is_empty()).collect::<BTreeSet<_>>().len()
                < names.len().min(2) + names.len() / 2
            && is_whole(&before[at - 1].1)
        {
            let above = before[at - 1].1.iter();
            names.iter_mut().zip(above).for_each(|(name, above)| *name = format!("{above} {name}").trim().to_owned());
        }
        let first_number = rows.get(first).map_or(u64::MAX, |row| row.0);
        if names.is_none() {
            // A comment may name the columns.
            let comments = sample.iter().rev().filter(|line| line.number < first_number);
            let mut comments = comments.filter_map(|line| line.text.trim().strip_prefix(['#', '%']));
            names = comments.find_map(|text| {
                let row = shape::separated(text.trim(), separator)?;
                let is_pair = row.first().is_some_and(|cell| cell.ends_with(':'));
                (row.len() == width && width > 1 && is_header(&row) && !is_pair).then_some(row)
            });
        }
        self.rows_from = match header {
            Some(_) if before.len() < first || !units.is_empty() => first_number,
            Some(at) => rows[at].0 + 1,
            None => {
                let text = |line: &Line| line.text.contains(|letter: char| letter.is_ascii_digit());
                sample.iter().find(|line| text(line) && !is_comment(&line.text)).map_or(0, |line| line.number)
            }
        };
        self.header = header.map(|at| before[at].1.clone());
        let header_line = header.map_or(0, |at| rows[at].0);
        let greetings = lines.iter().filter(|line| line.0 < header_line).map(|line| line.1.to_owned());
        self.greetings = greetings.collect();
        let ignored = lines.iter().filter(|line| line.0 + 1 < self.rows_from).count();
        if ignored > 0 {
            let why = format!("{ignored} of its lines, without any reading");
            self.skipped.push(Skipped::new("the beginning", why));
        }
        let is_echoed = names.is_none() && is_echoed_range(&rows[first..], width);
        if is_echoed {
            names = Some(ECHOED_RANGE[..width].iter().map(|&name| name.to_owned()).collect());
        }
        self.has_names = names.is_some();
        if !options.table.columns.is_empty() {
            if options.table.columns.len() != width {
                let given = options.table.columns.len();
                let message = format!("--columns: {given} names; expected {width}, as many as the rows have columns");
                return Err(FileError::new(file, message));
            }
            names = Some(options.table.columns.clone());
        } else {
            let said = match (&names, header) {
                (Some(names), Some(_)) => names.join(", "),
                (Some(_), None) if is_echoed => "that of `ros2 topic echo --csv` for sensor_msgs/Range".to_owned(),
                (Some(names), None) => format!("{}, from a comment", names.join(", ")),
                (None, _) => format!("none; {width} columns, named by their places"),
            };
            self.guesses.push(guess("header", said, "--columns"));
        }
        let values: Vec<_> = rows.iter().filter(|(_, row)| row.len() == width && has_number(row)).collect();
        let mut names = names.unwrap_or_default();
        // Without a header the same words before numbers in each row name them.
        if names.is_empty() && separator == Separator::Spaces && width > 1 {
            let cell = |at: usize| values.first().map_or("", |(_, row)| row[at].as_str());
            let is_word = |at: usize| {
                let text = cell(at);
                let is_unit = value::unit(text).is_some() || names::is_foreign_unit(text);
                text.starts_with(char::is_alphabetic) && !is_unit && values.iter().all(|(_, row)| row[at] == text)
            };
            let is_value = |at: &usize| value::with_unit(cell(*at), comma).is_some();
            let is_one = |at: usize| at + 1 == width || !is_value(&(at + 1));
            let words = |at: usize| (0..at).rev().take_while(|&before| is_word(before)).count();
            let name = |at: usize| match words(at) {
                0 => format!("column {}", at + 1),
                _ if is_word(at) || !is_one(at) => format!("column {}", at + 1),
                count => (at - count..at).map(cell).collect::<Vec<_>>().join(" "),
            };
            let is_named = |at: usize| words(at) > 0 && is_one(at);
            let is_before =
                (1..width).any(|at| is_value(&at) && is_named(at)) && (1..width).filter(is_value).all(is_named);
            // `40.1 cm left, 80.2 cm right`
            let labels: BTreeSet<_> = (1..width).filter(|at| is_value(&(at - 1)) && is_word(*at)).map(cell).collect();
            let is_behind = is_value(&0)
                && labels.len() == (0..width).filter(is_value).count()
                && labels.iter().all(|label| names::is_owner(label));
            if is_before || is_behind {
                let of = |at: usize| if is_behind && is_value(&at) { cell(at + 1).to_owned() } else { name(at) };
                names = (0..width).map(of).collect();
                self.has_names = true;
            }
        }
        // A printed frame's rows begin with their number, which has no name.
        let firsts = rows[first..].iter().filter(|(_, row)| row.len() == width).map(|(_, row)| row[0].as_str());
        if names.len() + 1 == width && (0..).zip(firsts.take(3)).all(|(n, text)| text.parse() == Ok(n)) {
            names.insert(0, String::new());
        } else if names.len() < width
            && header.is_some()
            && options.table.columns.is_empty()
            && values.iter().any(|(_, row)| row[names.len()..].iter().any(|text| !text.is_empty()))
        {
            // Either the line's beginning or its end is missing.
            names.clear();
            self.has_names = false;
            (self.header, self.rows_from) = (None, first_number);
        }
        names.iter_mut().for_each(|name| name.truncate(name.trim_end_matches(':').len()));
        names.truncate(width.max(1));
        (names.len()..width).for_each(|n| names.push(format!("column {}", n + 1)));
        self.columns = names.iter().map(|name| Column::new(name)).collect();
        for (column, (unit, is_other)) in self.columns.iter_mut().zip(units.iter().zip(&other_units)) {
            (column.has_length, column.has_other_unit) = (unit.is_some(), *is_other);
        }
        // `# t in s, d in mm`; `# unit: mm` is for all columns.
        let comments = sample.iter().filter_map(|line| line.text.trim().strip_prefix(['#', '%']));
        for said in comments.flat_map(|text| text.split([',', ';'])) {
            let Some((name, unit)) = said.split_once(" in ").or_else(|| said.split_once([':', '='])) else { continue };
            let name = name.trim().to_lowercase();
            let is_of_all = ["unit", "units", "range unit", "distance unit"].contains(&name.as_str());
            let of = self.columns.iter_mut().filter(|column| is_of_all || column.name.to_lowercase() == name);
            of.for_each(|column| column.has_unit_in_cells = column.has_unit_in_cells.or(value::unit(unit.trim())));
        }
        if separator != Separator::None {
            self.guesses.push(guess("separator", separator.name(), "--columns"));
        }
        if comma {
            self.guesses.push(guess("decimal mark", "comma", "--columns"));
        }
        // A sensor a row, or all in one line.
        let is_name = |text: &String| text.contains(char::is_alphabetic) && !is_number(text);
        let is_turned = width > 2 * values.len() && values.len() > 1 && values.iter().all(|(_, row)| is_name(&row[0]));
        if options.table.columns.is_empty() && width >= 8 && (is_turned || values.len() == 1 && self.header.is_none()) {
            let why = if is_turned { "a sensor a row" } else { "one line with all values" };
            let message = format!("{why}: {width} columns; expected a sensor a column, and a line for each instant");
            return Err(FileError::new(file, message));
        }
        let mut firsts = vec![];
        let is_row = |(number, row): &&(u64, Vec<String>)| {
            *number >= self.rows_from && row.len() == width && self.header.as_ref() != Some(row)
        };
        for (number, row) in rows.iter().filter(is_row) {
            let cell = row.first().map_or("", String::as_str);
            firsts.push((*number, cell.len(), value::with_unit(cell, comma).and_then(|(_, unit)| unit)));
            self.columns.iter_mut().zip(row).for_each(|(column, text)| column.note(text, comma));
        }
        // A log of a serial line begins in the middle of a line.
        if let [(number, first, unit), rest @ ..] = &firsts[..] {
            let mut alike = rest.iter().filter(|(_, _, other)| other == unit);
            let is_shorter = rest.len() >= 3 && alike.all(|(_, other, _)| first < other);
            self.is_first_cut = self.header.is_none() && *number == 1 && is_shorter && !self.columns[0].begins_evenly();
        }
        Ok(units)
    }

    /// Finds the columns of lines that name their values.
    fn named(&mut self, lines: &[(u64, &str)]) {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        let mut order = vec![];
        let split = |text: &str| if self.shape == Shape::Json { shape::object(text) } else { shape::keyed(text) };
        let rows: Vec<_> = lines.iter().filter_map(|(_, text)| split(text)).collect();
        for (pairs, (_, text)) in lines.iter().filter_map(|line| Some((split(line.1)?, line))) {
            let begin = order.len();
            for (name, _) in pairs {
                let count = counts.entry(name.clone()).or_default();
                *count += 1;
                if *count == 1 {
                    order.push(name);
                }
            }
            // Objects give their names by the alphabet.
            let place = |name: &String| {
                let find = |part: Option<&str>| text.find(&format!("\"{}\"", part?));
                let whole = find(Some(name));
                (whole.or_else(|| find(name.split(['.', '[']).next())), find(name.rsplit('.').next()))
            };
            order[begin..].sort_by_key(place);
        }
        if self.shape == Shape::Keyed {
            let mut lists: BTreeMap<Vec<&String>, usize> = BTreeMap::new();
            rows.iter().for_each(|row| *lists.entry(row.iter().map(|pair| &pair.0).collect()).or_default() += 1);
            let most =
                lists.into_iter().max_by_key(|&(_, count)| count).filter(|&(_, count)| count * 10 >= rows.len() * 8);
            self.usual_names = most.map(|(names, _)| names.into_iter().cloned().collect());
        }
        // A name that a damaged line makes up comes once.
        let most = counts.values().max().copied().unwrap_or(0);
        let is_text = |name: &String| !name.contains(|letter: char| letter == '\u{fffd}' || letter.is_control());
        let is_kept = |name: &String| is_text(name) && (self.shape == Shape::Json || most < 4 || counts[name] > 1);
        let kept = order.into_iter().filter(is_kept).take(MOST_SENSORS);
        self.columns = kept.map(|name| Column::new(&name)).collect();
        let by_name: HashMap<_, _> =
            self.columns.iter().enumerate().map(|(index, column)| (column.name.clone(), index)).collect();
        for (name, text) in rows.iter().flatten() {
            if let Some(&index) = by_name.get(name) {
                self.columns[index].note(text, self.decimal_comma);
            }
        }
    }

    fn place(&self, file: &Path, name: &String) -> Result<usize, FileError> {
        let names = || self.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ");
        let found = self.columns.iter().position(|column| column.name == *name);
        found.ok_or_else(|| FileError::new(file, format!("no column `{name}`; expected one of: {}", names())))
    }

    fn roles(&mut self, file: &Path, lines: &[(u64, &str)], options: &Options) -> Result<(), FileError> {
        let table = &options.table;
        let ranges = table.ranges.iter().map(|name| self.place(file, name)).collect::<Result<Vec<_>, _>>()?;
        let time = table.time.as_ref().map(|name| self.place(file, name)).transpose()?;
        let sensor = table.sensor.as_ref().map(|name| self.place(file, name)).transpose()?;
        let has_header = self.header.is_some()
            || self.has_names
            || !table.columns.is_empty()
            || !matches!(self.shape, Shape::Separated(_));
        let unit_of_row = |column: &Column| {
            (!has_header || names::meaning(&column.name) == Meaning::Other)
                && !column.distinct.is_empty()
                && column.distinct.keys().all(|text| value::unit(text).is_some())
        };
        let first = self.columns.iter().position(|column| !column.numbers.is_empty());
        let unit = self.columns.iter().position(unit_of_row);
        // Without a header a unit stands behind its number: `Starting in 3` has none.
        self.unit = unit.filter(|&at| has_header || first.is_some_and(|first| first < at));
        // A number before a percent sign, or before another unit, is not a length.
        for index in 1..self.columns.len() {
            let is_foreign = self.columns[index].distinct.keys().all(|text| names::is_foreign_unit(text));
            self.columns[index - 1].has_other_unit |=
                is_foreign && !has_header && !self.columns[index].distinct.is_empty();
        }
        // Of `sensor_msgs/Range`, and of MAVLink's and PX4's messages.
        let ends = |end: &str| self.columns.iter().position(|column| column.name.ends_with(end));
        let of_mavlink = ends("current_distance").and_then(|_| ends("type"));
        self.medium = ends("radiation_type").map(|at| (at, 0.0)).or(of_mavlink.map(|at| (at, 1.0)));
        self.medium = self.medium.filter(|_| table.ranges.is_empty());
        for index in 0..self.columns.len() {
            let column = &self.columns[index];
            let is_place = column.name.is_empty() || column.name.starts_with("Unnamed") || !has_header;
            let meaning = if is_place { Meaning::Vague } else { names::meaning(&column.name) };
            let role = if time == Some(index) {
                Role::Time
            } else if sensor == Some(index) {
                Role::Sensor
            } else if ranges.contains(&index) {
                Role::Range
            } else if column.name == "-" || (!ranges.is_empty() && meaning == Meaning::Vague) {
                Role::Other
            } else {
                match meaning {
                    // `us` is ultrasound, too.
                    Meaning::Time if column.name.eq_ignore_ascii_case("us") && !column.is_rising() => Role::Range,
                    Meaning::Time => Role::Time,
                    Meaning::Sensor => Role::Sensor,
                    Meaning::Least => Role::Least,
                    Meaning::Most => Role::Most,
                    Meaning::Other => Role::Other,
                    Meaning::Range | Meaning::Vague if column.has_other_unit => Role::Other,
                    Meaning::Range if !ranges.is_empty() => Role::Other,
                    Meaning::Range | Meaning::Vague if column.empties > 0 && column.distinct.is_empty() => Role::Empty,
                    Meaning::Vague if column.calendars > 0 && column.texts + column.numbers.len() == 0 => Role::Time,
                    Meaning::Vague if self.is_counter(index) => Role::Other,
                    Meaning::Vague if is_place && (self.is_clock(index) || column.is_epoch()) => Role::Time,
                    Meaning::Vague if self.is_sweep(index) => Role::Other,
                    Meaning::Vague if is_place && column.is_cycle() => Role::Sensor,
                    _ if column.is_range() => Role::Range,
                    Meaning::Vague if column.is_label() && (!has_header || column.takes_turns()) => Role::Sensor,
                    _ => Role::Other,
                }
            };
            let column = &mut self.columns[index];
            column.is_numeric = column.texts + column.calendars == 0 && !column.numbers.is_empty();
            column.role = role;
        }
        if ranges.is_empty() && table.columns.is_empty() {
            self.refuse_unreadable(file, lines)?;
        }
        if ranges.is_empty() && !has_header && lines.len() >= 8 {
            // Without any names, a column that never changes or has no echoes is not a range.
            let is_idle = |column: &Column| column.distinct.len() == 1 || column.median().is_nan();
            // Numbers beside words are ranges only if a word says so.
            let is_said =
                |column: &&Column| column.texts > 0 && column.numbers.is_empty() && column.distinct.len() == 1;
            let is_known = |column: &Column| {
                let text = column.distinct.keys().next().map_or("", String::as_str);
                names::quantity(text).is_empty() || value::unit(text).is_some()
            };
            let is_foreign = self.columns.iter().any(|column| is_said(&column))
                && !self.columns.iter().any(|column| column.units > 0 || is_said(&column) && is_known(column));
            let is_range = |column: &Column| is_foreign || column.role == Role::Range && is_idle(column);
            let idle = self.columns.iter_mut().filter(|column| !column.numbers.is_empty() && is_range(column));
            idle.for_each(|column| column.role = Role::Other);
        }
        if ranges.is_empty() && has_header {
            self.shared_units();
            self.named_ranges_alone();
            if table.columns.is_empty() {
                self.one_kind();
            }
            self.without_derived();
        }
        // Bytes, as tools for buses print them, are not a table.
        let bytes: Vec<_> = self.columns.iter().filter_map(Column::bytes).collect();
        let odd = bytes.iter().filter(|&&is_odd| is_odd).count();
        if !has_header && ranges.is_empty() && bytes.len() >= 4 && odd >= 2 {
            self.columns.iter_mut().for_each(|column| column.role = Role::Other);
        }
        // Home Assistant's name for a measured value.
        if self.columns.iter().all(|column| !matches!(column.role, Role::Range | Role::Empty)) {
            let is_state = |column: &&mut Column| column.name == "state" && column.is_range();
            self.columns.iter_mut().filter(is_state).for_each(|column| column.role = Role::Range);
        }
        self.time_columns(time);
        self.repetitions(lines, options);
        self.sensor_column(file, sensor, &ranges, lines)?;
        self.validities();
        let other = |column: &&Column| column.role == Role::Other && column.is_numeric && ranges.is_empty();
        let why = "a column that is no range, by its name or its values; --range reads it";
        self.skipped.extend(self.columns.iter().filter(other).map(|column| Skipped::new(&column.name, why)));
        Ok(())
    }

    /// Returns true if a name or a unit marks a column as a range.
    pub(super) fn is_called(column: &Column) -> bool {
        let by_unit = names::range_unit(&column.name).is_some_and(|(unit, is_sure)| is_sure || unit != RangeUnit::Us);
        // Microseconds may be of anything.
        let is_length = column.has_unit_in_cells != Some(RangeUnit::Us) || names::quantity(&column.name).is_empty();
        let by_cells = column.units * 2 > column.numbers.len() && is_length;
        let by_name = names::meaning(&column.name) == Meaning::Range || names::is_place(&column.name);
        let is_ultrasound = column.name.eq_ignore_ascii_case("us");
        column.has_length || by_unit || by_cells || by_name || is_ultrasound
    }

    /// Refuses a log whose range columns hold digits but no numbers, or which is one record.
    fn refuse_unreadable(&self, file: &Path, lines: &[(u64, &str)]) -> Result<(), FileError> {
        let has_digit = |text: &&String| text.contains(|letter: char| letter.is_ascii_digit());
        let is_odd = |column: &&Column| {
            let said = matches!(names::meaning(&column.name), Meaning::Range | Meaning::Vague);
            let is_called = said && (Self::is_called(column) || names::is_letter_of_place(&column.name));
            is_called
                && column.texts > column.numbers.len()
                && column.distinct.keys().filter(has_digit).count() * 2 > column.distinct.len()
        };
        if let Some(column) = self.columns.iter().find(is_odd) {
            let text = column.distinct.keys().find(has_digit).map_or("", String::as_str);
            let text: String = text.chars().take(40).collect();
            let message =
                format!("column {}: `{text}`; expected a number, with or without a unit of lengths", column.name);
            return Err(FileError::new(file, message));
        }
        // Several words, each on a line before its values.
        if self.shape == Shape::Separated(Separator::None) {
            let mut words: BTreeMap<&str, usize> = BTreeMap::new();
            let is_word = |text: &str| {
                value::range(text, true).is_none() && !text.contains(|letter: char| letter.is_ascii_digit())
            };
            lines.iter().filter(|line| is_word(line.1)).for_each(|line| *words.entry(line.1).or_default() += 1);
            words.retain(|_, count| *count > 2 && *count * 8 > lines.len());
            if words.len() > 1 {
                let words = words.into_keys().take(4).collect::<Vec<_>>().join("`, `");
                let message = format!("`{words}` on lines between values; expected each value on a line with its name");
                return Err(FileError::new(file, message));
            }
        }
        let found = self.ranges().count();
        if lines.len() == 1 && found > 8 {
            let message = format!("one record with {found} values; expected a line or an object for each instant");
            return Err(FileError::new(file, message));
        }
        Ok(())
    }

    /// Copies the unit in the cells of `e2` to `e0` and `e1`, if it is written once a line.
    fn shared_units(&mut self) {
        let stem = |name: &str| name.trim_end_matches(|letter: char| letter.is_ascii_digit()).to_owned();
        let said = self
            .ranges()
            .filter(|column| column.needs_unit())
            .map(|column| (stem(&column.name), column.has_unit_in_cells));
        let said: BTreeMap<_, _> = said.collect();
        for column in self.columns.iter_mut().filter(|column| column.role == Role::Range && column.units == 0) {
            if let Some(unit) = said.get(&stem(&column.name)).filter(|_| stem(&column.name) != column.name) {
                (column.has_unit_in_cells, column.has_length) = (*unit, true);
            }
        }
    }

    /// Removes columns that neither a name nor a unit marks as ranges, if others are marked.
    fn named_ranges_alone(&mut self) {
        // Letters are names of places if there are two or more.
        let is_letter = |column: &Column| names::is_letter_of_place(&column.name);
        let singles: Vec<_> = self.ranges().filter(|column| column.name.chars().count() == 1).collect();
        let has_letters = singles.len() > 1 && singles.iter().all(|column| is_letter(column));
        let is_called = |column: &Column| Self::is_called(column) || has_letters && is_letter(column);
        if self.ranges().any(is_called) {
            self.leave_out_if(|column| !is_called(column));
        }
    }

    /// Keeps unmarked columns as a ring only if their names say nothing else: numbers, letters of places. Beside
    /// ranges, a column that changes and is always beyond the reach of modules is removed.
    fn one_kind(&mut self) {
        const FARTHEST_M: f64 = 8.0;
        let of = self.places(Role::Range);
        let is_called = of.iter().any(|&index| Self::is_called(&self.columns[index]));
        if !is_called && self.sensor_names() == 0 {
            let is_plain = |&&index: &&usize| {
                let name = &self.columns[index].name;
                let quantity = names::quantity(name);
                let is_numbered = name.contains(|letter: char| letter.is_ascii_digit());
                quantity.is_empty() || !is_numbered && names::is_letter_of_place(&quantity)
            };
            let is_pin = |&index: &usize| names::is_analogue_pin(&self.columns[index].name);
            let ring: Vec<_> = of.iter().filter(is_plain).copied().collect();
            let is_one = |index: &&usize| !ring.contains(index) && self.columns[**index].name.chars().count() == 1;
            let is_ring =
                ring.len() > of.len() / 2 && !ring.iter().all(is_pin) && !of.iter().any(|index| is_one(&index));
            return self.leave_out(of.into_iter().filter(|index| !is_ring || !ring.contains(index)));
        }
        let is_beyond = |index: usize| {
            let column = &self.columns[index];
            let unit = column.has_unit_in_cells.or(names::range_unit(&column.name).map(|of| of.0));
            let metres = unit.map_or(1.0, |unit| unit.metres(343.2));
            column.distinct.len() > 2 && column.numbers.iter().all(|number| number * metres > FARTHEST_M)
        };
        let is_near = |index: usize| self.columns[index].numbers.iter().any(|&number| number > 0.0 && number < 1.5);
        if of.iter().any(|&index| is_near(index)) {
            let beyond: Vec<_> = of.into_iter().filter(|&index| is_beyond(index)).collect();
            self.leave_out(beyond);
        }
    }

    /// Number of columns that name the sensor of a row.
    fn sensor_names(&self) -> usize {
        self.columns.iter().filter(|column| column.role == Role::Sensor && column.distinct.len() > 1).count()
    }

    /// Removes a depth or a level beside a column that is called a range, since it is computed from it.
    fn without_derived(&mut self) {
        let is_called = |column: &Column| {
            (names::meaning(&column.name) == Meaning::Range || names::quantity(&column.name).is_empty())
                && !names::is_derived(&column.name)
        };
        if self.ranges().any(is_called) {
            self.leave_out_if(|column| names::is_derived(&column.name));
        }
    }

    /// Returns true if nearly every row of a table has one range, and empty cells for the other sensors.
    fn is_one_a_row(&self, lines: &[(u64, &str)]) -> bool {
        if !matches!(self.shape, Shape::Separated(_)) {
            return false;
        }
        let is_of_sensor = |column: &Column| matches!(column.role, Role::Range | Role::Empty);
        if self.columns.iter().filter(|column| is_of_sensor(column)).count() < 2 {
            return false;
        }
        let ranges = |row: &Vec<(usize, String)>| {
            row.iter().filter(|(index, cell)| is_of_sensor(&self.columns[*index]) && !cell.is_empty()).count()
        };
        let counts: Vec<_> = self.split(lines).iter().map(ranges).filter(|&count| count > 0).collect();
        let (of_one, of_any) = (counts.iter().filter(|&&count| count == 1).count(), counts.len());
        of_any >= 8 && of_one * 20 >= of_any * 19
    }

    /// Returns true for a column that counts rows.
    fn is_counter(&self, index: usize) -> bool {
        let column = &self.columns[index];
        column.is_rising() && column.steps().iter().all(|&step| (step - 1.0).abs() < 1e-9) && column.numbers[0] < 2.0
    }

    /// Returns true for the first of several unnamed columns if its values increase evenly: an angle, a loop's number.
    fn is_sweep(&self, index: usize) -> bool {
        let is_named = self.has_names || !matches!(self.shape, Shape::Separated(_));
        let ([], [column, _, ..]) = self.columns.split_at(index) else { return false };
        let steps: Vec<_> = column.numbers.windows(2).map(|two| (two[1] - two[0]).abs()).collect();
        let is_even = steps.iter().all(|&step| step == steps[0] && step > 0.0);
        !is_named && column.units == 0 && is_even && (steps.len() >= 5 || steps.len() >= 2 && steps[0] >= 5.0)
    }

    /// Returns true if the first unnamed numbers increase evenly to values that no range has: they are times.
    fn is_clock(&self, index: usize) -> bool {
        let (before, [column, others @ ..]) = self.columns.split_at(index) else { return false };
        let is_first = before.iter().all(|other| other.numbers.is_empty());
        if !is_first || others.is_empty() || !column.is_rising() {
            return false;
        }
        let steps = column.steps();
        let Some(median) = steps.get(steps.len() / 2) else { return false };
        let is_even = steps.iter().filter(|&step| *step <= 3.0 * median).count() * 10 >= 9 * steps.len();
        let middle = column.numbers[column.numbers.len() / 2];
        // Seconds among centimetres.
        let is_small = middle.fract() != 0.0
            && others
                .iter()
                .all(|other| other.numbers.iter().filter(|&&number| number > 0.0).all(|&number| number > 5.0 * middle));
        is_even && (middle >= 500.0 || column.numbers.len() >= 8 || is_small)
    }
}
