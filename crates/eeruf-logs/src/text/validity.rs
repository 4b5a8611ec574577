//! Columns that say whether the range beside them was measured.

use super::column::{Column, Role};
use super::plan::{Plan, Says, Validity, guess};
use crate::names;
use crate::value;

/// Words after a reading that say that it is valid.
const GOOD: [&str; 3] = ["valid", "ok", "good"];
const BAD: [&str; 5] = ["invalid", "nok", "bad", "fail", "failed"];

/// Returns true if each word says whether a reading is valid, and at least one says that it is.
pub(super) fn are_verdicts<'a>(mut words: impl Iterator<Item = &'a String> + Clone) -> bool {
    let is_in = |list: &[&str], word: &str| list.contains(&word.to_lowercase().as_str());
    words.clone().any(|word| is_in(&GOOD, word)) && words.all(|word| is_in(&GOOD, word) || is_in(&BAD, word))
}

impl Validity {
    /// The range that an invalid cell means.
    pub(super) fn of(self, range: usize, text: impl Fn(usize) -> Option<String>, decimal_comma: bool) -> Option<f64> {
        if self.range.is_some_and(|own| own != range) {
            return None;
        }
        let text = text(self.column)?;
        let number = value::number(&text, decimal_comma);
        match self.meaning {
            Says::RangefinderStatus => match number? {
                2.0 => Some(f64::NEG_INFINITY),
                number if number < 4.0 => Some(f64::INFINITY),
                _ => None,
            },
            Says::Flag => {
                let text = text.to_lowercase();
                let is_bad = number == Some(0.0) || text == "false" || BAD.contains(&text.as_str());
                is_bad.then_some(f64::INFINITY)
            }
            Says::ReadingType => match number? {
                1.0 => None,
                2.0 => Some(f64::NEG_INFINITY),
                _ => Some(f64::INFINITY),
            },
            Says::Quality => (number == Some(0.0)).then_some(f64::INFINITY),
        }
    }
}

fn meaning(column: &Column) -> Option<(Says, &'static str)> {
    let words: Vec<_> = column.name.to_lowercase().split(|c: char| !c.is_alphanumeric()).map(str::to_owned).collect();
    let has = |names: &[&str]| words.iter().any(|word| names.contains(&word.as_str()));
    let whole = |most: f64| {
        let is_in = |number: &f64| number.fract() == 0.0 && (-1.0..=most).contains(number);
        !column.numbers.is_empty() && column.numbers.iter().all(is_in)
    };
    let is_flag = column.distinct.keys().all(|text| {
        let text = text.to_lowercase();
        ["0", "1", "true", "false"].contains(&text.as_str())
    });
    if has(&["stat"]) && whole(4.0) && column.numbers.contains(&4.0) {
        Some((Says::RangefinderStatus, "4 is good"))
    } else if has(&["reading"]) && has(&["type"]) && whole(3.0) && column.numbers.contains(&1.0) {
        Some((Says::ReadingType, "1 is good"))
    } else if has(&["valid", "ok", "isvalid"]) && is_flag && column.distinct.len() <= 2 {
        Some((Says::Flag, "1 or true is good"))
    } else if are_verdicts(column.distinct.keys()) {
        Some((Says::Flag, "each says if its row is good"))
    } else if has(&["quality"]) && whole(255.0) && column.numbers.iter().any(|&number| number > 0.0) {
        Some((Says::Quality, "0 is bad"))
    } else {
        None
    }
}

impl Plan {
    /// Finds the columns that say whether ranges are valid.
    pub(super) fn validities(&mut self) {
        let ranges = self.places(Role::Range);
        let mut said = vec![];
        for index in self.places(Role::Other) {
            let Some((meaning, why)) = meaning(&self.columns[index]) else { continue };
            let without = |name: &str| {
                let mut words = names::stem(name);
                words.retain(|word| {
                    !["stat", "valid", "ok", "isvalid", "quality", "signal", "type"].contains(&word.as_str())
                });
                words
            };
            let own = without(&self.columns[index].name);
            let alike: Vec<_> =
                ranges.iter().copied().filter(|&range| without(&self.columns[range].name) == own).collect();
            let range = match (&alike[..], &ranges[..]) {
                ([one], _) => Some(*one),
                (_, [_]) => None,
                _ if own.is_empty() => None,
                _ => continue,
            };
            said.push(format!("column `{}`: {why}", self.columns[index].name));
            self.validity.push(Validity { column: index, range, meaning });
        }
        if !said.is_empty() {
            self.guesses.push(guess("validity", said.join(", "), "--range"));
        }
    }
}
