//! Writes MCAP: ranges in the messages of ROS 2 (`sensor_msgs/msg/Range` as of Iron, in CDR), all else in JSON.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use ::mcap::records::MessageHeader;
use ::mcap::{WriteOptions, Writer};

use crate::error::LogError;
use crate::firing_messages::{FIRING, message};
use crate::firings::Firing;
use crate::reading::Reading;

/// The fields of `sensor_msgs/msg/Range` and of what is in it.
const RANGE: &str = "\
std_msgs/Header header
uint8 ULTRASOUND=0
uint8 INFRARED=1
uint8 radiation_type
float32 field_of_view
float32 min_range
float32 max_range
float32 range
float32 variance
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

/// An MCAP file, open for writing.
pub struct McapWriter {
    file: PathBuf,
    writer: Writer<BufWriter<File>>,
    /// By the name of the type.
    schemas: BTreeMap<String, u16>,
    /// By topic: its channel, and how many messages it has.
    channels: BTreeMap<String, (u16, u32)>,
    message: Vec<u8>,
}

impl McapWriter {
    /// Creates the file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn create(file: &Path) -> Result<Self, LogError> {
        let opened = File::create(file).map_err(|error| LogError::new(file, error))?;
        let options = WriteOptions::new().profile("ros2").library("eeruf");
        let failed = |error: ::mcap::McapError| LogError::new(file, error);
        let writer = Writer::with_options(BufWriter::new(opened), options).map_err(failed)?;
        let (schemas, channels) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { file: file.to_owned(), writer, schemas, channels, message: Vec::new() })
    }

    fn failed(&self, error: impl fmt::Display) -> LogError {
        LogError::new(&self.file, error)
    }

    /// Writes a reading onto a topic, at time 0 if it has none. A frame is at most 4 GB long.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn range(&mut self, topic: &str, frame: &str, reading: &Reading) -> Result<(), LogError> {
        let mut message = std::mem::take(&mut self.message);
        encode(frame, reading, &mut message);
        let schema = ("sensor_msgs/msg/Range", "ros2msg", RANGE);
        let written = self.write(topic, schema, "cdr", reading.at_ns.unwrap_or(0), &message);
        self.message = message;
        written
    }

    /// Writes a JSON object onto a topic, as a message of this type, at this time in nanoseconds. The type is known to
    /// readers by its name, as those of Foxglove are; the schema in the file says only that it is an object.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn json(&mut self, topic: &str, type_name: &str, at_ns: u64, object: &str) -> Result<(), LogError> {
        let schema = (type_name, "jsonschema", r#"{"type":"object"}"#);
        self.write(topic, schema, "json", at_ns, object.as_bytes())
    }

    /// Writes one firing of a ring onto a topic, for [`FiringLog::read`](crate::FiringLog::read); the clock of its
    /// times is named, and the message's own time is in nanoseconds.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn firing(&mut self, topic: &str, clock: &str, at_ns: u64, firing: &Firing) -> Result<(), LogError> {
        self.json(topic, FIRING, at_ns, &message(clock, firing).to_string())
    }

    fn write(
        &mut self,
        topic: &str,
        (type_name, schema_encoding, schema): (&str, &str, &str),
        encoding: &str,
        at_ns: u64,
        message: &[u8],
    ) -> Result<(), LogError> {
        if !self.channels.contains_key(topic) {
            let schema = match self.schemas.get(type_name) {
                Some(&schema) => schema,
                None => {
                    let added = self.writer.add_schema(type_name, schema_encoding, schema.as_bytes());
                    let schema = added.map_err(|error| self.failed(error))?;
                    self.schemas.insert(type_name.to_owned(), schema);
                    schema
                }
            };
            let added = self.writer.add_channel(schema, topic, encoding, &BTreeMap::new());
            let channel = added.map_err(|error| self.failed(error))?;
            self.channels.insert(topic.to_owned(), (channel, 0));
        }
        let Some((channel, sequence)) = self.channels.get_mut(topic) else { return Ok(()) };
        *sequence = sequence.wrapping_add(1);
        let (channel_id, sequence) = (*channel, *sequence);
        let header = MessageHeader { channel_id, sequence, log_time: at_ns, publish_time: at_ns };
        self.writer.write_to_known_channel(&header, message).map_err(|error| LogError::new(&self.file, error))
    }

    /// Writes what is left, and the index.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.writer.finish().map(drop).map_err(|error| LogError::new(&self.file, error))
    }
}

/// `Range` in little-endian CDR.
fn encode(frame: &str, reading: &Reading, message: &mut Vec<u8>) {
    const HEAD: usize = 4;
    let align = |message: &mut Vec<u8>| {
        let length = (message.len() - HEAD).next_multiple_of(4) + HEAD;
        message.resize(length, 0);
    };
    message.clear();
    message.extend([0, 1, 0, 0]);
    let at_ns = reading.at_ns.unwrap_or(0);
    let (seconds, nanoseconds) = (at_ns / 1_000_000_000, at_ns % 1_000_000_000);
    message.extend((seconds as u32).to_le_bytes());
    message.extend((nanoseconds as u32).to_le_bytes());
    message.extend((frame.len() as u32 + 1).to_le_bytes());
    message.extend(frame.as_bytes());
    message.push(0);
    message.push(reading.radiation);
    align(message);
    let Reading { field_of_view_rad, min_range_m, max_range_m, range_m, variance, .. } = *reading;
    let metres = [min_range_m, max_range_m, range_m].map(|metres| metres as f32);
    for number in [&[field_of_view_rad], &metres[..], &[variance.unwrap_or(0.0)]].concat() {
        message.extend(number.to_le_bytes());
    }
}
