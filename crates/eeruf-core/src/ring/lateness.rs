//! [`Lateness`]: how far late firings have stretched the timetable, and which readings can therefore not be compared.
//!
//! A late firing delays all that follow, so the *stretch* of a firing, the time since the same sensor's firing before
//! less what the schedule says, is the sum of all lateness in between. From one reading to the next crosstalk moves by
//! what the schedule says, and by the emitter's stretch less the receiver's. The reading of a firing is therefore
//! compared only if no firing whose sound it may hold, of its own period, the one before or the one after, has a
//! stretch that differs by more than is tolerated: `docs/theory.md` section 2.1.

/// The least and the largest stretch of some firings, in microseconds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
struct Stretches {
    least: u16,
    most: u16,
}

impl Stretches {
    /// Of no firing.
    const NONE: Self = Self { least: u16::MAX, most: 0 };
    /// Of firings on time.
    const ON_TIME: Self = Self { least: 0, most: 0 };

    fn and(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    const fn difference(self) -> u16 {
        self.most.saturating_sub(self.least)
    }
}

/// What late firings have done to the timetable in this period and the one before. All sums stop at 65,535 us.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub(super) struct Lateness {
    /// At how many more period ends something late is still remembered; 0 while all is on time.
    watched: u8,
    /// At how many more period ends the next reading of every sensor becomes uncomparable, or [`FIRST_PERIOD`], in the
    /// lowest two bits; above, while it is watching, the sensor that fired last.
    uncomparable_and_last: u8,
    /// The latest step of this period.
    latest: u16,
    /// All lateness since the period before began.
    total: u16,
    /// Of that, the part of the period before.
    total_before: u16,
    stretches: Stretches,
    stretches_before: Stretches,
    /// By how much the last firing was late, and its stretch.
    last_late: u16,
    last_stretch: u16,
}

/// Nothing has fired before this period, so that its firings have no stretch.
const FIRST_PERIOD: u8 = 0b11;
const UNCOMPARABLE: u8 = 0b11;
/// Lateness in one period stretches firings of the next, whose sound may be heard in the one after that.
const WATCHED: u8 = 3;
/// No difference of two known stretches is tolerated if it is more than this, so that it has half of the range.
pub(super) const MOST_TOLERATED: u16 = u16::MAX / 2;

/// What a period's lateness came to.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PeriodLateness {
    pub(super) latest: u16,
    pub(super) sum: u16,
    pub(super) difference: u16,
    /// Whether the next reading of every sensor is uncomparable.
    pub(super) uncomparable: bool,
}

impl Lateness {
    pub(super) const NEW: Self = Self {
        watched: 0,
        uncomparable_and_last: FIRST_PERIOD,
        latest: 0,
        total: 0,
        total_before: 0,
        stretches: Stretches::NONE,
        stretches_before: Stretches::NONE,
        last_late: 0,
        last_stretch: 0,
    };

    const fn uncomparable(&self) -> u8 {
        self.uncomparable_and_last & UNCOMPARABLE
    }

    fn set_uncomparable(&mut self, periods: u8) {
        self.uncomparable_and_last = (self.uncomparable_and_last & !UNCOMPARABLE) | periods;
    }

    /// Whether firings on time have to be looked at too.
    #[inline]
    pub(super) const fn is_watching(&self) -> bool {
        self.watched != 0
    }

    /// A step was polled for late.
    pub(super) fn note(&mut self, late: u16) {
        self.latest = self.latest.max(late);
    }

    /// From now on firings are looked at. `totals` is the total at each sensor's last firing.
    pub(super) fn watch(&mut self, totals: &mut [u16]) {
        if self.watched == 0 {
            totals.fill(0);
            (self.total, self.total_before) = (0, 0);
            let before = if self.uncomparable() == FIRST_PERIOD { Stretches::NONE } else { Stretches::ON_TIME };
            (self.stretches, self.stretches_before) = (before, before);
        }
        self.watched = WATCHED;
    }

    /// The timetable has begun anew, in this period or with it.
    pub(super) fn begin_anew(&mut self, totals: &mut [u16]) {
        self.watch(totals);
        // A reading of the first period may hold sound from before, and is what the next one would be compared with.
        self.set_uncomparable(1);
    }

    /// The sum of lateness grows. Returns whether it is still known: if not, stretches mean nothing until two periods
    /// have ended.
    pub(super) fn add(&mut self, late: u16) -> bool {
        self.total = self.total.saturating_add(late);
        if self.total == u16::MAX {
            self.lose_track();
        }
        self.total != u16::MAX
    }

    /// The stretch of a firing, and its sensor's total for the next time.
    pub(super) fn stretch(&self, total: &mut u16) -> u16 {
        // The total never shrinks below what it was, unless the caller says that a sensor fired before it was due.
        let stretch = self.total.checked_sub(*total).unwrap_or(u16::MAX);
        *total = self.total;
        stretch
    }

    /// Whether the reading of a firing with this stretch may be compared with the one before it.
    pub(super) fn comparable(&mut self, stretch: u16, tolerated: u16) -> bool {
        if self.uncomparable() == FIRST_PERIOD {
            return true;
        }
        let Stretches { least, most } = self.stretches.and(self.stretches_before);
        self.stretches = self.stretches.and(Stretches { least: stretch, most: stretch });
        stretch.saturating_sub(least) <= tolerated && most.saturating_sub(stretch) <= tolerated
    }

    /// What the last firing came to, to be corrected by [`Ring::fired`](super::Ring::fired).
    pub(super) fn remember(&mut self, sensor: u8, late: u16, stretch: u16) {
        self.uncomparable_and_last = self.uncomparable() | sensor << UNCOMPARABLE.count_ones();
        (self.last_late, self.last_stretch) = (late, stretch);
    }

    /// By how much the last firing of a sensor was late, and its stretch; `None` if another one has fired since.
    pub(super) fn last_firing(&self, sensor: u8) -> Option<(u16, u16)> {
        if self.watched == 0 {
            // All recent firings were on time.
            return Some((0, 0));
        }
        let is_last = self.uncomparable_and_last >> UNCOMPARABLE.count_ones() == sensor;
        is_last.then_some((self.last_late, self.last_stretch))
    }

    /// Firings have shifted by nobody knows how much: nothing can be compared until two periods have ended.
    pub(super) fn lose_track(&mut self) {
        self.set_uncomparable(2);
    }

    /// Ends the period.
    pub(super) fn end_period(&mut self, totals: &mut [u16]) -> PeriodLateness {
        let latest = core::mem::take(&mut self.latest);
        let uncomparable = !matches!(self.uncomparable(), 0 | FIRST_PERIOD);
        self.set_uncomparable(if uncomparable { self.uncomparable() - 1 } else { 0 });
        if self.watched == 0 {
            return PeriodLateness { latest, uncomparable, ..PeriodLateness::default() };
        }
        self.watched -= 1;
        let sum = self.total.saturating_sub(self.total_before);
        let difference = self.stretches.and(self.stretches_before).difference();
        self.stretches_before = core::mem::replace(&mut self.stretches, Stretches::NONE);
        // All totals from the beginning of this period on, which will be the one before.
        let forgotten = if self.total == u16::MAX { u16::MAX } else { self.total_before };
        for total in totals {
            *total = total.saturating_sub(forgotten);
        }
        self.total -= forgotten;
        self.total_before = self.total;
        PeriodLateness { latest, sum, difference, uncomparable }
    }
}
