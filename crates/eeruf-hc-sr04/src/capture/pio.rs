//! [`PioLine`]: a module on a PIO state machine.

use eeruf_core::{Instant, Micros};

use super::LineEdge;

/// Conditions of jumps, and sources of `in`.
const ALWAYS: u16 = 0;
const X_COUNTS_DOWN: u16 = 2;
const PIN: u16 = 6;
const PINS: u16 = 0;
const X: u16 = 1;
const Y: u16 = 2;
const NULL: u16 = 3;
const OSR: u16 = 7;

const fn jmp(condition: u16, to: u16) -> u16 {
    condition << 5 | to
}

const fn shift_in(source: u16, bits: u16) -> u16 {
    0x4000 | source << 5 | bits
}

const fn wait(cycles: u16) -> u16 {
    cycles << 8
}

const PULL: u16 = 0x80A0;
const PUSH_UNLESS_FULL: u16 = 0x8000;
const MOV_X_OSR: u16 = 0xA027;
const OUT_X_24: u16 = 0x6038;
const SET_Y_1: u16 = 0xE041;
const SET_PINS_1: u16 = 0xE001;
const SET_PINS_0: u16 = 0xE000;

/// Clock of the state machine that runs [`PIO_PROGRAM`], in Hz.
pub const PIO_HZ: u32 = 2_000_000;

/// Program of a PIO state machine that triggers a module and reports the edges of its line. It wraps from its last
/// instruction to its first.
///
/// Run it at [`PIO_HZ`], with the trigger as the only `set` pin and the echo line as first `in` pin and `jmp` pin;
/// `out` shifts right, `in` shifts left, and autopull and autopush are off.
///
/// A firing takes the two words of [`PioLine::fire`]: the microseconds to wait; then a tag, with the microseconds to
/// listen in the low 24 bits. The program reports a word for each edge and one when it stops listening: the tag, 23
/// bits with the microseconds left (all ones at the end), and the level in the lowest bit. A full FIFO drops words; it
/// never delays the program.
pub const PIO_PROGRAM: [u16; 26] = {
    const LOW: u16 = 8;
    const ROSE: u16 = 11;
    const HIGH: u16 = 15;
    const STILL_HIGH: u16 = 21;
    const END: u16 = 22;
    [
        PULL,
        MOV_X_OSR,
        jmp(X_COUNTS_DOWN, 2) | wait(1),
        PULL,
        SET_Y_1,
        SET_PINS_1 | wait(19),
        SET_PINS_0,
        OUT_X_24,
        // LOW
        jmp(PIN, ROSE),
        jmp(X_COUNTS_DOWN, LOW),
        jmp(ALWAYS, END),
        // ROSE
        shift_in(OSR, 8),
        shift_in(X, 23),
        shift_in(Y, 1),
        PUSH_UNLESS_FULL,
        // HIGH
        jmp(PIN, STILL_HIGH),
        shift_in(OSR, 8),
        shift_in(X, 23),
        shift_in(NULL, 1),
        PUSH_UNLESS_FULL,
        jmp(ALWAYS, LOW),
        // STILL_HIGH
        jmp(X_COUNTS_DOWN, HIGH),
        // END
        shift_in(OSR, 8),
        shift_in(X, 23),
        shift_in(PINS, 1),
        PUSH_UNLESS_FULL,
    ]
};

/// Time from the words of a firing to its trigger, in addition to the wait that they ask for.
const STARTS_AFTER: u32 = 3;
/// Time allowed for a caller to write the words, an arbitrary choice.
const HANDING_OVER: u32 = 5;
/// Time from the start of the 10 us trigger to the start of the count.
const COUNTS_AFTER: Micros = Micros::new(11);
/// The count at the end, below the tag.
const ENDED: u32 = 0x7F_FFFF;

/// A module on a PIO state machine that runs [`PIO_PROGRAM`]: it makes the words that fire it, and decodes the words
/// that report edges.
///
/// Widths are exact to 3 us, since the program counts microseconds and stops counting while it reports an edge. Words
/// may be decoded late; words of an earlier firing, recognised by the tag, are dropped.
#[derive(Clone, Copy, Debug)]
pub struct PioLine {
    fired: Instant,
    listens: Micros,
    tag: u8,
    is_busy: bool,
}

impl PioLine {
    /// A module whose line is watched for `listens` after its trigger, at most 8 s. Pass the window plus half a
    /// millisecond, but at least 11 ms less than the time until the module fires again.
    pub const fn new(listens: Micros) -> Self {
        let listens = if listens.as_micros() < ENDED { listens } else { Micros::new(ENDED - 1) };
        Self { fired: Instant::from_micros(0), listens, tag: 0, is_busy: false }
    }

    /// The words that trigger the module at an instant, or now if that is past, and the time of the trigger. Write them
    /// at once. Returns `None` while the state machine listens, since it would start to wait only afterwards.
    pub fn fire(&mut self, at: Instant, now: Instant) -> Option<([u32; 2], Instant)> {
        // The word that ends a firing may have been lost.
        let listened = self.listens.saturating_add(Micros::from_millis(1));
        if self.is_busy && now.since(self.fired) < listened {
            return None;
        }
        let soonest = now + Micros::new(HANDING_OVER + STARTS_AFTER);
        let at = if soonest.has_reached(at) { soonest } else { at };
        self.tag = self.tag.wrapping_add(1);
        (self.fired, self.is_busy) = (at, true);
        let waits = at.since(now).as_micros().saturating_sub(STARTS_AFTER);
        Some(([waits, u32::from(self.tag) << 24 | self.listens.as_micros()], at))
    }

    /// The edge that a word of the state machine reports; `None` for the end of a firing or a word of an earlier one.
    pub fn edge(&mut self, word: u32) -> Option<LineEdge> {
        let (left, tag) = (word >> 1 & ENDED, word >> 24);
        if tag != u32::from(self.tag) {
            return None;
        }
        if left == ENDED {
            self.is_busy = false;
            return None;
        }
        let passed = Micros::new(self.listens.as_micros().checked_sub(left)?);
        Some(LineEdge { high: word & 1 == 1, at: self.fired + COUNTS_AFTER + passed })
    }
}
