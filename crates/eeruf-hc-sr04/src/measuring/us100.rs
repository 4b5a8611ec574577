//! [`Us100`]: a module on a serial line.

use eeruf_core::{Micros, SpeedOfSound};
use embedded_io::{Read, ReadReady, Write};

use super::{Fault, Measured, Measures};
use crate::modules::{Module, US_100};

/// The command that asks for a distance.
const RANGE: u8 = 0x55;
/// Largest number of bytes taken from a line at once, an arbitrary choice: every answer is shorter.
const MOST_BYTES: usize = 32;
/// Largest number of errors skipped when a line is cleared, an arbitrary choice.
const MOST_ERRORS: usize = 8;
/// Interval between two reads of the line, a choice. A receive buffer holds the two bytes far longer.
const READ_EVERY: Micros = Micros::from_millis(5);

/// A US-100 with its jumper set, on a serial line of 9600 baud.
///
/// The byte 0x55 requests a distance; two bytes answer, high byte first, in millimetres ("US-100 with RT-Thread
/// MicroPython", cnblogs 9486575). The burst starts a millisecond after the poll, when the byte has been sent. The
/// module takes up to 100 ms; the driver always waits that long, so that late bytes of an earlier measurement do not
/// count. It drops an answer that comes sooner than its echo. An answer is one distance, or the same distance twice.
///
/// **Nothing in range** is a distance beyond [`sees_to_mm`](Module::sees_to_mm): a choice, since it is undocumented. A
/// distance beyond the reach of sound within 100 ms is invalid. The answer has no check sum: if a flipped bit leaves a
/// possible distance, only the ring's judge can reject it.
///
/// **Speed of sound.** The module converts time to millimetres by its own thermometer. This driver converts them back
/// with [`SpeedOfSound::AT_20_CELSIUS`], 343.2 m/s, or the speed set by [`with_speed`](Self::with_speed). Convert
/// readings with that speed to get the module's millimetres. Echo times are off by 0.18 % per degree of difference.
#[derive(Debug)]
pub struct Us100<P> {
    port: P,
    speed: SpeedOfSound,
    bytes: [u8; 4],
    count: usize,
    /// True if an answer came sooner than its own echo, or too soon to rule one out: it belongs to an earlier start.
    is_stale: bool,
    /// True if the line reported an error since the start.
    broken: bool,
}

impl<P: Read + ReadReady + Write> Us100<P> {
    /// A module on this port, whose `write` takes one byte without waiting.
    pub const fn new(port: P) -> Self {
        let speed = SpeedOfSound::AT_20_CELSIUS;
        Self { port, speed, bytes: [0; 4], count: 0, is_stale: false, broken: false }
    }

    /// Sets the speed of sound, for example for the temperature of the air.
    #[must_use]
    pub fn with_speed(self, speed: SpeedOfSound) -> Self {
        Self { speed, ..self }
    }

    /// Returns the port.
    pub fn release(self) -> P {
        self.port
    }

    /// Reads all bytes up to an error. Returns false if there may be more.
    fn read(&mut self, since: Micros) -> Result<bool, P::Error> {
        for _ in 0..MOST_BYTES {
            let mut byte = [0];
            if !self.port.read_ready()? || self.port.read(&mut byte)? == 0 {
                return Ok(true);
            }
            if let (Some(place), [byte]) = (self.bytes.get_mut(self.count), byte) {
                *place = byte;
            }
            self.count = self.count.saturating_add(1);
            if self.count == 2 && since < self.t_echo().min(self.speed.echo_time(US_100.sees_to_mm)) {
                (self.count, self.is_stale) = (0, true);
            }
        }
        Ok(false)
    }

    fn mm(&self) -> u32 {
        let [high, low, ..] = self.bytes;
        u16::from_be_bytes([high, low]).into()
    }

    fn t_echo(&self) -> Micros {
        self.speed.echo_time(self.mm())
    }

    fn decode(&self) -> Result<Measured, Fault> {
        let [high, low, high_again, low_again] = self.bytes;
        match self.count {
            0 if !self.is_stale => return Err(Fault::NoAnswer),
            1 => return Err(Fault::Truncated),
            2 => {}
            4 if [high, low] == [high_again, low_again] => {}
            _ => return Err(Fault::Invalid),
        }
        let t_echo = self.t_echo();
        if t_echo < Micros::new(US_100.blanking_us) || t_echo > Micros::new(US_100.report_us) {
            return Err(Fault::Invalid);
        }
        Ok(if self.mm() > US_100.sees_to_mm { Measured::Nothing } else { Measured::Echo(t_echo) })
    }
}

impl<P: Read + ReadReady + Write> Measures for Us100<P> {
    fn module(&self) -> &Module {
        &US_100
    }

    fn start(&mut self) -> Result<Micros, Fault> {
        // Errors on the line are as old as the bytes discarded here.
        let mut drained = Err(Fault::Bus);
        for _ in 0..MOST_ERRORS {
            drained = match self.read(Micros::ZERO) {
                Ok(true) => Ok(()),
                Ok(false) => Err(Fault::Invalid),
                Err(_) => Err(Fault::Bus),
            };
            if drained != Err(Fault::Bus) {
                break;
            }
        }
        (self.count, self.is_stale, self.broken) = (0, false, false);
        drained?;
        match self.port.write(&[RANGE]) {
            Ok(1) => Ok(READ_EVERY),
            _ => Err(Fault::Bus),
        }
    }

    fn result(&mut self, since: Micros) -> Result<Measured, Fault> {
        self.broken |= self.read(since).is_err();
        let reports = Micros::new(US_100.report_us);
        if since < reports {
            return Ok(Measured::NotYet(reports.min(since.saturating_add(READ_EVERY))));
        }
        if self.broken { Err(Fault::Bus) } else { self.decode() }
    }
}
