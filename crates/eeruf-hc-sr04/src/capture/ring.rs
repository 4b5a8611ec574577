//! [`CaptureRing`]: a ring whose modules are triggered and timed by hardware.

use eeruf_core::{Edge, Instant, Micros, Ring, RingEvent, judge::Judge, plan::Plan};

use super::{Captures, LineEdge};
use crate::error::SetupError;
use crate::ring::HcSr04Ring;
use crate::settings::Settings;

/// Time by which firings are handed to the hardware in advance, an arbitrary choice: a loop may be late by this, minus
/// the time for which the hardware is busy with a sensor.
const AHEAD: Micros = Micros::from_millis(10);

/// A ring of modules on hardware that triggers them and captures their edges, such as PIO, RMT or a timer.
///
/// The loop may be a few milliseconds late: firings of a table are as exact as the hardware, and its reports are judged
/// as if the loop had been on time. A plan whose next firing depends on earlier echoes, such as flow, fires when the
/// loop polls; the hardware reports the exact instant.
#[derive(Debug)]
pub struct CaptureRing<R, C, const K: usize> {
    ring: HcSr04Ring<R, (), (), (), K>,
    hardware: C,
    /// Firings that the hardware holds, in order, and their number.
    armed: [(u8, Instant); K],
    count: usize,
    /// True if the last armed firing is later than it was due: once it has fired, all later ones move with it.
    is_late: bool,
    is_held: bool,
    /// For each sensor, an edge later than the last poll of the ring.
    waiting: [Option<LineEdge>; K],
}

impl<P: Plan, J: Judge, C: Captures, const K: usize, const H: usize> CaptureRing<Ring<P, J, K, 1, H>, C, K> {
    /// Puts a ring on hardware. Readings without an echo are emitted when the hardware has reported.
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] as for [`HcSr04Ring::new`], and [`SetupError::Ring`] if a sensor fires again before
    /// the hardware has reported.
    pub fn new(ring: Ring<P, J, K, 1, H>, settings: Settings, hardware: C) -> Result<Self, SetupError> {
        let mut ring = HcSr04Ring::by_hardware(ring, settings)?;
        ring.set_report_after(hardware.reports_within())?;
        let armed = [(0, Instant::from_micros(0)); K];
        Ok(Self { ring, hardware, armed, count: 0, is_late: false, is_held: false, waiting: [None; K] })
    }

    /// Like [`Ring::poll`]: call until there is no event. [`RingEvent::Fire`] is for information, and may come some
    /// milliseconds after the firing.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        let decides_late = self.decides_late();
        if !decides_late {
            self.arm(now);
        }
        let until = if decides_late && !self.is_held { now } else { self.until(now) };
        for (sensor, waiting) in (0..).zip(&mut self.waiting) {
            loop {
                *waiting = waiting.take().or_else(|| self.hardware.edge(sensor, now));
                let Some(LineEdge { high, at }) = waiting.filter(|edge| until.has_reached(edge.at)) else { break };
                *waiting = None;
                // Sensors that the ring does not have are ignored.
                _ = self.ring.edge(Edge { sensor, high, at });
            }
        }
        let event = self.ring.poll_triggered(until)?;
        let RingEvent::Fire { sensor, .. } = event else { return Some(event) };
        if decides_late {
            // If the hardware is busy nothing is heard, and the reading says so.
            _ = self.hardware.fire(sensor, now, now).map(|at| self.ring.fired(sensor, at));
        } else {
            self.armed.rotate_left(1.min(K));
            self.count = self.count.saturating_sub(1);
            self.is_late &= self.count > 0;
        }
        Some(event)
    }

    /// Returns true if only the next firing is known, and the hardware has none.
    fn decides_late(&self) -> bool {
        self.count == 0 && self.ring.upcoming().nth(1).is_none()
    }

    /// Hands firings that are due soon to the hardware.
    fn arm(&mut self, now: Instant) {
        while !self.is_held && !self.is_late {
            let Some(next) = self.ring.upcoming().nth(self.count) else { return };
            let Some(place) = self.armed.get_mut(self.count) else { return };
            if !(now + AHEAD).has_reached(next.due) {
                return;
            }
            let Some(at) = self.hardware.fire(next.sensor, next.due, now) else { return };
            *place = (next.sensor, at);
            self.count += 1;
            self.is_late = at != next.due;
        }
    }

    /// The instant up to which the ring can be polled: the next firing's, and not beyond a firing that the hardware has
    /// not made.
    fn until(&self, now: Instant) -> Instant {
        let fires = self.armed.first().filter(|_| self.count > 0).map(|&(_, at)| at);
        match fires {
            Some(at) if now.has_reached(at) => at,
            _ => match self.ring.upcoming().next() {
                Some(next) if now.has_reached(next.due) => Instant::from_micros(next.due.as_micros().wrapping_sub(1)),
                _ => now,
            },
        }
    }

    /// Returns the time of the next poll: [`Ring::next_deadline`], or when a firing must go to the hardware. It is in
    /// the past if an event is pending, or the hardware is busy with a sensor that must fire.
    pub fn next_deadline(&self) -> Instant {
        let deadline = self.ring.next_deadline();
        let next =
            self.ring.upcoming().nth(self.count).filter(|_| !self.is_held && !self.is_late && !self.decides_late());
        let arms = next.map(|next| Instant::from_micros(next.due.as_micros().wrapping_sub(AHEAD.as_micros())));
        arms.filter(|arms| deadline.has_reached(*arms)).unwrap_or(deadline)
    }

    /// Stops giving firings to the hardware, or starts again.
    pub fn hold(&mut self, is_held: bool) {
        self.is_held = is_held;
    }

    /// The driver, to pause or change it; `None` while the hardware still has a firing to make. [Hold](Self::hold) the
    /// ring and poll until it is `Some`.
    pub fn driver_mut(&mut self) -> Option<&mut HcSr04Ring<Ring<P, J, K, 1, H>, (), (), (), K>> {
        if self.count == 0 { Some(&mut self.ring) } else { None }
    }

    /// The driver.
    pub const fn driver(&self) -> &HcSr04Ring<Ring<P, J, K, 1, H>, (), (), (), K> {
        &self.ring
    }

    /// Returns the hardware.
    pub fn into_hardware(self) -> C {
        self.hardware
    }
}
