//! Modules on hardware that triggers them and captures their edges: [`Captures`], and [`CaptureRing`], a ring of them.
//!
//! A late loop fires late and stamps edges late; a peripheral does neither. The ring hands it each firing ahead of
//! time, and later sorts its reports by time.
//!
//! | decoder | peripheral | its reports |
//! |---|---|---|
//! | [`PioLine`] | PIO of an RP2040 with [`PIO_PROGRAM`], which triggers too | words of a FIFO |
//! | [`RmtLine`] | receiver of an ESP32's RMT | levels with their durations, once the line is idle |
//! | [`TimerLine`] | input capture of an STM32's timer | registers of 16 bits, and flags |
//!
//! All reports become time-stamped edges, so that the driver applies the same rules as to interrupts: gaps, spikes,
//! exchanged wires, lost edges. Silence without a rising edge is [`Unanswered`](eeruf_core::ReadingKind::Unanswered).

mod pio;
mod ring;
mod rmt;
mod timer;

use eeruf_core::{Instant, Micros};

pub use pio::{PIO_HZ, PIO_PROGRAM, PioLine};
pub use ring::CaptureRing;
pub use rmt::RmtLine;
pub use timer::{Captured, TimerLine};

/// An edge on the echo line of a sensor, as hardware captured it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineEdge {
    /// True if the line rose.
    pub high: bool,
    /// Time of the edge.
    pub at: Instant,
}

/// Hardware that triggers the modules of a ring at given instants and captures the edges of their lines.
pub trait Captures {
    /// Schedules the trigger of a sensor at an instant or as soon after it as possible, and returns its time. Returns
    /// `None` while the hardware is busy with the sensor; the ring then tries again.
    fn fire(&mut self, sensor: u8, at: Instant, now: Instant) -> Option<Instant>;

    /// The next edge of a sensor's line, the oldest first; `None` until the hardware reports one.
    fn edge(&mut self, sensor: u8, now: Instant) -> Option<LineEdge>;

    /// Longest time from a firing to the report of its last edge; zero if edges are reported as they come.
    fn reports_within(&self) -> Micros {
        Micros::ZERO
    }
}
