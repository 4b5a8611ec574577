//! Logs in which each line wraps a reading in a form of its own, rewritten into lines or objects that are read anyway.
//!
//! A line that seems to hold a reading and does not fit the form is damaged.

use std::collections::HashSet;

use serde_json::Value as Json;

use super::esphome::EspHome;
use super::groups::Groups;
use super::messages::written;
use super::sample::usual;
use crate::names::{self, Meaning};
use crate::value;

pub(super) enum Rewriter {
    EspHome(EspHome),
    Groups(Groups),
    /// Points of `InfluxDB`'s line protocol, and of Prometheus, by the digits of their times.
    Metrics(usize),
    /// Objects that hold a log's lines, as `journalctl -o json` and Docker write them.
    Messages,
    /// Lines of Teleplot, with or without times.
    Teleplot(bool),
    /// Docker Compose's lines of one service, each after its name and a bar.
    Compose(String),
}

/// Outcome of rewriting a line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Rewritten {
    /// Lines or objects; none for a comment.
    Lines(Vec<String>),
    /// It holds no reading.
    Nothing,
    /// It may hold a reading, and is damaged.
    Misfit,
}

impl Rewriter {
    /// The form of a text by its beginning, if it is one of these.
    pub(super) fn of(start: &str) -> Option<Self> {
        // The last one may not be whole, and the first may be cut.
        let whole = start.rsplit_once('\n').map_or(start, |(whole, _)| whole);
        let lines = whole.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        let lines: Vec<_> = lines.take(50).collect();
        let first = *lines.first()?;
        let is_most = |count: usize| count * 2 > lines.len();
        if let Some(groups) = Groups::of(&lines) {
            return Some(Self::Groups(groups));
        }
        if EspHome::is_in(start) {
            return Some(Self::EspHome(EspHome::default()));
        }
        let digits: Vec<_> = lines.iter().filter_map(|line| digits_of_time(&point(line)?)).collect();
        if is_most(digits.len()) {
            return Some(Self::Metrics(usual(digits.into_iter())));
        }
        if is_most(lines.iter().filter(|line| wrapped(line).is_some()).count()) {
            return Some(Self::Messages);
        }
        let pairs: Vec<_> = lines.iter().filter_map(|line| teleplot(line)).collect();
        if is_most(pairs.len()) {
            return Some(Self::Teleplot(pairs.iter().filter(|pair| pair.starts_with('[')).count() * 2 > pairs.len()));
        }
        let (name, _) = first.split_once("  | ").map(|(name, said)| (name.trim_end(), said))?;
        let is_name =
            name.rsplit_once('-').is_some_and(|(service, n)| !service.contains(' ') && n.parse::<u32>().is_ok());
        let name = format!("{name}  | ");
        (is_name && lines.iter().all(|line| line.starts_with(&name))).then_some(Self::Compose(name))
    }

    pub(super) const fn form(&self) -> &'static str {
        match self {
            Self::EspHome(_) => "ESPHome's log",
            Self::Groups(_) => "a table of many measurements a row",
            Self::Metrics(_) => "points of InfluxDB's line protocol or of Prometheus",
            Self::Messages => "JSON, an object around each line of a log",
            Self::Teleplot(_) => "lines of Teleplot",
            Self::Compose(_) => "the log of Docker Compose",
        }
    }

    pub(super) const fn gives_objects(&self) -> bool {
        matches!(self, Self::Metrics(_))
    }

    pub(super) fn rewrite(&mut self, line: &str) -> Rewritten {
        use Rewritten::{Lines, Misfit};
        let or_misfit = |text: Option<String>| text.map_or(Misfit, |text| Lines(vec![text]));
        match self {
            Self::EspHome(log) => log.rewrite(line),
            Self::Groups(groups) => groups.rewrite(line),
            Self::Metrics(_) if line.trim().is_empty() || line.starts_with('#') => Lines(vec![]),
            Self::Metrics(digits) => {
                let values = point(line).filter(|values| digits_of_time(values) == Some(*digits));
                or_misfit(values.map(|values| written(&values)))
            }
            Self::Messages => or_misfit(wrapped(line)),
            Self::Teleplot(has_time) if line.starts_with('>') => {
                let text = teleplot(line).filter(|text| text.starts_with('[') == *has_time);
                or_misfit(text)
            }
            Self::Teleplot(_) => Lines(vec![line.to_owned()]),
            Self::Compose(name) => Lines(vec![line.strip_prefix(name.as_str()).unwrap_or(line).to_owned()]),
        }
    }
}

/// A point as `sonar,sensor=front distance=40.1 1700000000000000000` or `range_meters{sensor="front"} 0.4 1700000000`.
fn point(line: &str) -> Option<Vec<(String, Json)>> {
    let line = line.trim();
    let mut values = vec![];
    let time = |text: &str| text.parse::<u64>().ok().filter(|_| text.len() >= 10).map(Json::from);
    if let Some((name, rest)) = line.split_once('{') {
        let is_name = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b':');
        let (labels, rest) = rest.split_once('}').filter(|_| is_name && !name.is_empty())?;
        values.extend(pairs(labels)?);
        let mut cells = rest.split_whitespace();
        let (number, at) = (cells.next()?, cells.next());
        let number = value::range(number, false).map(|_| number)?;
        values.push((name.to_owned(), number.parse::<f64>().map_or(Json::Null, Json::from)));
        if let Some(at) = at {
            values.push(("time".to_owned(), time(at)?));
        }
        return cells.next().is_none().then_some(values);
    }
    if line.contains('\\') {
        return None;
    }
    let (series, rest) = line.split_once(' ')?;
    let (measurement, tags) = series.split_once(',').unwrap_or((series, ""));
    if measurement.contains(['=', ':', '{', '"']) || !measurement.starts_with(char::is_alphabetic) {
        return None;
    }
    values.push(("topic".to_owned(), Json::from(measurement)));
    values.extend(pairs(tags)?);
    let (fields, at) =
        rest.rsplit_once(' ').filter(|(_, at)| time(at).is_some()).map_or((rest, None), |(a, b)| (a, Some(b)));
    let fields = pairs(fields).filter(|fields| !fields.is_empty())?;
    for (name, field) in fields {
        let Json::String(text) = field else { return None };
        let is_word = ["t", "T", "true", "True", "f", "F", "false", "False"].contains(&text.as_str());
        let number = value::number(text.trim_end_matches(['i', 'u']), false);
        values.push((name, number.map_or_else(|| Json::from(text.as_str()), Json::from)));
        if number.is_none() && !is_word && !line.contains(&format!("\"{text}\"")) {
            return None;
        }
    }
    values.extend(at.and_then(time).map(|at| ("time".to_owned(), at)));
    let mut known = HashSet::new();
    values.iter().all(|(name, _)| known.insert(name.clone())).then_some(values)
}

/// Digits of a point's time, of which a line that is cut has fewer.
fn digits_of_time(values: &[(String, Json)]) -> Option<usize> {
    let time = values.iter().find(|(name, _)| name == "time")?;
    Some(time.1.to_string().len())
}

/// Pairs of `name=value` parted by commas, the values with or without quotes.
fn pairs(text: &str) -> Option<Vec<(String, Json)>> {
    let (mut pairs, mut rest) = (vec![], text);
    while !rest.is_empty() {
        let (name, after) = rest.split_once('=')?;
        let (own, left) = match after.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"')?,
            None => after.split_at(after.find(',').unwrap_or(after.len())),
        };
        let is_name = !name.is_empty() && !name.contains([',', ' ', '"']);
        let is_end = left.is_empty() || (left.starts_with(',') && left.len() > 1);
        if !is_name || !is_end || own.is_empty() || (!after.starts_with('"') && own.contains([' ', '"', '='])) {
            return None;
        }
        pairs.push((name.to_owned(), Json::from(own)));
        rest = left.strip_prefix(',').unwrap_or(left);
    }
    Some(pairs)
}

/// The line of a log in an object, after its time.
fn wrapped(line: &str) -> Option<String> {
    const TEXTS: [&str; 4] = ["MESSAGE", "log", "message", "msg"];
    const TIMES: [&str; 5] = ["__REALTIME_TIMESTAMP", "time", "timestamp", "@timestamp", "ts"];
    let Json::Object(fields) = serde_json::from_str(line.trim()).ok()? else { return None };
    let own = TEXTS.iter().find_map(|name| fields.get(*name)?.as_str())?.trim();
    let is_range = |(name, value): (&String, &Json)| value.is_number() && names::meaning(name) == Meaning::Range;
    if !own.contains(|letter: char| letter.is_ascii_digit()) || own.contains('\n') || fields.iter().any(is_range) {
        return None;
    }
    let Some(time) = TIMES.iter().find_map(|name| fields.get(*name)) else { return Some(own.to_owned()) };
    let text = time.as_str().map_or_else(|| time.to_string(), str::to_owned);
    if value::calendar_ns(&text).is_some() {
        return Some(format!("[{text}] {own}"));
    }
    let seconds = value::number(&text, false).filter(|&number| number >= 0.0)?;
    let scale = [1e17, 1e14, 1e11].iter().position(|&least| seconds >= least).map_or(1.0, |n| [1e-9, 1e-6, 1e-3][n]);
    Some(format!("[{:.6}] {own}", seconds * scale))
}

/// A pair with its time before it, of `>name:value`, `>name:value\u{a7}unit` or `>name:milliseconds:value`.
fn teleplot(line: &str) -> Option<String> {
    let (pair, _) = line.strip_prefix('>')?.split_once('|').unwrap_or((line.strip_prefix('>')?, ""));
    let (pair, unit) = pair.split_once('\u{a7}').unwrap_or((pair, ""));
    let (name, values) = pair.split_once(':')?;
    let (ms, own) = values.split_once(':').map_or((None, values), |(ms, own)| (Some(ms), own));
    value::number(own, false).filter(|_| !name.is_empty())?;
    let own = format!("{name}: {own} {unit}");
    Some(match ms {
        Some(ms) => format!("[{:.6}] {own}", value::number(ms, false)? * 1e-3),
        None => own,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_lines_are_no_points_and_no_messages() {
        for line in ["left: 40 right: 80", "ring front=40.1", "left 40 right 80", "{\"left\":40}", "a=1,b=2 1700000000"]
        {
            assert!(Rewriter::of(line).is_none(), "{line}");
        }
        let range = "{\"time\":1.5,\"distance\":40,\"msg\":\"run 7\"}";
        assert!(Rewriter::of(range).is_none());
        for line in ["sonar distance=40.x 1700000000", "sonar distance= 1700000000", "sonar,a distance=4 1700000000"] {
            assert_eq!(point(line), None, "{line}");
        }
    }
}
