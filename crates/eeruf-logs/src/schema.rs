//! Message definitions of ROS 1 and ROS 2, and numbers at a path of a message that has one.

use std::collections::HashMap;

use crate::bytes::Bytes;

/// Largest depth of nested types.
const DEEPEST: usize = 16;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Primitive {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    U64,
    I64,
    F32,
    F64,
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

/// The header of a message: stamp in nanoseconds and frame.
#[derive(Default)]
pub(crate) struct Header {
    pub(crate) stamp_ns: u64,
    pub(crate) frame: String,
}

fn primitive(name: &str) -> Option<Primitive> {
    Some(match name {
        "bool" | "byte" | "char" | "uint8" | "octet" => Primitive::U8,
        "int8" => Primitive::I8,
        "uint16" => Primitive::U16,
        "int16" => Primitive::I16,
        "uint32" => Primitive::U32,
        "int32" => Primitive::I32,
        "uint64" => Primitive::U64,
        "int64" => Primitive::I64,
        "float32" => Primitive::F32,
        "float64" => Primitive::F64,
        "time" | "duration" => Primitive::Time,
        _ if name == "string" || name.starts_with("string<=") => Primitive::Text,
        _ => return None,
    })
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
        let mut paths = vec![];
        let suffix = |field: &Field| if field.length == Length::One { "" } else { "[]" };
        for field in &self.0[""] {
            let path = format!("{}{}", field.name, suffix(field));
            match &field.of {
                Type::Primitive(Primitive::Text | Primitive::Time) => {}
                Type::Primitive(_) => paths.push(path),
                Type::Message(of) => {
                    for inner in self.fields(of).unwrap_or_default() {
                        if matches!(inner.of, Type::Primitive(of) if !matches!(of, Primitive::Text | Primitive::Time)) {
                            paths.push(format!("{path}.{}{}", inner.name, suffix(inner)));
                        }
                    }
                }
            }
        }
        paths
    }

    /// The numbers at a path of a message, and its header; `None` if the message does not fit the definition.
    pub(crate) fn numbers(
        &self,
        path: &[String],
        message: Bytes<'_>,
        cdr: Option<usize>,
    ) -> Option<(Header, Vec<f64>)> {
        let mut walk = Walk { schema: self, rest: message, cdr, header: Header::default(), numbers: vec![] };
        walk.message("", Some(path), 0)?;
        // CDR may pad a message to a multiple of four.
        let padding = if cdr.is_some() { 3 } else { 0 };
        (walk.rest.left() <= padding).then_some((walk.header, walk.numbers))
    }
}

struct Walk<'s, 'b> {
    schema: &'s Schema,
    rest: Bytes<'b>,
    /// The largest alignment of CDR; ROS 1 has none.
    cdr: Option<usize>,
    header: Header,
    numbers: Vec<f64>,
}

impl Walk<'_, '_> {
    fn align(&mut self, size: usize) -> Option<()> {
        match self.cdr {
            Some(most) => self.rest.align(size.min(most)),
            None => Some(()),
        }
    }

    fn message(&mut self, of: &str, wanted: Option<&[String]>, depth: usize) -> Option<()> {
        /// Largest number of numbers in one message.
        const MOST: usize = 1 << 16;
        if depth > DEEPEST {
            return None;
        }
        let schema = self.schema;
        let fields = schema.fields(of)?;
        // An empty message has one byte in CDR.
        for field in fields {
            let inner = match wanted {
                Some([first, rest @ ..]) if *first == field.name => Some(rest),
                _ => None,
            };
            let is_header =
                depth == 0 && matches!(&field.of, Type::Message(of) if of.rsplit('/').next() == Some("Header"));
            let count = match field.length {
                Length::One => 1,
                Length::Fixed(count) => count,
                Length::Counted => {
                    self.align(4)?;
                    self.rest.u32()? as usize
                }
            };
            if count > self.rest.left() {
                return None;
            }
            if is_header {
                self.read_header()?;
                continue;
            }
            for _ in 0..count {
                match &field.of {
                    Type::Message(of) => self.message(of, inner, depth + 1)?,
                    Type::Primitive(of) => {
                        let number = self.primitive(*of)?;
                        if inner.is_some_and(<[String]>::is_empty) && self.numbers.len() < MOST {
                            self.numbers.push(number);
                        }
                    }
                }
            }
        }
        Some(())
    }

    fn read_header(&mut self) -> Option<()> {
        self.align(4)?;
        if self.cdr.is_none() {
            self.rest.u32()?; // A sequence number.
        }
        let (seconds, nanoseconds) = (self.rest.u32()?, self.rest.u32()?);
        self.header.stamp_ns = u64::from(seconds) * 1_000_000_000 + u64::from(nanoseconds);
        self.header.frame = self.rest.text()?.trim_end_matches('\0').to_owned();
        Some(())
    }

    fn primitive(&mut self, of: Primitive) -> Option<f64> {
        let size = match of {
            Primitive::U8 | Primitive::I8 => 1,
            Primitive::U16 | Primitive::I16 => 2,
            Primitive::U64 | Primitive::I64 | Primitive::F64 => 8,
            _ => 4,
        };
        self.align(size)?;
        Some(match of {
            Primitive::U8 => self.rest.u8()?.into(),
            Primitive::I8 => self.rest.u8()?.cast_signed().into(),
            Primitive::U16 => self.rest.u16()?.into(),
            Primitive::I16 => self.rest.u16()?.cast_signed().into(),
            Primitive::U32 => self.rest.u32()?.into(),
            Primitive::I32 => self.rest.u32()?.cast_signed().into(),
            Primitive::U64 => self.rest.u64()? as f64,
            Primitive::I64 => self.rest.u64()?.cast_signed() as f64,
            Primitive::F32 => self.rest.f32()?.into(),
            Primitive::F64 => f64::from_bits(self.rest.u64()?),
            Primitive::Text => {
                self.rest.counted()?;
                0.0
            }
            Primitive::Time => {
                self.rest.take(8)?;
                0.0
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bytes::Order;

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
        let path = ["sonars".to_owned(), "range".to_owned()];
        let read = |bytes: &[u8]| schema.numbers(&path, Bytes::new(bytes, Order::Little), None);
        let (header, numbers) = read(&bytes).unwrap();
        assert_eq!((header.stamp_ns, header.frame.as_str(), &numbers[..]), (2_000_000_003, "f", &[1.5, 2.5][..]));
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_none(), "{length}");
        }
        bytes.push(0);
        assert!(read(&bytes).is_none());
    }
}
