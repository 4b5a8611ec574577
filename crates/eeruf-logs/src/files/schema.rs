//! Message definitions of ROS 1 and ROS 2, and values at paths of messages that have one.

use std::collections::HashMap;

use super::bytes::{Bytes, Number, Order};

/// Largest depth of nested types.
const DEEPEST: usize = 16;
/// Largest number of fields of a message with its nested messages.
const MOST_FIELDS: usize = 1 << 12;
/// Largest number of values of a message.
const MOST_VALUES: usize = 1 << 16;

/// Encoding of a topic's messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// ROS 2, which aligns numbers and ends texts with a zero.
    Cdr,
    /// ROS 1, whose headers have a number.
    Ros1,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Primitive {
    /// A number of this size in bytes.
    Number(Number, usize),
    Text,
    /// Seconds and nanoseconds.
    Time,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Type {
    Primitive(Primitive),
    Message(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Length {
    One,
    Fixed(usize),
    Counted,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Field {
    name: String,
    of: Type,
    length: Length,
}

/// A message's definition, with those of its nested messages. The message itself has the name "".
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Schema(HashMap<String, Vec<Field>>);

fn primitive(name: &str) -> Option<Primitive> {
    let number = |kind, prefix: &str| {
        let bits = name.strip_prefix(prefix)?.parse().ok().filter(|bits| [8, 16, 32, 64].contains(bits))?;
        Some(Primitive::Number(kind, bits / 8))
    };
    match name {
        "bool" | "byte" | "char" | "octet" => Some(Primitive::Number(Number::Unsigned, 1)),
        "time" | "duration" => Some(Primitive::Time),
        _ if name == "string" || name.starts_with("string<=") => Some(Primitive::Text),
        _ => number(Number::Unsigned, "uint")
            .or_else(|| number(Number::Signed, "int"))
            .or_else(|| number(Number::Float, "float")),
    }
}

impl Schema {
    /// Parses a definition: its fields, and after lines of `=` the nested messages, each after `MSG: NAME`.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let mut types: HashMap<String, Vec<Field>> = HashMap::new();
        let mut own = String::new();
        types.insert(String::new(), vec![]);
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() || line.starts_with("====") {
                continue;
            }
            if let Some(name) = line.strip_prefix("MSG:") {
                own = name.trim().replace("/msg/", "/");
                types.insert(own.clone(), vec![]);
                continue;
            }
            let (of, rest) = line.split_once(char::is_whitespace)?;
            if rest.contains('=') && !of.contains("<=") || rest.trim_start().starts_with('=') {
                continue;
            }
            let name = rest.split_whitespace().next()?.to_owned();
            let (of, length) = match of.strip_suffix(']').and_then(|of| of.rsplit_once('[')) {
                None => (of, Length::One),
                Some((of, "")) => (of, Length::Counted),
                Some((of, most)) if most.starts_with("<=") => (of, Length::Counted),
                Some((of, number)) => (of, Length::Fixed(number.parse().ok().filter(|&number| number <= 1 << 20)?)),
            };
            let of = primitive(of).map_or_else(|| Type::Message(of.replace("/msg/", "/")), Type::Primitive);
            types.get_mut(&own)?.push(Field { name, of, length });
        }
        let schema = Self(types);
        (!schema.0[""].is_empty()).then_some(schema)
    }

    fn fields(&self, name: &str) -> Option<&[Field]> {
        if let Some(fields) = self.0.get(name) {
            return Some(fields);
        }
        // A type without a package is in the same package, or is the header.
        let ends = |known: &&String| known.rsplit('/').next() == name.rsplit('/').next();
        self.0.keys().find(ends).map(|known| self.0[known].as_slice())
    }

    /// The paths to numbers, with `[]` after arrays, of at most two names.
    pub(crate) fn number_paths(&self) -> Vec<String> {
        let path = |field: &Field| format!("{}{}", field.name, if field.length == Length::One { "" } else { "[]" });
        let is_number = |field: &&Field| matches!(field.of, Type::Primitive(Primitive::Number(..)));
        let of = |field: &Field| match &field.of {
            Type::Message(of) => {
                let inner = self.fields(of).unwrap_or_default().iter().filter(is_number);
                inner.map(|inner| format!("{}.{}", path(field), path(inner))).collect()
            }
            Type::Primitive(_) => Some(field).filter(is_number).map(path).into_iter().collect::<Vec<_>>(),
        };
        self.0[""].iter().flat_map(of).collect()
    }

    /// A decoder for the values at these paths; `None` if a path or a nested type is missing.
    pub(crate) fn decoder(&self, paths: &[&str]) -> Option<Decoder> {
        let wanted: Vec<_> = paths.iter().copied().enumerate().collect();
        let (mut fields, mut found) = (0, 0);
        let steps = self.steps("", &wanted, 0, &mut fields, &mut found)?;
        (found == paths.len()).then_some(Decoder(steps))
    }

    fn steps(
        &self,
        of: &str,
        wanted: &[(usize, &str)],
        depth: usize,
        fields: &mut usize,
        found: &mut usize,
    ) -> Option<Vec<Step>> {
        let step = |field: &Field| {
            *fields += 1;
            let inner = |&(place, path): &(usize, _)| {
                let (name, rest) = str::split_once(path, '.').unwrap_or((path, ""));
                (name == field.name).then_some((place, rest))
            };
            let inner: Vec<_> = wanted.iter().filter_map(inner).collect();
            let of = match &field.of {
                Type::Message(of) if depth == 0 && of.rsplit('/').next() == Some("Header") => Of::Header,
                _ if depth > DEEPEST || *fields > MOST_FIELDS => return None,
                Type::Message(of) => Of::Message(self.steps(of, &inner, depth + 1, fields, found)?),
                Type::Primitive(of) => {
                    let place = inner.first().filter(|inner| inner.1.is_empty()).map(|inner| inner.0);
                    *found += usize::from(place.is_some());
                    Of::Primitive(*of, place)
                }
            };
            Some(Step { of, length: field.length })
        };
        self.fields(of)?.iter().map(step).collect()
    }
}

/// A field that is decoded.
#[derive(Debug)]
struct Step {
    of: Of,
    length: Length,
}

#[derive(Debug)]
enum Of {
    Header,
    Message(Vec<Step>),
    /// A primitive, with the place of its path among the wanted ones.
    Primitive(Primitive, Option<usize>),
}

/// A decoder for messages of one type.
#[derive(Debug)]
pub(crate) struct Decoder(Vec<Step>);

/// A value at a wanted path.
#[derive(Clone, Copy)]
enum Value<'a> {
    Number(f64),
    Text(&'a [u8]),
}

/// The header of a message, and its values at the wanted paths.
#[derive(Default)]
pub(crate) struct Decoded<'a> {
    /// The stamp in nanoseconds, 0 for none.
    pub(crate) stamp_ns: u64,
    pub(crate) frame: &'a [u8],
    /// Values, each with the place of its path.
    values: Vec<(usize, Value<'a>)>,
    /// True if an array was left out because it is too long.
    pub(crate) is_too_long: bool,
}

impl Decoder {
    /// Decodes a message, with arrays of at most `most` elements; `None` if it does not fit the definition.
    pub(crate) fn decode<'a>(&self, encoding: Encoding, message: &'a [u8], most: usize) -> Option<Decoded<'a>> {
        let (rest, cdr) = match encoding {
            Encoding::Ros1 => (Bytes::new(message, Order::Little), None),
            Encoding::Cdr => {
                let (header, body) = message.split_at_checked(4)?;
                // Plain CDR, of the first and of the second version, for types that do not change.
                let (order, largest) = match (header[0], header[1]) {
                    (0, 0) => (Order::Big, 8),
                    (0, 1) => (Order::Little, 8),
                    (0, 6) => (Order::Big, 4),
                    (0, 7) => (Order::Little, 4),
                    _ => return None,
                };
                (Bytes::new(body, order), Some(largest))
            }
        };
        let mut walk = Walk { rest, cdr, most, found: Decoded { values: Vec::with_capacity(8), ..Decoded::default() } };
        walk.message(&self.0)?;
        // CDR may pad a message to a multiple of four.
        let padding = if cdr.is_some() { 3 } else { 0 };
        (walk.rest.left() <= padding).then_some(walk.found)
    }
}

impl<'a> Decoded<'a> {
    fn values(&self, place: usize) -> impl Iterator<Item = Value<'a>> {
        self.values.iter().filter(move |value| value.0 == place).map(|value| value.1)
    }

    /// The numbers at a path, given by its place.
    pub(crate) fn numbers(&self, place: usize) -> impl Iterator<Item = f64> {
        self.values(place).filter_map(|value| if let Value::Number(number) = value { Some(number) } else { None })
    }

    /// The first number at a path, 0 for none.
    pub(crate) fn number(&self, place: usize) -> f64 {
        self.numbers(place).next().unwrap_or(0.0)
    }

    /// The text at a path; invalid bytes are replaced.
    pub(crate) fn text(&self, place: usize) -> String {
        let text = self.values(place).find_map(|value| if let Value::Text(text) = value { Some(text) } else { None });
        String::from_utf8_lossy(text.unwrap_or_default()).into_owned()
    }
}

struct Walk<'a> {
    rest: Bytes<'a>,
    /// The largest alignment of CDR; ROS 1 has none.
    cdr: Option<usize>,
    most: usize,
    found: Decoded<'a>,
}

impl<'a> Walk<'a> {
    fn align(&mut self, size: usize) -> Option<()> {
        self.cdr.map_or(Some(()), |largest| self.rest.align(size.min(largest)))
    }

    fn u32(&mut self) -> Option<u32> {
        self.align(4)?;
        self.rest.u32()
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        self.align(4)?;
        let text = self.rest.counted()?;
        Some(if self.cdr.is_some() { text.strip_suffix(&[0]).unwrap_or(text) } else { text })
    }

    fn message(&mut self, steps: &[Step]) -> Option<()> {
        for Step { of, length } in steps {
            let count = match *length {
                Length::One => 1,
                Length::Fixed(count) => count,
                Length::Counted => self.u32()? as usize,
            };
            if count > self.rest.left() {
                return None;
            }
            match of {
                Of::Header => self.header()?,
                Of::Message(steps) => (0..count).try_for_each(|_| self.message(steps))?,
                Of::Primitive(of, None) => self.values(*of, count, None)?,
                Of::Primitive(of, place) => {
                    self.found.is_too_long |= count > self.most;
                    self.values(*of, count, place.filter(|_| count <= self.most))?;
                }
            }
        }
        Some(())
    }

    fn header(&mut self) -> Option<()> {
        if self.cdr.is_none() {
            self.rest.u32()?; // A sequence number.
        }
        let (seconds, nanoseconds) = (self.u32()?, self.u32()?);
        self.found.stamp_ns = u64::from(seconds) * 1_000_000_000 + u64::from(nanoseconds);
        self.found.frame = self.text()?;
        Some(())
    }

    fn values(&mut self, of: Primitive, count: usize, place: Option<usize>) -> Option<()> {
        if let (Primitive::Number(_, size), None, 1..) = (of, place, count) {
            self.align(size)?;
            return self.rest.take(size.checked_mul(count)?).map(drop);
        }
        for _ in 0..count {
            let value = match of {
                Primitive::Number(kind, size) => {
                    self.align(size)?;
                    Value::Number(self.rest.number(kind, size)?)
                }
                Primitive::Text => Value::Text(self.text()?),
                Primitive::Time => {
                    self.align(4)?;
                    self.rest.take(8)?;
                    continue;
                }
            };
            if let Some(place) = place.filter(|_| self.found.values.len() < MOST_VALUES) {
                self.found.values.push((place, value));
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_at_a_path_of_nested_arrays() {
        let text = "std_msgs/Header header\nuint8 MOST=4\nSonar[] sonars\nfloat64 gain\n====\nMSG: std_msgs/Header\n\
                    uint32 seq\ntime stamp\nstring frame_id\n====\nMSG: own/Sonar\nuint8 id\nfloat32 range\n";
        let schema = Schema::parse(text).unwrap();
        assert_eq!(schema.number_paths(), ["header.seq", "sonars[].id", "sonars[].range", "gain"]);
        let mut bytes = vec![];
        bytes.extend([1_u32, 2, 3, 1].into_iter().flat_map(u32::to_le_bytes));
        bytes.push(b'f');
        bytes.extend(2_u32.to_le_bytes());
        for (id, range) in [(0, 1.5_f32), (1, 2.5)] {
            bytes.push(id);
            bytes.extend(range.to_le_bytes());
        }
        bytes.extend(7.0_f64.to_le_bytes());
        let decoder = schema.decoder(&["sonars.range", "gain"]).unwrap();
        let found = decoder.decode(Encoding::Ros1, &bytes, 9).unwrap();
        assert_eq!((found.stamp_ns, found.frame, found.number(1)), (2_000_000_003, &b"f"[..], 7.0));
        assert_eq!(found.numbers(0).collect::<Vec<_>>(), [1.5, 2.5]);
        for length in 0..bytes.len() {
            assert!(decoder.decode(Encoding::Ros1, &bytes[..length], 9).is_none(), "{length}");
        }
        bytes.push(0);
        assert!(decoder.decode(Encoding::Ros1, &bytes, 9).is_none());
        assert!(schema.decoder(&["sonars.other"]).is_none());
    }
}
