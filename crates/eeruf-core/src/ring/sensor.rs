//! What a ring knows of one of its sensors.

use crate::filter::{NO_ECHO, Rule, Track, insert};
use crate::reading::{ReadingKind, Verdict};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// What is known of one sensor between its firing and its next: 16 bytes where it reports one echo.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sensor<const E: usize> {
    pub(super) fired: Instant,
    /// The echoes of the present firing; also, in the first place, the time of an early or late edge.
    echoes: [u32; E],
    pub(super) track: Track<E>,
}

// The flags of a sensor, beside the phase in which it fired.
const PHASE: u8 = 0b111;
/// It has fired, and what became of that is not yet told.
pub(super) const LISTENING: u8 = 1 << 3;
/// It has a reading that can be told without waiting for its window to close.
pub(super) const READY: u8 = 1 << 4;
/// The only edges so far came outside the window: within the blanking time while it listens, late once that is told. A
/// sensor that has not fired is said to have had its late edge, so that none is told of it.
const OUTSIDE: u8 = 1 << 5;
/// The driver found the line stuck.
pub(super) const STUCK: u8 = 1 << 6;
/// The next reading is not to be compared with its neighbours in time.
pub(super) const DISTURBED: u8 = 1 << 7;

/// What to do about an edge.
pub(super) enum Edge {
    /// A reading can be told.
    Ready,
    /// It came after the window, which is not yet closed.
    Late,
    /// Nothing.
    Noted,
}

impl<const E: usize> Sensor<E> {
    pub(super) const NEW: Self =
        Self { fired: Instant::from_micros(0), echoes: [NO_ECHO; E], track: Track::new(OUTSIDE) };

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.track.flags & flag != 0
    }

    pub(super) fn set(&mut self, flag: u8) {
        self.track.flags |= flag;
    }

    fn clear(&mut self, flag: u8) {
        self.track.flags &= !flag;
    }

    pub(super) const fn phase(&self) -> Phase {
        Phase(self.track.flags & PHASE)
    }

    pub(super) fn fire(&mut self, phase: Phase, now: Instant) {
        self.track.flags = (self.track.flags & DISTURBED) | LISTENING | phase.0;
        self.fired = now;
    }

    pub(super) fn drop_firing(&mut self) {
        self.echoes = [NO_ECHO; E];
        self.track.forget();
        self.track.flags = OUTSIDE;
    }

    pub(super) fn echo(&mut self, at: Instant, blanking: Micros, window: Micros) -> Edge {
        let t_echo = at.since(self.fired);
        if !at.has_reached(self.fired) {
            // From before it fired, or from a clock that has jumped.
            return Edge::Noted;
        }
        if !self.is(LISTENING) {
            if t_echo <= window || self.is(OUTSIDE) {
                return Edge::Noted;
            }
            self.set(OUTSIDE | READY);
            self.hold(t_echo);
            return Edge::Ready;
        }
        if t_echo > window {
            return Edge::Late;
        }
        if t_echo < blanking {
            if self.held().is_none() {
                self.set(OUTSIDE);
                self.hold(t_echo);
            }
            return Edge::Noted;
        }
        if self.is(OUTSIDE) {
            self.clear(OUTSIDE);
            self.echoes = [NO_ECHO; E];
        }
        insert(&mut self.echoes, t_echo.as_micros());
        if E > 1 || self.is(READY) {
            return Edge::Noted;
        }
        self.set(READY);
        Edge::Ready
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

    /// The late edge.
    pub(super) fn tell_late(&mut self) -> Verdict {
        let t_echo = self.held();
        self.clear(READY);
        self.echoes = [NO_ECHO; E];
        Verdict { kind: ReadingKind::Late, t_echo, previous: None, age: self.track.age() }
    }

    /// Ends the firing.
    pub(super) fn judge(&mut self, rule: Rule, expected_change_us: impl FnOnce() -> i32) -> Verdict {
        let disturbed = self.is(DISTURBED);
        if disturbed {
            self.track.forget();
        }
        let verdict = if self.is(STUCK) {
            self.track.skip(ReadingKind::Stuck, None)
        } else if self.is(OUTSIDE) {
            self.track.skip(ReadingKind::TooEarly, self.held())
        } else {
            self.track.push(rule, &self.echoes, expected_change_us())
        };
        if disturbed {
            self.track.forget();
        }
        self.track.flags &= PHASE;
        self.echoes = [NO_ECHO; E];
        verdict
    }
}
