//! [`Encoder`]: the bytes of a frame.

use eeruf_core::{MAX_SENSORS, Micros, judge::Explanation};

use crate::firing::FiringMessage;
use crate::{BY_HISTORY, BY_NOTHING, FIRING, HELLO, NO_ECHO, PERIOD, VERSION};

/// The longest content of a frame: a period's end with 64 sensors, and the check sum.
const LONGEST_CONTENT: usize = 10 + MAX_SENSORS + 2;
/// The longest frame, with the byte that COBS adds and the zero at its end.
pub const LONGEST_FRAME: usize = LONGEST_CONTENT + 2;
/// The longest name of a clock, in bytes.
pub const LONGEST_CLOCK: usize = 16;

/// Makes frames and numbers them.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    sequence: u16,
}

/// A frame, ready to be sent.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    bytes: [u8; LONGEST_FRAME],
    length: usize,
}

impl Frame {
    /// Returns the bytes, with the zero at the end.
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

impl Encoder {
    /// Makes an encoder whose first frame has the number 0.
    pub const fn new() -> Self {
        Self { sequence: 0 }
    }

    /// Encodes a greeting: the number of sensors, and the name of the board's clock (ASCII, cut to 16 bytes).
    pub fn hello(&mut self, sensors: u8, clock: &str) -> Frame {
        let mut content = self.begin(HELLO);
        content.push(&[sensors]);
        content.push(clock.as_bytes().get(..clock.len().min(LONGEST_CLOCK)).unwrap_or_default());
        content.finish()
    }

    /// Encodes a firing.
    pub fn firing(&mut self, firing: &FiringMessage) -> Frame {
        let mut content = self.begin(FIRING);
        content.push(&[firing.sensor, firing.phase, firing.kind as u8]);
        content.push(&firing.fired.as_micros().to_le_bytes());
        content.push(&firing.period.to_le_bytes());
        content.push(&firing.t_echo.map_or(NO_ECHO, Micros::as_micros).to_le_bytes());
        content.push(&short(firing.late).to_le_bytes());
        content.push(&firing.age.as_micros().to_le_bytes());
        content.push(&[match firing.explained_by {
            None => BY_NOTHING,
            Some(Explanation::Sensor(sensor)) => sensor,
            Some(Explanation::History) => BY_HISTORY,
        }]);
        content.finish()
    }

    /// Encodes the end of a period: its number, its greatest lateness, the number of edges lost on the board since it
    /// started (modulo 256), and the health of each sensor, numbered as `eeruf_hc_sr04::Health`.
    pub fn period(
        &mut self,
        period: u32,
        max_late: Micros,
        edges_lost: u8,
        health: impl IntoIterator<Item = u8>,
    ) -> Frame {
        let mut content = self.begin(PERIOD);
        content.push(&period.to_le_bytes());
        content.push(&short(max_late).to_le_bytes());
        content.push(&[edges_lost]);
        for state in health.into_iter().take(MAX_SENSORS) {
            content.push(&[state]);
        }
        content.finish()
    }

    fn begin(&mut self, kind: u8) -> Content {
        let mut content = Content { bytes: [0; LONGEST_CONTENT], length: 0 };
        content.push(&[VERSION << 4 | kind]);
        content.push(&self.sequence.to_le_bytes());
        self.sequence = self.sequence.wrapping_add(1);
        content
    }
}

fn short(time: Micros) -> u16 {
    u16::try_from(time.as_micros()).unwrap_or(u16::MAX)
}

struct Content {
    bytes: [u8; LONGEST_CONTENT],
    length: usize,
}

impl Content {
    fn push(&mut self, more: &[u8]) {
        for &byte in more {
            if let Some(place) = self.bytes.get_mut(self.length) {
                *place = byte;
                self.length += 1;
            }
        }
    }

    /// Adds the check sum and applies COBS: each zero is replaced by the distance to the next one. Contents are shorter
    /// than 254 bytes, where COBS would need a second byte.
    fn finish(mut self) -> Frame {
        let content = self.bytes.get(..self.length).unwrap_or_default();
        self.push(&crc_16(content).to_le_bytes());
        let mut frame = Frame { bytes: [0; LONGEST_FRAME], length: self.length + 2 };
        let (mut last_zero, mut distance) = (0, 1_u8);
        for (&byte, at) in self.bytes.iter().take(self.length).zip(1..) {
            if byte == 0 {
                frame.put(last_zero, distance);
                (last_zero, distance) = (at, 1);
            } else {
                frame.put(at, byte);
                distance = distance.wrapping_add(1);
            }
        }
        frame.put(last_zero, distance);
        frame
    }
}

impl Frame {
    fn put(&mut self, at: usize, byte: u8) {
        if let Some(place) = self.bytes.get_mut(at) {
            *place = byte;
        }
    }
}

/// CRC-16/IBM-3740, also called CCITT-FALSE: polynomial 0x1021, initial value 0xFFFF.
fn crc_16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| if crc & 0x8000 != 0 { crc << 1 ^ 0x1021 } else { crc << 1 })
    })
}
