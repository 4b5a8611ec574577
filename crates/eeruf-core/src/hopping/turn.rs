//! [`Turn`]: what a hopping ring knows of one sensor's firings.

use crate::time::Micros;

/// One sensor's firings: twelve bytes.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Turn {
    pub(super) lag: Micros,
    /// Its wait after that in the present phase, in steps of the code.
    pub(super) place: u8,
    /// Lateness of its last firing, in microseconds.
    pub(super) late: u16,
    /// In which phase that was.
    pub(super) phase: u8,
    /// Firings since its last accepted reading.
    pub(super) unserved: u8,
    /// Readings running that did not fit what is confirmed.
    pub(super) misfits: u8,
    flags: u8,
    /// Not this sensor's own: who fires at this place of the period's order. Here it takes no room.
    pub(super) order: u8,
}

/// It has fired since the start.
pub(super) const FIRED: u8 = 1;
/// Its last firing was alone.
pub(super) const SOLO: u8 = 2;
/// Set if the lags let the sound of its last firing move as the code says.
pub(super) const SETTLED: u8 = 4;
/// It does not fire.
pub(super) const DISABLED: u8 = 8;

impl Turn {
    pub(super) const fn new(lag: Micros, place: u8) -> Self {
        Self { lag, place, late: 0, phase: 0, unserved: 0, misfits: 0, flags: 0, order: u8::MAX }
    }

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    pub(super) fn set(&mut self, flag: u8, on: bool) {
        self.flags = if on { self.flags | flag } else { self.flags & !flag };
    }

    /// It fires, on time. It is not [`DISABLED`].
    #[inline(always)]
    pub(super) fn fire(&mut self, phase: u8, flags: u8) {
        (self.late, self.phase, self.flags) = (0, phase, flags);
    }

    pub(super) fn heard(&mut self, accepted: bool, fits: bool) {
        self.unserved = if accepted { 0 } else { self.unserved.saturating_add(1) };
        self.misfits = if fits { 0 } else { self.misfits.saturating_add(1) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_takes_twelve_bytes() {
        assert_eq!(size_of::<Turn>(), 12);
    }
}
