//! [`HcSr04HoppingRing`]: the driver of a [`HoppingRing`].

use eeruf_core::{Edge, EdgeQueue, HoppingRing, Instant, RingEvent, Scheduler, SensorError};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::error::SetupError;
use crate::health::Health;
use crate::lines::{Lines, Pins};
use crate::settings::Settings;

/// A [`HoppingRing`] whose firings are triggers on pins and whose echoes are pulses on lines: as
/// [`HcSr04Ring`](crate::HcSr04Ring), for rings of which no sensor may stay blind.
#[derive(Debug)]
pub struct HcSr04HoppingRing<T, I, D, const K: usize, const H: usize = 4> {
    ring: HoppingRing<K, H>,
    lines: Lines<T, I, D, K>,
}

impl<T: OutputPin, I: InputPin, D: DelayNs, const K: usize, const H: usize> HcSr04HoppingRing<T, I, D, K, H> {
    /// Puts a ring on its pins. A hopping ring may fire a sensor again as soon as its window has ended, such as alone:
    /// the window must be as long as the sensors rest, [`Settings::min_retrigger`].
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the window is shorter.
    pub fn new(
        ring: HoppingRing<K, H>,
        pins: [Pins<T, I>; K],
        delay: D,
        settings: Settings,
    ) -> Result<Self, SetupError> {
        settings.allow(ring.firing().min_refire())?;
        Ok(Self { ring, lines: Lines::new(pins, delay, settings) })
    }

    /// As [`HoppingRing::poll`]. [`RingEvent::Fire`] is for information: the sensor has been triggered already, which
    /// takes [`Settings::trigger`].
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        self.poll_expecting(now, |_| 0)
    }

    /// As [`HoppingRing::poll_expecting`].
    pub fn poll_expecting(&mut self, now: Instant, expected_change_us: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::Fire { sensor, .. } = event {
            if !self.lines.trigger(sensor, now) {
                // It is there: it has just fired.
                _ = self.ring.stuck(sensor);
            }
        }
        Some(event)
    }

    /// Hands in all edges in the queue, then [polls](Self::poll). Read the clock for `now` just before.
    pub fn poll_with_edges<const N: usize>(&mut self, edges: &EdgeQueue<N>, now: Instant) -> Option<RingEvent> {
        while let Some(edge) = edges.pop() {
            // An edge of a line that the ring does not have concerns nobody here.
            _ = self.edge(edge);
        }
        self.poll(now)
    }

    /// As [`HoppingRing::next_deadline`].
    pub fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    /// An edge on an echo line. Hand in all edges you have before you poll.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn edge(&mut self, edge: Edge) -> Result<(), SensorError> {
        match self.lines.edge(edge) {
            Some(at) => self.ring.echo(edge.sensor, at),
            None => Ok(()),
        }
    }

    /// As [`HoppingRing::fired`], where a sensor was triggered later than the poll said: by a clock read after it.
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError> {
        self.ring.fired(sensor, at)?;
        self.lines.fired(sensor, at);
        Ok(())
    }

    /// How a sensor was at its last complete firing, as far as its line shows it; [`Health::Missing`] for one that the
    /// ring does not have.
    pub fn health(&self, sensor: u8) -> Health {
        self.lines.health(sensor)
    }

    /// The ring.
    pub const fn ring(&self) -> &HoppingRing<K, H> {
        &self.ring
    }

    /// As [`HoppingRing::disable`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn disable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.disable(sensor)
    }

    /// As [`HoppingRing::enable`].
    ///
    /// # Errors
    /// [`SensorError`] for a sensor that is not there.
    pub fn enable(&mut self, sensor: u8) -> Result<(), SensorError> {
        self.ring.enable(sensor)
    }

    /// As [`HoppingRing::restart`].
    pub fn restart(&mut self, now: Instant) {
        self.ring.restart(now);
    }
}
