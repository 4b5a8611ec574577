//! [`Punctuality`]: whether all firings that may still be heard kept a verified timetable.
//!
//! While they did, (13a) and (13b) say what [`Sounds`](super::history::Sounds) would find, and a ring need not ask. A
//! late firing delays all that follow, so the time between two firings is off by at most the sum of lateness in
//! between; a verified schedule has some of that to spare.

/// For this many ends of periods an irregularity is remembered: the first of three readings, which a filter over three
/// may compare, was fired three periods ago, and sound is audible for two.
const WATCHED: u8 = 6;
/// Nothing is proven of the timetable, so that each reading is asked about.
const ALWAYS: u8 = u8::MAX;

/// Lateness of firings, and whether it matters yet.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub(super) struct Punctuality {
    /// At how many more ends of periods something irregular can still be heard; 0 while all is on time.
    watched: u8,
    /// The latest step of this period.
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
    /// Nothing has fired yet. `proven`: whether the timetable was verified for what the ring asks for.
    pub(super) const fn new(proven: bool) -> Self {
        Self { watched: if proven { 0 } else { ALWAYS }, latest: 0, sum: 0 }
    }

    /// Returns true if nothing irregular can be heard.
    #[inline]
    pub(super) const fn is_on_time(&self) -> bool {
        self.watched == 0
    }

    /// Something irregular happened. `proven` as for [`new`](Self::new).
    pub(super) fn disturb(&mut self, proven: bool) {
        self.watched = if proven { WATCHED } else { ALWAYS };
    }

    /// A step was polled for late.
    pub(super) fn note(&mut self, late: u16) {
        self.latest = self.latest.max(late);
    }

    /// A firing came late. Returns whether this period's firings together were late by more than is to spare.
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
