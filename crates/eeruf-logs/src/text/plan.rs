//! The plan for reading a text: its shape, its columns with their roles, and the guesses.

use std::collections::{BTreeSet, HashMap};

use super::column::{Column, Role};
use super::shape::Shape;
use crate::options::TimeUnit;
use crate::sink::{Guess, Skipped};

/// Largest number of sensors in one log.
pub(super) const MOST_SENSORS: usize = 4096;

/// Numbers that mean no echo.
#[derive(Clone, Debug, Default)]
pub(super) struct NoEcho {
    pub(super) zero: bool,
    pub(super) negative: bool,
    pub(super) numbers: Vec<f64>,
    pub(super) words: Vec<String>,
}

/// The meaning of a column of validity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Says {
    /// The status of ArduPilot's `RFND`: 4 is good, 3 beyond the range, 2 below it, less means no measurement.
    RangefinderStatus,
    /// The reading type of `DroneCAN`: 1 is good, 2 too close, 3 too far, 0 unknown.
    ReadingType,
    /// A flag: 1 or `true` is good.
    Flag,
    /// A quality: 0 is bad, below 0 unknown.
    Quality,
}

/// A column of validity, and the range to which it applies, or all of its row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Validity {
    pub(super) column: usize,
    pub(super) range: Option<usize>,
    pub(super) meaning: Says,
}

#[derive(Default)]
pub(super) struct Plan {
    pub(super) shape: Shape,
    pub(super) has_prefix: bool,
    pub(super) decimal_comma: bool,
    pub(super) columns: Vec<Column>,
    pub(super) by_name: HashMap<String, usize>,
    pub(super) header: Option<Vec<String>>,
    /// True if a header, a comment or the form of the rows names the columns.
    pub(super) has_names: bool,
    /// Number of the first line that can be a row.
    pub(super) rows_from: u64,
    pub(super) time: Vec<(usize, TimeUnit)>,
    pub(super) sensor: Option<usize>,
    /// Sensors that a column names often enough to be trusted.
    pub(super) known: BTreeSet<String>,
    /// Labels of rows with another quantity, besides one that is called a range.
    pub(super) foreign: BTreeSet<String>,
    pub(super) no_echo: NoEcho,
    /// True if each row has one sensor, so that empty cells of the others are not silence.
    pub(super) one_a_row: bool,
    pub(super) is_first_cut: bool,
    /// The column with the unit of its row's range.
    pub(super) unit: Option<usize>,
    /// The column with the medium of a row's sensor, and the number that means ultrasound.
    pub(super) medium: Option<(usize, f64)>,
    /// Columns that say whether ranges are valid.
    pub(super) validity: Vec<Validity>,
    /// Lines before the header, which are repeated after a reset.
    pub(super) greetings: BTreeSet<String>,
    /// True if lines of dashes separate rows or messages; otherwise they are words for no echo.
    pub(super) has_rules: bool,
    /// The names in nearly all lines of pairs.
    pub(super) usual_names: Option<Vec<String>>,
    pub(super) form: String,
    pub(super) guesses: Vec<Guess>,
    /// A warning about ranges that no ultrasonic sensor measures.
    pub(super) implausible: Option<String>,
    pub(super) skipped: Vec<Skipped>,
}

impl Plan {
    /// The columns with this role, by their places.
    pub(super) fn places(&self, role: Role) -> Vec<usize> {
        (0..self.columns.len()).filter(|&index| self.columns[index].role == role).collect()
    }

    /// The columns with ranges.
    pub(super) fn ranges(&self) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(|column| column.role == Role::Range)
    }

    /// Makes columns no ranges, given by their places.
    pub(super) fn leave_out(&mut self, places: impl IntoIterator<Item = usize>) {
        places.into_iter().for_each(|index| self.columns[index].role = Role::Other);
    }

    /// Makes columns with ranges no ranges, if a condition holds for them.
    pub(super) fn leave_out_if(&mut self, is_out: impl Fn(&Column) -> bool) {
        let out = self.columns.iter_mut().filter(|column| column.role == Role::Range && is_out(column));
        out.for_each(|column| column.role = Role::Other);
    }
}

pub(super) fn guess(what: &str, value: impl Into<String>, option: &str) -> Guess {
    Guess { what: what.to_owned(), value: value.into(), option: option.to_owned() }
}
