//! The bytes of a text in whatever encoding, as what it is: lines, objects of a JSON document, or messages as
//! `ros2 topic echo` and `rostopic echo` print them.

use std::collections::VecDeque;
use std::io::{self, BufRead, BufReader, Read};

use super::lines::{Input, Line, Lines, Objects};
use super::messages;
use crate::bytes::Order;

pub(crate) enum Source<'a> {
    Lines(Lines<'a>),
    Objects(Objects<'a>),
    Messages(Lines<'a>),
    /// An ArduPilot log as text: many tables in one file, of which one holds ranges.
    DataFlash(Lines<'a>),
}

impl<'a> Source<'a> {
    pub(crate) fn new(input: Box<dyn Read + 'a>) -> io::Result<Self> {
        let mut input = BufReader::with_capacity(1 << 16, input);
        let first = input.fill_buf()?;
        let (skip, utf16) = match first {
            [0xff, 0xfe, ..] => (2, Some(Order::Little)),
            [0xfe, 0xff, ..] => (2, Some(Order::Big)),
            [0xef, 0xbb, 0xbf, ..] => (3, None),
            // Text of the first kind has its zeroes at odd places.
            [one, 0, two, 0, ..] if *one != 0 && *two != 0 => (0, Some(Order::Little)),
            [0, one, 0, two, ..] if *one != 0 && *two != 0 => (0, Some(Order::Big)),
            _ => (0, None),
        };
        input.consume(skip);
        let mut input: Input<'a> = match utf16 {
            None => BufReader::new(Box::new(input)),
            Some(order) => BufReader::new(Box::new(Utf16 { input, order, out: VecDeque::new(), high: None })),
        };
        let start = String::from_utf8_lossy(input.fill_buf()?).into_owned();
        if messages::are_in(&start) {
            return Ok(Self::Messages(Lines::new(input)));
        }
        if start.starts_with("FMT,") {
            return Ok(Self::DataFlash(Lines::new(input)));
        }
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
        Ok(if is_document { Self::Objects(Objects::new(input)) } else { Self::Lines(Lines::new(input)) })
    }

    pub(crate) fn next(&mut self) -> io::Result<Option<Line>> {
        match self {
            Self::Lines(lines) => lines.next(),
            Self::Objects(objects) => objects.next_row(),
            Self::Messages(lines) => messages::next(lines),
            Self::DataFlash(lines) => loop {
                let Some(line) = lines.next()? else { return Ok(None) };
                if let Some(text) = rangefinder(&line.text) {
                    return Ok(Some(Line { text, ..line }));
                }
            },
        }
    }

    /// The form of a text that is records and no lines.
    pub(crate) const fn of_records(&self) -> Option<&'static str> {
        match self {
            Self::Lines(_) => None,
            Self::Objects(_) => Some("JSON, a document"),
            Self::Messages(_) => Some("messages, as `ros2 topic echo` prints them"),
            Self::DataFlash(_) => Some("RFND of an ArduPilot log"),
        }
    }

    /// Returns true for records of which each is an object.
    pub(super) const fn is_of_objects(&self) -> bool {
        matches!(self, Self::Objects(_) | Self::Messages(_))
    }
}

/// A row of an ArduPilot log's table `RFND`, or its header. Without an echo the range is none, as its status says.
fn rangefinder(line: &str) -> Option<String> {
    if let Some(format) = line.strip_prefix("FMT,") {
        let mut cells = format.splitn(5, ',').map(str::trim);
        return (cells.nth(2) == Some("RFND")).then(|| cells.nth(1).map(str::to_owned))?;
    }
    let mut cells: Vec<_> = line.strip_prefix("RFND,")?.split(',').map(str::trim).collect();
    // Time, instance, range, status and orientation: 1 is without data, 2 below and 3 beyond what it measures.
    if let [_, _, range, status, _, ..] = &mut cells[..] {
        match *status {
            "0" | "1" => *range = "none",
            "2" => *range = "-inf",
            "3" => *range = "inf",
            _ => {}
        }
    }
    Some(cells.join(","))
}

/// Transcodes UTF-16 to UTF-8.
struct Utf16<R> {
    input: R,
    order: Order,
    out: VecDeque<u8>,
    high: Option<u16>,
}

impl<R: Read> Read for Utf16<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.out.is_empty() {
            let mut pairs = Vec::new();
            (&mut self.input).take(1 << 13).read_to_end(&mut pairs)?;
            if pairs.is_empty() && self.high.is_none() {
                return Ok(0);
            }
            let unit = |pair: &[u8]| match (self.order, pair) {
                (Order::Little, &[low, high]) => u16::from_le_bytes([low, high]),
                (Order::Big, &[high, low]) => u16::from_be_bytes([high, low]),
                _ => 0xfffd,
            };
            let is_end = pairs.is_empty();
            let mut units: Vec<u16> = self.high.take().into_iter().chain(pairs.chunks(2).map(unit)).collect();
            if !is_end && units.last().is_some_and(|last| (0xd800..0xdc00).contains(last)) {
                self.high = units.pop();
            }
            let text: String = char::decode_utf16(units).map(|letter| letter.unwrap_or('\u{fffd}')).collect();
            self.out.extend(text.bytes());
        }
        self.out.read(into)
    }
}
