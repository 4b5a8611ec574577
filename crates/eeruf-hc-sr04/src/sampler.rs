//! [`Sampler`]: edges of lines that a loop samples.

use eeruf_core::Instant;

/// Turns the levels of `K` echo lines into edges, for a loop without edge interrupts.
///
/// ```
/// use eeruf_core::Instant;
/// use eeruf_hc_sr04::Sampler;
/// let at = Instant::from_micros;
/// let mut lines = Sampler::<1>::new(at(0));
/// assert_eq!(lines.look(0, false, at(100), at(104)), None);
/// // The line rose between two looks.
/// assert_eq!(lines.look(0, true, at(400), at(404)), Some((at(100), at(404))));
/// ```
#[derive(Clone, Debug)]
pub struct Sampler<const K: usize> {
    /// Time when each line was last sampled, and its level then.
    seen: [(Instant, bool); K],
}

impl<const K: usize> Sampler<K> {
    /// A sampler of lines that are low at `now`.
    pub const fn new(now: Instant) -> Self {
        Self { seen: [(now, false); K] }
    }

    /// Records the level that a line had between two readings of the clock. If it changed, returns the instants between
    /// which it did, for [`HcSr04Ring::edge_between`](crate::HcSr04Ring::edge_between). Call it for all lines before
    /// each poll.
    pub fn look(&mut self, sensor: u8, high: bool, before: Instant, after: Instant) -> Option<(Instant, Instant)> {
        let seen = self.seen.get_mut(usize::from(sensor))?;
        let (earliest, was_high) = core::mem::replace(seen, (before, high));
        (high != was_high).then_some((earliest, after))
    }
}
