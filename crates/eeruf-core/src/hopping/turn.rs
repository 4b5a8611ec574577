//! [`Turn`]: what a hopping ring knows of one sensor's firings.

use crate::time::{Instant, Micros};

/// One sensor's firings.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Turn {
    pub(super) lag: Micros,
    /// What it waits after that in the present phase, in steps of the code.
    pub(super) place: u8,
    /// When it last fired.
    pub(super) fired: Instant,
    /// By how much that was late, in microseconds.
    pub(super) late: u16,
    /// In which phase that was.
    pub(super) phase: u8,
    /// Firings since its last accepted reading.
    pub(super) unserved: u8,
    /// Readings running that did not fit what is confirmed.
    pub(super) misfits: u8,
    flags: u8,
}

/// It has fired since the start.
pub(super) const FIRED: u8 = 1;
/// Its last firing was alone.
pub(super) const SOLO: u8 = 2;
/// What it hears of its last firing moves as the code says, as far as lags are concerned.
pub(super) const SETTLED: u8 = 4;

impl Turn {
    pub(super) const fn new(lag: Micros) -> Self {
        let fired = Instant::from_micros(0);
        Self { lag, place: 0, fired, late: 0, phase: 0, unserved: 0, misfits: 0, flags: 0 }
    }

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    pub(super) fn clear(&mut self, flag: u8) {
        self.flags &= !flag;
    }

    pub(super) fn fire(&mut self, now: Instant, late: u16, phase: u8, flags: u8) {
        (self.fired, self.late, self.phase, self.flags) = (now, late, phase, flags | FIRED);
    }

    pub(super) fn heard(&mut self, accepted: bool, fits: bool) {
        self.unserved = if accepted { 0 } else { self.unserved.saturating_add(1) };
        self.misfits = if fits { 0 } else { self.misfits.saturating_add(1) };
    }
}
