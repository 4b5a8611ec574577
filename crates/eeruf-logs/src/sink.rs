//! Where readers of files hand in messages: finds out which sensor each reading is of, counts, and notes what is lost.

use std::collections::HashSet;
use std::fmt;
use std::path::Path;

use crate::message::{Encoding, Kind, MAX_BEAMS, Undecoded};
use crate::options::{Options, Parts, RangeUnit};
use crate::pattern::{FiringPattern, Stamps};
use crate::reading::{Echo, Reading, Sensor};
use eeruf_files::FileError;

/// Contents of a log, and what of it could not be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The form of the file.
    pub form: String,
    /// The sensors, in the order in which they were first met.
    pub sensors: Vec<Sensor>,
    /// Number of messages with readings there that were (rows, of a CSV file).
    pub messages: u64,
    /// Damage, as far as it is known.
    pub damage: Vec<FileError>,
    /// Topics without readings, with their types, and how many topics had none at all.
    pub skipped: Vec<Skipped>,
    /// Guesses about what the log does not say.
    pub guesses: Vec<Guess>,
    /// Values that were read and seem to be wrong.
    pub warnings: Vec<String>,
    /// Firing pattern of the sensors, by the times of the readings.
    pub firing: FiringPattern,
}

/// A guess about a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// The subject of the guess.
    pub what: String,
    /// The guess, and what it is made by.
    pub value: String,
    /// The options that override it.
    pub option: String,
}

/// A topic whose messages, or some of them, hold no readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The topic.
    pub topic: String,
    /// Reason why its messages were left out.
    pub why: String,
    /// Number of messages that were left out, where they were counted.
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
    infrared: u64,
    /// The topic of which this one is what a filter made.
    judged: Option<(String, u64)>,
    /// The unit of numbers, once it is known.
    unit: Option<RangeUnit>,
    is_asked: bool,
}

struct Frame {
    id: Vec<u8>,
    /// The index of each beam's sensor.
    sensors: Vec<usize>,
}

/// Takes messages, and hands on readings.
pub(crate) struct Sink<'a> {
    pub(crate) report: Report,
    /// Number of messages that were found, of whatever type and whether or not they could be read.
    pub(crate) found: u64,
    each: &'a mut dyn FnMut(&Report, &Reading),
    buffer: Vec<Reading>,
    more_damage: u64,
    options: &'a Options,
    /// Topics with readings.
    topics: HashSet<String>,
    /// Topics of which one warning is enough.
    warned: HashSet<String>,
    stamps: Stamps,
    /// All readings of a row, or of a message, have its time.
    pub(crate) one_time_a_row: bool,
    /// Readings have times of their own.
    has_own_times: bool,
}

impl<'a> Sink<'a> {
    pub(crate) fn new(options: &'a Options, each: &'a mut dyn FnMut(&Report, &Reading)) -> Self {
        Self {
            report: Report::default(),
            found: 0,
            each,
            buffer: Vec::new(),
            more_damage: 0,
            options,
            topics: HashSet::new(),
            warned: HashSet::new(),
            stamps: Stamps::default(),
            one_time_a_row: false,
            has_own_times: false,
        }
    }

    /// The form of the log.
    pub(crate) fn form(&mut self, form: &str) {
        form.clone_into(&mut self.report.form);
    }

    /// Warns of options that choose from parts which the log does not have.
    pub(crate) fn has(&mut self, parts: Parts) {
        self.report.warnings.extend(self.options.without_effect(parts));
    }

    /// A topic by its name, the name of its type, the text of its schema if there is one, and its encoding.
    pub(crate) fn topic(
        &mut self,
        name: &str,
        type_name: &str,
        schema: Option<&str>,
        encoding: Option<Encoding>,
    ) -> Topic {
        let kind = Kind::of(name, type_name, schema, self.options);
        let mut skip = |why: String| {
            let skipped = Skipped { topic: name.to_owned(), why, messages: 0 };
            if !self.report.skipped.contains(&skipped) {
                self.report.skipped.push(skipped);
            }
        };
        let decoding = match (kind, encoding) {
            (Ok(kind), Some(encoding)) => Some((encoding, kind)),
            (Ok(_), None) => {
                skip(format!("{type_name} in an encoding that is neither cdr nor ros1"));
                None
            }
            (Err(why), _) => {
                skip(why);
                None
            }
        };
        if decoding.is_some() {
            self.topics.insert(name.to_owned());
        }
        let is_asked =
            self.options.topics.iter().chain(self.options.fields.iter().map(|field| &field.topic)).any(|t| t == name);
        let base = ["/accepted", "/confirmed"].iter().find_map(|end| name.strip_suffix(end));
        let judged = base.filter(|_| !self.options.judged && !is_asked).map(|base| (base.to_owned(), 0));
        Topic {
            name: name.to_owned(),
            decoding,
            frames: Vec::new(),
            next: 0,
            undecoded: 0,
            beams: 0,
            infrared: 0,
            judged,
            unit: None,
            is_asked,
        }
    }

    /// A message on a topic, recorded at this time.
    pub(crate) fn message(&mut self, topic: &mut Topic, recorded_ns: u64, message: &[u8]) {
        let Some((encoding, kind)) = topic.decoding.clone() else { return };
        if let Some((base, left_out)) = &mut topic.judged
            && self.topics.contains(base)
        {
            *left_out += 1;
            return;
        }
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
        match kind {
            Kind::Range { .. } => {
                let infrared = self.buffer.first().is_some_and(|reading| reading.radiation == 1);
                if infrared && !topic.is_asked {
                    topic.infrared += 1;
                    return;
                }
                self.doubt(&topic.name);
            }
            Kind::Numbers(ref numbers) => self.scale(topic, numbers.unit),
            Kind::Points(_) | Kind::Points2 => self.scale(topic, Some(RangeUnit::M)),
            Kind::LaserScan(_) => {}
        }
        let is_shared =
            self.buffer.len() > 1 && self.buffer.iter().all(|reading| reading.at_ns == self.buffer[0].at_ns);
        self.one_time_a_row |= is_shared;
        self.has_own_times |= !is_shared;
        self.report.messages += 1;
        let at = topic.frame(&frame);
        let frame = &mut topic.frames[at];
        for reading in &mut self.buffer {
            let beam = reading.sensor;
            while frame.sensors.len() <= beam {
                let number = frame.sensors.len();
                let sensor = Sensor {
                    topic: topic.name.clone(),
                    frame: String::from_utf8_lossy(&frame.id).into_owned(),
                    beam: kind.has_places().then_some(number as u16),
                };
                // The same sensor may be in several files of a bag.
                let known = self.report.sensors.iter().position(|known| *known == sensor);
                frame.sensors.push(known.unwrap_or(self.report.sensors.len()));
                if known.is_none() {
                    self.report.sensors.push(sensor);
                }
            }
            reading.sensor = frame.sensors[beam];
            self.stamps.push(reading.sensor, reading.at_ns, finite(reading));
            (self.each)(&self.report, reading);
        }
    }

    /// Warns of ranges that no ultrasonic sensor has: centimetres in place of metres.
    fn doubt(&mut self, topic: &str) {
        /// The farthest that a sensor in air sees is about 11 m.
        const FARTHEST_M: f64 = 25.0;
        let Some(reading) = self.buffer.first() else { return };
        let (most, range) = (reading.max_range_m, reading.range_m);
        if (most > FARTHEST_M || (range > FARTHEST_M && range.is_finite())) && !self.warned.contains(topic) {
            self.warned.insert(topic.to_owned());
            self.report.warnings.push(format!(
                "{topic}: a range of {range} m of at most {most} m; expected less than {FARTHEST_M} m from an \
                 ultrasonic sensor; if the driver writes centimetres, `--field {topic} range cm` reads them"
            ));
        }
    }

    /// Turns numbers of the buffer into metres, and zero, negative and far ones into no echo.
    fn scale(&mut self, topic: &mut Topic, known: Option<RangeUnit>) {
        let most =
            self.buffer.iter().map(|reading| reading.range_m).filter(|range| range.is_finite()).fold(0.0, f64::max);
        if topic.unit.is_none() && (known.is_some() || most > 0.0) {
            let by_values = match most {
                _ if most <= 20.0 => RangeUnit::M,
                _ if most <= 1100.0 => RangeUnit::Cm,
                _ => RangeUnit::Mm,
            };
            let unit = known.unwrap_or(by_values);
            topic.unit = Some(unit);
            let why = if known.is_some() { String::new() } else { format!(", by values of up to {}", most as f32) };
            let (what, value) = (format!("range unit of {}", topic.name), format!("{}{why}", unit.name()));
            self.report.guesses.push(Guess { what, value, option: "--field".to_owned() });
        }
        let metres = topic.unit.unwrap_or(RangeUnit::M).metres(self.options.speed_of_sound);
        for reading in &mut self.buffer {
            let range_m = reading.range_m * metres;
            reading.max_range_m = self.options.no_echo_m;
            reading.range_m = if range_m.is_nan() || (range_m > 0.0 && range_m < self.options.no_echo_m) {
                range_m
            } else {
                f64::INFINITY
            };
        }
    }

    /// A reading that came in no message.
    pub(crate) fn reading(&mut self, reading: &Reading) {
        self.stamps.push(reading.sensor, reading.at_ns, finite(reading));
        (self.each)(&self.report, reading);
    }

    /// No more messages will come on a topic.
    pub(crate) fn close(&mut self, topic: &Topic) {
        let lost = [
            (topic.undecoded, "a length that does not fit their type".to_owned()),
            (
                topic.beams,
                format!(
                    "more than {MAX_BEAMS} beams: a lidar, no ring of sonars; --topic {} reads them all the same",
                    topic.name
                ),
            ),
            (topic.infrared, format!("infrared light, no sound; --topic {} reads them", topic.name)),
            (
                topic.judged.as_ref().map_or(0, |judged| judged.1),
                "what a filter made of another topic; --topic reads it".to_owned(),
            ),
        ];
        for (messages, why) in lost.into_iter().filter(|(messages, _)| *messages > 0) {
            self.report.skipped.push(Skipped { topic: topic.name.clone(), why, messages });
        }
    }

    /// A file says how many messages it has, and the number found before it.
    pub(crate) fn counted(&mut self, file: &Path, counted: u64, before: u64) {
        let missing = (before + counted).saturating_sub(self.found);
        if missing > 0 {
            self.damage(file, None, format!("{missing} of the {counted} messages that it counts were not found"));
        }
    }

    /// A line of a text cannot be read.
    pub(crate) fn damaged_line(&mut self, file: &Path, line: u64, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_line(Some(line)));
    }

    /// A part of a file cannot be read.
    pub(crate) fn damage(&mut self, file: &Path, at: Option<u64>, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_byte(at));
    }

    /// Lists damage, as far as there is room for it.
    pub(crate) fn note(&mut self, damage: FileError) {
        if self.report.damage.len() < LISTED {
            self.report.damage.push(damage);
        } else {
            self.more_damage += 1;
        }
    }

    pub(crate) fn finish(mut self, file: &Path) -> Report {
        if self.more_damage > 0 {
            let message = format!("{} more places that cannot be read", self.more_damage);
            self.report.damage.push(FileError::new(file, message));
        }
        self.report.firing = self.stamps.pattern(self.report.sensors.len(), self.one_time_a_row && !self.has_own_times);
        self.report
    }
}

fn finite(reading: &Reading) -> Option<f64> {
    match reading.echo() {
        Echo::At(range_m) => Some(range_m),
        _ => None,
    }
}

impl Topic {
    /// Returns true if its messages hold readings, as far as its type says.
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
