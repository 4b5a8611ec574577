//! [`Decoder`]: turns bytes into messages, even if the line has damaged them.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use crc::{CRC_16_IBM_3740, Crc, Table};
use eeruf_core::{Instant, MAX_SENSORS, Micros, ReadingKind, judge::Explanation};

use crate::encode::{LONGEST_CLOCK, LONGEST_FRAME};
use crate::firing::FiringMessage;
use crate::{BY_HISTORY, BY_NOTHING, FIRING, HELLO, NO_ECHO, OF_HOPPING, OLDEST_VERSION, PERIOD, VERSION};

const CRC: Crc<u16, Table<1>> = Crc::<u16, Table<1>>::new(&CRC_16_IBM_3740);

/// Contents of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Message {
    /// A greeting that the board sends now and then.
    Hello {
        /// Number of the board's sensors, 1 to 64.
        sensors: u8,
        /// Name of the board's clock.
        clock: String,
    },
    /// A firing, and its outcome.
    Firing(FiringMessage),
    /// A period has ended.
    Period {
        /// The number, from 0.
        period: u32,
        /// The largest lateness of a firing in the period.
        max_late: Micros,
        /// Number of edges lost on the board since it started, modulo 256.
        edges_lost: u8,
        /// Health of each sensor, numbered as `eeruf_hc_sr04::Health`.
        health: Vec<u8>,
    },
}

/// Number of extra bytes in a firing of a hopping ring, for the weights of the reading.
const HOW: usize = 6;

/// A message and its frame's number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Received {
    /// The number, which wraps: frames that are missing in between were lost.
    pub sequence: u16,
    /// Contents of the frame.
    pub message: Message,
    /// True for a firing of a hopping ring, which boards of earlier versions send; the weights of the reading are
    /// ignored.
    pub of_hopping: bool,
}

/// Reason why the bytes between two zeros are not a valid frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameError {
    /// The frame is damaged or cut: not COBS, too long or too short, or its check sum is wrong.
    Damaged,
    /// The frame is whole, but its protocol version is unknown.
    Version(u8),
    /// The frame is whole, but this version has no such kind of frame or value.
    Content(&'static str),
}

impl fmt::Display for FrameError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Damaged => f.write_str("a damaged frame"),
            Self::Version(version) => {
                write!(
                    f,
                    "the board speaks version {version} of the serial protocol; expected {OLDEST_VERSION} to {VERSION}"
                )
            }
            Self::Content(what) => write!(f, "a frame whose {what} is not one of version {VERSION}"),
        }
    }
}

impl core::error::Error for FrameError {}

/// Assembles frames from bytes. It may start in the middle of one.
#[derive(Clone, Debug)]
pub struct Decoder {
    bytes: [u8; LONGEST_FRAME],
    /// Number of bytes; past the longest frame it only counts.
    length: usize,
}

impl Default for Decoder {
    fn default() -> Self {
        Self { bytes: [0; LONGEST_FRAME], length: 0 }
    }
}

impl Decoder {
    /// Processes a byte. Returns the message of the frame that it ends, if any.
    ///
    /// # Errors
    /// [`FrameError`] if the bytes between two zeros are not a valid frame; the next frame is still read.
    pub fn push(&mut self, byte: u8) -> Option<Result<Received, FrameError>> {
        if byte != 0 {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
            }
            self.length = self.length.saturating_add(1);
            return None;
        }
        let length = core::mem::take(&mut self.length);
        if length == 0 {
            return None;
        }
        let Some(encoded) = self.bytes.get_mut(..length) else { return Some(Err(FrameError::Damaged)) };
        Some(decode(encoded))
    }
}

fn decode(encoded: &mut [u8]) -> Result<Received, FrameError> {
    let length = cobs::decode_in_place(encoded).map_err(|_| FrameError::Damaged)?;
    let whole = encoded.get(..length).ok_or(FrameError::Damaged)?;
    let (content, &check_sum) = whole.split_last_chunk().ok_or(FrameError::Damaged)?;
    if CRC.checksum(content) != u16::from_le_bytes(check_sum) {
        return Err(FrameError::Damaged);
    }
    let mut fields = Fields(content);
    let [first] = fields.take()?;
    let version = first >> 4;
    if !(OLDEST_VERSION..=VERSION).contains(&version) {
        return Err(FrameError::Version(version));
    }
    let sequence = u16::from_le_bytes(fields.take()?);
    let message = match first & 0xF {
        HELLO => hello(fields)?,
        kind @ (FIRING | OF_HOPPING) => firing(fields, version, kind == OF_HOPPING)?,
        PERIOD => period(fields)?,
        _ => return Err(FrameError::Content("kind")),
    };
    Ok(Received { sequence, message, of_hopping: first & 0xF == OF_HOPPING })
}

fn hello(mut fields: Fields<'_>) -> Result<Message, FrameError> {
    let [sensors] = fields.take()?;
    if !(1..=MAX_SENSORS).contains(&usize::from(sensors)) {
        return Err(FrameError::Content("number of sensors"));
    }
    let clock = core::str::from_utf8(fields.0).ok().filter(|name| name.len() <= LONGEST_CLOCK);
    // The name appears in the first line of logs.
    let clock = clock.filter(|name| name.bytes().all(|byte| (b' '..=b'~').contains(&byte)));
    Ok(Message::Hello { sensors, clock: clock.ok_or(FrameError::Content("clock"))?.into() })
}

fn firing(mut fields: Fields<'_>, version: u8, of_hopping: bool) -> Result<Message, FrameError> {
    let [sensor, phase, kind] = fields.take()?;
    if usize::from(sensor) >= MAX_SENSORS {
        return Err(FrameError::Content("sensor"));
    }
    let firing = FiringMessage {
        sensor,
        phase,
        kind: *ReadingKind::ALL.get(usize::from(kind)).ok_or(FrameError::Content("kind of reading"))?,
        fired: Instant::from_micros(u32::from_le_bytes(fields.take()?)),
        period: u32::from_le_bytes(fields.take()?),
        t_echo: Some(u32::from_le_bytes(fields.take()?)).filter(|&us| us != NO_ECHO).map(Micros::new),
        late: Micros::new(u16::from_le_bytes(fields.take()?).into()),
        age: Micros::new(u32::from_le_bytes(fields.take()?)),
        explained_by: if version == OLDEST_VERSION { None } else { explanation(&mut fields)? },
    };
    if of_hopping {
        fields.take::<HOW>()?;
    }
    fields.end()?;
    Ok(Message::Firing(firing))
}

fn explanation(fields: &mut Fields<'_>) -> Result<Option<Explanation>, FrameError> {
    match fields.take()? {
        [BY_NOTHING] => Ok(None),
        [BY_HISTORY] => Ok(Some(Explanation::History)),
        [sensor] if usize::from(sensor) < MAX_SENSORS => Ok(Some(Explanation::Sensor(sensor))),
        _ => Err(FrameError::Content("explanation")),
    }
}

fn period(mut fields: Fields<'_>) -> Result<Message, FrameError> {
    let period = u32::from_le_bytes(fields.take()?);
    let max_late = Micros::new(u16::from_le_bytes(fields.take()?).into());
    let [edges_lost] = fields.take()?;
    if !(1..=MAX_SENSORS).contains(&fields.0.len()) {
        return Err(FrameError::Content("number of sensors"));
    }
    Ok(Message::Period { period, max_late, edges_lost, health: fields.0.into() })
}

/// The rest of the content.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], FrameError> {
        let (&field, rest) = self.0.split_first_chunk().ok_or(FrameError::Content("length"))?;
        self.0 = rest;
        Ok(field)
    }

    fn end(self) -> Result<(), FrameError> {
        if self.0.is_empty() { Ok(()) } else { Err(FrameError::Content("length")) }
    }
}
