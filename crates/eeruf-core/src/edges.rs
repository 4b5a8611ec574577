//! [`EdgeQueue`]: hands edges from the interrupt, which only time-stamps them, to the main loop.

use core::sync::atomic::{AtomicU8, AtomicU16, Ordering};

use crate::time::Instant;

/// An edge on the echo line of one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Edge {
    /// The sensor, from 0 to 127.
    pub sensor: u8,
    /// True if the line rose.
    pub high: bool,
    /// Time of the edge.
    pub at: Instant,
}

/// A lock-free queue of up to `N` edges from one producer, the edge interrupt, to one consumer, the main loop. It needs
/// no atomic exchange, which a Cortex-M0 lacks, and no atomic access wider than 16 bits, for AVRs.
///
/// `N` is a power of two from 2 to 128: a mask then keeps every index in range without a check.
///
/// ```
/// use eeruf_core::{Edge, EdgeQueue, Instant};
/// static EDGES: EdgeQueue<32> = EdgeQueue::new();
/// EDGES.push(Edge { sensor: 3, high: true, at: Instant::from_micros(1_450) }); // in the interrupt
/// assert_eq!(EDGES.pop().map(|edge| edge.sensor), Some(3)); // in the main loop
/// assert_eq!(EDGES.pop(), None);
/// ```
#[derive(Debug)]
pub struct EdgeQueue<const N: usize> {
    /// Times of the edges, each as a low and a high half.
    at: [[AtomicU16; 2]; N],
    /// Sensor of each edge; the highest bit is set if the line rose.
    line: [AtomicU8; N],
    /// Total numbers of edges pushed and popped; both wrap.
    pushed: AtomicU8,
    popped: AtomicU8,
    lost: AtomicU8,
}

const HIGH: u8 = 0x80;

impl<const N: usize> EdgeQueue<N> {
    /// An empty queue.
    pub const fn new() -> Self {
        const { assert!(N.is_power_of_two() && N >= 2 && N <= 128, "the length of an EdgeQueue is 2, 4, 8, .. 128") };
        Self {
            at: [const { [AtomicU16::new(0), AtomicU16::new(0)] }; N],
            line: [const { AtomicU8::new(0) }; N],
            pushed: AtomicU8::new(0),
            popped: AtomicU8::new(0),
            lost: AtomicU8::new(0),
        }
    }

    /// Adds an edge; if the queue is full the edge is [lost](Self::lost). Call it from one interrupt priority only.
    #[inline]
    pub fn push(&self, edge: Edge) {
        let pushed = self.pushed.load(Ordering::Relaxed);
        let place = usize::from(pushed) % N;
        let full = usize::from(pushed.wrapping_sub(self.popped.load(Ordering::Acquire))) >= N;
        match (self.at.get(place), self.line.get(place)) {
            (Some([low, high]), Some(line)) if !full => {
                let at = edge.at.as_micros();
                low.store(at as u16, Ordering::Relaxed);
                high.store((at >> 16) as u16, Ordering::Relaxed);
                line.store(if edge.high { edge.sensor | HIGH } else { edge.sensor & !HIGH }, Ordering::Relaxed);
                self.pushed.store(pushed.wrapping_add(1), Ordering::Release);
            }
            _ => self.lose(),
        }
    }

    #[cold]
    fn lose(&self) {
        self.lost.store(self.lost.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
    }

    /// Takes out the oldest edge. Call it from the main loop only.
    #[inline]
    pub fn pop(&self) -> Option<Edge> {
        let popped = self.popped.load(Ordering::Relaxed);
        if popped == self.pushed.load(Ordering::Acquire) {
            return None;
        }
        let place = usize::from(popped) % N;
        let line = self.line.get(place)?.load(Ordering::Relaxed);
        let [low, high] = self.at.get(place)?.each_ref().map(|half| u32::from(half.load(Ordering::Relaxed)));
        let at = Instant::from_micros(high << 16 | low);
        self.popped.store(popped.wrapping_add(1), Ordering::Release);
        Some(Edge { sensor: line & !HIGH, high: line & HIGH != 0, at })
    }

    /// Returns true if no edge is waiting; call it with interrupts off before going to sleep.
    pub fn is_empty(&self) -> bool {
        self.popped.load(Ordering::Relaxed) == self.pushed.load(Ordering::Relaxed)
    }

    /// Number of edges lost because the queue was full. The count wraps at 256 instead of stopping: read it at least
    /// once per period, and take the difference.
    pub fn lost(&self) -> u8 {
        self.lost.load(Ordering::Relaxed)
    }
}

impl<const N: usize> Default for EdgeQueue<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(n: u32) -> Edge {
        Edge { sensor: (n % 100) as u8, high: n % 3 == 0, at: Instant::from_micros(n.wrapping_mul(0x0123_4567)) }
    }

    // Edges come out in the order they went in through many wraps of the counts.
    #[test]
    fn edges_keep_their_order_through_wraps_of_the_counts() {
        let queue = EdgeQueue::<128>::new();
        for round in 0..20 {
            for n in 0..100 {
                queue.push(edge(100 * round + n));
            }
            for n in 0..100 {
                assert!(!queue.is_empty(), "an edge waits");
                assert_eq!(queue.pop(), Some(edge(100 * round + n)));
            }
            assert!(queue.is_empty());
        }
        assert_eq!(queue.lost(), 0);
    }

    #[test]
    fn a_full_queue_keeps_the_oldest_edges_and_counts_the_lost() {
        let queue = EdgeQueue::<4>::new();
        for n in 0..300 {
            queue.push(edge(n));
        }
        // 296, which wraps.
        assert_eq!(queue.lost(), 40);
        for n in 0..4 {
            assert_eq!(queue.pop(), Some(edge(n)));
        }
        assert_eq!(queue.pop(), None);
    }
}
