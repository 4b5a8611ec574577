//! What a ring knows of one of its sensors.

use super::history::Firings;
use crate::filter::{Agreement, NO_ECHO, Tracker, insert, shift};
use crate::reading::{Explanation, ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// The state of one sensor between its firing and its next: 28 bytes where it reports one echo and four firings are
/// remembered.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Sensor<const E: usize, const H: usize> {
    pub(super) firings: Firings<H>,
    /// The echoes of the present firing; also, in the first place, the time of an early or late edge.
    echoes: [u32; E],
    pub(super) tracker: Tracker<E>,
}

// The flags of a sensor, beside the phase in which it fired.
const PHASE: u8 = 0b111;
/// It has fired, and its reading is pending.
pub(super) const LISTENING: u8 = 1 << 3;
/// It has a reading that can be emitted before its window closes.
pub(super) const READY: u8 = 1 << 4;
/// The only edges so far came outside the window: within the blanking time while it listens, late after its reading. A
/// sensor that has not fired counts as having had its late edge, so that none is emitted for it.
const OUTSIDE: u8 = 1 << 5;
/// The driver found the line stuck.
pub(super) const STUCK: u8 = 1 << 6;
/// Nothing has shown yet that it listens: silence says nothing.
pub(super) const UNANSWERED: u8 = 1 << 7;

/// What came of an edge.
pub(super) enum Noted {
    /// It makes a reading that can be emitted.
    Ready,
    /// It came after the window, which is not yet closed.
    Late,
    /// It is stored with the others of its firing.
    Stored,
    /// Nothing listens for it.
    Unwanted,
}

impl<const E: usize, const H: usize> Sensor<E, H> {
    /// One that has not fired by `now`.
    pub(super) const fn new(now: Instant) -> Self {
        Self { firings: Firings::none_before(now), echoes: [NO_ECHO; E], tracker: Tracker::new(OUTSIDE) }
    }

    /// When it last fired.
    #[inline]
    pub(super) const fn fired(&self) -> Instant {
        self.firings.last()
    }

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.tracker.flags & flag != 0
    }

    pub(super) fn set(&mut self, flag: u8) {
        self.tracker.flags |= flag;
    }

    pub(super) fn clear(&mut self, flag: u8) {
        self.tracker.flags &= !flag;
    }

    pub(super) const fn phase(&self) -> Phase {
        Phase(self.tracker.flags & PHASE)
    }

    #[inline]
    pub(super) fn fire(&mut self, phase: Phase, now: Instant, unanswered: u8) {
        self.tracker.flags = LISTENING | unanswered | phase.0;
        self.firings.push(now);
    }

    /// Its last firing was at another instant: the echoes that were measured from it change by as much.
    pub(super) fn correct(&mut self, at: Instant) {
        let later_us = at.since(self.fired()).as_micros() as i32;
        self.firings.correct(at);
        if !self.is(LISTENING) {
            // Its reading is with the tracker already.
            self.tracker.shift(later_us);
        }
        if !shift(&mut self.echoes, later_us) {
            // The first edge came before it fired, and may have kept out the echo.
            self.set(OUTSIDE);
        }
    }

    /// Forgets firings that are so long ago that no edge is an echo of them.
    #[inline]
    pub(super) fn expire(&mut self, now: Instant) {
        if self.firings.expire(now) && !self.is(LISTENING) {
            self.set(OUTSIDE);
        }
    }

    /// Forgets all firings, `now`.
    pub(super) fn drop_firings(&mut self, now: Instant) {
        self.firings = Firings::none_before(now);
        self.echoes = [NO_ECHO; E];
        self.tracker.forget();
        self.tracker.flags = OUTSIDE;
    }

    pub(super) fn echo(&mut self, at: Instant, blanking: Micros, window: Micros) -> Noted {
        let t_echo = at.since(self.fired());
        if !at.has_reached(self.fired()) {
            // From before it fired, or from a clock that has jumped.
            return Noted::Unwanted;
        }
        if !self.is(LISTENING) {
            if t_echo <= window || self.is(OUTSIDE) {
                return Noted::Unwanted;
            }
            self.set(OUTSIDE | READY);
            self.hold(t_echo);
            return Noted::Ready;
        }
        if t_echo > window {
            return Noted::Late;
        }
        if t_echo < blanking {
            if self.held().is_none() {
                self.set(OUTSIDE);
                self.hold(t_echo);
            }
            return Noted::Stored;
        }
        if self.is(OUTSIDE) {
            self.clear(OUTSIDE);
            self.echoes = [NO_ECHO; E];
        }
        insert(&mut self.echoes, t_echo.as_micros());
        if E > 1 || self.is(READY) {
            return Noted::Stored;
        }
        self.set(READY);
        Noted::Ready
    }

    fn hold(&mut self, t_echo: Micros) {
        if let Some(echo) = self.echoes.first_mut() {
            *echo = t_echo.as_micros();
        }
    }

    /// The first edge held, of whatever kind.
    pub(super) fn held(&self) -> Option<Micros> {
        self.echoes.first().filter(|&&echo| echo != NO_ECHO).map(|&echo| Micros::new(echo))
    }

    /// The reading that a late edge makes.
    pub(super) fn take_late(&mut self) -> Verdict {
        let t_echo = self.held();
        self.clear(READY);
        self.echoes = [NO_ECHO; E];
        Verdict { kind: ReadingKind::Late, t_echo, previous: None, age: self.tracker.age(), explained_by: None }
    }

    /// Ends the firing; what it heard is compared with nothing.
    pub(super) fn end(&mut self) -> Verdict {
        let t_echo = self.held();
        let kind = match t_echo {
            _ if self.is(STUCK) => ReadingKind::Stuck,
            _ if self.is(OUTSIDE) => ReadingKind::TooEarly,
            Some(_) => ReadingKind::First,
            None if self.is(UNANSWERED) => ReadingKind::Unanswered,
            None => ReadingKind::NoEcho,
        };
        self.tracker.flags &= PHASE;
        self.echoes = [NO_ECHO; E];
        let t_echo = t_echo.filter(|_| kind != ReadingKind::Stuck);
        Verdict { kind, t_echo, previous: None, age: None, explained_by: None }
    }

    /// Ends the firing, and compares its reading with the one before.
    pub(super) fn compare(
        &mut self,
        agreement: Agreement,
        expected_change_us: impl FnOnce() -> i32,
        explanation: impl FnMut(u32, u32) -> Option<Explanation>,
    ) -> Verdict {
        let verdict = if self.is(STUCK) {
            self.tracker.skip(ReadingKind::Stuck, None)
        } else if self.is(OUTSIDE) {
            self.tracker.skip(ReadingKind::TooEarly, self.held())
        } else if self.is(UNANSWERED) && self.held().is_none() {
            self.tracker.skip(ReadingKind::Unanswered, None)
        } else {
            self.tracker.push(agreement, &self.echoes, expected_change_us(), explanation)
        };
        self.tracker.flags &= PHASE;
        self.echoes = [NO_ECHO; E];
        verdict
    }
}
