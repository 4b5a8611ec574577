//! Where readers of files hand in messages: finds out which sensor each reading is of, counts, and notes what is lost.

use std::fmt;
use std::path::Path;

use crate::error::Damage;
use crate::message::{Encoding, Kind, MAX_BEAMS, Undecoded};
use crate::reading::{Reading, Sensor};

/// What a log holds, and what of it could not be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The sensors, in the order in which they were first met.
    pub sensors: Vec<Sensor>,
    /// How many messages with readings there were (rows, of a CSV file).
    pub messages: u64,
    /// What could not be read, as far as that is known.
    pub damage: Vec<Damage>,
    /// Topics without readings, with their types, and how many topics had none at all.
    pub skipped: Vec<Skipped>,
}

/// A topic whose messages, or some of them, hold no readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The topic.
    pub topic: String,
    /// Why its messages were left out.
    pub why: String,
    /// How many messages were left out, where they were counted.
    pub messages: u64,
}

impl Report {
    /// The name of each sensor: its topic, with the frame where several sensors share a topic.
    pub fn names(&self) -> Vec<String> {
        let of_topic = |topic: &str| self.sensors.iter().filter(|sensor| sensor.topic == topic).count();
        self.sensors.iter().map(|sensor| sensor.name(of_topic(&sensor.topic) == 1)).collect()
    }
}

/// Damage beyond this is counted, not listed.
const LISTED: usize = 100;

/// One topic of one file.
pub(crate) struct Topic {
    name: String,
    decoding: Option<(Encoding, Kind)>,
    frames: Vec<Frame>,
    /// The frame after the last one: rings often come in turn.
    next: usize,
    undecoded: u64,
    beams: u64,
}

struct Frame {
    id: Vec<u8>,
    /// The index of each beam's sensor.
    sensors: Vec<usize>,
}

/// Takes messages, and hands on readings.
pub(crate) struct Sink<'a> {
    pub(crate) report: Report,
    /// How many messages were found, of whatever type and whether or not they could be read.
    pub(crate) found: u64,
    each: &'a mut dyn FnMut(&[Sensor], &Reading),
    buffer: Vec<Reading>,
    more_damage: u64,
}

impl<'a> Sink<'a> {
    pub(crate) fn new(each: &'a mut dyn FnMut(&[Sensor], &Reading)) -> Self {
        Self { report: Report::default(), found: 0, each, buffer: Vec::new(), more_damage: 0 }
    }

    /// A topic by its name, the name of its type, the text of its schema if there is one, and its encoding.
    pub(crate) fn topic(
        &mut self,
        name: &str,
        type_name: &str,
        schema: Option<&str>,
        encoding: Option<Encoding>,
    ) -> Topic {
        let kind = Kind::of(type_name, schema);
        let mut skip = |why: String| {
            let skipped = Skipped { topic: name.to_owned(), why, messages: 0 };
            if !self.report.skipped.contains(&skipped) {
                self.report.skipped.push(skipped);
            }
        };
        let decoding = match (kind, encoding) {
            (Some(kind), Some(encoding)) => Some((encoding, kind)),
            (Some(_), None) => {
                skip(format!("{type_name} in an encoding that is neither cdr nor ros1"));
                None
            }
            (None, _) => {
                skip(format!("{type_name}; expected sensor_msgs Range or LaserScan"));
                None
            }
        };
        Topic { name: name.to_owned(), decoding, frames: Vec::new(), next: 0, undecoded: 0, beams: 0 }
    }

    /// A message on a topic, recorded at this time.
    pub(crate) fn message(&mut self, topic: &mut Topic, recorded_ns: u64, message: &[u8]) {
        let Some((encoding, kind)) = topic.decoding else { return };
        self.buffer.clear();
        let frame = match kind.decode(encoding, message, recorded_ns, &mut self.buffer) {
            Ok(frame) => frame,
            Err(Undecoded::Length) => {
                topic.undecoded += 1;
                return;
            }
            Err(Undecoded::Beams) => {
                topic.beams += 1;
                return;
            }
        };
        self.report.messages += 1;
        let at = topic.frame(frame);
        let frame = &mut topic.frames[at];
        for reading in &mut self.buffer {
            let beam = reading.sensor;
            while frame.sensors.len() <= beam {
                let number = frame.sensors.len();
                let sensor = Sensor {
                    topic: topic.name.clone(),
                    frame: String::from_utf8_lossy(&frame.id).into_owned(),
                    beam: (kind == Kind::LaserScan).then_some(number as u16),
                };
                // The same sensor may be in several files of a bag.
                let known = self.report.sensors.iter().position(|known| *known == sensor);
                frame.sensors.push(known.unwrap_or(self.report.sensors.len()));
                if known.is_none() {
                    self.report.sensors.push(sensor);
                }
            }
            reading.sensor = frame.sensors[beam];
            (self.each)(&self.report.sensors, reading);
        }
    }

    /// A reading that came in no message.
    pub(crate) fn reading(&mut self, reading: &Reading) {
        (self.each)(&self.report.sensors, reading);
    }

    /// No more messages will come on a topic.
    pub(crate) fn close(&mut self, topic: &Topic) {
        let lost = [
            (topic.undecoded, "a length that does not fit their type".to_owned()),
            (topic.beams, format!("more than {MAX_BEAMS} beams: a lidar, no ring of sonars")),
        ];
        for (messages, why) in lost.into_iter().filter(|(messages, _)| *messages > 0) {
            self.report.skipped.push(Skipped { topic: topic.name.clone(), why, messages });
        }
    }

    /// A file says how many messages it has, and before it so many had been found.
    pub(crate) fn counted(&mut self, file: &Path, counted: u64, before: u64) {
        let missing = (before + counted).saturating_sub(self.found);
        if missing > 0 {
            self.damage(file, None, format!("{missing} of the {counted} messages that it counts were not found"));
        }
    }

    /// A part of a file cannot be read.
    pub(crate) fn damage(&mut self, file: &Path, at: Option<u64>, message: impl fmt::Display) {
        if self.report.damage.len() < LISTED {
            let message = message.to_string().replace('\n', "; ");
            self.report.damage.push(Damage { file: file.to_owned(), at, message });
        } else {
            self.more_damage += 1;
        }
    }

    pub(crate) fn finish(mut self, file: &Path) -> Report {
        if self.more_damage > 0 {
            let message = format!("{} more places that cannot be read", self.more_damage);
            self.report.damage.push(Damage { file: file.to_owned(), at: None, message });
        }
        self.report
    }
}

impl Topic {
    /// Whether its messages hold readings, as far as its type says.
    pub(crate) const fn has_readings(&self) -> bool {
        self.decoding.is_some()
    }

    /// The place of a frame among those of the topic.
    fn frame(&mut self, id: &[u8]) -> usize {
        let known = match self.frames.get(self.next) {
            Some(frame) if frame.id == id => Some(self.next),
            _ => self.frames.iter().position(|frame| frame.id == id),
        };
        let at = known.unwrap_or_else(|| {
            self.frames.push(Frame { id: id.to_vec(), sensors: Vec::new() });
            self.frames.len() - 1
        });
        self.next = (at + 1) % self.frames.len();
        at
    }
}
