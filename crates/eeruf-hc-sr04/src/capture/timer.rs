//! [`TimerLine`]: a module on two capture channels of a timer.

use eeruf_core::{Instant, Micros};

use super::LineEdge;

/// Time after which a 16-bit register that counts microseconds is ambiguous.
const WRAPS_AFTER: Micros = Micros::new(1 << 16);

/// Capture registers of one line, read and cleared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Captured {
    /// Counter at the last rise since the registers were last read, if there was one.
    pub rise: Option<u16>,
    /// Counter at the last fall since the registers were last read, if there was one.
    pub fall: Option<u16>,
    /// True if a register was overwritten before it was read (`CCxOF`).
    pub is_over: bool,
}

/// A module whose line is captured by a 16-bit timer at 1 MHz, with rises in one register and falls in another. It
/// turns the registers into edges.
///
/// Read the registers at least every 65 ms. If they are read later, a value could be from before a wrap; after an
/// overcapture an edge is missing. Either case yields no edges at all, and silence without a rise is not free space.
#[derive(Clone, Copy, Debug, Default)]
pub struct TimerLine {
    /// Time when the registers were read last.
    read: Option<Instant>,
    /// Edges to come, in reverse.
    edges: [Option<LineEdge>; 2],
}

impl TimerLine {
    /// A module whose registers have not been read.
    pub const fn new() -> Self {
        Self { read: None, edges: [None; 2] }
    }

    /// Decodes registers that were read at `now`, when the timer stood at `counter`. Take out all [edges](Self::edge)
    /// of an earlier reading first.
    pub fn captured(&mut self, registers: Captured, counter: u16, now: Instant) {
        let is_ambiguous = self.read.is_none_or(|read| now.since(read) >= WRAPS_AFTER);
        self.read = Some(now);
        if is_ambiguous || registers.is_over {
            return;
        }
        let age = |captured: u16| u32::from(counter.wrapping_sub(captured));
        let edge = |high, captured| {
            let at = Instant::from_micros(now.as_micros().wrapping_sub(age(captured)));
            LineEdge { high, at }
        };
        let (rise, fall) = (registers.rise.map(|at| edge(true, at)), registers.fall.map(|at| edge(false, at)));
        let is_pulse = registers.rise.zip(registers.fall).is_none_or(|(rise, fall)| age(rise) >= age(fall));
        self.edges = if is_pulse { [fall, rise] } else { [rise, fall] };
    }

    /// The next edge.
    pub fn edge(&mut self) -> Option<LineEdge> {
        let [second, first] = &mut self.edges;
        first.take().or_else(|| second.take())
    }
}
