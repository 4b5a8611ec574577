//! Lines of a text with any line ending, and the objects of a JSON document.

use std::borrow::Cow;
use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};

/// The bytes of a text.
pub(super) type Input<'a> = BufReader<Box<dyn Read + 'a>>;

/// Length above which a line is dropped.
const LONGEST_LINE: usize = 1 << 16;
/// Length above which an object is dropped.
const LONGEST_OBJECT: usize = 1 << 20;

/// A line or an object.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    /// The line's number, from 1.
    pub(crate) number: u64,
    pub(crate) text: String,
    /// False for a last line without a line break, which may be cut.
    pub(crate) is_ended: bool,
    pub(crate) is_too_long: bool,
    /// True if the line may hold a reading but does not have the form of the log.
    pub(crate) is_misfit: bool,
}

/// Outcome of rewriting a line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Rewritten {
    Lines(Vec<String>),
    /// The line holds no reading.
    Nothing,
    /// The line may hold a reading, and is damaged.
    Misfit,
}

/// A text without a terminal's escape sequences: `ESC [`, numbers, a letter.
fn without_colours(text: &str) -> Cow<'_, str> {
    if !text.contains("\u{1b}[") {
        return Cow::Borrowed(text);
    }
    let mut parts = text.split("\u{1b}[");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let rest = part.trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';');
        match rest.strip_prefix(['m', 'H', 'J', 'K']) {
            Some(rest) => plain.push_str(rest),
            None => plain.extend(["\u{1b}[", part]),
        }
    }
    Cow::Owned(plain)
}

/// Lines that end with `\n`, `\r\n` or `\r`.
pub(crate) struct Lines<'a> {
    pub(super) input: Input<'a>,
    number: u64,
    pending: VecDeque<Line>,
    /// True if each line begins with `#`, which then does not begin a comment.
    pub(super) has_hashes: bool,
}

impl<'a> Lines<'a> {
    pub(super) fn new(input: Input<'a>) -> Self {
        Self { input, number: 0, pending: VecDeque::new(), has_hashes: false }
    }

    pub(super) fn next(&mut self) -> io::Result<Option<Line>> {
        if let Some(line) = self.pending.pop_front() {
            return Ok(Some(line));
        }
        let mut bytes = Vec::new();
        (&mut self.input).take(LONGEST_LINE as u64).read_until(b'\n', &mut bytes)?;
        if bytes.is_empty() {
            return Ok(None);
        }
        let is_too_long = bytes.len() == LONGEST_LINE && bytes.last() != Some(&b'\n') && !bytes.contains(&b'\r');
        if is_too_long {
            self.input.skip_until(b'\n')?;
            bytes = vec![b'\n'];
        }
        let is_ended = bytes.last() == Some(&b'\n');
        let text = String::from_utf8_lossy(&bytes);
        let text = text.strip_suffix('\n').unwrap_or(&text);
        let text = if self.has_hashes { text.strip_prefix('#').unwrap_or(text) } else { text };
        let text = without_colours(text.trim_end_matches('\r'));
        // Bytes, as Python prints them.
        let bytes = text.strip_prefix("b'").and_then(|text| text.strip_suffix('\''));
        let text = bytes.map_or(text.as_ref(), |text| text.trim_end_matches("\\n").trim_end_matches("\\r"));
        let mut parts = text.split('\r').peekable();
        while let Some(part) = parts.next() {
            self.number += 1;
            let (number, text, is_ended) = (self.number, part.to_owned(), is_ended || parts.peek().is_some());
            self.pending.push_back(Line { number, text, is_ended, is_too_long, is_misfit: false });
        }
        Ok(self.pending.pop_front())
    }
}

/// The objects of a JSON document: elements of its arrays, or consecutive objects. Nested arrays are such elements too.
pub(crate) struct Objects<'a> {
    input: Input<'a>,
    number: u64,
}

impl<'a> Objects<'a> {
    pub(super) fn new(input: Input<'a>) -> Self {
        Self { input, number: 1 }
    }

    pub(super) fn next(&mut self) -> io::Result<Option<Line>> {
        // Brackets that are open since the record began.
        let (mut record, mut open, mut is_text, mut is_escaped): (Vec<u8>, Vec<u8>, _, _) =
            (vec![], vec![], false, false);
        let (mut begin, mut is_element, mut is_too_long, mut before) = (self.number, false, false, 0);
        loop {
            let Some(&byte) = self.input.fill_buf()?.first() else {
                if record.is_empty() {
                    return Ok(None);
                }
                let text = String::from_utf8_lossy(&record).into_owned();
                return Ok(Some(Line { number: begin, text, is_ended: false, is_too_long, is_misfit: false }));
            };
            self.input.consume(1);
            self.number += u64::from(byte == b'\n');
            let is_list = byte == b'[' && !self.is_inner()?;
            let is_new = !is_text && matches!(byte, b'{' | b'[') && !is_list && before == b'[' && !is_element;
            let opens = !is_text && byte == b'{' && record.is_empty();
            if is_new || opens {
                record.clear();
                open.clear();
                (begin, is_element) = (self.number, before == b'[' || before == b',');
            }
            if !byte.is_ascii_whitespace() {
                before = byte;
            }
            if record.is_empty() && !is_new && !opens {
                // Between records; an array after a comma is one.
                if !(byte == b'[' && self.is_inner()?) {
                    continue;
                }
                (begin, is_element) = (self.number, true);
            }
            if record.len() < LONGEST_OBJECT {
                record.push(byte);
            } else {
                is_too_long = true;
            }
            match byte {
                _ if is_escaped => is_escaped = false,
                b'\\' if is_text => is_escaped = true,
                b'"' => is_text = !is_text,
                b'\n' if is_text => is_text = false,
                b'{' | b'[' if !is_text => open.push(byte),
                b'}' | b']' if !is_text => {
                    open.pop();
                    if open.is_empty() {
                        let text = String::from_utf8_lossy(&record).into_owned();
                        return Ok(Some(Line { number: begin, text, is_ended: true, is_too_long, is_misfit: false }));
                    }
                }
                _ => {}
            }
        }
    }

    /// Returns true if a number follows, so that the array holds values instead of records.
    fn is_inner(&mut self) -> io::Result<bool> {
        let next = self.input.fill_buf()?.iter().find(|byte| !byte.is_ascii_whitespace());
        Ok(next.is_some_and(|byte| byte.is_ascii_digit() || b"-\"n".contains(byte)))
    }
}
