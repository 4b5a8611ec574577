//! The first lines of a text: their prefixes, and how their values are separated.

use std::collections::BTreeMap;

use super::lines::Line;
use super::shape::{self, Separator, Shape, is_rule};
use crate::names::{self, Meaning};
use crate::value;

pub(crate) fn is_comment(text: &str) -> bool {
    let text = text.trim_start();
    if text.starts_with(|letter: char| letter.is_ascii_digit()) {
        return false;
    }
    // MATLAB's; `%time` begins a header.
    let is_percent = text.starts_with("% ") || text == "%";
    text.is_empty()
        || text.starts_with('#')
        || is_percent
        || text.starts_with("//")
        || text.get(..4).is_some_and(|start| start.eq_ignore_ascii_case("sep="))
}

/// Lines without comments and without the prefixes of a serial monitor.
pub(super) struct Stripped<'a> {
    pub(super) lines: Vec<(u64, &'a str)>,
    pub(super) has_prefix: bool,
    pub(super) has_rules: bool,
}

pub(super) fn strip(sample: &[Line]) -> Stripped<'_> {
    let lines: Vec<_> = sample
        .iter()
        // A last line that may be cut says nothing of the others.
        .filter(|line| !is_comment(&line.text) && !line.is_misfit && (line.is_ended || sample.len() < 4))
        .map(|line| (line.number, line.text.trim()))
        .collect();
    let rules = lines.iter().filter(|line| is_rule(line.1)).count();
    let values = lines.iter().filter(|line| !is_rule(line.1) && value::range(line.1, true).is_some()).count();
    // If a line is one value, dashes separate messages only if they follow each of them.
    let has_rules = rules > 0 && (values * 2 < lines.len() - rules || rules * 2 + 1 >= lines.len());
    let lines: Vec<_> = lines.into_iter().filter(|line| !(has_rules && is_rule(line.1))).collect();
    let with = lines.iter().filter(|(_, text)| value::prefix(text).is_some_and(|(_, rest)| !rest.is_empty())).count();
    let first = lines.first().map_or("", |line| line.1);
    let is_header = value::prefix(first).is_none()
        && !first.contains([':', '='])
        && names::meaning(first.split([' ', '\t', ',', ';']).next().unwrap_or_default()) == Meaning::Time;
    // A whole number in brackets that falls as often as it rises is a sensor's.
    let whole = |text: &str| text.strip_prefix('[')?.split_once(']')?.0.trim().parse::<u64>().ok();
    let numbers: Vec<_> = lines.iter().filter_map(|(_, text)| whole(text)).collect();
    let rises = numbers.windows(2).filter(|two| two[0] < two[1]).count();
    let is_label = numbers.len() * 2 > lines.len() && rises * 10 < (numbers.len() - 1) * 9;
    let has_prefix = with > 0 && with * 10 >= lines.len() * 6 && !is_header && !is_label;
    let strip = |(number, text): (u64, _)| {
        let rest = value::prefix(text).filter(|_| has_prefix).map_or(text, |found| found.1);
        (number, value::without_level(rest))
    };
    Stripped { lines: lines.into_iter().map(strip).collect(), has_prefix, has_rules }
}

/// The shape that fits most lines best, and true if numbers have a decimal comma.
pub(super) fn shape_of(lines: &[(u64, &str)]) -> (Shape, bool) {
    let total = lines.len().max(1);
    let json = lines.iter().filter(|(_, text)| text.contains('{') && shape::object(text).is_some()).count();
    if json * 2 >= total {
        return (Shape::Json, false);
    }
    let pairs: Vec<_> = lines.iter().filter_map(|(_, text)| shape::keyed(text)).collect();
    let has_comma = |texts: &mut dyn Iterator<Item = &str>| {
        let (mut comma, mut point) = (false, false);
        for text in texts {
            let number = value::with_unit(text, true).is_some();
            comma |= number && text.contains(',');
            point |= number && text.contains('.');
        }
        comma && !point
    };
    let is_value = |(_, text): &(String, String)| value::range(text, true).is_some_and(|_| !text.is_empty());
    let valued = pairs.iter().filter(|pairs| pairs.iter().any(is_value)).count();
    if valued * 2 >= total {
        let comma = has_comma(&mut pairs.iter().flatten().map(|(_, text)| text.as_str()));
        return (Shape::Keyed, comma);
    }
    let mut best = (0.0, Separator::None, false);
    // A comma in each line is a decimal mark only below a header of one name.
    let is_decimal = |text: &str| text.split_once(',').is_none_or(|(whole, rest)| whole.len() < 3 || rest.len() < 3);
    let has_one_name = lines.iter().take(5).any(|(_, text)| text.contains(char::is_alphabetic) && !text.contains(','))
        && lines.iter().all(|(_, text)| is_decimal(text));
    for separator in Separator::ALL.into_iter().chain([Separator::None]) {
        let rows: Vec<_> = lines.iter().filter_map(|(_, text)| shape::separated(text, separator)).collect();
        let width = usual(rows.iter().map(Vec::len));
        if width < 2 && separator != Separator::None {
            continue;
        }
        let usual: Vec<_> = rows.iter().filter(|row| row.len() == width).collect();
        let cells = || usual.iter().flat_map(|row| row.iter().map(String::as_str));
        let comma = has_comma(&mut cells()) && (separator != Separator::None || has_one_name);
        let is_clean = |text: &&str| value::range(text, comma).is_some() || value::calendar_ns(text).is_some();
        let is_word = |text: &&str| !text.contains([',', ';', '\t', '|', ':', '=']);
        let clean = cells().filter(is_clean).count() as f64;
        let words = cells().filter(|text| !is_clean(text) && is_word(text)).count() as f64;
        let share = usual.len() as f64 / total as f64;
        let score = share * (clean + 0.5 * words) / cells().count().max(1) as f64;
        // A table is still a table if some lines do not fit.
        if score > best.0 + 1e-9 {
            best = (score, separator, comma);
        }
    }
    (Shape::Separated(best.1), best.2)
}

/// The most frequent number.
pub(super) fn usual(numbers: impl Iterator<Item = usize>) -> usize {
    let mut counts = BTreeMap::new();
    numbers.for_each(|number| *counts.entry(number).or_insert(0) += 1);
    counts.into_iter().max_by_key(|&(number, count)| (count, number)).map_or(0, |(number, _)| number)
}
