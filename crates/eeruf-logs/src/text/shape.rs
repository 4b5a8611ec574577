//! The shapes of a line, and its cells.

use serde_json::Value as Json;

use crate::names::{self, Meaning, meaning};
use crate::value;

/// The way in which a line is separated into cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Shape {
    Separated(Separator),
    /// Pairs: `left: 40, right: 80`.
    Keyed,
    #[default]
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Separator {
    Comma,
    Semicolon,
    Tab,
    Bar,
    Spaces,
    /// One cell for each line.
    None,
}

impl Separator {
    pub(crate) const ALL: [Self; 5] = [Self::Semicolon, Self::Tab, Self::Comma, Self::Bar, Self::Spaces];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Comma => "comma",
            Self::Semicolon => "semicolon",
            Self::Tab => "tab",
            Self::Bar => "vertical bar",
            Self::Spaces => "spaces",
            Self::None => "one value a line",
        }
    }

    const fn letter(self) -> Option<char> {
        Some(match self {
            Self::Comma => ',',
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Bar => '|',
            Self::Spaces | Self::None => return None,
        })
    }
}

/// Returns true for a line of dashes or other signs between rows or messages.
pub(super) fn is_rule(text: &str) -> bool {
    let text = text.trim();
    let is_of = |sign| text.contains(sign) && text.replace([sign, '+', '|'], "").is_empty();
    text.len() >= 3 && ['-', '=', '*', '_'].into_iter().any(is_of)
}

/// Returns true for the line between a header and its rows, as in `sqlite3`, `psql` and Markdown.
pub(super) fn is_underline(cells: &[String]) -> bool {
    let is_part = |cell: &String| cell.trim_matches([':', '+', '-', '=']).is_empty();
    cells.iter().all(is_part) && cells.iter().any(|cell| cell.contains("--") || cell.contains("=="))
}

/// A line without the brackets with which Python prints a list.
fn without_brackets(line: &str) -> &str {
    if line.starts_with(|letter: char| letter.is_ascii_digit()) {
        return line;
    }
    // A sentence of NMEA 0183.
    let sentence = line.strip_prefix('$').and_then(|line| line.rsplit_once('*'));
    if let Some((inner, _)) = sentence.filter(|(_, sum)| sum.len() == 2) {
        return inner;
    }
    let pairs = [('[', ']'), ('(', ')'), ('<', '>'), ('{', '}')];
    let inner = pairs.iter().find_map(|&(open, close)| line.strip_prefix(open)?.strip_suffix(close));
    // Python's tuple of one.
    let single = inner.and_then(|inner| inner.strip_suffix(',')).filter(|single| !single.contains(','));
    single.or(inner).unwrap_or(line)
}

/// A cell without the bracket of a list that begins or ends in it.
fn without_half_brackets(cell: &str) -> &str {
    match (cell.contains(['[', '(']), cell.contains([']', ')'])) {
        (true, false) => cell.trim_start_matches(['[', '(', ' ']),
        (false, true) => cell.trim_end_matches([']', ')', ' ']),
        _ => cell,
    }
}

/// The cells of a line, without quotes and surrounding spaces; `None` if a quote is not closed.
pub(crate) fn separated(line: &str, separator: Separator) -> Option<Vec<String>> {
    let line = without_brackets(line.trim_matches([' ', '\u{feff}']));
    let Some(letter) = separator.letter() else {
        return Some(match separator {
            Separator::Spaces => {
                let mut cells: Vec<String> = vec![];
                for cell in line.split_whitespace().map(|cell| cell.trim_matches('"').trim_end_matches([',', ';'])) {
                    // A unit belongs to the number before it.
                    match cells
                        .last_mut()
                        .filter(|last| value::unit(cell).is_some() && value::number(last, true).is_some())
                    {
                        Some(last) => last.extend([" ", cell]),
                        None => cells.push(cell.to_owned()),
                    }
                }
                cells
            }
            _ => vec![line.trim().to_owned()],
        });
    };
    // A list in brackets after a number has more cells.
    let opens = |(at, open): &(usize, &str)| {
        let is_digit = |letter: Option<char>| letter.is_some_and(|letter| letter.is_ascii_digit());
        letter == ',' && is_digit(line[..*at].chars().last()) && is_digit(line[at + open.len()..].chars().next())
    };
    let has_brackets = line.as_bytes().iter().any(|byte| b"([)]".contains(byte));
    let inner = || line.match_indices(" (").chain(line.match_indices(" [")).find(opens);
    if let Some((at, open)) = has_brackets.then(inner).flatten() {
        return separated(&format!("{},{}", &line[..at], line[at + open.len()..].replace([')', ']'], "")), separator);
    }
    if !line.bytes().any(|byte| byte == b'"') {
        let plain = |cell: &str| if has_brackets { without_half_brackets(cell.trim()) } else { cell.trim() }.to_owned();
        // A list of one: cells are short.
        return Some(line.split([letter]).map(plain).collect());
    }
    let (mut cells, mut cell, mut is_quoted) = (vec![], String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(own) = letters.next() {
        match own {
            '"' if is_quoted && letters.peek() == Some(&'"') => cell.extend(letters.next()),
            '"' => is_quoted = !is_quoted,
            _ if own == letter && !is_quoted => cells.push(std::mem::take(&mut cell).trim().to_owned()),
            _ => cell.push(own),
        }
    }
    cells.push(cell.trim().to_owned());
    (!is_quoted).then_some(cells)
}

/// The pairs of a line: each value after a colon or an equals sign, with the words before it as its name; `None` if it
/// holds anything else.
///
/// Words before a name that are not part of it are ignored: a program, a decision, the number of a loop, the name of a
/// message around it.
pub(crate) fn keyed(line: &str) -> Option<Vec<(String, String)>> {
    const BETWEEN: [char; 6] = [',', ';', '|', '\t', ' ', '&'];
    // A colon of full width, as Chinese and Japanese have it; the sign between a value and its unit of a plotter.
    if line.contains(['\u{ff1a}', '\u{a7}']) {
        return keyed(&line.replace('\u{ff1a}', ":").replace('\u{a7}', " "));
    }
    if !line.contains([':', '=']) {
        if let Some(arrow) = ["<-", "->"].into_iter().find(|arrow| line.contains(arrow)) {
            return keyed(&line.replace(arrow, "="));
        }
        return glued(line).or_else(|| sentence(line));
    }
    let dict = line.trim().trim_start_matches("- ").strip_prefix('{').and_then(|inner| inner.strip_suffix('}'));
    let (mut rest, mut pairs, mut heading) = (dict.unwrap_or(line), vec![], "");
    let mut unit_at_end = None;
    while let Some(at) = rest.find([':', '=']) {
        // A decoded message begins after it.
        if let Some(after) = rest[at..].strip_prefix("::") {
            rest = after;
            continue;
        }
        let is_equal = rest[at..].starts_with('=');
        let key = if dict.is_some() {
            rest[..at].trim_matches(BETWEEN).trim_matches(['\'', '"'])
        } else {
            name_in(rest[..at].trim_matches(BETWEEN), is_equal)
        };
        if key.is_empty() || key.chars().count() > 40 {
            return None;
        }
        let after = &rest[at + 1..];
        // `sonar: left=34`; each of several headings is a part of the names below it.
        let inner = after.split_once([':', '=']).map_or("", |(name, _)| name.trim_start());
        let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
        if !is_equal && inner.starts_with(char::is_alphabetic) && inner.chars().all(is_name) {
            let is_own = names::is_place(key) || key.contains(|letter: char| letter == '/' || letter.is_ascii_digit());
            heading = if is_own || after.contains(':') || !pairs.is_empty() { key } else { "" };
            rest = after;
            continue;
        }
        let after =
            after.strip_prefix(['=', '>']).filter(|_| is_equal).unwrap_or(after).trim_start_matches([' ', '\t']);
        // A list gives a value for each place.
        if let Some((list, left)) = after.strip_prefix('[').and_then(|list| list.split_once(']')) {
            let places = list.split(',').map(str::trim).enumerate();
            pairs.extend(places.map(|(n, text)| (format!("{key}[{n}]"), text.to_owned())));
            rest = left;
            continue;
        }
        let phrase = ["out of range", "no echo", "time out"]
            .iter()
            .find(|phrase| after.get(..phrase.len()).is_some_and(|start| start.eq_ignore_ascii_case(phrase)));
        let quoted = after.strip_prefix('"').and_then(|inner| inner.find('"'));
        let mut end = match phrase {
            _ if let Some(length) = quoted => length + 2,
            Some(phrase) => phrase.len(),
            None => after.find([',', ';', '|', '\t', ' ', '&', ')', ']']).unwrap_or(after.len()),
        };
        // A decimal comma.
        if after[end..].starts_with(',') && after[..end].bytes().all(|byte| byte.is_ascii_digit()) {
            let digits = after[end + 1..].bytes().take_while(u8::is_ascii_digit).count();
            let next = after[end + 1 + digits..].chars().next();
            if digits > 0 && end > 0 && next.is_none_or(|letter| BETWEEN.contains(&letter)) {
                end += 1 + digits;
            }
        }
        let mut text = after[..end].trim_matches('"').to_owned();
        rest = &after[end..];
        // A plotter's instant before the value.
        if let Some((instant, own)) = text.split_once(':').filter(|(instant, _)| is_instant(instant)) {
            pairs.push(("timestamp".to_owned(), instant.to_owned()));
            text = own.to_owned();
        }
        if text.contains(':') && value::calendar_ns(&text).is_none() {
            return None;
        }
        // A unit after a space.
        let spaced = rest.trim_start_matches(' ');
        let word = &spaced[..spaced.find(BETWEEN).unwrap_or(spaced.len())];
        let follows = spaced[word.len()..].trim_start().chars().next();
        let is_key = word.contains([':', '=']) || follows.is_some_and(|letter| letter == ':' || letter == '=');
        // The unit of another quantity, as in `21.5 C`.
        let is_unit = value::unit(word).is_some() || word.starts_with('%') || (1..=4).contains(&word.len());
        let begins = word.starts_with(|letter: char| letter.is_alphabetic() || "%\"\u{b0}\u{b5}".contains(letter));
        let is_unit = is_unit && begins && !word.contains(|letter: char| letter.is_ascii_digit() || letter == '(');
        if !is_key && !text.is_empty() && value::range(&text, true).is_some() && is_unit {
            text = format!("{text} {}", word.trim_end_matches([')', ']']));
            rest = &spaced[word.len()..];
        }
        // The suffix of whole numbers in line protocol.
        if let Some(digits) = text.strip_suffix('i').filter(|digits| is_equal && digits.parse::<i64>().is_ok()) {
            text.truncate(digits.len());
        }
        // A remark, such as the same range in another unit.
        let mut owner = "";
        if let Some((remark, after)) = rest.trim_start().strip_prefix('(').and_then(|remark| remark.split_once(')')) {
            rest = after;
            if names::is_owner(remark) {
                owner = remark;
            }
            unit_at_end = value::unit(remark).map(|_| remark);
        }
        // A number before `=`, or before a value with a unit, is a sensor's; before anything else a part of a time.
        let is_number = key.len() <= 2 && key.bytes().all(|byte| byte.is_ascii_digit());
        let is_named = key.chars().any(char::is_alphabetic);
        if !is_named && !(is_number && (is_equal || value::with_unit(&text, true)?.1.is_some())) {
            return None;
        }
        pairs.push((format!("{heading} {key} {owner}").trim().to_owned(), text));
    }
    // `left=342 right=1201 (mm)`
    if let Some(unit) = unit_at_end {
        let is_length = |name: &str| matches!(meaning(name), Meaning::Range | Meaning::Vague);
        let of = pairs.iter_mut().filter(|(name, text)| value::number(text, true).is_some() && is_length(name));
        of.for_each(|(_, text)| text.extend([" ", unit]));
    }
    // A time series' instant after the values.
    if let Some(instant) = Some(rest.trim()).filter(|rest| is_instant(rest) && !pairs.is_empty()) {
        pairs.push(("timestamp".to_owned(), instant.to_owned()));
        rest = "";
    }
    let has_unit = |text: &str| value::with_unit(text, true).is_some_and(|(_, unit)| unit.is_some());
    let is_text = |text: &str| text.len() > 2 && text.chars().all(char::is_alphabetic);
    let is_word = pairs.last().is_some_and(|(_, text)| is_text(text) || has_unit(text));
    let is_said =
        (is_word || rest.trim_start().starts_with("->")) && !rest.contains(|letter: char| letter.is_ascii_digit());
    (!pairs.is_empty() && (is_said || !rest.contains(char::is_alphanumeric))).then_some(pairs)
}

/// Returns true for milli-, micro- or nanoseconds since 1970.
fn is_instant(text: &str) -> bool {
    (13..=19).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The name at the end of the text between two values.
fn name_in(before: &str, is_equal: bool) -> &str {
    if before.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') {
        return before;
    }
    let mut name = before;
    for open in ['(', '[', '{'] {
        let close = if open == '(' { ')' } else { (open as u8 + 2) as char };
        // Brackets that are still open surround the name.
        if let Some(at) = name.rfind(open).filter(|&at| !name[at..].contains(close)) {
            name = &name[at + 1..];
        }
    }
    let is_decided = ["->", "=>", "<"].iter().any(|arrow| name.contains(arrow));
    for mark in ["->", "=>", "<", " - ", "|", ",", ";", "\t", "> "] {
        name = name.rsplit_once(mark).map_or(name, |(_, last)| last);
    }
    let name = name.trim_start_matches(['>', '*', '-', ']', ' ']).trim_end();
    match name.split(' ').collect::<Vec<_>>()[..] {
        // `-> LEFT ML=180`, `<reading t="1"`, `loop 17 t=1200`
        [_, last] if is_equal && is_decided => last,
        [_, number, last] if value::number(number, false).is_some() => last,
        _ => name,
    }
}

/// The pair of a sentence that ends with a range and its unit: `Distance to nearest object is 0.4 m`.
fn sentence(line: &str) -> Option<Vec<(String, String)>> {
    let at = line.find(|letter: char| letter.is_ascii_digit())?;
    let (name, text) = (line[..at].trim_end_matches(['-', '+', ' ']), line[at..].trim_end_matches('.'));
    let is_name = |word: &str| word.len() > 1 && word.chars().all(char::is_alphabetic);
    let (_, unit) = value::with_unit(text, false)?;
    let is_sentence = name.split(' ').count() > 1 && name.split(' ').all(is_name) && line[..at].ends_with(' ');
    (is_sentence && unit.is_some() && name.len() <= 40).then(|| vec![(name.to_owned(), text.to_owned())])
}

/// The pairs of a line of names with values directly after them, such as `F40 L80` or `R0756`.
fn glued(line: &str) -> Option<Vec<(String, String)>> {
    let mut pairs: Vec<(String, String)> = vec![];
    for cell in line.split([' ', '\t', ',', ';']).filter(|cell| !cell.is_empty()) {
        let (name, text) = cell.split_at(cell.find(|letter: char| letter.is_ascii_digit())?);
        let is_name = (1..=8).contains(&name.len()) && name.bytes().all(|byte| byte.is_ascii_alphabetic());
        if !is_name || pairs.iter().any(|(known, _)| known == name) || value::with_unit(text, false).is_none() {
            return None;
        }
        pairs.push((name.to_owned(), text.to_owned()));
    }
    (!pairs.is_empty()).then_some(pairs)
}

/// The values of a JSON object by path, or of an array by place; `None` for anything else.
fn json(text: &str) -> Option<Vec<(String, String)>> {
    // Python writes numbers that JSON does not have.
    let plain = || text.replace("-Infinity", "null").replace("Infinity", "null").replace("NaN", "null");
    let found = serde_json::from_str(text.trim()).or_else(|_| serde_json::from_str(plain().trim()));
    let found: Json = found.ok()?;
    let mut pairs = vec![];
    match found {
        Json::Object(_) => flatten("", &found, &mut pairs),
        Json::Array(cells) => (1..).zip(&cells).for_each(|(n, cell)| flatten(&format!("column {n}"), cell, &mut pairs)),
        _ => return None,
    }
    Some(pairs)
}

/// The pairs of an object; the text before it becomes `topic` if it is a path, as an MQTT client prints it, and
/// otherwise `before`.
pub(crate) fn object(text: &str) -> Option<Vec<(String, String)>> {
    let lead = text.find(['{', '[']).map_or("", |at| &text[..at]);
    let mut pairs = json(&text[lead.len()..])?;
    let lead = lead.trim_end_matches([' ', ':', '=', '\t']);
    let name = if lead.contains('/') { "topic" } else { "before" };
    if !lead.is_empty() && pairs.iter().all(|(known, _)| known != name) {
        pairs.insert(0, (name.to_owned(), lead.to_owned()));
    }
    Some(pairs)
}

fn flatten(path: &str, value: &Json, pairs: &mut Vec<(String, String)>) {
    /// Largest number of values of a ring.
    const MOST: usize = 4096;
    if pairs.len() >= MOST {
        return;
    }
    match value {
        Json::Object(fields) => {
            for (name, value) in fields {
                flatten(&if path.is_empty() { name.clone() } else { format!("{path}.{name}") }, value, pairs);
            }
        }
        Json::Array(cells) => {
            for (n, cell) in cells.iter().enumerate() {
                flatten(&format!("{path}[{n}]"), cell, pairs);
            }
        }
        Json::Null => pairs.push((path.to_owned(), "null".to_owned())),
        Json::String(text) => pairs.push((path.to_owned(), text.trim().to_owned())),
        other => pairs.push((path.to_owned(), other.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keyed_lines_give_pairs_and_nothing_else_does() {
        let pairs = |line: &str| {
            keyed(line).map(|pairs| pairs.iter().map(|(key, text)| format!("{key}|{text}")).collect::<Vec<_>>())
        };
        let some = |expected: &[&str]| Some(expected.iter().map(|&pair| pair.to_owned()).collect::<Vec<_>>());
        assert_eq!(pairs("left: 40 right: 80"), some(&["left|40", "right|80"]));
        assert_eq!(pairs("left:40,right:80"), some(&["left|40", "right|80"]));
        assert_eq!(pairs("Sensor 1: 40 cm, Sensor 2: 80cm"), some(&["Sensor 1|40 cm", "Sensor 2|80cm"]));
        assert_eq!(pairs("Ping: out of range"), some(&["Ping|out of range"]));
        assert_eq!(pairs("Range: 40 cm (sensor 3)"), some(&["Range sensor 3|40 cm"]));
        assert_eq!(pairs("range_mm=2157i,left=3 (in V)"), some(&["range_mm|2157", "left|3"]));
        assert_eq!(pairs("a=40,5 b=80,1"), some(&["a|40,5", "b|80,1"]));
        assert_eq!(pairs("left: "), some(&["left|"]));
        assert_eq!(pairs("0=79cm 1=119 cm"), some(&["0|79cm", "1|119 cm"]));
        assert_eq!(pairs("0: 79cm 1: out of range"), None);
        assert_eq!(pairs("{'t': 0.05, 'left': None}"), some(&["t|0.05", "left|None"]));
        let arrow = "Left: 34 Right: 65 -> FORWARD ML=180";
        assert_eq!(pairs(arrow), some(&["Left|34", "Right|65", "ML|180"]));
        assert_eq!(pairs("2A0 [2] 22 78 :: Sonar(Front: 34 cm)"), some(&["Front|34 cm"]));
        assert_eq!(pairs(">left:1700000000000:34\u{a7}cm"), some(&["timestamp|1700000000000", "left|34 cm"]));
        let lines =
            ["40,80", "12:00:01", "left: 40 of many", "hello", "left 40", "left 40 right 80", "left 40 left 80"];
        for line in lines.into_iter().chain(["sensor 1 40 cm", "0.1 left 40", "left right 40 80"]) {
            assert_eq!(pairs(line), None, "{line}");
        }
    }

    #[test]
    fn separated_lines_keep_what_is_quoted() {
        assert_eq!(separated("\"40,5\", 80 ", Separator::Comma).unwrap(), ["40,5", "80"]);
        assert_eq!(separated("[40, 80]", Separator::Comma).unwrap(), ["40", "80"]);
        assert_eq!(separated("left 40 cm right none", Separator::Spaces).unwrap(), ["left", "40 cm", "right", "none"]);
        assert_eq!(separated("(0.1, [40, 80])", Separator::Comma).unwrap(), ["0.1", "40", "80"]);
        assert_eq!(separated("t, left [cm]", Separator::Comma).unwrap(), ["t", "left [cm]"]);
        assert_eq!(separated("\"40,5, 80", Separator::Comma), None);
    }
}
