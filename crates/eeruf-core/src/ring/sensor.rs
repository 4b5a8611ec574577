//! What a ring knows of one of its sensors.

use crate::filter::{NO_ECHO, Rule, Tracker, insert};
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// What is known of one sensor between its firing and its next: 16 bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Sensor<const E: usize> {
    pub(super) fired: Instant,
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
/// The next reading is not to be compared with the one before it, nor with the one after it.
pub(super) const UNCOMPARABLE: u8 = 1 << 7;

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

impl<const E: usize> Sensor<E> {
    pub(super) const NEW: Self =
        Self { fired: Instant::from_micros(0), echoes: [NO_ECHO; E], tracker: Tracker::new(OUTSIDE) };

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.tracker.flags & flag != 0
    }

    pub(super) fn set(&mut self, flag: u8) {
        self.tracker.flags |= flag;
    }

    fn clear(&mut self, flag: u8) {
        self.tracker.flags &= !flag;
    }

    pub(super) const fn phase(&self) -> Phase {
        Phase(self.tracker.flags & PHASE)
    }

    /// `compares`: whether its reading will be compared with the one before.
    #[inline]
    pub(super) fn fire(&mut self, phase: Phase, now: Instant, compares: bool) {
        let uncomparable = if compares { self.tracker.flags & UNCOMPARABLE } else { 0 };
        self.tracker.flags = uncomparable | LISTENING | phase.0;
        self.fired = now;
    }

    /// It fired this much later: echoes that are in already are nearer.
    pub(super) fn postpone(&mut self, later: Micros) {
        self.fired += later;
        for echo in self.echoes.iter_mut().filter(|echo| **echo != NO_ECHO) {
            *echo = echo.saturating_sub(later.as_micros());
        }
    }

    pub(super) fn drop_firing(&mut self) {
        self.echoes = [NO_ECHO; E];
        self.tracker.forget();
        self.tracker.flags = OUTSIDE;
    }

    pub(super) fn echo(&mut self, at: Instant, blanking: Micros, window: Micros) -> Noted {
        let t_echo = at.since(self.fired);
        if !at.has_reached(self.fired) {
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
        Verdict { kind: ReadingKind::Late, t_echo, previous: None, age: self.tracker.age() }
    }

    /// Ends the firing; what it heard is compared with nothing.
    pub(super) fn end(&mut self) -> Verdict {
        let t_echo = self.held();
        let kind = match t_echo {
            _ if self.is(STUCK) => ReadingKind::Stuck,
            _ if self.is(OUTSIDE) => ReadingKind::TooEarly,
            Some(_) => ReadingKind::First,
            None => ReadingKind::NoEcho,
        };
        self.tracker.flags &= PHASE;
        self.echoes = [NO_ECHO; E];
        Verdict { kind, t_echo: t_echo.filter(|_| kind != ReadingKind::Stuck), previous: None, age: None }
    }

    /// Ends the firing, and compares its reading with the one before.
    pub(super) fn compare(&mut self, rule: Rule, expected_change_us: impl FnOnce() -> i32) -> Verdict {
        let uncomparable = self.is(UNCOMPARABLE);
        if uncomparable {
            self.tracker.forget();
        }
        let verdict = if self.is(STUCK) {
            self.tracker.skip(ReadingKind::Stuck, None)
        } else if self.is(OUTSIDE) {
            self.tracker.skip(ReadingKind::TooEarly, self.held())
        } else {
            self.tracker.push(rule, &self.echoes, expected_change_us())
        };
        if uncomparable {
            self.tracker.forget();
        }
        self.tracker.flags &= PHASE;
        self.echoes = [NO_ECHO; E];
        verdict
    }
}
