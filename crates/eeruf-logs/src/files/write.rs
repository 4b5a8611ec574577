//! Writes MCAP with messages of ROS 2, in CDR: `sensor_msgs/msg/Range` as of Iron, poses, markers, firings.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use ::mcap::records::MessageHeader;
use ::mcap::{WriteOptions, Writer};

use super::cdr::Cdr;
use super::ros2::{self, Marker, Transform};
use crate::firings::Firing;
use crate::reading::LogReading;
use eeruf_files::FileError;

/// An MCAP file, open for writing.
pub struct McapWriter {
    file: PathBuf,
    writer: Writer<BufWriter<File>>,
    /// Schemas by the name of their type.
    schemas: BTreeMap<&'static str, u16>,
    /// Channels by topic, each with its number of messages.
    channels: BTreeMap<String, (u16, u32)>,
    message: Vec<u8>,
}

/// A failure to write, from the crate that writes.
fn unwritten(file: &Path, error: &::mcap::McapError) -> FileError {
    match error {
        ::mcap::McapError::Io(error) => FileError::writing(file, error),
        _ => FileError::new(file, error),
    }
}

impl McapWriter {
    /// Creates the file.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(file: &Path) -> Result<Self, FileError> {
        let opened = File::create(file).map_err(|error| FileError::writing(file, &error))?;
        let options = WriteOptions::new().profile("ros2").library("eeruf");
        let failed = |error| unwritten(file, &error);
        let writer = Writer::with_options(BufWriter::new(opened), options).map_err(failed)?;
        let (schemas, channels) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { file: file.to_owned(), writer, schemas, channels, message: Vec::new() })
    }

    /// Writes a reading to a topic, at time 0 if it has none. A frame is at most 4 GB long.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn range(&mut self, topic: &str, frame: &str, reading: &LogReading) -> Result<(), FileError> {
        let at_ns = reading.at_ns.unwrap_or(0);
        self.write(topic, ros2::RANGE, at_ns, |out| ros2::range(out, frame, reading))
    }

    /// Writes one firing of a ring to a topic, for [`FiringLog::read`](crate::FiringLog::read), with the name of its
    /// clock; the message's own time is in nanoseconds.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn firing(&mut self, topic: &str, clock: &str, at_ns: u64, firing: &Firing) -> Result<(), FileError> {
        self.write(topic, ros2::FIRING, at_ns, |out| ros2::firing(out, at_ns, clock, firing))
    }

    /// Writes the places of frames, a `tf2_msgs/msg/TFMessage`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn transforms(&mut self, topic: &str, at_ns: u64, transforms: &[Transform]) -> Result<(), FileError> {
        self.write(topic, ros2::TRANSFORMS, at_ns, |out| ros2::transforms(out, at_ns, transforms))
    }

    /// Writes a robot's place, and its velocities in its own frame, a `nav_msgs/msg/Odometry`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn odometry(
        &mut self,
        topic: &str,
        at_ns: u64,
        of: &Transform,
        linear_m_s: [f64; 3],
        angular_rad_s: [f64; 3],
    ) -> Result<(), FileError> {
        self.write(topic, ros2::ODOMETRY, at_ns, |out| ros2::odometry(out, at_ns, of, linear_m_s, angular_rad_s))
    }

    /// Writes markers, as a `visualization_msgs/msg/MarkerArray`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn markers(&mut self, topic: &str, at_ns: u64, markers: &[Marker]) -> Result<(), FileError> {
        self.write(topic, ros2::MARKERS, at_ns, |out| ros2::markers(out, at_ns, markers))
    }

    fn write(
        &mut self,
        topic: &str,
        of: &'static str,
        at_ns: u64,
        encode: impl FnOnce(&mut Cdr),
    ) -> Result<(), FileError> {
        let mut message = Cdr::begin(std::mem::take(&mut self.message));
        encode(&mut message);
        self.message = message.bytes();
        if !self.channels.contains_key(topic) {
            let schema = match self.schemas.get(of) {
                Some(&schema) => schema,
                None => {
                    let added = self.writer.add_schema(of, "ros2msg", ros2::definition(of).as_bytes());
                    let schema = added.map_err(|error| unwritten(&self.file, &error))?;
                    self.schemas.insert(of, schema);
                    schema
                }
            };
            let added = self.writer.add_channel(schema, topic, "cdr", &BTreeMap::new());
            let channel = added.map_err(|error| unwritten(&self.file, &error))?;
            self.channels.insert(topic.to_owned(), (channel, 0));
        }
        let Some((channel, sequence)) = self.channels.get_mut(topic) else { return Ok(()) };
        *sequence = sequence.wrapping_add(1);
        let (channel_id, sequence) = (*channel, *sequence);
        let header = MessageHeader { channel_id, sequence, log_time: at_ns, publish_time: at_ns };
        self.writer.write_to_known_channel(&header, &self.message).map_err(|error| unwritten(&self.file, &error))
    }

    /// Writes the rest of the file, and the index.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), FileError> {
        self.writer.finish().map(drop).map_err(|error| unwritten(&self.file, &error))
    }
}
