//! Guesses of units, times and values for no echo, from the names of columns and their first values.

use std::collections::BTreeSet;

use crate::options::{Options, RangeUnit, TimeUnit};

use super::column::{Column, Role};
use super::plan::{Plan, guess};
use crate::names;
use crate::sink::Skipped;
use crate::value;

impl Plan {
    pub(super) fn range_units(&mut self, units: &[Option<RangeUnit>], options: &Options) {
        let asked = options.table.range_unit;
        let mut values = vec![];
        let mut unnamed = vec![];
        for index in 0..self.columns.len() {
            let column = &mut self.columns[index];
            if !matches!(column.role, Role::Range | Role::Empty | Role::Least | Role::Most) {
                continue;
            }
            let median = Some(column.median()).filter(|median| !median.is_nan());
            let name = names::range_unit(&column.name)
                .filter(|(unit, is_sure)| *is_sure || *unit != RangeUnit::Us || median.is_none_or(|us| us >= 500.0));
            let row = units.get(index).copied().flatten();
            let known = asked.or(row).or(column.has_unit_in_cells).or(name.map(|name| name.0));
            match known {
                Some(unit) => column.unit = unit,
                None if column.role == Role::Range || column.role == Role::Empty => {
                    unnamed.push(index);
                    for (text, &count) in &column.distinct {
                        let number = value::number(text, self.decimal_comma).filter(|&number| number > 0.0);
                        let has_fraction = text.contains(['.', ',']) || text.contains(['e', 'E']);
                        values.extend(number.map(|number| (number, has_fraction)).into_iter().cycle().take(count));
                    }
                }
                // The limits are in the unit of the range.
                None => unnamed.push(index),
            }
        }
        // Four digits with leading zeroes have room for metres in millimetres, and for no centimetres.
        let is_padded = |index: &usize| {
            let texts = || self.columns[*index].distinct.keys();
            texts().all(|text| text.len() == 4 && text.bytes().all(|byte| byte.is_ascii_digit()))
                && texts().any(|text| text.starts_with('0') && text != "0000")
        };
        let is_padded = !unnamed.is_empty() && unnamed.iter().all(is_padded);
        let unit = if is_padded { RangeUnit::Mm } else { by_magnitude(&mut values) };
        self.refute(&values, unit, &unnamed, options);
        for &index in &unnamed {
            self.columns[index].unit = unit;
        }
        if let Some(unit) = asked {
            self.doubt(unit, options);
        } else {
            let mut found: Vec<&str> = self.ranges().map(|column| column.unit.name()).collect();
            found.dedup();
            let why = match (values.first(), values.last()) {
                (Some((least, _)), Some((most, _))) => format!(", by values of {least} to {most}"),
                _ => ", by names or units beside the values".to_owned(),
            };
            let why = match self.unit {
                Some(index) => format!(", each as its row says in column `{}`", self.columns[index].name),
                None => why,
            };
            self.guesses.push(guess("range unit", found.join(", ") + &why, "--range-unit"));
        }
    }

    /// Rejects columns that only their numbers suggest as ranges, if nine of ten values would be nearer than any module
    /// hears: a countdown, a share, a state.
    fn refute(&mut self, values: &[(f64, bool)], unit: RangeUnit, unnamed: &[usize], options: &Options) {
        const NEAREST_M: f64 = 0.04;
        let is_asked = !options.table.ranges.is_empty() || !options.table.columns.is_empty();
        let is_called = |column: &Column| {
            names::meaning(&column.name) == names::Meaning::Range || names::is_place(&column.name) || column.units > 0
        };
        let ranges = || unnamed.iter().filter(|&&index| self.columns[index].role == Role::Range);
        let Some(most) = values.get(values.len().saturating_sub(1) * 9 / 10) else { return };
        let is_near = most.0 * unit.metres(options.speed_of_sound) < NEAREST_M;
        // A row's unit may show that nothing is an echo.
        let of_rows = self.unit.and_then(|index| value::unit(self.columns[index].distinct.keys().next()?));
        let least_m =
            values.first().map_or(0.0, |value| value.0) * of_rows.unwrap_or(unit).metres(options.speed_of_sound);
        if !is_asked
            && (is_near || least_m >= options.no_echo_m)
            && !ranges().any(|&index| is_called(&self.columns[index]))
        {
            let taken: Vec<_> = ranges().copied().collect();
            let why = "nearer or farther than modules hear, in any unit";
            self.skipped.extend(taken.iter().map(|&index| Skipped::new(&self.columns[index].name, why)));
            self.leave_out(taken);
        }
    }

    /// Warns about a unit with which most ranges are nearer or farther than ultrasonic sensors hear.
    fn doubt(&mut self, unit: RangeUnit, options: &Options) {
        const PLAUSIBLE_M: std::ops::RangeInclusive<f64> = 0.01..=25.0;
        let mut values: Vec<_> =
            self.ranges().flat_map(|column| column.numbers.iter().copied()).filter(|&n| n > 0.0).collect();
        values.sort_by(f64::total_cmp);
        let Some(median) = values.get(values.len() / 2) else { return };
        let metres = median * unit.metres(options.speed_of_sound);
        if !PLAUSIBLE_M.contains(&metres) {
            let name = unit.name();
            self.implausible = Some(format!(
                "a median range of {median} {name}, {:.3} m; expected {} to {} m from an ultrasonic sensor; if the \
                 values are not {name}, leave out --range-unit",
                metres,
                PLAUSIBLE_M.start(),
                PLAUSIBLE_M.end()
            ));
        }
    }

    pub(super) fn no_echoes(&mut self, options: &Options) {
        /// Numbers that sensors and libraries send if they hear nothing.
        const CEILINGS: [f64; 15] = [
            127.0, 255.0, 300.0, 400.0, 450.0, 500.0, 600.0, 765.0, 999.0, 1000.0, 1023.0, 4000.0, 5000.0, 8190.0,
            65535.0,
        ];
        for text in &options.no_echo {
            match value::number(text, self.decimal_comma) {
                Some(number) => self.no_echo.numbers.push(number),
                None => self.no_echo.words.push(text.to_lowercase()),
            }
        }
        let ranges: Vec<_> = self.columns.iter().filter(|column| column.role == Role::Range).collect();
        let numbers = || ranges.iter().flat_map(|column| column.numbers.iter().copied());
        let mut said = vec![];
        if options.no_echo.is_empty() {
            (self.no_echo.zero, self.no_echo.negative) = (true, true);
            if numbers().any(|number| number == 0.0) {
                said.push("0".to_owned());
            }
            let least = numbers().fold(0.0, f64::min);
            if least < 0.0 {
                said.push(format!("below 0 ({least})"));
            }
            let most = numbers().fold(0.0, f64::max);
            let total = numbers().count();
            let at_most = numbers().filter(|&number| number == most).count();
            let next = numbers().filter(|&number| number < most).fold(0.0, f64::max);
            let alternates = ranges.iter().any(|column| {
                column.numbers.contains(&most)
                    && column.numbers.iter().any(|&number| number > 0.0 && number < 0.8 * most)
            });
            if CEILINGS.contains(&most) && at_most * 10 >= total && at_most >= 3 && next < 0.8 * most && alternates {
                self.no_echo.numbers.push(most);
                said.push(format!("{most}"));
            }
        } else {
            said.extend(options.no_echo.iter().cloned());
        }
        let is_word = |text: &&String| value::is_no_echo(text);
        let words: BTreeSet<_> =
            ranges.iter().flat_map(|column| column.distinct.keys().filter(is_word)).cloned().collect();
        said.extend(words);
        if ranges.iter().any(|column| column.empties > 0) {
            let of_another = if self.one_a_row { " is another sensor's row" } else { "" };
            said.push(format!("an empty cell{of_another}"));
        }
        said.push(format!("{} m and more", options.no_echo_m));
        self.guesses.push(guess("no echo", said.join(", "), "--no-echo, --no-echo-m"));
    }

    pub(super) fn times(&mut self, options: &Options) {
        for (index, unit) in &mut self.time {
            let column = &self.columns[*index];
            let said;
            (*unit, said) = match (options.table.time_unit, names::time_unit(&column.name)) {
                (Some(unit), _) => (unit, ""),
                (None, Some(unit)) if !column.numbers.is_empty() => (unit, ", by its name"),
                _ => (time_by_magnitude(column), ", by its values"),
            };
            if options.table.time.is_none() || !said.is_empty() {
                let unit = if column.numbers.is_empty() { "dates or times of day" } else { unit.said().0 };
                self.guesses.push(guess(
                    "time",
                    format!("column `{}`, {unit}{said}", column.name),
                    "--time, --time-unit",
                ));
            }
        }
        if self.time.is_empty() && !self.has_prefix {
            self.guesses.push(guess("time", "none: the log does not say when readings were", "--time"));
        }
    }
}

/// The unit of ranges by their magnitude; sorts the ranges.
fn by_magnitude(values: &mut [(f64, bool)]) -> RangeUnit {
    /// Values that sensors and libraries send in place of a range.
    const PLACEHOLDERS: [f64; 8] = [999.0, 9999.0, 8190.0, 8191.0, 32767.0, 65533.0, 65534.0, 65535.0];
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    // No echo comes after a second.
    let is_real = |value: &&(f64, bool)| !PLACEHOLDERS.contains(&value.0) && value.0 < 1e6;
    let real: Vec<_> = values.iter().filter(is_real).copied().collect();
    let values = if real.is_empty() { &*values } else { &real };
    let Some(&(median, _)) = values.get(values.len() / 2) else { return RangeUnit::M };
    // A line that was held for too long, now and then, says nothing of the unit.
    let most = values.get(values.len() - 1 - values.len() / 10).map_or(median, |value| value.0);
    let has_fractions = values.iter().any(|value| value.1);
    if has_fractions && (most <= 12.0 || median <= 7.0) {
        RangeUnit::M
    } else if median <= 500.0 && most <= 1100.0 {
        RangeUnit::Cm
    } else if most <= 10_000.0 {
        RangeUnit::Mm
    } else {
        RangeUnit::Us
    }
}

fn time_by_magnitude(column: &Column) -> TimeUnit {
    let first = column.numbers.first().copied().unwrap_or(0.0);
    let steps = column.steps();
    let step = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let has_fractions = column.numbers.iter().any(|number| number.fract() != 0.0);
    match first {
        _ if first >= 1e17 => TimeUnit::Ns,
        _ if first >= 1e14 => TimeUnit::Us,
        _ if first >= 1e11 => TimeUnit::Ms,
        _ if first >= 1e9 && step < 1e3 || has_fractions => TimeUnit::S,
        _ if step >= 5000.0 => TimeUnit::Us,
        _ if step >= 5.0 => TimeUnit::Ms,
        _ => TimeUnit::S,
    }
}
