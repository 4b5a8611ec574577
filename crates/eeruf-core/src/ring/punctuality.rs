//! [`Punctuality`]: tracks whether all firings that may still be heard kept a verified timetable.
//!
//! While they did, (13a) and (13b) hold, and a ring need not look for explanations. A late firing delays all that
//! follow, so the time between two firings is off by at most the sum of lateness in between; a verified schedule
//! tolerates some lateness.

/// Number of period ends for which an irregularity is remembered. A filter may compare three readings, the first of
/// which was fired three periods ago, and sound is audible for two periods.
const WATCHED: u8 = 6;
/// Marker of an unproven timetable, under which each reading is checked.
const ALWAYS: u8 = u8::MAX;

/// Lateness of firings, and for how long it still matters.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub(super) struct Punctuality {
    /// Number of period ends until nothing irregular can be heard; 0 while all is on time.
    watched: u8,
    /// Greatest lateness of a step in this period.
    latest: u16,
    /// The sum of this period's lateness; stops at 65,535 us.
    sum: u16,
}

/// One period's lateness.
#[derive(Clone, Copy, Debug)]
pub(super) struct PeriodLateness {
    pub(super) latest: u16,
    pub(super) sum: u16,
}

impl Punctuality {
    /// State before the first firing. `proven` is true if the timetable was verified for the ring's settings.
    pub(super) const fn new(proven: bool) -> Self {
        Self { watched: if proven { 0 } else { ALWAYS }, latest: 0, sum: 0 }
    }

    /// Returns true if nothing irregular can be heard.
    #[inline]
    pub(super) const fn is_on_time(&self) -> bool {
        self.watched == 0
    }

    /// Notes an irregularity. `proven` as for [`new`](Self::new).
    pub(super) fn disturb(&mut self, proven: bool) {
        self.watched = if proven { WATCHED } else { ALWAYS };
    }

    /// Notes the lateness of a step.
    pub(super) fn note(&mut self, late: u16) {
        self.latest = self.latest.max(late);
    }

    /// Adds the lateness of a firing. Returns true if this period's firings together exceed the margin.
    pub(super) fn add(&mut self, late: u16, spare: u16) -> bool {
        self.sum = self.sum.saturating_add(late);
        self.sum > spare
    }

    /// Ends the period.
    pub(super) fn end_period(&mut self) -> PeriodLateness {
        if self.watched != ALWAYS {
            self.watched = self.watched.saturating_sub(1);
        }
        PeriodLateness { latest: core::mem::take(&mut self.latest), sum: core::mem::take(&mut self.sum) }
    }
}
