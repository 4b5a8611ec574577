//! Messages of topics, and the assignment of their readings to sensors.

use std::path::Path;
use std::rc::Rc;

use super::message::{Kind, MAX_BEAMS, Of, Undecoded};
use super::ros2::FIRING;
use super::schema::Encoding;
use crate::options::RangeUnit;
use crate::reading::Sensor;
use crate::sink::{Guess, Sink, Skipped, finite};

/// One topic of one file.
#[derive(Default)]
pub(crate) struct Topic {
    name: String,
    decoding: Option<Rc<(Encoding, Kind)>>,
    /// True for firings of a ring, if they are asked for.
    has_firings: bool,
    frames: Vec<Frame>,
    /// Index of the frame after the last one, since rings often fire in turn.
    next: usize,
    undecoded: u64,
    beams: u64,
    infrared: u64,
    /// The topic whose filtered readings this one holds.
    judged: Option<(String, u64)>,
    /// The unit of the numbers, once it is known.
    unit: Option<RangeUnit>,
    is_asked: bool,
}

struct Frame {
    id: Vec<u8>,
    /// The index of each beam's sensor.
    sensors: Vec<usize>,
}

impl Sink<'_> {
    /// A topic, given its name, the name of its type, its schema if there is one, and its encoding.
    pub(crate) fn topic(
        &mut self,
        name: &str,
        type_name: &str,
        schema: Option<&str>,
        encoding: Option<Encoding>,
    ) -> Topic {
        let kind = Kind::of(name, type_name, schema, self.options);
        let skip = |why: String| {
            let skipped = Skipped::new(name, why);
            if !self.report.skipped.contains(&skipped) {
                self.report.skipped.push(skipped);
            }
        };
        let decoding = match (kind, encoding) {
            (Ok(kind), Some(encoding)) => Ok(Rc::new((encoding, kind))),
            (Ok(_), None) => Err(format!("{type_name} in an encoding that is neither cdr nor ros1")),
            (Err(why), _) => Err(why),
        };
        let decoding = decoding.map_err(skip).ok();
        if decoding.is_some() {
            self.of_topics.names.insert(name.to_owned());
        }
        let is_asked =
            self.options.topics.iter().chain(self.options.fields.iter().map(|field| &field.topic)).any(|t| t == name);
        let base = ["/accepted", "/confirmed"].iter().find_map(|end| name.strip_suffix(end));
        let judged = base.filter(|_| !self.options.judged && !is_asked).map(|base| (base.to_owned(), 0));
        let has_firings = type_name == FIRING && self.of_topics.firings.is_some();
        Topic { name: name.to_owned(), decoding, has_firings, judged, is_asked, ..Topic::default() }
    }

    /// Adds a message on a topic, recorded at this time.
    pub(crate) fn message(&mut self, topic: &mut Topic, recorded_ns: u64, message: &[u8]) {
        if topic.has_firings
            && let Some(firings) = &mut self.of_topics.firings
        {
            return firings(&topic.name, message);
        }
        let Some(decoding) = topic.decoding.clone() else { return };
        let (encoding, kind) = &*decoding;
        if let Some((base, left_out)) = &mut topic.judged
            && self.of_topics.names.contains(base)
        {
            *left_out += 1;
            return;
        }
        self.of_topics.buffer.clear();
        let frame = match kind.decode(*encoding, message, recorded_ns, &mut self.of_topics.buffer) {
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
        match kind.of {
            Of::Range => {
                let infrared = self.of_topics.buffer.first().is_some_and(|reading| reading.radiation == 1);
                if infrared && !topic.is_asked {
                    topic.infrared += 1;
                    return;
                }
                self.doubt(&topic.name);
            }
            Of::Numbers { unit, .. } => self.scale(topic, unit),
            Of::Points => self.scale(topic, Some(RangeUnit::M)),
            Of::LaserScan(_) => {}
        }
        let is_shared = self.of_topics.buffer.len() > 1
            && self.of_topics.buffer.iter().all(|reading| reading.at_ns == self.of_topics.buffer[0].at_ns);
        self.one_time_a_row |= is_shared;
        self.has_own_times |= !is_shared;
        self.report.messages += 1;
        let at = topic.frame(frame);
        let frame = &mut topic.frames[at];
        for reading in &mut self.of_topics.buffer {
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

    /// Warns about ranges that no ultrasonic sensor measures, such as centimetres instead of metres.
    fn doubt(&mut self, topic: &str) {
        /// The farthest that a sensor in air sees is about 11 m.
        const FARTHEST_M: f64 = 25.0;
        let Some(reading) = self.of_topics.buffer.first() else { return };
        let (most, range) = (reading.max_range_m, reading.range_m);
        if (most > FARTHEST_M || (range > FARTHEST_M && range.is_finite())) && !self.of_topics.warned.contains(topic) {
            self.of_topics.warned.insert(topic.to_owned());
            self.report.warnings.push(format!(
                "{topic}: a range of {range} m of at most {most} m; expected less than {FARTHEST_M} m from an \
                 ultrasonic sensor; if the driver writes centimetres, `--field {topic} range cm` reads them"
            ));
        }
    }

    /// Converts numbers of the buffer to metres, and zero, negative and far ones to no echo.
    fn scale(&mut self, topic: &mut Topic, known: Option<RangeUnit>) {
        let most = self
            .of_topics
            .buffer
            .iter()
            .map(|reading| reading.range_m)
            .filter(|range| range.is_finite())
            .fold(0.0, f64::max);
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
        for reading in &mut self.of_topics.buffer {
            let range_m = reading.range_m * metres;
            reading.max_range_m = self.options.no_echo_m;
            reading.range_m = if range_m.is_nan() || (range_m > 0.0 && range_m < self.options.no_echo_m) {
                range_m
            } else {
                f64::INFINITY
            };
        }
    }

    /// Ends a topic.
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
            self.report.skipped.push(Skipped { messages, ..Skipped::new(&topic.name, why) });
        }
    }

    /// Compares the number of messages that a file claims to have with the number found in it.
    pub(crate) fn counted(&mut self, file: &Path, counted: u64, before: u64) {
        let missing = (before + counted).saturating_sub(self.of_topics.found);
        if missing > 0 {
            self.damage(file, None, format!("{missing} of the {counted} messages that it counts were not found"));
        }
    }
}

impl Topic {
    /// Returns true if the topic's messages hold readings or firings, judging by their type.
    pub(crate) const fn has_readings(&self) -> bool {
        self.decoding.is_some() || self.has_firings
    }

    /// The index of a frame among those of the topic.
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
