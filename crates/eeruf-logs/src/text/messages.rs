//! Messages as `ros2 topic echo` and `rostopic echo` print them: maps by indentation, each ended by a line `---`; and
//! blocks of `name: value`, each ended by a blank line or begun by `###`.

use std::collections::BTreeSet;
use std::io;

use serde_json::Value as Json;

use super::lines::{Line, Lines};
use crate::value;

/// Length of text above which a message is dropped.
const LONGEST: usize = 1 << 20;

/// The mark that ends a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Rule,
    Blank,
}

impl End {
    /// Finds the mark from the beginning of a text: a line that ends the keys and list elements, or blank lines between
    /// blocks with the same two or more keys.
    pub(super) fn of(start: &str) -> Option<Self> {
        let is_plain = |key: &str| key.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let is_key = |line: &&str| entry(line).is_some_and(|(key, _)| line.starts_with(key) && is_plain(key));
        let lines = start.lines().filter(|line| !line.trim().is_empty()).skip_while(|line| !is_key(line));
        let mut lines = lines.skip_while(|line| is_part(line) && !is_numbered(line)).peekable();
        if lines.peek().is_some_and(|line| line.trim_end() == "---") {
            return Some(Self::Rule);
        }
        let lines: Vec<_> = start.lines().collect();
        let keys =
            |block: &[&str]| block.iter().map(|line| Some(entry(line)?.0.to_owned())).collect::<Option<Vec<_>>>();
        let blocks = lines.split(|line| Self::Blank.is_at(line)).filter(|block| !block.is_empty()).take(4).map(keys);
        let blocks: Vec<_> = blocks.collect();
        let is_one =
            |two: &[Option<Vec<String>>]| two[0] == two[1] && two[0].as_ref().is_some_and(|keys| keys.len() > 1);
        blocks.windows(2).any(is_one).then_some(Self::Blank)
    }

    fn is_at(self, line: &str) -> bool {
        match self {
            Self::Rule => line.trim_end() == "---",
            Self::Blank => line.trim().is_empty() || line.starts_with("###"),
        }
    }
}

/// Returns true for a key that ends with its own number, as a sensor's does and a field's does not.
fn is_numbered(line: &str) -> bool {
    entry(line).is_some_and(|(key, _)| key.contains(' '))
}

/// The next message, as a JSON object of its values by their paths. A message that is damaged, or that has no end and
/// may be cut, remains text.
pub(super) fn next(lines: &mut Lines<'_>, end: End) -> io::Result<Option<Line>> {
    let (mut message, mut first, mut bytes, mut is_ended) = (vec![], 0, 0, false);
    while let Some(line) = lines.next()? {
        if end.is_at(&line.text) {
            if message.is_empty() {
                continue;
            }
            is_ended = true;
            break;
        }
        if message.is_empty() {
            first = line.number;
        }
        bytes += line.text.len();
        // The last block of a file needs no blank line.
        is_ended = end == End::Blank && line.is_ended;
        if bytes <= LONGEST && !line.text.trim().is_empty() {
            message.push(line.text);
        }
    }
    if message.is_empty() {
        return Ok(None);
    }
    let values = if is_ended { object(&message) } else { None };
    let text = values.map_or_else(|| message.join("\n"), |values| written(&values));
    Ok(Some(Line { number: first, text, is_ended, is_too_long: bytes > LONGEST, is_misfit: false }))
}

/// The key and the rest of a line `key: value` or `key:`.
fn entry(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.trim().split_once(':')?;
    let is_key = key.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && key.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_ ()[]".contains(&byte));
    (is_key && (value.is_empty() || value.starts_with(' '))).then_some((key, value.trim()))
}

/// Returns true for a line that can be part of a message.
fn is_part(line: &str) -> bool {
    entry(line).is_some() || line.trim_start().starts_with("- ")
}

/// The values of a message; `None` if a line has no key or a key occurs twice, as when the line between two messages is
/// lost.
fn object(message: &[String]) -> Option<Vec<(String, Json)>> {
    let mut values = vec![];
    let mut paths = BTreeSet::new();
    // Keys that are open, each with its indentation, and the number of elements of a list below it.
    let mut open: Vec<(usize, String, usize)> = vec![];
    for line in message {
        if !is_part(line) {
            return None;
        }
        let indentation = line.len() - line.trim_start().len();
        let (element, rest) = match line.trim_start().strip_prefix("- ") {
            Some(rest) => (true, rest.trim()),
            None => (false, line.trim()),
        };
        // An element of a list may stand below its key without indentation.
        open.retain(|(at, ..)| *at < indentation || (element && *at == indentation));
        let path = |open: &[(usize, String, usize)]| open.last().map_or(String::new(), |(_, path, _)| path.clone());
        let mut parent = path(&open);
        if element && let Some((_, list, n)) = open.last_mut() {
            parent = format!("{list}[{n}]");
            *n += 1;
            open.push((indentation + 1, parent.clone(), 0));
        }
        let (path, text) = match entry(rest) {
            Some((key, text)) => {
                let path = if parent.is_empty() { key.to_owned() } else { format!("{parent}.{key}") };
                open.push((indentation + 2 * usize::from(element), path.clone(), 0));
                (path, text)
            }
            None => (parent, rest),
        };
        if !text.is_empty() {
            if !paths.insert(path.clone()) {
                return None;
            }
            values.push((path, scalar(text)));
        }
    }
    Some(values)
}

/// Values by their paths as a JSON object, in their order.
fn written(values: &[(String, Json)]) -> String {
    let fields: Vec<_> = values.iter().map(|(path, value)| format!("{}:{value}", Json::from(path.as_str()))).collect();
    format!("{{{}}}", fields.join(","))
}

/// A value: a list in brackets, a number, or text without quotes and without the dot before `inf` and `nan`.
fn scalar(text: &str) -> Json {
    // The meaning of a number, as a comment.
    let text = text.split_once(" # ").map_or(text, |(number, _)| number.trim_end());
    let is_parsed = text.starts_with('[') || value::number(text, false).is_some();
    let parsed = if is_parsed { serde_json::from_str(text).ok() } else { None };
    parsed.unwrap_or_else(|| {
        let plain = text.trim_matches(['\'', '"']);
        let is_word = ["inf", "nan"].iter().any(|word| plain.to_lowercase().ends_with(word));
        Json::String(if is_word { plain.replacen('.', "", 1) } else { plain.to_owned() })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_becomes_its_values_by_their_paths() {
        let message = "header:\n  stamp:\n    sec: 7\n    nanosec: 50\n  frame_id: us_1\nrange: .inf\n\
                       ranges:\n- 0.5\n- 1.5\n\
                       data: [1, 2]\nlist:\n- a: 1\n  b: 2\n- a: 3\nname: ''";
        let lines: Vec<_> = message.lines().map(str::to_owned).collect();
        let expected = serde_json::json!({
            "header.stamp.sec": 7, "header.stamp.nanosec": 50, "header.frame_id": "us_1", "range": "inf",
            "ranges[0]": 0.5, "ranges[1]": 1.5, "data": [1, 2], "list[0].a": 1, "list[0].b": 2, "list[1].a": 3,
            "name": "",
        });
        let values = object(&lines).unwrap();
        assert_eq!(serde_json::from_str::<Json>(&written(&values)).unwrap(), expected);
        assert_eq!(values[0].0, "header.stamp.sec");
        for damaged in ["range: 0.5\nrange: 0.6", "frame_id: a\nra", "range: 0.5\n- 1\n- 2\n 7"] {
            let lines: Vec<_> = damaged.lines().map(str::to_owned).collect();
            assert_eq!(object(&lines), None, "{damaged}");
        }
    }

    #[test]
    fn text_is_messages_only_with_a_line_that_ends_one() {
        assert_eq!(End::of("range: 0.5\n---\nrange: 0.6\n"), Some(End::Rule));
        assert_eq!(End::of("\nheader: \n  seq: 1\n---\n"), Some(End::Rule));
        assert_eq!(End::of("### 1\nid: 0\nrange: 1\n\n### 2\nid: 1\nrange: 2\n\n### 3\nid: 0\n"), Some(End::Blank));
        for text in [
            "range: 0.5\nrange: 0.6\n",
            "left,right\n---\n",
            "{\"a\": 1}\n---\n",
            "12:00:01 -> 4\n---\n",
            "run: 1\nSensor 1: 4 cm\n---\n",
        ] {
            assert_eq!(End::of(text), None, "{text}");
        }
    }
}
