//! Recognises a text log from its first lines: its shape, header, units, no-echo values and times.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use crate::options::{Options, RangeUnit};
use crate::sink::Skipped;
use eeruf_files::FileError;

use super::column::{Column, Role};
use super::lines::Line;
use super::plan::{MOST_SENSORS, NoEcho, Plan, guess};
use super::sample::{Stripped, is_comment, shape_of, strip, usual};
use super::shape::{self, Separator, Shape, is_underline};
use crate::names::{self, Meaning};
use crate::value;

/// Recognises a log by its first lines.
pub(super) fn recognise(
    file: &Path,
    sample: &[Line],
    (records, is_of_objects): (Option<&str>, bool),
    options: &Options,
) -> Result<Plan, FileError> {
    let Stripped { lines, has_prefix, has_rules, lead } = strip(sample);
    let (shape, decimal_comma) = if is_of_objects { (Shape::Json, false) } else { shape_of(&lines) };
    let mut plan = Plan {
        shape,
        has_prefix,
        lead,
        decimal_comma,
        columns: vec![],
        by_name: HashMap::new(),
        header: None,
        has_names: false,
        rows_from: 0,
        time: vec![],
        sensor: None,
        known: BTreeSet::new(),
        foreign: BTreeSet::new(),
        no_echo: NoEcho::default(),
        one_a_row: false,
        is_first_cut: false,
        unit: None,
        medium: None,
        validity: vec![],
        greetings: BTreeSet::new(),
        has_rules,
        usual_names: None,
        form: String::new(),
        guesses: vec![],
        implausible: None,
        skipped: vec![],
    };
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

/// Columns that `ros2 topic echo --csv` prints of a Range, whose last came with Iron.
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
    /// Finds header, names and rows of a table; the answer is the units of a row of units.
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
        let is_units = |row: &[String]| {
            let is_unit =
                |text: &String| text.is_empty() || value::unit(text).is_some() || names::time_unit(text).is_some();
            row.iter().all(is_unit)
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
        let (mut units, mut other_units, mut is_long) = (vec![], vec![], false);
        if let Some(at) = header
            && at > 0
            && is_units(&before[at].1)
            && is_header(&before[at - 1].1)
        {
            units = before[at].1.iter().map(|text| value::unit(text)).collect();
            header = Some(at - 1);
        }
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
            (header, is_long) = (Some(top), true);
        }
        let mut names: Option<Vec<String>> = header.map(|at| before[at].1.clone());
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
            Some(_) if before.len() < first || is_long => first_number,
            Some(at) => rows[at].0 + 1 + u64::from(!units.is_empty()),
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
            let why = format!("{ignored} lines before the readings, without any");
            self.skipped.push(Skipped { topic: "the beginning".to_owned(), why, messages: 0 });
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
        let mut names = names.unwrap_or_default();
        // A printed frame's rows begin with their number, which has no name.
        let firsts = rows[first..].iter().filter(|(_, row)| row.len() == width).map(|(_, row)| row[0].as_str());
        if names.len() + 1 == width && (0..).zip(firsts.take(3)).all(|(n, text)| text.parse() == Ok(n)) {
            names.insert(0, String::new());
        }
        names.iter_mut().for_each(|name| name.truncate(name.trim_end_matches(':').len()));
        names.truncate(width.max(1));
        (names.len()..width).for_each(|n| names.push(format!("column {}", n + 1)));
        self.columns = names.iter().map(|name| Column::new(name)).collect();
        for (column, (unit, is_other)) in self.columns.iter_mut().zip(units.iter().zip(&other_units)) {
            (column.has_length, column.has_other_unit) = (unit.is_some(), *is_other);
        }
        // `# t in s, d in mm`
        let comments = sample.iter().filter_map(|line| line.text.trim().strip_prefix(['#', '%']));
        for said in comments.flat_map(|text| text.split([',', ';'])) {
            let Some((name, unit)) = said.trim().split_once(" in ") else { continue };
            let of = self.columns.iter_mut().filter(|column| column.name == name.trim());
            of.for_each(|column| column.has_unit_in_cells = value::unit(unit.trim()));
        }
        if separator != Separator::None {
            self.guesses.push(guess("separator", separator.name(), "--columns"));
        }
        if comma {
            self.guesses.push(guess("decimal mark", "comma", "--columns"));
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
        let has_time = self.has_prefix
            || time.is_some()
            || self.columns.iter().any(|column| names::meaning(&column.name) == Meaning::Time);
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
        // A number before a percent sign, or a unit of anything else, is no length.
        for index in 1..self.columns.len() {
            let is_foreign = self.columns[index].distinct.keys().all(|text| names::is_foreign_unit(text));
            self.columns[index - 1].has_other_unit |= is_foreign && !self.columns[index].distinct.is_empty();
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
                    // The beginning of the header is cut off.
                    Meaning::Vague if !has_time && self.is_clock(index) && self.is_even(index) => Role::Time,
                    Meaning::Vague if is_place && column.is_cycle() => Role::Sensor,
                    Meaning::Vague if column.is_flag() || column.is_beyond() => Role::Other,
                    _ if column.is_range() => Role::Range,
                    Meaning::Vague if !has_header && column.is_label() => Role::Sensor,
                    _ => Role::Other,
                }
            };
            let column = &mut self.columns[index];
            column.is_numeric = column.texts + column.calendars == 0 && !column.numbers.is_empty();
            column.role = role;
        }
        if ranges.is_empty() && has_header {
            self.named_ranges_alone();
            self.without_odd_ones();
            self.without_derived();
        }
        // Bytes, as tools for buses print them, are no table.
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
        if ranges.is_empty() {
            self.one_range_beside_a_sensor();
        }
        self.repetitions(lines, options);
        self.sensor_column(file, sensor, &ranges, lines)?;
        self.validities();
        let other = |column: &&Column| column.role == Role::Other && column.is_numeric && ranges.is_empty();
        let skipped = self.columns.iter().filter(other).map(|column| Skipped {
            topic: column.name.clone(),
            why: "a column that is no range, by its name or its values; --range reads it".to_owned(),
            messages: 0,
        });
        self.skipped.extend(skipped);
        Ok(())
    }

    /// Where names or units say which columns are ranges, one of which neither says anything is none.
    fn named_ranges_alone(&mut self) {
        let is_called = |column: &Column| {
            let by_unit =
                names::range_unit(&column.name).is_some_and(|(unit, is_sure)| is_sure || unit != RangeUnit::Us);
            let by_cells = column.units * 2 > column.numbers.len();
            let by_name = names::meaning(&column.name) == Meaning::Range || names::is_place(&column.name);
            column.has_length || by_unit || by_cells || by_name
        };
        if self.columns.iter().any(|column| column.role == Role::Range && is_called(column)) {
            let vague = self.columns.iter_mut().filter(|column| column.role == Role::Range && !is_called(column));
            vague.for_each(|column| column.role = Role::Other);
        }
    }

    /// A voltage or a share among ranges: other decimals than each other column has, and nearer than modules hear.
    fn without_odd_ones(&mut self) {
        /// Share of the smallest of the others' medians.
        const FAR_BELOW: f64 = 0.2;
        let is_vague =
            |column: &Column| column.role == Role::Range && column.units == 0 && !names::is_place(&column.name);
        let found: Vec<_> =
            self.columns.iter().map(|column| (is_vague(column), column.median(), column.has_fractions())).collect();
        let others =
            |index: usize| found.iter().enumerate().filter(move |(at, of)| *at != index && of.0).map(|(_, of)| of);
        let is_odd = |index: usize| {
            let (is_range, median, fractions) = found[index];
            let least = others(index).map(|of| of.1).fold(f64::INFINITY, f64::min);
            is_range && fractions && others(index).all(|of| !of.2) && least.is_finite() && median < FAR_BELOW * least
        };
        let odd: Vec<_> = (0..found.len()).filter(|&index| is_odd(index)).collect();
        odd.into_iter().for_each(|index| self.columns[index].role = Role::Other);
    }

    /// A depth or a level beside a column that is called a range is worked out from it.
    fn without_derived(&mut self) {
        let is_called = |column: &Column| {
            column.role == Role::Range
                && names::meaning(&column.name) == Meaning::Range
                && !names::is_derived(&column.name)
        };
        if self.columns.iter().any(is_called) {
            let derived = |column: &&mut Column| column.role == Role::Range && names::is_derived(&column.name);
            self.columns.iter_mut().filter(derived).for_each(|column| column.role = Role::Other);
        }
    }

    /// Where a row names its sensor, it has one range: what is called so, and no number without a meaning beside it.
    fn one_range_beside_a_sensor(&mut self) {
        let is_called_range =
            |column: &Column| column.role == Role::Range && names::meaning(&column.name) == Meaning::Range;
        let is_sensor = |column: &Column| column.role == Role::Sensor && column.distinct.len() > 1;
        let one = self.columns.iter().filter(|column| is_called_range(column)).count() == 1;
        if one && self.columns.iter().any(is_sensor) {
            let others =
                self.columns.iter_mut().filter(|column| column.role == Role::Range && !is_called_range(column));
            others.for_each(|column| column.role = Role::Other);
        }
    }

    /// Returns true if nearly each row of a table has one range and empty cells for the other sensors.
    fn is_one_a_row(&self, lines: &[(u64, &str)]) -> bool {
        let Shape::Separated(separator) = self.shape else { return false };
        let is_of_sensor = |column: &Column| matches!(column.role, Role::Range | Role::Empty);
        if self.columns.iter().filter(|column| is_of_sensor(column)).count() < 2 {
            return false;
        }
        let rows = lines.iter().filter(|line| line.0 >= self.rows_from);
        let rows: Vec<_> = rows.filter_map(|(_, text)| shape::separated(text, separator)).collect();
        let ranges = |row: &Vec<String>| {
            let cells = self.columns.iter().zip(row).filter(|(column, _)| is_of_sensor(column));
            cells.filter(|(_, cell)| !cell.is_empty()).count()
        };
        let single = rows.iter().filter(|row| ranges(row) == 1).count();
        rows.len() >= 8 && single * 20 >= rows.len() * 19
    }

    /// A column that counts rows.
    fn is_counter(&self, index: usize) -> bool {
        let column = &self.columns[index];
        column.is_rising() && column.steps().iter().all(|&step| (step - 1.0).abs() < 1e-9) && column.numbers[0] < 2.0
    }

    /// The first of several columns without names whose values go on by one step: an angle, a loop's number.
    fn is_sweep(&self, index: usize) -> bool {
        let is_named = self.has_names || !matches!(self.shape, Shape::Separated(_));
        let ([], [column, _, ..]) = self.columns.split_at(index) else { return false };
        let steps: Vec<_> = column.numbers.windows(2).map(|two| (two[1] - two[0]).abs()).collect();
        let is_even = steps.iter().all(|&step| step == steps[0] && step > 0.0);
        !is_named && column.units == 0 && is_even && (steps.len() >= 5 || steps.len() >= 2 && steps[0] >= 5.0)
    }

    /// The first numbers without a name that rise evenly, to numbers that no range has, are times.
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

    /// A column that rises by the same step in 30 rows and more.
    fn is_even(&self, index: usize) -> bool {
        let steps = self.columns[index].steps();
        let Some(median) = steps.get(steps.len() / 2) else { return false };
        let same = steps.iter().filter(|&step| (step / median - 1.0).abs() < 0.1).count();
        steps.len() >= 29 && same * 10 >= 9 * steps.len()
    }
}
