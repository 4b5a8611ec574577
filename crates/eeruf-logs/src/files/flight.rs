//! Distance sensors in flight logs: `ArduPilot`'s `.BIN`, `MAVLink`'s `.tlog`, `PX4`'s `.ulg`.

use std::collections::{BTreeMap, HashMap};
use std::io::{self, Read};
use std::path::Path;

use eeruf_files::FileError;

use super::bytes::{Bytes, Order};
use crate::reading::{LogReading, Sensor};
use crate::sink::{Sink, Skipped};

/// A form of flight log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flight {
    DataFlash,
    Telemetry,
    ULog,
}

impl Flight {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::DataFlash => "a DataFlash log of ArduPilot",
            Self::Telemetry => "MAVLink telemetry",
            Self::ULog => "a ULog file of PX4",
        }
    }

    /// The message with distances.
    const fn message(self) -> &'static str {
        match self {
            Self::DataFlash => "RFND",
            Self::Telemetry => "DISTANCE_SENSOR",
            Self::ULog => "distance_sensor",
        }
    }
}

/// One message.
struct Distance {
    at_us: u64,
    instance: u8,
    /// The range, with infinities as in REP 117; `None` for sensors that do not measure by sound.
    range_m: Option<f64>,
    max_m: f64,
}

/// The bytes of the log in their order.
struct Input<'a> {
    input: &'a mut dyn Read,
    at: u64,
}

impl Input<'_> {
    /// The next `length` bytes; `None` if fewer are left.
    fn take(&mut self, length: usize) -> io::Result<Option<Vec<u8>>> {
        let mut bytes = vec![];
        self.at += (&mut *self.input).take(length as u64).read_to_end(&mut bytes)? as u64;
        Ok((bytes.len() == length).then_some(bytes))
    }

    fn byte(&mut self) -> io::Result<Option<u8>> {
        Ok(self.take(1)?.map(|bytes| bytes[0]))
    }
}

/// Reads the distances of a flight log.
pub(crate) fn read(flight: Flight, input: &mut dyn Read, file: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let (mut input, mut other) = (Input { input: &mut io::BufReader::new(input), at: 0 }, 0);
    let mut sensors = BTreeMap::new();
    let mut each = |of: Distance| {
        let Some(range_m) = of.range_m else { return other += 1 };
        let sensor = *sensors.entry(of.instance).or_insert_with(|| {
            let topic = format!("{} {}", flight.message(), of.instance);
            sink.report.sensors.push(Sensor { topic, frame: String::new(), beam: None });
            sink.report.sensors.len() - 1
        });
        sink.report.messages += 1;
        sink.reading(&LogReading::new(sensor, Some(of.at_us.saturating_mul(1000)), range_m, of.max_m));
    };
    let damaged = match flight {
        Flight::DataFlash => data_flash(&mut input, &mut each),
        Flight::Telemetry => telemetry(&mut input, &mut each),
        Flight::ULog => ulog(&mut input, &mut each),
    };
    let damaged = damaged.map_err(|error| FileError::reading(file, &error))?;
    if damaged > 0 {
        sink.damage(file, Some(input.at), format!("{damaged} bytes that are no message were passed over"));
    }
    let skipped = |why| Skipped { messages: other, ..Skipped::new(flight.message(), why) };
    if other > 0 {
        sink.report.skipped.push(skipped("of lasers, radars and infrared light".to_owned()));
    } else if sink.report.sensors.is_empty() {
        sink.report.skipped.push(skipped(format!("no such message in {}", flight.name())));
    }
    Ok(())
}

/// The fields of a message by their names, each with its type.
type Fields = Vec<(String, String)>;

/// The size of a type, given by its letter in ArduPilot's logs or its name in PX4's.
fn size(kind: &str) -> Option<usize> {
    Some(match kind {
        "b" | "B" | "M" | "int8_t" | "uint8_t" | "bool" | "char" => 1,
        "h" | "H" | "c" | "C" | "g" | "int16_t" | "uint16_t" => 2,
        "i" | "I" | "e" | "E" | "L" | "f" | "n" | "int32_t" | "uint32_t" | "float" => 4,
        "q" | "Q" | "d" | "int64_t" | "uint64_t" | "double" => 8,
        "N" => 16,
        "Z" | "a" => 64,
        _ => {
            let (kind, count) = kind.strip_suffix(']')?.split_once('[')?;
            size(kind)? * count.parse::<usize>().ok()?
        }
    })
}

/// The numeric value of a field.
fn field(fields: &Fields, body: &[u8], name: &str) -> Option<f64> {
    let mut rest = Bytes::new(body, Order::Little);
    for (own, kind) in fields {
        let bytes = rest.take(size(kind)?)?;
        if own != name {
            continue;
        }
        let mut of = [0; 8];
        of[..bytes.len().min(8)].copy_from_slice(&bytes[..bytes.len().min(8)]);
        let (unsigned, bits) = (u64::from_le_bytes(of), 64 - 8 * bytes.len().min(8));
        let signed = (unsigned << bits).cast_signed() >> bits;
        return Some(match kind.as_str() {
            "f" | "float" => f32::from_bits(unsigned as u32).into(),
            "d" | "double" => f64::from_bits(unsigned),
            "c" | "e" => signed as f64 * 0.01,
            "C" | "E" => unsigned as f64 * 0.01,
            kind if kind.starts_with('i') || kind == "b" || kind == "h" || kind == "q" => signed as f64,
            _ => unsigned as f64,
        });
    }
    None
}

/// A text that ends at the first zero byte.
fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.split(|&byte| byte == 0).next().unwrap_or_default()).into_owned()
}

/// Reads ArduPilot's messages, each after `a3 95` and after its format. Returns the number of skipped bytes.
fn data_flash(input: &mut Input<'_>, each: &mut dyn FnMut(Distance)) -> io::Result<u64> {
    const FORMAT: u8 = 0x80;
    let mut formats = HashMap::from([(FORMAT, (89, String::new(), vec![]))]);
    let (mut passed, mut before) = (0, 0);
    while let Some(byte) = input.byte()? {
        if (before, byte) != (0xa3, 0x95) {
            passed += u64::from(byte != 0xa3 || before == 0xa3);
            before = byte;
            continue;
        }
        before = 0;
        let Some(kind) = input.byte()? else { break };
        let Some((length, name, fields)) = formats.get(&kind) else {
            passed += 3;
            continue;
        };
        let Some(body) = input.take(usize::from(*length).saturating_sub(3))? else { break };
        if kind == FORMAT {
            let kinds = text(&body[6..22]);
            let fields =
                text(&body[22..86]).split(',').map(str::to_owned).zip(kinds.chars().map(String::from)).collect();
            formats.insert(body[0], (body[1], text(&body[2..6]), fields));
        } else if name == "RFND" {
            let of = |name| field(fields, &body, name);
            // 4 is good, 3 beyond the range and 2 below it.
            let range_m = match of("Stat") {
                Some(2.0) => f64::NEG_INFINITY,
                Some(status) if status < 4.0 => f64::INFINITY,
                _ => of("Dist").unwrap_or(f64::NAN),
            };
            let (at_us, instance) = (of("TimeUS").unwrap_or(0.0) as u64, of("Instance").unwrap_or(0.0) as u8);
            each(Distance { at_us, instance, range_m: Some(range_m), max_m: 0.0 });
        }
    }
    Ok(passed)
}

/// Reads `MAVLink`: frames of version 1 or 2, each after its time.
fn telemetry(input: &mut Input<'_>, each: &mut dyn FnMut(Distance)) -> io::Result<u64> {
    const DISTANCE_SENSOR: u32 = 132;
    /// The byte of the message's definition that its check sum includes.
    const EXTRA: u8 = 85;
    let (mut passed, mut head) = (0, vec![]);
    loop {
        if head.len() < 9 {
            let Some(more) = input.take(9 - head.len())? else { return Ok(passed) };
            head.extend(more);
        }
        let version = match head[8] {
            0xfe => 1,
            0xfd => 2,
            _ => {
                head.remove(0);
                passed += 1;
                continue;
            }
        };
        let Some(mut frame) = input.take(if version == 1 { 5 } else { 9 })? else { return Ok(passed) };
        let length = usize::from(frame[0]);
        let is_signed = version == 2 && frame[1] & 1 == 1;
        let id = if version == 1 { frame[4].into() } else { u32::from_le_bytes([frame[6], frame[7], frame[8], 0]) };
        let Some(body) = input.take(length + 2 + if is_signed { 13 } else { 0 })? else { return Ok(passed) };
        let at_us = head[..8].iter().fold(0, |us, &byte| us << 8 | u64::from(byte));
        head.clear();
        frame.extend(&body[..length]);
        frame.push(EXTRA);
        if id != DISTANCE_SENSOR || checksum(&frame) != u16::from_le_bytes([body[length], body[length + 1]]) {
            continue;
        }
        // Zeroes at the end are left out.
        let mut of = body[..length].to_vec();
        of.resize(39, 0);
        let cm = |at: usize| f64::from(u16::from_le_bytes([of[at], of[at + 1]])) * 0.01;
        let (distance, is_sound, is_bad) = (cm(8), matches!(of[10], 1 | 4), of[38] == 1);
        let range_m = is_sound.then_some(if is_bad || distance == 0.0 { f64::INFINITY } else { distance });
        each(Distance { at_us, instance: of[11], range_m, max_m: cm(6) });
    }
}

/// The check sum of `MAVLink`, `CRC-16/MCRF4XX`.
fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |sum, &byte| {
        let low = byte ^ (sum as u8);
        let low = low ^ (low << 4);
        (sum >> 8) ^ (u16::from(low) << 8) ^ (u16::from(low) << 3) ^ (u16::from(low) >> 4)
    })
}

/// Reads PX4's messages, each after its size and kind.
fn ulog(input: &mut Input<'_>, each: &mut dyn FnMut(Distance)) -> io::Result<u64> {
    let (mut fields, mut instances): (Fields, HashMap<u16, u8>) = (vec![], HashMap::new());
    _ = input.take(16)?;
    while let Some(head) = input.take(3)? {
        let Some(body) = input.take(u16::from_le_bytes([head[0], head[1]]).into())? else { break };
        let word = |at: usize| body.get(at..at + 2).map_or(0, |two| u16::from_le_bytes([two[0], two[1]]));
        match head[2] {
            b'F' => {
                if let Some(of) = text(&body).strip_prefix("distance_sensor:") {
                    let field =
                        |field: &str| field.split_once(' ').map(|(kind, name)| (name.to_owned(), kind.to_owned()));
                    fields = of.split(';').filter_map(field).collect();
                }
            }
            b'A' if body.get(3..).is_some_and(|name| text(name) == "distance_sensor") => {
                instances.insert(word(1), body[0]);
            }
            b'D' => {
                let Some(&instance) = instances.get(&word(0)) else { continue };
                let of = |name| field(&fields, &body[2..], name);
                let max_m = of("max_distance").unwrap_or(0.0);
                let is_bad = of("signal_quality") == Some(0.0);
                let range_m = if is_bad { f64::INFINITY } else { of("current_distance").unwrap_or(f64::NAN) };
                // 0 is a laser, 2 infrared, 3 radar.
                let range_m = of("type").is_none_or(|kind| kind == 1.0 || kind == 4.0).then_some(range_m);
                each(Distance { at_us: of("timestamp").unwrap_or(0.0) as u64, instance, range_m, max_m });
            }
            _ => {}
        }
    }
    Ok(0)
}
