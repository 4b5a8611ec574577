//! The reading of a text: its shape, its columns with their roles, and what was guessed.

use std::collections::{BTreeSet, HashMap};

use super::column::Column;
use super::shape::Shape;
use crate::options::TimeUnit;
use crate::sink::{Guess, Skipped};

/// The sensors of one log.
pub(super) const MOST_SENSORS: usize = 4096;

/// Numbers that mean that there was no echo.
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
    /// The status of ArduPilot's `RFND`: 4 is good, 3 beyond the range, 2 below it, less is no measurement.
    RangefinderStatus,
    /// `DroneCAN`'s: 1 is good, 2 too close, 3 too far, 0 unknown.
    ReadingType,
    /// 1 or `true` is good.
    Flag,
    /// 0 is bad; below 0 nothing is known.
    Quality,
}

/// A column of validity, and the one range that it is about, or all of its row.
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
    /// A header, a comment or the form of the rows names the columns.
    pub(super) has_names: bool,
    /// Lines before this one are no rows.
    pub(super) rows_from: u64,
    pub(super) time: Vec<(usize, TimeUnit)>,
    pub(super) sensor: Option<usize>,
    /// Sensors that a column names, as often as is needed to trust them.
    pub(super) known: BTreeSet<String>,
    /// Labels of rows whose names are of another quantity, beside one that is called a range.
    pub(super) foreign: BTreeSet<String>,
    pub(super) no_echo: NoEcho,
    /// Each row is of one sensor: the empty cells of the others are no silence.
    pub(super) one_a_row: bool,
    pub(super) is_first_cut: bool,
    /// The column that says the unit of its row's range.
    pub(super) unit: Option<usize>,
    /// The column that says by what a row's sensor measures, and the number of ultrasound.
    pub(super) medium: Option<(usize, f64)>,
    /// Columns that say whether ranges are any.
    pub(super) validity: Vec<Validity>,
    /// Lines before the header, which a reset repeats.
    pub(super) greetings: BTreeSet<String>,
    /// Lines of dashes part rows or messages; else they are words for no echo.
    pub(super) has_rules: bool,
    /// The names that nearly each line of pairs has.
    pub(super) usual_names: Option<Vec<String>>,
    pub(super) form: String,
    pub(super) guesses: Vec<Guess>,
    /// A warning of ranges that no ultrasonic sensor has.
    pub(super) implausible: Option<String>,
    pub(super) skipped: Vec<Skipped>,
}

pub(super) fn guess(what: &str, value: impl Into<String>, option: &str) -> Guess {
    Guess { what: what.to_owned(), value: value.into(), option: option.to_owned() }
}
