//! Messages of ROS 2 in an MCAP file, decoded by the definitions in the file.

use std::collections::HashMap;
use std::path::Path;

use serde_json::{Map, Value, json};

/// A message as an object of its fields.
pub(crate) struct Message {
    pub(crate) topic: String,
    pub(crate) kind: String,
    pub(crate) log_time: u64,
    pub(crate) value: Value,
}

/// All messages of a file, each of which must be of ROS 2 and fit its definition to the last byte.
pub(crate) fn messages(file: &Path) -> Vec<Message> {
    let bytes = std::fs::read(file).unwrap();
    let all = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    all.map(|message| {
        let schema = message.channel.schema.as_ref().unwrap();
        let encodings = (message.channel.message_encoding.as_str(), schema.encoding.as_str());
        assert_eq!(encodings, ("cdr", "ros2msg"), "{}", schema.name);
        let types = types(std::str::from_utf8(&schema.data).unwrap());
        let mut of = Decoder { types: &types, body: &message.data[4..], at: 0 };
        let value = of.message("");
        assert_eq!(of.at, of.body.len(), "{}: {value}", schema.name);
        let (topic, kind) = (message.channel.topic.clone(), schema.name.clone());
        Message { topic, kind, log_time: message.log_time, value }
    })
    .collect()
}

/// Types and names of fields by message; the message itself is "".
fn types(text: &str) -> HashMap<String, Vec<(String, String)>> {
    let (mut types, mut own) = (HashMap::<_, Vec<_>>::new(), String::new());
    for line in text.lines().map(|line| line.split('#').next().unwrap().trim()) {
        if let Some(name) = line.strip_prefix("MSG: ") {
            name.clone_into(&mut own);
        } else if let Some((of, name)) = line.split_once(' ').filter(|(_, name)| !name.contains('=')) {
            types.entry(own.clone()).or_default().push((of.to_owned(), name.to_owned()));
        }
    }
    types
}

struct Decoder<'a> {
    types: &'a HashMap<String, Vec<(String, String)>>,
    body: &'a [u8],
    at: usize,
}

impl Decoder<'_> {
    fn number<const SIZE: usize>(&mut self) -> [u8; SIZE] {
        self.at = self.at.next_multiple_of(SIZE) + SIZE;
        self.body[self.at - SIZE..self.at].try_into().unwrap()
    }

    fn message(&mut self, name: &str) -> Value {
        let mut object = Map::new();
        for (of, name) in &self.types[name] {
            let value = match of.strip_suffix(']').and_then(|of| of.split_once('[')) {
                None => self.value(of),
                Some((of, count)) => {
                    let count = count.parse().unwrap_or_else(|_| u32::from_le_bytes(self.number()));
                    (0..count).map(|_| self.value(of)).collect()
                }
            };
            object.insert(name.clone(), value);
        }
        object.into()
    }

    fn value(&mut self, of: &str) -> Value {
        match of {
            "bool" => json!(self.number::<1>()[0] == 1),
            "uint8" => json!(self.number::<1>()[0]),
            "int32" => json!(i32::from_le_bytes(self.number())),
            "uint32" => json!(u32::from_le_bytes(self.number())),
            "int64" => json!(i64::from_le_bytes(self.number())),
            "uint64" => json!(u64::from_le_bytes(self.number())),
            "float32" => json!(f32::from_le_bytes(self.number())),
            "float64" => json!(f64::from_le_bytes(self.number())),
            "string" => {
                let length = u32::from_le_bytes(self.number()) as usize;
                self.at += length;
                json!(std::str::from_utf8(&self.body[self.at - length..self.at - 1]).unwrap())
            }
            other => self.message(other),
        }
    }
}
