//! The text of a file in any encoding, as lines, as objects of a JSON document, or as messages printed by `ros2 topic
//! echo` and `rostopic echo`.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};

use super::boot::{Boot, is_noise};
use super::esphome::EspHome;
use super::groups::Groups;
use super::lines::{Input, Line, Lines, Objects, Rewritten};
use super::messages::{self, End};

/// The records or lines of a text.
pub(crate) struct Source<'a> {
    form: Form<'a>,
    pending: VecDeque<Line>,
    /// Number of lines that a board, a monitor or a logger wrote by itself.
    pub(super) left_out: u64,
    /// True where noise of a board's boot may occur: before the first line, and after a boot message.
    may_be_noise: bool,
    boot: Boot,
}

/// A function that rewrites lines. A line that seems to hold a reading but does not fit the form is a misfit.
type Rewriter = Box<dyn FnMut(&str) -> Rewritten>;

enum Form<'a> {
    Lines(Lines<'a>),
    Objects(Objects<'a>),
    Messages(Lines<'a>, End),
    /// Lines that wrap readings in a named form, rewritten into lines that can be read.
    Rewritten(Lines<'a>, &'static str, Rewriter),
}

impl<'a> Source<'a> {
    pub(crate) fn new(input: Box<dyn Read + 'a>) -> io::Result<Self> {
        let form = Form::new(input)?;
        Ok(Self { form, pending: VecDeque::new(), left_out: 0, may_be_noise: true, boot: Boot::default() })
    }

    pub(crate) fn next(&mut self) -> io::Result<Option<Line>> {
        loop {
            if let Some(line) = self.pending.pop_front() {
                return Ok(Some(line));
            }
            let (line, rewrite) = match &mut self.form {
                Form::Lines(lines) => (lines.next()?, None),
                Form::Rewritten(lines, _, rewrite) => (lines.next()?, Some(rewrite)),
                Form::Objects(objects) => return objects.next(),
                Form::Messages(lines, end) => return messages::next(lines, *end),
            };
            let Some(line) = line else { return Ok(None) };
            let is_start = self.boot.is_boot(&line.text);
            if is_start || (self.may_be_noise && is_noise(&line.text)) {
                self.may_be_noise = true;
                self.left_out += 1;
                continue;
            }
            self.may_be_noise &= line.text.trim().is_empty();
            match rewrite {
                None => return Ok(Some(line)),
                Some(rewrite) => match rewrite(&line.text) {
                    Rewritten::Lines(texts) => {
                        self.pending.extend(texts.into_iter().map(|text| Line { text, ..line.clone() }));
                    }
                    Rewritten::Nothing => self.left_out += 1,
                    Rewritten::Misfit => return Ok(Some(Line { is_misfit: true, ..line })),
                },
            }
        }
    }

    /// The form of a text made of records instead of lines.
    pub(crate) const fn of_records(&self) -> Option<&'static str> {
        match &self.form {
            Form::Lines(_) => None,
            Form::Objects(_) => Some("JSON, a document"),
            Form::Messages(_, End::Rule) => Some("messages, as `ros2 topic echo` prints them"),
            Form::Messages(..) => Some("blocks of name and value"),
            Form::Rewritten(_, name, _) => Some(name),
        }
    }

    /// Returns true for records that are objects.
    pub(super) const fn is_of_objects(&self) -> bool {
        matches!(self.form, Form::Objects(_) | Form::Messages(..))
    }
}

impl<'a> Form<'a> {
    fn new(input: Box<dyn Read + 'a>) -> io::Result<Self> {
        // A pipe gives a little at a time.
        let (mut input, mut first) = (input, vec![]);
        (&mut input).take(1 << 14).read_to_end(&mut first)?;
        let mut input = BufReader::with_capacity(1 << 16, io::Cursor::new(first).chain(input));
        let first = input.fill_buf()?;
        let (skip, utf16) = match first {
            [0xff, 0xfe, ..] => (2, Some(false)),
            [0xfe, 0xff, ..] => (2, Some(true)),
            [0xef, 0xbb, 0xbf, ..] => (3, None),
            // Little-endian text has its zeroes at odd places.
            [one, 0, two, 0, ..] if *one != 0 && *two != 0 => (0, Some(false)),
            [0, one, 0, two, ..] if *one != 0 && *two != 0 => (0, Some(true)),
            _ => (0, None),
        };
        input.consume(skip);
        let mut input: Input<'a> = match utf16 {
            None => BufReader::new(Box::new(input)),
            Some(is_big) => {
                let mut bytes = input.bytes().map_while(Result::ok);
                let unit = move || {
                    let pair = [bytes.next()?, bytes.next().unwrap_or_default()];
                    Some(if is_big { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) })
                };
                let letters = char::decode_utf16(std::iter::from_fn(unit));
                BufReader::new(Box::new(Utf16 { letters, out: VecDeque::new() }))
            }
        };
        let start = String::from_utf8_lossy(input.fill_buf()?).into_owned();
        if let Some(end) = End::of(&start) {
            return Ok(Self::Messages(Lines::new(input), end));
        }
        if let Some((name, rewrite)) = rewriter(&start) {
            return Ok(Self::Rewritten(Lines::new(input), name, rewrite));
        }
        // Keyword lines, such as `#SONAR 24: 53 cm`.
        let has_hashes = start
            .lines()
            .filter(|line| !line.trim().is_empty())
            .take(50)
            .all(|line| line.strip_prefix('#').is_some_and(|rest| rest.starts_with(char::is_alphanumeric)));
        let mut start = start.trim_start().chars();
        let is_document = match start.next() {
            Some('[') => matches!(start.as_str().trim_start().chars().next(), Some('{' | '[')),
            // Objects on lines of their own are JSON lines.
            Some('{') => {
                let mut lines = start.as_str().lines();
                let first = lines.next().unwrap_or_default();
                !first.contains('}') || !lines.any(|line| line.trim_start().starts_with('{'))
            }
            _ => false,
        };
        let mut lines = Lines::new(input);
        lines.has_hashes = has_hashes;
        Ok(if is_document { Self::Objects(Objects::new(lines.input)) } else { Self::Lines(lines) })
    }
}

/// The form of a text whose lines are rewritten, from its beginning.
fn rewriter(start: &str) -> Option<(&'static str, Rewriter)> {
    // An ArduPilot log as text: many tables in one file, one of which has ranges.
    if start.starts_with("FMT,") {
        let rewrite = |line: &str| Rewritten::Lines(rangefinder(line).into_iter().collect());
        return Some(("RFND of an ArduPilot log", Box::new(rewrite)));
    }
    // The last line may not be whole, and the first may be cut.
    let whole = start.rsplit_once('\n').map_or(start, |(whole, _)| whole);
    let lines = whole.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    if let Some(mut groups) = Groups::of(&lines.take(50).collect::<Vec<_>>()) {
        return Some(("a table of many measurements a row", Box::new(move |line| groups.rewrite(line))));
    }
    let mut log = EspHome::is_in(start).then(EspHome::default)?;
    Some(("ESPHome's log", Box::new(move |line| log.rewrite(line))))
}

/// A row of an ArduPilot log's table `RFND`, or its header.
fn rangefinder(line: &str) -> Option<String> {
    if let Some(format) = line.strip_prefix("FMT,") {
        let mut cells = format.splitn(5, ',').map(str::trim);
        return (cells.nth(2) == Some("RFND")).then(|| cells.nth(1).map(str::to_owned))?;
    }
    let cells: Vec<_> = line.strip_prefix("RFND,")?.split(',').map(str::trim).collect();
    Some(cells.join(","))
}

/// A reader of UTF-16 as UTF-8.
struct Utf16<U: Iterator<Item = u16>> {
    letters: std::char::DecodeUtf16<U>,
    out: VecDeque<u8>,
}

impl<U: Iterator<Item = u16>> Read for Utf16<U> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.out.len() < into.len()
            && let Some(letter) = self.letters.next()
        {
            self.out.extend(letter.unwrap_or('\u{fffd}').encode_utf8(&mut [0; 4]).bytes());
        }
        self.out.read(into)
    }
}
