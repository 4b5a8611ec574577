//! Firing logs in MCAP: messages `eeruf_msgs/msg/Firing` of ROS 2.

use std::collections::BTreeSet;
use std::io::{BufReader, Read};
use std::path::Path;

use ::mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::firing_text::{MAX_SENSORS, kind_of};
use crate::firings::{Firing, FiringLog};
use crate::message::cdr_bytes;
use eeruf_files::FileError;

/// The type of the messages in ROS 2.
pub(crate) const FIRING: &str = "eeruf_msgs/msg/Firing";

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

/// Decodes a ROS 2 message into a firing and the name of its clock.
fn of_cdr(data: &[u8]) -> Option<(Firing, String)> {
    let (mut rest, most) = cdr_bytes(data)?;
    rest.take(8)?;
    rest.text()?;
    rest.align(4)?;
    let clock = rest.text()?.trim_end_matches('\0').to_owned();
    let sensor = Some(rest.u8()?).filter(|&sensor| sensor < MAX_SENSORS);
    rest.align(most)?;
    let fired_us = rest.u64()?.cast_signed();
    let (period, phase, has_echo) = (rest.u32()?, rest.u8()?, rest.u8()? != 0);
    rest.align(4)?;
    let t_echo_us = Some(rest.u32()?).filter(|_| has_echo);
    let reading = kind_of(rest.text()?.trim_end_matches('\0'));
    rest.align(4)?;
    let g_us_ms = Some(f32::from_bits(rest.u32()?)).filter(|g| *g >= 0.0);
    Some((Firing { sensor: sensor?, fired_us, period, phase, t_echo_us, reading, g_us_ms }, clock))
}

/// Reads the firings of a file, up to damage; `file` is used in errors.
pub(crate) fn read(input: impl Read, file: &Path) -> Result<FiringLog, FileError> {
    let mut input = BufReader::new(input);
    let mut reader = LinearReader::new_with_options(LinearReaderOptions::default().with_emit_chunks(false));
    let mut of = FiringMessages::default();
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
struct FiringMessages {
    /// Schemas of firings, and channels that have them.
    schemas: BTreeSet<u16>,
    channels: Vec<(u16, String)>,
    /// The channels that have messages.
    used: BTreeSet<u16>,
    clock: String,
    firings: Vec<Firing>,
    damage: Option<String>,
}

impl FiringMessages {
    fn record(&mut self, opcode: u8, data: &[u8], file: &Path) -> Result<(), FileError> {
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
                    let expected = "expected sensor (0 to 63), fired_us, period, phase and t_echo_us";
                    let bad =
                        || FileError::new(file, format!("topic {topic}: a message that is no firing; {expected}"));
                    let (firing, clock) = of_cdr(&data).ok_or_else(bad)?;
                    if self.clock.is_empty() {
                        self.clock = clock;
                    }
                    self.firings.push(firing);
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
            return Err(FileError::new(file, format!("0 firings; expected messages of the type {FIRING}{why}")));
        }
        if self.used.len() > 1 {
            let topics = self.channels.into_iter().filter(|channel| self.used.contains(&channel.0));
            let topics = topics.map(|channel| channel.1).collect::<Vec<_>>().join(", ");
            return Err(FileError::new(file, format!("firings of several rings: {topics}; expected one topic")));
        }
        let clock = if self.clock.is_empty() { "unnamed" } else { &self.clock };
        Ok(FiringLog { damage: self.damage, ..FiringLog::new(clock, self.firings) })
    }
}
