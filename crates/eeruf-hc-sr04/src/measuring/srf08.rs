//! [`Srf08`]: a module on an I2C bus.

use eeruf_core::Micros;
use embedded_hal::i2c::{Error, ErrorKind, I2c};

use super::{Fault, Measured, Measures};
use crate::modules::{Module, SRF08};

/// Register 0 is the command when written, and the software revision when read; 1 is the light sensor, and 2 and 3 are
/// the first echo, high byte first.
const FIRST_REGISTER: u8 = 0;
/// Command for ranging with the result in microseconds.
const RANGE_IN_US: u8 = 0x52;
/// Value read from a bus that no device drives, for example while the module ranges.
const UNDRIVEN: u8 = 0xFF;
/// Delay from the start to the check that the module ranges: arbitrary, but longer than a command takes at 100 kHz.
const IS_RANGING: Micros = Micros::from_millis(2);

/// A Devantech SRF08, or another module with its registers, on an I2C bus.
///
/// It ranges for 65 ms, with the range register at its default, and does not respond meanwhile; register 2 then holds
/// the time of the first echo, or 0 if there was none (SRF08 Technical Specification, Devantech). The driver reads it
/// together with the revision; it refuses revision 0 by choice, since a data line shorted to ground reads as 0. If
/// polled in the first half of the 65 ms, the driver checks once that the module ranges: if the module responds, it was
/// not started, and its registers hold an earlier result.
///
/// Several modules can share a bus through handles such as those of the crate `embedded-hal-bus`.
#[derive(Debug)]
pub struct Srf08<B> {
    bus: B,
    address: u8,
    /// True if the module responded when it should have been ranging.
    is_idle: bool,
}

impl<B: I2c> Srf08<B> {
    /// The factory address, in 7 bits (0xE0 in the data sheet). Fifteen more can be set.
    pub const ADDRESS: u8 = 0x70;

    /// A module at this address of 7 bits, 0x70 to 0x7F.
    pub const fn new(bus: B, address: u8) -> Self {
        Self { bus, address, is_idle: false }
    }

    /// Returns the bus.
    pub fn release(self) -> B {
        self.bus
    }
}

impl<B: I2c> Measures for Srf08<B> {
    fn module(&self) -> &Module {
        &SRF08
    }

    fn start(&mut self) -> Result<Micros, Fault> {
        self.is_idle = false;
        self.bus.write(self.address, &[FIRST_REGISTER, RANGE_IN_US]).map_err(|error| fault(&error))?;
        Ok(IS_RANGING)
    }

    fn result(&mut self, since: Micros) -> Result<Measured, Fault> {
        if self.is_idle {
            return Err(Fault::NoAnswer);
        }
        let ranges = Micros::new(SRF08.report_us);
        let is_early = since < Micros::new(SRF08.report_us / 2);
        if !is_early && since < ranges {
            return Ok(Measured::NotYet(ranges));
        }
        let mut bytes = [UNDRIVEN; 4];
        let read = self.bus.write_read(self.address, &[FIRST_REGISTER], &mut bytes);
        let [revision, _light, high, low] = bytes;
        if is_early {
            self.is_idle = read.is_ok() && revision != UNDRIVEN;
            return if self.is_idle { Err(Fault::NoAnswer) } else { Ok(Measured::NotYet(ranges)) };
        }
        read.map_err(|error| fault(&error))?;
        match (revision, u16::from_be_bytes([high, low])) {
            (UNDRIVEN, _) => Err(Fault::NoAnswer),
            (0, _) => Err(Fault::Bus),
            (_, 0) => Ok(Measured::Nothing),
            // The module had stopped listening.
            (_, us) if u32::from(us) > SRF08.report_us => Err(Fault::Invalid),
            (_, us) => Ok(Measured::Echo(Micros::new(us.into()))),
        }
    }
}

fn fault(error: &impl Error) -> Fault {
    match error.kind() {
        ErrorKind::NoAcknowledge(_) => Fault::NoAnswer,
        _ => Fault::Bus,
    }
}
