//! The state of one sensor of a ring.

use super::history::Firings;
use crate::filter::{NO_ECHO, insert, shift};
use crate::reading::ReadingKind;
use crate::time::{Instant, Micros};

/// The state of one sensor from one firing to the next: 24 bytes with one echo and four remembered firings. The judge
/// keeps the sensor's readings.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Sensor<const E: usize, const H: usize> {
    pub(super) firings: Firings<H>,
    /// The echoes of the current firing; an early or late edge is stored in the first place.
    echoes: [Micros; E],
    flags: u8,
    /// Uncertainty of the echoes of the current firing, of the one before and of all earlier ones, in units of
    /// [`UNIT`]: the greatest of each; or [`WIDE`].
    uncertain: [u8; 3],
}

/// Unit of uncertainty: 2 us.
const UNIT: u32 = 2;
/// The greatest uncertainty of an echo time: 5 cm.
const MOST: Micros = Micros::new(300);
/// Marker of an edge of the current firing that came within too wide an interval.
const WIDE: u8 = u8::MAX;

// The flags of a sensor, beside the period in which it fired, modulo 8.
const PERIOD: u8 = 0b111;
/// The sensor has fired, and its reading is pending.
pub(super) const LISTENING: u8 = 1 << 3;
/// The sensor has a reading that can be emitted before its window closes.
pub(super) const READY: u8 = 1 << 4;
/// All edges so far came outside the window: within the blanking time, or late after the reading. A sensor that has not
/// fired has this flag, so that no late edge is emitted for it.
const OUTSIDE: u8 = 1 << 5;
// Two bits of evidence: neither is set once it is complete.
/// The driver found the line stuck.
pub(super) const STUCK: u8 = 1 << 6;
/// Nothing has shown yet that the sensor listens: its silence means nothing.
pub(super) const UNANSWERED: u8 = 1 << 7;
/// The sensor holds its line: silence counts once the line has fallen. The flag outlasts the reading.
pub(super) const HELD: u8 = STUCK | UNANSWERED;

/// The outcome of an edge.
pub(super) enum Noted {
    /// The edge makes a reading that can be emitted.
    Ready,
    /// The edge came after the window, which is not yet closed.
    Late,
    /// The edge is stored with the others of its firing.
    Stored,
    /// No sensor listens for the edge.
    Unwanted,
}

impl<const E: usize, const H: usize> Sensor<E, H> {
    /// State of a sensor that has not fired by `now`.
    pub(super) const fn new(now: Instant) -> Self {
        Self { firings: Firings::none_before(now), echoes: [NO_ECHO; E], flags: OUTSIDE, uncertain: [0; 3] }
    }

    /// Returns the time of the last firing.
    #[inline]
    pub(super) const fn fired(&self) -> Instant {
        self.firings.last()
    }

    pub(super) const fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    fn set(&mut self, flag: u8) {
        self.flags |= flag;
    }

    fn clear(&mut self, flag: u8) {
        self.flags &= !flag;
    }

    fn evidence(&self) -> u8 {
        self.flags & HELD
    }

    /// Notes evidence about the current firing, if there is one. If the line was stuck, nothing more counts.
    pub(super) fn shows(&mut self, evidence: u8) {
        if self.is(LISTENING) && self.evidence() != STUCK {
            self.flags = self.flags & !HELD | evidence;
        }
    }

    /// Notes that the evidence is complete. Returns true if the reading was emitted and its silence counts only now.
    pub(super) fn answered(&mut self) -> bool {
        let (evidence, is_out) = (self.evidence(), !self.is(LISTENING));
        if evidence != STUCK {
            self.clear(HELD);
        }
        is_out && evidence == HELD
    }

    /// Number of periods since the firing, if fewer than eight.
    pub(super) const fn periods_ago(&self, period: u32) -> u8 {
        (period as u8).wrapping_sub(self.flags) & PERIOD
    }

    #[inline]
    pub(super) fn fire(&mut self, period: u32, now: Instant, unanswered: u8) {
        self.flags = LISTENING | unanswered | (period as u8 & PERIOD);
        self.firings.push(now);
    }

    /// Corrects the instant of the last firing, and with it the echoes measured from there. Returns how many
    /// microseconds later it was.
    pub(super) fn correct(&mut self, at: Instant) -> i32 {
        let later_us = at.since(self.fired()).as_micros() as i32;
        self.firings.correct(at);
        if !shift(&mut self.echoes, later_us) {
            // The first edge came before it fired, and may have kept out the echo.
            self.set(OUTSIDE);
        }
        later_us
    }

    /// Forgets firings so old that no edge can be their echo. Returns true if it forgot them.
    #[inline]
    pub(super) fn expire(&mut self, now: Instant) -> bool {
        let expired = self.firings.expire(now);
        if expired && !self.is(LISTENING) {
            self.clear(HELD);
            self.set(OUTSIDE);
        }
        expired
    }

    /// Forgets all firings, `now`.
    pub(super) fn drop_firings(&mut self, now: Instant) {
        self.firings = Firings::none_before(now);
        self.echoes = [NO_ECHO; E];
        (self.flags, self.uncertain) = (OUTSIDE, [0; 3]);
    }

    /// Stores an edge `at` an instant, which may be wrong by `off` either way.
    pub(super) fn echo(&mut self, at: Instant, off: Micros, blanking: Micros, window: Micros) -> Noted {
        if off > MOST {
            return self.wide_echo(at, off, blanking, window);
        }
        let t_echo = at.since(self.fired());
        if !at.has_reached(self.fired()) {
            // The edge came before the firing, or the clock has jumped.
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
            if self.evidence() == HELD {
                self.clear(HELD);
            }
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
        insert(&mut self.echoes, t_echo);
        // At most 150.
        self.be_uncertain(off.as_micros().div_ceil(UNIT) as u8)
    }

    /// Raises the uncertainty of the current firing's echoes to this.
    fn be_uncertain(&mut self, units: u8) -> Noted {
        let [now, ..] = &mut self.uncertain;
        *now = units.max(*now);
        if E > 1 || self.is(READY) {
            return Noted::Stored;
        }
        self.set(READY);
        Noted::Ready
    }

    /// Handles an edge that says too little about the echo time: without an earlier echo the firing has none.
    #[cold]
    fn wide_echo(&mut self, at: Instant, off: Micros, blanking: Micros, window: Micros) -> Noted {
        let us = |time: Micros| i64::from(time.as_micros());
        // Time since the firing; negative before it.
        let middle = i64::from(at.since(self.fired()).as_micros() as i32);
        let [earliest, latest] = [middle - us(off), middle + us(off)];
        let listens = self.is(LISTENING);
        if latest < us(blanking) || (listens && earliest > us(window)) {
            return self.echo(at, Micros::ZERO, blanking, window);
        }
        if !listens {
            return Noted::Unwanted;
        }
        if !self.is(OUTSIDE) && self.held().is_some_and(|echo| us(echo) <= earliest) {
            return Noted::Stored;
        }
        self.be_uncertain(WIDE)
    }

    /// Forgets the echo of the last firing. Returns true if that could have been emitted.
    pub(super) fn unhear(&mut self) -> bool {
        let was_ready = self.is(READY);
        if was_ready {
            // Edges stored before it are lost too.
            self.clear(READY | OUTSIDE);
            self.echoes = [NO_ECHO; E];
            self.uncertain[0] = 0;
        }
        was_ready
    }

    fn hold(&mut self, t_echo: Micros) {
        if let Some(echo) = self.echoes.first_mut() {
            *echo = t_echo;
        }
    }

    /// The first stored edge, of any kind.
    pub(super) fn held(&self) -> Option<Micros> {
        self.echoes.first().copied().filter(|&echo| echo != NO_ECHO)
    }

    /// Ends the firing; `unwitnessed` is the kind of silence without a witness.
    #[inline]
    pub(super) fn end(&mut self, unwitnessed: ReadingKind) -> Ended<E> {
        let echoes = core::mem::replace(&mut self.echoes, [NO_ECHO; E]);
        let is_silent = echoes.first().is_none_or(|&echo| echo == NO_ECHO);
        let uncertain = self.uncertain;
        let evidence = self.evidence();
        let unusable = match evidence {
            STUCK => Some(ReadingKind::Stuck),
            _ if uncertain[0] == WIDE => Some(ReadingKind::Late),
            _ if self.is(OUTSIDE) => Some(ReadingKind::TooEarly),
            UNANSWERED if is_silent => Some(unwitnessed),
            _ => None,
        };
        let echoes =
            if matches!(unusable, Some(ReadingKind::Stuck | ReadingKind::Late)) { [NO_ECHO; E] } else { echoes };
        let is_held = evidence == HELD && is_silent && unusable.is_none();
        let [now, before, earlier] = uncertain;
        self.uncertain = [0, now, if before == WIDE { earlier } else { earlier.max(before) }];
        self.flags &= if is_held { PERIOD | HELD } else { PERIOD };
        Ended { is_held, unusable, echoes, uncertain }
    }

    /// Takes out the late edge of a firing that has ended. The flag is true if the silence counts only now.
    pub(super) fn end_late(&mut self) -> (Option<Micros>, bool) {
        let (t_echo, is_held) = (self.held(), self.evidence() == HELD);
        self.echoes = [NO_ECHO; E];
        // No other edge is expected after a late one.
        self.flags &= PERIOD | OUTSIDE;
        (t_echo, is_held)
    }
}

/// Uncertainty of the echoes that [`Ended`] holds.
pub(super) fn off_by(uncertain: [u8; 3]) -> [Micros; 3] {
    uncertain.map(|units| Micros::new(u32::from(units) * UNIT))
}

/// A firing that has ended.
pub(super) struct Ended<const E: usize> {
    /// True if the silence counts only once the line has fallen.
    pub(super) is_held: bool,
    /// Reason why the firing says nothing about the echo time, if it does not.
    pub(super) unusable: Option<ReadingKind>,
    pub(super) echoes: [Micros; E],
    /// Uncertainty of the last firing's echoes, of the previous firing's, and of all earlier ones.
    pub(super) uncertain: [u8; 3],
}
