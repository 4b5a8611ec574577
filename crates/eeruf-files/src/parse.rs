//! Parsing of TOML, with errors that name the line, the key, the value and the expected one.

use std::fmt;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::FileError;
use crate::meant::meant;

/// Rust's type names, and the words that messages use for them.
const TYPES: [(&str, &str); 6] = [
    ("a sequence", "a list"),
    ("usize", "a whole number from 0 on"),
    ("u64", "a whole number from 0 on"),
    ("u32", "a whole number from 0 to 4294967295"),
    ("u8", "a whole number from 0 to 255"),
    ("f64", "a number"),
];
/// Keys whose values are lists or tables, with a sample of each.
const SAMPLES: [(&str, &str); 5] = [
    ("pose", "pose = { x_m = 0.0, y_m = 0.0, heading_deg = 45.0 }"),
    ("ring", "ring = { sensors = 8, spacing_deg = 45.0, radius_m = 0.1 }"),
    ("points_m", "points_m = [[0.0, 1.0], [2.0, 1.0]]"),
    ("poses", "poses = [{ x_m = 0.1, y_m = 0.0, heading_deg = 45.0 }, ..]"),
    ("sensors", "a list; a robot's number of sensors stands in its `ring = { sensors = 8, .. }`"),
];
/// Endings of keys, and the units they stand for.
const UNITS: [(&str, &str); 5] =
    [("_us", "microseconds"), ("_deg", "degrees"), ("_m_s", "metres per second"), ("_m", "metres"), ("_db", "dB")];

/// Reads a TOML text.
///
/// # Errors
/// The first error, with its line and key.
///
/// ```
/// #[derive(Debug, serde::Deserialize)]
/// struct Ring { sensors: usize }
/// let error = eeruf_files::parse::<Ring>("# a ring\nsensors = -4").unwrap_err();
/// assert_eq!(error.to_string(), "line 2: sensors: integer `-4`; expected a whole number from 0 on");
/// # let _ = |ring: Ring| ring.sensors;
/// ```
pub fn parse<T: DeserializeOwned>(text: &str) -> Result<T, FileError> {
    toml::from_str(text).map_err(|error| {
        let span = error.span();
        let line = span.as_ref().map(|span| line_at(text, span.start));
        let table = DeTable::parse(text).ok();
        let key = span.as_ref().and_then(|span| key_at(table.as_ref()?.get_ref(), span.start));
        let found = span.and_then(|span| text.get(span)).unwrap_or_default();
        let of_line = line.and_then(|line| text.lines().nth(line as usize - 1)).unwrap_or_default();
        let not_toml = || if table.is_none() { syntax(of_line, error.message()) } else { empty(text) };
        FileError::in_text(not_toml().unwrap_or_else(|| message(key, found, error.message()))).at_line(line)
    })
}

/// Returns the error for an empty text.
fn empty(text: &str) -> Option<String> {
    let is_empty = text.lines().all(|line| line.trim().is_empty() || line.trim().starts_with('#'));
    is_empty.then(|| "empty; expected lines such as `sensors = 8`; `eeruf examples .` writes files".to_owned())
}

/// Returns the likely mistake in a line that is not TOML.
fn syntax(line: &str, error: &str) -> Option<String> {
    const QUOTES: [char; 8] =
        ['\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}', '\u{201a}', '\u{ab}', '\u{bb}'];
    let line = line.trim();
    let is_key = |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "_-\"".contains(c));
    let of = |mark| line.split_once(mark).map(|(key, value): (&str, &str)| (key.trim(), value.trim()));
    let plain = |word: &str| word.trim_end_matches(',').trim_matches('"').to_owned();
    if let Some(quote) = line.chars().find(|c| QUOTES.contains(c)) {
        return Some(format!("{quote}: a typographic quote; expected straight ones: {}", line.replace(QUOTES, "\"")));
    }
    if line.starts_with(['{', '}']) {
        return Some("JSON; expected TOML: a line `key = value` for each key, without braces".to_owned());
    }
    if let Some((key, value)) = of(':').filter(|(key, _)| is_key(key)) {
        let value = if value.is_empty() { ".." } else { value.trim_end_matches(',') };
        return Some(format!("{key}: a colon; expected `{} = {value}`", plain(key)));
    }
    let (key, value) = of('=')?;
    match error {
        _ if !key.is_ascii() => {
            Some(format!("{key}: a letter beyond z; expected a key of a to z, digits, `-` and `_`"))
        }
        _ if value.ends_with(',') => Some(format!("{key}: a comma after the value; expected the end of the line")),
        _ if error.starts_with("string values must be quoted") => {
            let is_yes = ["yes", "no", "on", "off", "True", "False"].contains(&value);
            let expected = if is_yes { "true or false".to_owned() } else { format!("quotes: {key} = \"{value}\"") };
            Some(format!("{key}: {value}; expected {expected}"))
        }
        _ => None,
    }
}

/// Reads a TOML text and passes it to a builder.
///
/// # Errors
/// The error of [`parse`], or the builder's message, at the line of the first key that it names.
///
/// ```
/// #[derive(serde::Deserialize)]
/// struct Ring { tick_us: u32 }
/// let positive = |ring: Ring| if ring.tick_us > 0 { Ok(ring) } else { Err("a tick of 0 us; expected 1 or more") };
/// let error = eeruf_files::build("# a ring\ntick_us = 0", positive).err().unwrap();
/// assert_eq!(error.to_string(), "line 2: a tick of 0 us; expected 1 or more");
/// ```
pub fn build<T: DeserializeOwned, B, E: fmt::Display>(
    text: &str,
    builder: impl FnOnce(T) -> Result<B, E>,
) -> Result<B, FileError> {
    builder(parse(text)?).map_err(|error| {
        let message = error.to_string();
        let line = DeTable::parse(text).ok().and_then(|table| {
            let keys: Vec<_> = table.get_ref().keys().map(|key| (key.get_ref().as_ref(), key.span().start)).collect();
            let is_named = |key: &str, word: &str| key == word || key.strip_suffix("_us") == Some(word);
            let found = message.split("; expected").next().unwrap_or_default();
            let mut words = found.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            words.find_map(|word| keys.iter().find(|(key, _)| is_named(key, word)).map(|(_, at)| line_at(text, *at)))
        });
        FileError::in_text(message).at_line(line)
    })
}

/// Returns the line of a byte, counted from 1.
pub(crate) fn line_at(text: &str, byte: usize) -> u64 {
    1 + text.get(..byte).map_or(0, |before| before.matches('\n').count() as u64)
}

/// Returns the error in a TOML value that was parsed before, as `thing: value; expected X`.
pub fn explain(error: &toml::de::Error) -> String {
    message(None, "", error.message())
}

/// Returns the error in a JSON text from its parser's message, `what at line N column M`.
///
/// ```
/// let error = eeruf_files::explain_json("missing field `period_us` at line 1 column 2");
/// assert_eq!(error.to_string(), "line 1: period_us: missing; expected `period_us = ..`");
/// ```
pub fn explain_json(error: &str) -> FileError {
    let (what, at) = error.rsplit_once(" at line ").unwrap_or((error, ""));
    let line = at.split(' ').next().and_then(|line| line.parse().ok());
    FileError::in_text(message(None, "", what).replace("expected TOML", "expected JSON")).at_line(line)
}

/// Returns the key whose value is at a byte of the text.
fn key_at<'a>(table: &'a DeTable<'_>, at: usize) -> Option<&'a str> {
    table.iter().find_map(|(key, value)| in_value(key.get_ref(), value, at))
}

fn in_value<'a>(key: &'a str, value: &'a Spanned<DeValue<'_>>, at: usize) -> Option<&'a str> {
    let span = value.span();
    match value.get_ref() {
        // The span of a table may end with its header.
        DeValue::Table(table) => key_at(table, at).or_else(|| (span.start == at).then_some(key)),
        DeValue::Array(array) => {
            let within = array.iter().find_map(|value| in_value(key, value, at));
            within.or_else(|| span.contains(&at).then_some(key))
        }
        _ => span.contains(&at).then_some(key),
    }
}

/// Rewrites the parser's message as `thing: value; expected X`.
fn message(key: Option<&str>, found: &str, error: &str) -> String {
    let bare = |name: &str| name.trim_matches('`').to_owned();
    if let Some((name, keys)) = error.strip_prefix("unknown field ").and_then(|rest| rest.split_once(", ")) {
        let name = bare(name);
        if let Some(known) = meant(&name, keys.split('`').skip(1).step_by(2)) {
            let unit = UNITS.iter().find(|(ending, _)| known.ends_with(ending)).filter(|of| !name.ends_with(of.0));
            let unit = unit.map_or(String::new(), |(_, unit)| format!(", in {unit}"));
            return format!("{name}: unknown key; did you mean `{known}`{unit}?");
        }
        return format!("{name}: unknown key; {}", keys.replace("there are no fields", "expected none"));
    }
    if error == "duplicate key" {
        return format!("{found}: set twice; expected each key once");
    }
    if let Some(name) = error.strip_prefix("missing field ") {
        let place = key.map_or(String::new(), |key| format!(" in {key}"));
        return format!("{0}: missing{place}; expected `{0} = ..`", bare(name));
    }
    // If a value fits none of several types, the parser names only the types.
    if let Some(expected) = error.strip_prefix("expected ").filter(|_| !found.is_empty() && !found.contains('\n')) {
        return format!("{}`{found}`; expected {expected}", key.map_or(String::new(), |key| format!("{key}: ")));
    }
    let error = ["invalid type: ", "invalid value: ", "invalid ", "unknown variant "]
        .into_iter()
        .find_map(|kind| error.strip_prefix(kind))
        .filter(|_| key.is_some() || error.contains(", expected "))
        .unwrap_or(error);
    let (found, expected) = error.rsplit_once(", expected ").unwrap_or((error, ""));
    let found = found.strip_suffix(" as i128").or(found.strip_suffix(" as u128")).unwrap_or(found);
    if let Some(key) = key.filter(|_| (found, expected) == ("map", "a sequence")) {
        return format!("{key}: one table; expected a list of them, each below `[[{key}]]`");
    }
    let is_structure =
        ["struct ", "a sequence", "an array of ", "a tuple of "].iter().any(|of| expected.starts_with(of));
    if let Some((key, sample)) = SAMPLES.iter().find(|of| key == Some(of.0) && is_structure) {
        let found = found.strip_prefix("length ").map_or(found.to_owned(), |count| format!("a list of {count}"));
        return format!("{key}: {found}; expected {sample}");
    }
    let expected = TYPES.iter().find(|(name, _)| *name == expected).map_or(expected, |(_, words)| words);
    let values = ["an array of length ", "a tuple of size "].iter().find_map(|list| expected.strip_prefix(list));
    let values = values.map(|count| format!("{count} values"));
    let expected = values.as_deref().unwrap_or(if expected.starts_with("struct ") { "a table" } else { expected });
    let expected = match expected {
        "" if error.contains("expected ") => String::new(),
        "" => "; expected TOML".to_owned(),
        expected => format!("; expected {expected}"),
    };
    let key = key.map_or(String::new(), |key| format!("{key}: "));
    // A library's error about a value may already begin with its key.
    format!("{}{found}{expected}", if found.starts_with(&key) { "" } else { &key })
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::parse;

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "read by serde alone")]
    struct Ring {
        sensors: usize,
        layout: Option<Layout>,
        #[serde(default)]
        walls: Vec<Wall>,
    }

    #[derive(Debug, Deserialize)]
    #[serde(rename_all = "lowercase")]
    enum Layout {
        Line,
        Ring,
    }

    #[derive(Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    #[expect(dead_code, reason = "read by serde alone")]
    struct Wall {
        points_m: [f64; 2],
    }

    #[test]
    fn errors_name_line_key_value_and_expectation() {
        let cases = [
            ("sensors = -4", "line 1: sensors: integer `-4`; expected a whole number from 0 on"),
            ("sensors = \"4\"", "line 1: sensors: string \"4\"; expected a whole number from 0 on"),
            ("sensors = 4\nlayout = \"star\"", "line 2: layout: `star`; expected `line` or `ring`"),
            ("", "line 1: empty; expected lines such as `sensors = 8`; `eeruf examples .` writes files"),
            ("layout = \"ring\"", "line 1: sensors: missing; expected `sensors = ..`"),
            ("sensor = 4", "line 1: sensor: unknown key; did you mean `sensors`?"),
            ("sensors = 4\nspeed = 3", "line 2: speed: unknown key; expected one of `sensors`, `layout`, `walls`"),
            ("sensors = 4\n[[walls]]\n", "line 2: points_m: missing in walls; expected `points_m = ..`"),
            ("sensors = 4\n[walls]", "line 2: walls: one table; expected a list of them, each below `[[walls]]`"),
            ("sensors = 4\nwalls = 3", "line 2: walls: integer `3`; expected a list"),
            (
                "sensors = 18446744073709551616",
                "line 1: sensors: integer `18446744073709551616`; expected a whole number from 0 on",
            ),
            ("sensors: 4", "line 1: sensors: a colon; expected `sensors = 4`"),
            ("{\"sensors\": 4}", "line 1: JSON; expected TOML: a line `key = value` for each key, without braces"),
            ("sensors = 4,", "line 1: sensors: a comma after the value; expected the end of the line"),
            ("layout = ring", "line 1: layout: ring; expected quotes: layout = \"ring\""),
            ("layout = yes", "line 1: layout: yes; expected true or false"),
            (
                "layout = \u{201c}ring\u{201d}",
                "line 1: \u{201c}: a typographic quote; expected straight ones: layout = \"ring\"",
            ),
            ("sensors = 4\n[[walls]]\npoints_m = [1, true]", "line 3: points_m: boolean `true`; expected a number"),
            (
                "sensors = 4\n[[walls]]\npoints_m = 1",
                "line 3: points_m: integer `1`; expected points_m = [[0.0, 1.0], [2.0, 1.0]]",
            ),
            ("sensors = 4\nsensors = 5", "line 2: sensors: set twice; expected each key once"),
            ("sensors", "line 1: key with no value; expected `=`"),
        ];
        for (text, expected) in cases {
            assert_eq!(parse::<Ring>(text).unwrap_err().to_string(), expected, "{text}");
        }
    }
}
