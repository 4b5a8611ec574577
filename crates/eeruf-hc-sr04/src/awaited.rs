//! [`HcSr04Ring::next`]: a ring as a task of an async executor, without interrupts of its own.

use eeruf_core::{Edge, Instant, Reading, Ring, RingEvent, judge::Judge, plan::Plan};
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal_async::digital::Wait;

use crate::error::SetupError;
use crate::lines::Pins;
use crate::ring::{Edges, HcSr04Ring};
use crate::settings::Settings;

/// The clock of a ring that waits for its lines, and the levels last seen on them.
#[derive(Debug)]
pub struct Awaited<C> {
    clock: C,
    high: u64,
    looked: Instant,
}

impl<C> Edges for Awaited<C> {
    fn pop(&self) -> Option<Edge> {
        None
    }
}

impl<P, J, T, I, D, C, const K: usize, const H: usize> HcSr04Ring<Ring<P, J, K, 1, H>, T, I, D, K, Awaited<C>>
where
    P: Plan,
    J: Judge,
    T: OutputPin,
    I: InputPin + Wait,
    D: embedded_hal::delay::DelayNs + embedded_hal_async::delay::DelayNs,
    C: Fn() -> Instant,
{
    /// Puts a ring on pins that can be awaited, with a clock and a delay that can block (for a trigger) and be awaited.
    ///
    /// # Errors
    /// As for [`new`](HcSr04Ring::new).
    pub fn awaited(
        ring: Ring<P, J, K, 1, H>,
        pins: [Pins<T, I>; K],
        delay: D,
        settings: Settings,
        clock: C,
    ) -> Result<Self, SetupError> {
        let looked = clock();
        Self::with_edges(ring, pins, delay, settings, Awaited { clock, high: 0, looked })
    }

    /// Returns the next reading. Meanwhile it fires sensors that are due, and sleeps until a line changes or a step is
    /// due. It drops events for firings and ends of periods.
    ///
    /// Time stamps of edges are late by the time that the executor takes to wake this task. If other tasks ran
    /// meanwhile, the time of an edge is uncertain by their duration; beyond half a millisecond the reading is
    /// [`Late`](eeruf_core::ReadingKind::Late). The future may be dropped at any await, for example by a `select`.
    pub async fn next(&mut self) -> Reading {
        loop {
            self.look();
            let now = self.clock();
            match self.poll(now) {
                Some(RingEvent::Reading(reading)) => return reading,
                Some(_) => continue,
                None => {}
            }
            let now = self.clock();
            let deadline = self.next_deadline();
            let us = if now.has_reached(deadline) { 0 } else { deadline.since(now).as_micros() };
            if let Some(sensor) = self.lines.wait(us).await {
                let at = self.clock();
                self.see(sensor, at, at);
            }
        }
    }

    fn clock(&self) -> Instant {
        (self.edges.clock)()
    }

    /// Processes all changes since the lines were last looked at.
    fn look(&mut self) {
        let earliest = self.edges.looked;
        self.edges.looked = self.clock();
        for sensor in (0..64).take(K) {
            let latest = self.clock();
            self.see(sensor, earliest, latest);
        }
    }

    /// Processes a line's change between two instants, if it changed.
    fn see(&mut self, sensor: u8, earliest: Instant, latest: Instant) {
        let Some(high) = self.lines.level(sensor) else { return };
        let bit = 1 << sensor;
        if high == (self.edges.high & bit != 0) {
            return;
        }
        self.edges.high ^= bit;
        // The sensor exists, and time never runs backwards.
        _ = self.edge_between(sensor, high, earliest, latest);
    }
}
