//! Rows with many measurements, each a group of columns: `Tms1;Lus1;Rus1;Tms2;..`, as bicycle sensors write them.

use super::lines::Rewritten;
use super::shape::{Separator, separated};
use crate::names::{self, Meaning};
use crate::value;

/// Number of groups below which the numbers are sensors.
const FEWEST: usize = 3;

/// The columns of a repeated group.
pub(super) struct Groups {
    separator: Separator,
    /// The column at which the first group begins.
    begin: usize,
    /// The names in a group, without their numbers.
    names: Vec<String>,
    groups: usize,
    /// The column with the time of the row in milliseconds, to which the times of the groups are added.
    time: Option<usize>,
    header: String,
    has_begun: bool,
    /// Largest number that is an echo, from a line before the header.
    most: Option<f64>,
}

/// A name and the number at its end.
fn numbered(name: &str) -> Option<(&str, usize)> {
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    Some((stem, name[stem.len()..].parse().ok()?))
}

/// Returns true for the time of a group: `T`, `Tms`, `time`.
fn is_time(name: &str) -> bool {
    let rest = name.strip_prefix(['T', 't']).unwrap_or(name);
    rest.is_empty() || ["ms", "us", "s"].contains(&rest) || names::meaning(name) == Meaning::Time
}

/// A name with its unit as a separate word: `L_us` for `Lus`.
fn parted(name: &str) -> String {
    let unit = ["us", "cm", "mm"].into_iter().find_map(|unit| Some((name.strip_suffix(unit)?, unit)));
    match unit.filter(|(stem, _)| stem.ends_with(|letter: char| letter.is_uppercase())) {
        Some((stem, unit)) => format!("{stem}_{unit}"),
        None => name.to_owned(),
    }
}

impl Groups {
    /// Groups from the first lines.
    pub(super) fn of(lines: &[&str]) -> Option<Self> {
        let found = |line: &&str| {
            let separators = [Separator::Semicolon, Separator::Comma, Separator::Tab];
            separators.into_iter().find_map(|separator| Self::of_header(line, separator))
        };
        let (at, mut found) = lines.iter().take(5).enumerate().find_map(|(at, line)| Some((at, found(line)?)))?;
        let limit = |pair: &str| {
            let (name, number) = pair.split_once('=')?;
            let name = name.to_lowercase();
            (name.starts_with("max") && name.contains("valid")).then(|| value::number(number, false))?
        };
        found.most = lines[..at].iter().flat_map(|line| line.split('&')).find_map(limit);
        Some(found)
    }

    fn of_header(line: &str, separator: Separator) -> Option<Self> {
        let cells = separated(line, separator)?;
        let begin = cells.iter().position(|name| numbered(name).is_some_and(|(_, number)| number == 1))?;
        let names: Vec<_> = cells[begin..].iter().map_while(|name| numbered(name).filter(|of| of.1 == 1)).collect();
        let names: Vec<_> = names.into_iter().map(|(name, _)| name.to_owned()).collect();
        let is_group = |(n, group): (usize, &[String])| {
            let fits = |(own, name): (&String, &String)| numbered(own) == Some((name, n + 1));
            group.len() == names.len() && group.iter().zip(&names).all(fits)
        };
        let groups = cells[begin..].chunks(names.len()).enumerate().take_while(|&group| is_group(group)).count();
        if groups < FEWEST || names.len() < 2 || !is_time(&names[0]) {
            return None;
        }
        let ms = |name: &String| ["millis", "ms"].contains(&name.to_lowercase().as_str());
        let time = cells[..begin].iter().position(ms);
        let header = ["t_ms".to_owned()].into_iter().chain(names[1..].iter().map(|name| parted(name)));
        let header = header.collect::<Vec<_>>().join(";");
        Some(Self { separator, begin, names, groups, time, header, has_begun: false, most: None })
    }

    pub(super) fn rewrite(&mut self, line: &str) -> Rewritten {
        let Some(cells) = separated(line, self.separator) else { return Rewritten::Misfit };
        if !self.has_begun {
            self.has_begun = numbered(cells.get(self.begin).map_or("", String::as_str)).is_some_and(|of| of.1 == 1);
            return if self.has_begun { Rewritten::Lines(vec![self.header.clone()]) } else { Rewritten::Nothing };
        }
        let number = |cell: &String| value::number(cell, false);
        let Some(base) = self.time.map_or(Some(0.0), |at| number(cells.get(at)?)) else { return Rewritten::Misfit };
        let groups = cells.get(self.begin..).unwrap_or_default().chunks(self.names.len()).take(self.groups);
        let row = |group: &[String]| {
            let at = base + number(group.first()?)?;
            let range = |cell: &String| match number(cell) {
                // It was not measured this time.
                None if cell.is_empty() => "unavailable".to_owned(),
                Some(us) if self.most.is_some_and(|most| us > most) => "inf".to_owned(),
                _ => cell.clone(),
            };
            let ranges: Vec<_> = group[1..].iter().map(range).collect();
            (ranges.len() + 1 == self.names.len()).then(|| format!("{at};{}", ranges.join(";")))
        };
        Rewritten::Lines(groups.filter_map(row).collect())
    }
}
