//! [`RmtLine`]: a module on a receiver of an RMT.

use eeruf_core::{Instant, Micros};

use super::LineEdge;

/// Time from the trigger to the rise of the line, of which the receiver reports nothing: it begins with the first edge.
const RISES_AFTER: Micros = Micros::new(450);

/// A module on a receiver of an ESP32's RMT, which holds up to `N` symbols: the edges by what it received.
///
/// A symbol is two levels, each with how long it lasted; 0 marks the level at the end, when the line had not changed
/// for the idle threshold. Set that above the longest echo and below what a healthy module holds its line for: a line
/// that is high for as long is free space. Start the receiver with each trigger. The time of the first edge is unknown
/// and set to 450 us after the trigger, so exchanged wires go unseen.
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
    /// Number of levels, and of those that are through.
    levels: usize,
    next: usize,
    /// Time when the next level begins.
    at: Instant,
    /// The last level.
    was_high: bool,
}

impl<const N: usize> RmtLine<N> {
    /// A module whose receiver counts by this tick, and ends when the line has not changed for `idle`, at most 32,767
    /// ticks: with 2 us, 65 ms.
    pub const fn new(tick: Micros, idle: Micros) -> Self {
        Self { tick, idle, symbols: [0; N], levels: 0, next: 0, at: Instant::from_micros(0), was_high: false }
    }

    /// Takes in what was received of the firing at `fired`, once all edges of an earlier reception are out. Symbols
    /// that have no room are lost.
    pub fn received(&mut self, fired: Instant, symbols: &[u32]) {
        self.levels = 2 * symbols.len().min(N);
        (self.next, self.at, self.was_high) = (0, fired + RISES_AFTER, false);
        self.symbols.iter_mut().zip(symbols).for_each(|(place, symbol)| *place = *symbol);
    }

    /// The next edge. A line that is high at the end falls with the idle threshold, though in truth it falls later.
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
