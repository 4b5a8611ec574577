//! Firing logs in MCAP: messages of the type `eeruf.Firing` in JSON.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde_json::{Value, json};

use crate::error::LogError;
use crate::firings::{Firing, FiringLog, MAX_SENSORS, was_rejected};
use crate::weighed::Weighed;

/// The type of the messages.
pub(crate) const FIRING: &str = "eeruf.Firing";

/// One firing as a message.
pub(crate) fn message(clock: &str, firing: &Firing) -> Value {
    let reading = Some(firing.reading()).filter(|reading| !reading.is_empty());
    let mut message = json!({
        "clock": clock, "sensor": firing.sensor, "fired_us": firing.fired_us, "period": firing.period,
        "phase": firing.phase, "t_echo_us": firing.t_echo_us, "reading": reading,
    });
    if let (Some(weighed), Some(fields)) = (&firing.weighed, message.as_object_mut()) {
        weighed.add_to(fields);
    }
    message
}

/// Reads the firings of a file, as far as it is whole.
pub(crate) fn read(file: &Path) -> Result<FiringLog, LogError> {
    let mut input = BufReader::new(File::open(file).map_err(|error| LogError::new(file, error))?);
    let mut reader = LinearReader::new_with_options(LinearReaderOptions::default().with_emit_chunks(false));
    let mut of = Found::default();
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = input.read(reader.insert(wanted)).map_err(|error| LogError::new(file, error))?;
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
    /// The channels that have messages.
    used: BTreeSet<u16>,
    clock: String,
    firings: Vec<Firing>,
    listened: Vec<Firing>,
    damage: Option<String>,
}

impl Found {
    fn record(&mut self, opcode: u8, data: &[u8], file: &Path) -> Result<(), LogError> {
        let Ok(record) = ::mcap::parse_record(opcode, data) else {
            self.damage = Some("a record does not have the fields of its kind".to_owned());
            return Ok(());
        };
        match record {
            ::mcap::records::Record::Schema { header, .. } if header.name == FIRING => {
                self.schemas.insert(header.id);
            }
            ::mcap::records::Record::Channel(channel)
                if self.schemas.contains(&channel.schema_id)
                    && self.channels.iter().all(|known| known.0 != channel.id) =>
            {
                self.channels.push((channel.id, channel.topic));
            }
            ::mcap::records::Record::Message { header, data } => {
                let id = header.channel_id;
                if let Some((_, topic)) = self.channels.iter().find(|known| known.0 == id) {
                    let message = serde_json::from_slice::<Value>(&data).ok();
                    let number = (self.firings.len() + self.listened.len()) as u64;
                    let firing = message.as_ref().and_then(|message| firing(message, number));
                    let expected = "expected sensor (0 to 63), fired_us, period, phase and t_echo_us (or null), and of \
                                    solo, steady and changes all or none";
                    let bad = || {
                        LogError::new(file, format!("topic {topic}: {}; {expected}", String::from_utf8_lossy(&data)))
                    };
                    let firing = firing.ok_or_else(bad)?;
                    let field = |name: &str| message.as_ref().and_then(|message| message.get(name));
                    if let Some(clock) = field("clock").and_then(Value::as_str).filter(|_| self.clock.is_empty()) {
                        clock.clone_into(&mut self.clock);
                    }
                    let only_listened = field("sends").is_some_and(|sends| sends == 0 || sends == false);
                    if only_listened { &mut self.listened } else { &mut self.firings }.push(firing);
                    self.used.insert(id);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn log(self, file: &Path) -> Result<FiringLog, LogError> {
        if self.firings.is_empty() {
            let why = self.damage.map_or(String::new(), |damage| format!("; {damage}"));
            return Err(LogError::new(file, format!("no firings: expected messages of the type {FIRING}{why}")));
        }
        if self.used.len() > 1 {
            let topics = self.channels.into_iter().filter(|channel| self.used.contains(&channel.0));
            let topics = topics.map(|channel| channel.1).collect::<Vec<_>>().join(", ");
            return Err(LogError::new(file, format!("firings of several rings: {topics}; expected one topic")));
        }
        let clock = if self.clock.is_empty() { "unnamed" } else { &self.clock };
        Ok(FiringLog { listened: self.listened, damage: self.damage, ..FiringLog::new(clock, self.firings) })
    }
}

/// The firing at this place, if the message has all that one has.
fn firing(message: &Value, place: u64) -> Option<Firing> {
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
        weighed: Weighed::of_message(message, place)?,
        rejected: message.get("reading").and_then(Value::as_str).map(was_rejected),
    })
}
