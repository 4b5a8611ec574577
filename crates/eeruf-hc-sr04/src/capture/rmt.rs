//! [`RmtLine`]: a module on a receiver of an RMT.

use eeruf_core::{Instant, Micros};

use super::LineEdge;

/// Time from the trigger to the rise of the line. The receiver does not report it, since it starts at the first edge.
const RISES_AFTER: Micros = Micros::new(450);

/// A module on a receiver of an ESP32's RMT, which holds up to `N` symbols; it turns them into edges.
///
/// A symbol has two levels, each with its duration; 0 marks the last level, after which the line did not change for the
/// idle threshold. Set that threshold above the longest echo and below the time for which a healthy module holds its
/// line: a line that stays high that long means free space. Start the receiver with each trigger. The time of the first
/// edge is unknown and set to 450 us after the trigger, so exchanged wires go unseen.
///
/// ```
/// use eeruf_core::{Instant, Micros};
/// use eeruf_hc_sr04::capture::RmtLine;
/// let (mut line, fired) = (RmtLine::<4>::new(Micros::new(2), Micros::from_millis(37)), Instant::from_micros(1_000));
/// line.received(fired, &[0x8000 | 2_915]); // high for 2,915 ticks of 2 us, then low
/// let rise = line.edge().unwrap();
/// assert_eq!(line.edge().unwrap().at.since(rise.at), Micros::new(5_830));
/// assert_eq!(line.edge(), None);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct RmtLine<const N: usize> {
    tick: Micros,
    idle: Micros,
    symbols: [u32; N],
    /// Number of levels, and number already decoded.
    levels: usize,
    next: usize,
    /// Time when the next level begins.
    at: Instant,
    /// The previous level.
    was_high: bool,
}

impl<const N: usize> RmtLine<N> {
    /// A module whose receiver counts in this tick and stops when the line has not changed for `idle`, at most 32,767
    /// ticks: with 2 us, 65 ms.
    pub const fn new(tick: Micros, idle: Micros) -> Self {
        Self { tick, idle, symbols: [0; N], levels: 0, next: 0, at: Instant::from_micros(0), was_high: false }
    }

    /// Stores the symbols received for the firing at `fired`; take out all edges of an earlier reception first. Symbols
    /// beyond `N` are lost.
    pub fn received(&mut self, fired: Instant, symbols: &[u32]) {
        self.levels = 2 * symbols.len().min(N);
        (self.next, self.at, self.was_high) = (0, fired + RISES_AFTER, false);
        self.symbols.iter_mut().zip(symbols).for_each(|(place, symbol)| *place = *symbol);
    }

    /// The next edge. A line that is still high at the end counts as fallen at the idle threshold, though it falls
    /// later.
    pub fn edge(&mut self) -> Option<LineEdge> {
        while self.next <= self.levels && self.levels > 0 {
            let symbol = self.symbols.get(self.next / 2).map_or(0, |symbol| symbol >> (16 * (self.next % 2)));
            let (high, ticks) = (symbol & 0x8000 != 0 && self.next < self.levels, symbol & 0x7FFF);
            let edge = LineEdge { high, at: self.at };
            // A line that was high when the receiver was started: its fall is the first edge.
            let is_edge = high != self.was_high || self.next == 0;
            (self.was_high, self.next) = (high, self.next + 1);
            if ticks == 0 {
                self.at += self.idle;
                self.levels = self.next.min(self.levels);
            } else {
                self.at += Micros::new(self.tick.as_micros().saturating_mul(ticks));
            }
            if is_edge {
                return Some(edge);
            }
        }
        None
    }
}
