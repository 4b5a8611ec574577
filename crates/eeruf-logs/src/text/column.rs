//! A column of a text, and the properties of its first values.

use std::collections::BTreeMap;

use crate::options::RangeUnit;

use super::validity::are_verdicts;
use crate::names;
use crate::value::{self, Value};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Role {
    /// The ranges of a sensor.
    Range,
    Time,
    Sensor,
    Least,
    Most,
    #[default]
    Other,
    /// A column without values so far.
    Empty,
}

/// A column: its name and role, and its first values counted by kind.
#[derive(Clone, Debug, Default)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) role: Role,
    /// True if each value in the first lines is a number.
    pub(super) is_numeric: bool,
    pub(super) unit: RangeUnit,
    /// The longest value so far.
    pub(super) longest: usize,
    pub(super) shortest: usize,
    pub(super) numbers: Vec<f64>,
    pub(super) no_echoes: usize,
    pub(super) empties: usize,
    pub(super) texts: usize,
    pub(super) calendars: usize,
    pub(super) distinct: BTreeMap<String, usize>,
    /// Number of rows whose text differs from that of the previous row.
    changes: usize,
    last: String,
    pub(super) has_unit_in_cells: Option<RangeUnit>,
    pub(super) units: usize,
    /// True if the unit below the column's name is a unit of length, false for another unit.
    pub(super) has_length: bool,
    pub(super) has_other_unit: bool,
    /// A unit in which every second cell repeats the range of the previous cell.
    pub(super) repeated_unit: Option<RangeUnit>,
}

impl Column {
    pub(super) fn new(name: &str) -> Self {
        Self { name: name.to_owned(), shortest: usize::MAX, ..Self::default() }
    }

    pub(super) fn note(&mut self, text: &str, decimal_comma: bool) {
        self.longest = self.longest.max(text.len());
        self.shortest = self.shortest.min(text.len());
        if text.is_empty() || text == "unavailable" {
            self.empties += 1;
            return;
        }
        if self.last != text {
            self.changes += 1;
            text.clone_into(&mut self.last);
        }
        if self.distinct.len() <= 1024 {
            *self.distinct.entry(text.to_owned()).or_default() += 1;
        }
        match value::range(text, decimal_comma) {
            Some((Value::Number(number), unit)) => {
                self.numbers.push(number);
                self.has_unit_in_cells = self.has_unit_in_cells.or(unit);
                self.units += usize::from(unit.is_some());
            }
            Some(_) => self.no_echoes += 1,
            None if value::calendar_ns(text).or_else(|| value::elapsed_ns(text)).is_some() => self.calendars += 1,
            None => self.texts += 1,
        }
    }

    pub(super) fn is_range(&self) -> bool {
        let numbers = self.numbers.len() + self.no_echoes;
        // Dashes between values are no deaf sensor.
        let is_dash = self.numbers.is_empty() && self.distinct.keys().all(|text| text.starts_with('-'));
        numbers > 0 && !is_dash && self.texts + self.calendars <= numbers
    }

    /// The median of the column's positive numbers.
    pub(super) fn median(&self) -> f64 {
        let mut sorted: Vec<_> = self.numbers.iter().copied().filter(|&number| number > 0.0).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Returns true for numbers that never fall and are seconds, milli-, micro- or nanoseconds since 1970.
    pub(super) fn is_epoch(&self) -> bool {
        let is_in = |number: &f64| [1.0, 1e3, 1e6, 1e9].iter().any(|unit| (1e9..2.2e9).contains(&(number / unit)));
        let falls = self.numbers.windows(2).filter(|two| two[1] < two[0]).count();
        // A few damaged lines do not matter.
        let count = self.numbers.iter().filter(|number| is_in(number)).count();
        count > 0 && count * 10 >= 9 * self.numbers.len() && falls * 10 <= self.numbers.len()
    }

    /// Returns true for whole numbers that repeatedly count through the sensors.
    pub(super) fn is_cycle(&self) -> bool {
        let of = |pick: fn(f64, f64) -> f64| self.numbers.iter().copied().reduce(pick).unwrap_or(0.0);
        let (least, most, rows) = (of(f64::min), of(f64::max), self.numbers.len());
        let is_next = |two: &&[f64]| two[1] == two[0] + 1.0 || (two[0] == most && two[1] == least);
        let distinct = self.distinct.len();
        let next = self.numbers.windows(2).filter(is_next).count();
        (2..=64).contains(&distinct)
            && (0.0..=64.0).contains(&least)
            && self.texts + self.no_echoes + self.units == 0
            && rows >= 6.max(2 * distinct)
            && next * 10 >= (rows - 1) * 9
    }

    /// Returns true for texts that may name a sensor: not pairs, not times, and some of them repeated.
    pub(super) fn is_label(&self) -> bool {
        let rows: usize = self.distinct.values().sum();
        let is_name = |text: &String| {
            let inner = text.trim_start_matches(['[', '(']);
            let is_address = inner.starts_with("0x");
            (is_address || !inner.starts_with(|letter: char| letter.is_ascii_digit()))
                && (!text.contains('=') || text.contains('{'))
                && value::unit(text).is_none()
                && (self.distinct.len() > 1 || !names::is_foreign_unit(text))
        };
        // A robot's mode stays for a while; sensors take turns.
        let is_state = self.distinct.len() > 1 && self.changes * 2 < rows + self.distinct.len();
        let is_name = self.texts > 0 && self.distinct.keys().all(is_name);
        is_name && !is_state && !are_verdicts(self.distinct.keys()) && (self.distinct.len() < rows || rows < 3)
    }

    /// Returns true for texts that occur equally often, like sensors in turn and unlike a robot's actions.
    pub(super) fn takes_turns(&self) -> bool {
        let counts = || self.distinct.values().copied();
        self.distinct.len() > 1 && counts().max() <= counts().min().map(|least| least + 1 + least / 4)
    }

    /// For cells of two hexadecimal digits, as bus tools print bytes: true if some are not decimal numbers.
    pub(super) fn bytes(&self) -> Option<bool> {
        let is_byte = |text: &String| text.len() == 2 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let is_odd = |text: &String| text.starts_with('0') || text.bytes().any(|byte| byte.is_ascii_alphabetic());
        let is_all = !self.distinct.is_empty() && self.distinct.keys().all(is_byte);
        is_all.then(|| self.distinct.keys().any(is_odd))
    }

    /// Returns true if the column's numbers have units, so that a number without one was cut off.
    pub(super) fn needs_unit(&self) -> bool {
        self.units * 10 >= self.numbers.len() * 8 && self.units > 0
    }

    pub(super) fn is_rising(&self) -> bool {
        let others = self.no_echoes + self.empties + self.texts + self.calendars;
        // A few damaged lines do not matter.
        let rises = self.numbers.windows(2).filter(|two| two[0] < two[1]).count();
        let rows = self.numbers.len();
        rows >= 3 && others * 10 <= rows && (rows - 1 - rises) * 20 < rows.max(20)
    }

    /// Returns true if half of the steps go down, which a clock never does, even if it restarts often.
    pub(super) fn falls_often(&self) -> bool {
        let falls = self.numbers.windows(2).filter(|two| two[1] < two[0]).count();
        falls * 2 >= self.numbers.len() && falls > 0
    }

    /// Returns true for a rising column whose first step is at most three times its median step.
    pub(super) fn begins_evenly(&self) -> bool {
        let steps = self.steps();
        let (Some(median), [first, second, ..]) = (steps.get(steps.len() / 2), &self.numbers[..]) else { return false };
        self.is_rising() && second - first <= 3.0 * median
    }

    pub(super) fn steps(&self) -> Vec<f64> {
        let mut steps: Vec<f64> =
            self.numbers.windows(2).map(|two| two[1] - two[0]).filter(|&step| step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        steps
    }
}
