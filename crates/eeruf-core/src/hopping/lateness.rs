//! [`Lateness`]: whether firings were punctual enough that crosstalk moved as the code says.

/// The least and the most by which some firings were late, in microseconds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Spread {
    least: u16,
    most: u16,
}

impl Spread {
    const NONE: Self = Self { least: u16::MAX, most: 0 };

    fn and(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }
}

/// Lateness of the firings of this period and of the two before: no older ones can be heard in a reading that is
/// emitted now, if sound dies within a period.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Lateness {
    periods: [Spread; 3],
}

impl Lateness {
    pub(crate) const NEW: Self = Self { periods: [Spread::NONE; 3] };

    pub(crate) fn note(&mut self, late: u16) {
        let [present, ..] = &mut self.periods;
        *present = present.and(Spread { least: late, most: late });
    }

    /// As `note(0)`, the least there is.
    #[inline(always)]
    pub(crate) fn note_punctual(&mut self) {
        let [present, ..] = &mut self.periods;
        present.least = 0;
    }

    /// As if none of this period's firings had been noted, unless the timetable has moved.
    pub(crate) fn begin_anew(&mut self) {
        let [present, ..] = &mut self.periods;
        if present.most != u16::MAX {
            *present = Spread::NONE;
        }
    }

    /// The timetable has moved: nothing that is heard across it moves as the code says.
    pub(crate) fn break_off(&mut self) {
        let [present, ..] = &mut self.periods;
        *present = Spread { least: 0, most: u16::MAX };
    }

    pub(crate) fn end_period(&mut self) {
        self.periods.rotate_right(1);
        let [present, ..] = &mut self.periods;
        *present = Spread::NONE;
    }

    /// Returns true if a firing this late differs from all others by no more than is tolerated.
    pub(crate) fn is_steady(&self, late: u16, tolerated: u16) -> bool {
        let [present, before, before_that] = self.periods;
        let Spread { least, most } = present.and(before).and(before_that);
        late.saturating_sub(least) <= tolerated && most.saturating_sub(late) <= tolerated
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERATED: u16 = 44;

    #[test]
    fn a_punctual_firing_is_one_that_is_late_by_nothing() {
        let mut lateness = Lateness::NEW;
        lateness.note(200);
        assert!(lateness.is_steady(200, TOLERATED));
        lateness.note_punctual();
        assert!(!lateness.is_steady(200, TOLERATED));
        // What it differs from is forgotten after two more periods.
        for remembered in [true, true, false] {
            lateness.end_period();
            lateness.note(200);
            assert_eq!(lateness.is_steady(200, TOLERATED), !remembered);
        }
    }

    // Nothing is steady in the period in which the timetable moves and the two after it.
    #[test]
    fn nothing_is_steady_while_the_timetable_moves() {
        let mut lateness = Lateness::NEW;
        lateness.break_off();
        for steady in [false, false, false, true] {
            lateness.note_punctual();
            assert_eq!(lateness.is_steady(0, TOLERATED), steady);
            for late in [200, u16::MAX / 2, u16::MAX] {
                assert!(!lateness.is_steady(late, u16::MAX / 2) || steady);
            }
            lateness.end_period();
        }
    }
}
