//! Firing logs in MCAP: messages `eeruf_msgs/msg/Firing` of ROS 2, and `eeruf.Firing` in JSON from other programs.

use std::collections::BTreeSet;
use std::io::{BufReader, Read};
use std::path::Path;

use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde_json::{Value, json};

use crate::bytes::Bytes;
use crate::firings::{Firing, FiringLog, MAX_SENSORS, OF_HOPPING, kind_of};
use crate::message::cdr_bytes;
use eeruf_files::FileError;

/// The type of the messages in ROS 2.
pub(crate) const FIRING: &str = "eeruf_msgs/msg/Firing";

/// The type of the messages in JSON.
const JSON_FIRING: &str = "eeruf.Firing";

/// The fields of the message in ROS 2.
pub(crate) const FIRING_FIELDS: &str = "\
# One firing of one sensor of a ring; sensors, periods and phases count from 0.
std_msgs/Header header
string clock
uint8 sensor
int64 fired_us
uint32 period
uint8 phase
# Without an echo t_echo_us is 0.
bool has_echo
uint32 t_echo_us
# What the ring made of the reading; empty if unknown.
string reading
# How fast readings change with the robot's motion, in microseconds for each millisecond; -1 if unknown.
float32 g
";

/// Messages of earlier versions end with how a ring that hopped weighed the reading: a flag, and as many bytes.
const OF_HOPPING_BYTES: usize = 16;

/// A message of ROS 2 with the fields of one in JSON.
fn of_cdr(data: &[u8]) -> Option<Value> {
    let (mut rest, most) = cdr_bytes(data)?;
    let flag = |rest: &mut Bytes<'_>| Some(rest.u8()? != 0);
    rest.take(8)?;
    rest.text()?;
    rest.align(4)?;
    let clock = rest.text()?;
    let clock = clock.trim_end_matches('\0');
    let sensor = rest.u8()?;
    rest.align(most)?;
    let fired_us = rest.u64()?.cast_signed();
    let (period, phase, has_echo) = (rest.u32()?, rest.u8()?, flag(&mut rest)?);
    rest.align(4)?;
    let t_echo_us = Some(rest.u32()?).filter(|_| has_echo);
    let reading = rest.text()?;
    let reading = Some(reading.trim_end_matches('\0')).filter(|reading| !reading.is_empty());
    let mut message = json!({
        "clock": clock, "sensor": sensor, "fired_us": fired_us, "period": period, "phase": phase,
        "t_echo_us": t_echo_us, "reading": reading,
    });
    if rest.left() < OF_HOPPING_BYTES {
        rest.align(4)?;
        let g = f32::from_bits(rest.u32()?);
        message["g"] = json!((g >= 0.0).then_some(g));
    } else if flag(&mut rest)? {
        OF_HOPPING.iter().for_each(|&name| message[name] = json!(true));
    }
    Some(message)
}

/// Reads the firings of a file, as far as it is whole; `file` stands in errors.
pub(crate) fn read(input: impl Read, file: &Path) -> Result<FiringLog, FileError> {
    let mut input = BufReader::new(input);
    let mut reader = LinearReader::new_with_options(LinearReaderOptions::default().with_emit_chunks(false));
    let mut of = Found::default();
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = input.read(reader.insert(wanted)).map_err(|error| FileError::reading(file, &error))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { data, opcode }) => of.record(opcode, data, file)?,
            Err(error) => {
                of.damage = Some(format!("the rest cannot be read: {error}"));
                break;
            }
        }
    }
    of.log(file)
}

#[derive(Default)]
struct Found {
    /// Schemas of firings, and channels that have them.
    schemas: BTreeSet<u16>,
    channels: Vec<(u16, String)>,
    /// The channels in CDR.
    in_cdr: BTreeSet<u16>,
    /// The channels that have messages.
    used: BTreeSet<u16>,
    clock: String,
    firings: Vec<Firing>,
    listened: Vec<Firing>,
    of_hopping: bool,
    damage: Option<String>,
}

impl Found {
    fn record(&mut self, opcode: u8, data: &[u8], file: &Path) -> Result<(), FileError> {
        let Ok(record) = ::mcap::parse_record(opcode, data) else {
            self.damage = Some("a record does not have the fields of its kind".to_owned());
            return Ok(());
        };
        match record {
            ::mcap::records::Record::Schema { header, .. } if [FIRING, JSON_FIRING].contains(&header.name.as_str()) => {
                self.schemas.insert(header.id);
            }
            ::mcap::records::Record::Channel(channel)
                if self.schemas.contains(&channel.schema_id)
                    && self.channels.iter().all(|known| known.0 != channel.id) =>
            {
                if channel.message_encoding == "cdr" {
                    self.in_cdr.insert(channel.id);
                }
                self.channels.push((channel.id, channel.topic));
            }
            ::mcap::records::Record::Message { header, data } => {
                let id = header.channel_id;
                if let Some((_, topic)) = self.channels.iter().find(|known| known.0 == id) {
                    let message =
                        if self.in_cdr.contains(&id) { of_cdr(&data) } else { serde_json::from_slice(&data).ok() };
                    let firing = message.as_ref().and_then(firing);
                    let expected = "expected sensor (0 to 63), fired_us, period, phase and t_echo_us (or null)";
                    let bad = || {
                        let text = message.as_ref().map(Value::to_string);
                        let text = text.unwrap_or_else(|| String::from_utf8_lossy(&data).into_owned());
                        FileError::new(file, format!("topic {topic}: {text}; {expected}"))
                    };
                    let firing = firing.ok_or_else(bad)?;
                    let field = |name: &str| message.as_ref().and_then(|message| message.get(name));
                    if let Some(clock) = field("clock").and_then(Value::as_str).filter(|_| self.clock.is_empty()) {
                        clock.clone_into(&mut self.clock);
                    }
                    self.of_hopping |= OF_HOPPING.iter().all(|name| field(name).is_some());
                    let only_listened = field("sends").is_some_and(|sends| sends == 0 || sends == false);
                    if only_listened { &mut self.listened } else { &mut self.firings }.push(firing);
                    self.used.insert(id);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn log(self, file: &Path) -> Result<FiringLog, FileError> {
        if self.firings.is_empty() {
            let why = self.damage.map_or(String::new(), |damage| format!("; {damage}"));
            return Err(FileError::new(
                file,
                format!("0 firings; expected messages of the type {FIRING}, or {JSON_FIRING} in JSON{why}"),
            ));
        }
        if self.used.len() > 1 {
            let topics = self.channels.into_iter().filter(|channel| self.used.contains(&channel.0));
            let topics = topics.map(|channel| channel.1).collect::<Vec<_>>().join(", ");
            return Err(FileError::new(file, format!("firings of several rings: {topics}; expected one topic")));
        }
        let clock = if self.clock.is_empty() { "unnamed" } else { &self.clock };
        let Self { listened, of_hopping, damage, .. } = self;
        Ok(FiringLog { listened, of_hopping, damage, ..FiringLog::new(clock, self.firings) })
    }
}

/// The firing, if the message has all that one has.
fn firing(message: &Value) -> Option<Firing> {
    let number = |name: &str| message.get(name)?.as_f64().filter(|number| (0.0..9e15).contains(number));
    let t_echo_us = match message.get("t_echo_us") {
        None | Some(Value::Null) => None,
        Some(_) => Some(number("t_echo_us").filter(|&us| us < 4e9)?.round() as u32),
    };
    let whole = |name: &str| message.get(name)?.as_u64();
    Some(Firing {
        sensor: u8::try_from(whole("sensor")?).ok().filter(|&sensor| sensor < MAX_SENSORS)?,
        fired_us: number("fired_us")?.round() as i64,
        period: u32::try_from(whole("period")?).ok()?,
        phase: u8::try_from(whole("phase")?).ok()?,
        t_echo_us,
        g_us_ms: number("g").map(|g| g as f32),
        reading: message.get("reading").and_then(Value::as_str).and_then(kind_of),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cdr::Cdr;

    // Earlier versions ended with a flag, and with how a ring that hopped weighed the reading.
    #[test]
    fn message_of_a_hopping_ring_is_read_and_known_as_such() {
        for is_weighed in [true, false] {
            let mut out = Cdr::begin(vec![]);
            out.header(1, "");
            out.text("board");
            out.u8(3);
            out.i64(15_000);
            out.u32(7);
            out.u8(1);
            out.bool(true);
            out.u32(5_872);
            out.text("tentative");
            out.bool(is_weighed);
            out.i64(12);
            out.bool(false);
            out.bool(true);
            out.u8(7);
            out.i32(-120);
            let message = of_cdr(&out.bytes()).unwrap();
            let firing = firing(&message).unwrap();
            assert_eq!((firing.sensor, firing.t_echo_us, firing.g_us_ms), (3, Some(5_872), None));
            assert_eq!(OF_HOPPING.iter().all(|name| message.get(name).is_some()), is_weighed);
        }
    }
}
