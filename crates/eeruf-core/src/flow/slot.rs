//! [`Slot`]: what a flow ring knows of one sensor's firings.

use crate::time::Micros;

/// One sensor's firings: twelve bytes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Slot {
    /// Its firing in the present cycle, after the cycle's start, in units of the grid.
    pub(super) at: u16,
    /// Lateness of its last firing, in microseconds.
    pub(super) late: u16,
    /// Its wait in the present phase, in steps of the code.
    pub(super) place: u8,
    /// The phase of its last firing.
    pub(super) phase: u8,
    /// Quiet that it needs before its firing, in [`QUIET_US`].
    pub(super) before: u8,
    /// Quiet that it needs after its firing.
    pub(super) after: u8,
    /// Firings since its last believed reading.
    pub(super) unserved: u8,
    flags: u8,
    /// Of the cycle's firing in this place: its sensor.
    pub(super) order: u8,
    /// Of the cycle's firing in this place: the gap to the next, in units of the grid.
    pub(super) gap: u8,
}

/// The unit of quiet, in microseconds.
pub(super) const QUIET_US: u32 = 256;

/// The most quiet that a byte holds.
pub(super) const LONGEST_QUIET: Micros = Micros::new(255 * QUIET_US);

/// A time in units of quiet.
pub(super) const fn quiet(time: Micros) -> u8 {
    let units = time.as_micros() / QUIET_US;
    if units > 255 { 255 } else { units as u8 }
}

/// It has fired since the start.
pub(super) const FIRED: u8 = 1;
/// It does not fire.
pub(super) const DISABLED: u8 = 2;

impl Slot {
    pub(super) const fn new(quiet: u8) -> Self {
        Self {
            at: 0,
            late: 0,
            place: 0,
            phase: 0,
            before: quiet,
            after: quiet,
            unserved: 0,
            flags: 0,
            order: u8::MAX,
            gap: 0,
        }
    }

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    pub(super) fn set(&mut self, flag: u8, on: bool) {
        self.flags = if on { self.flags | flag } else { self.flags & !flag };
    }

    /// It fires, on time.
    #[inline(always)]
    pub(super) fn fire(&mut self, phase: u8) {
        (self.late, self.phase) = (0, phase);
        self.flags |= FIRED;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_takes_twelve_bytes() {
        assert_eq!(size_of::<Slot>(), 12);
    }
}
