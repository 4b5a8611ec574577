//! [`HcSr04Ring`]: the driver. It triggers the sensors that a ring fires, and hands the ring the echoes.

use eeruf_core::{Instant, Ring, RingEvent, Scheduler};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::edges::{Edge, EdgeQueue};
use crate::error::SetupError;
use crate::health::Health;
use crate::line::{Line, Pulse};
use crate::settings::Settings;

/// The two pins of one sensor.
#[derive(Clone, Debug)]
pub struct Pins<T, I> {
    /// The trigger.
    pub trigger: T,
    /// The echo line. It is read only just before a trigger; its edges come in through [`HcSr04Ring::edge`].
    pub echo: I,
}

/// A [`Ring`] whose firings are triggers on pins and whose echoes are pulses on lines.
#[derive(Debug)]
pub struct HcSr04Ring<S, T, I, D, const K: usize> {
    ring: Ring<S, K>,
    pins: [Pins<T, I>; K],
    delay: D,
    lines: [Line; K],
    settings: Settings,
}

impl<S: Scheduler, T: OutputPin, I: InputPin, D: DelayNs, const K: usize> HcSr04Ring<S, T, I, D, K> {
    /// Puts a ring on its pins. Its window should exceed the longest echo by a millisecond, because the line rises only
    /// about half a millisecond after the trigger.
    ///
    /// # Errors
    /// [`SetupError::Retrigger`] if the schedule fires a sensor again sooner than it may be triggered.
    pub fn new(ring: Ring<S, K>, pins: [Pins<T, I>; K], delay: D, settings: Settings) -> Result<Self, SetupError> {
        let min_refire = ring.scheduler().longest_window();
        if min_refire < settings.min_retrigger {
            return Err(SetupError::Retrigger { min_refire, min_retrigger: settings.min_retrigger });
        }
        Ok(Self { ring, pins, delay, lines: [Line::NEW; K], settings })
    }

    /// As [`Ring::poll`]. [`RingEvent::Fire`] is for information: the sensor has been triggered already.
    ///
    /// A trigger takes [`Settings::trigger`], 10 us, during which the driver waits: setting an alarm would take as
    /// long.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        let event = self.ring.poll(now)?;
        if let RingEvent::Fire(sensor) = event {
            self.trigger(sensor, now);
        }
        Some(event)
    }

    /// Hands in all edges in the queue, then [polls](Self::poll). Read the clock for `now` just before: then no window
    /// closes on an edge that came in time, however long the main loop was busy elsewhere.
    pub fn poll_with_edges<const N: usize>(&mut self, edges: &EdgeQueue<N>, now: Instant) -> Option<RingEvent> {
        while let Some(edge) = edges.pop() {
            self.edge(edge);
        }
        self.poll(now)
    }

    /// As [`Ring::next_deadline`].
    pub fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    /// An edge on an echo line. Hand in all edges you have before you poll.
    pub fn edge(&mut self, edge: Edge) {
        let Some(line) = self.lines.get_mut(usize::from(edge.sensor)) else { return };
        if let Some(width) = line.edge(edge, &self.settings) {
            self.ring.echo(edge.sensor, line.triggered + width);
        }
    }

    /// How a sensor was at its last complete firing, as far as its line shows it; [`Health::Missing`] for one that the
    /// ring does not have.
    pub fn health(&self, sensor: u8) -> Health {
        self.lines.get(usize::from(sensor)).map_or(Health::Missing, |line| line.health)
    }

    /// The ring.
    pub const fn ring(&self) -> &Ring<S, K> {
        &self.ring
    }

    /// As [`Ring::disable`].
    pub fn disable(&mut self, sensor: u8) {
        self.ring.disable(sensor);
    }

    /// As [`Ring::enable`].
    pub fn enable(&mut self, sensor: u8) {
        self.ring.enable(sensor);
    }

    fn trigger(&mut self, sensor: u8, now: Instant) {
        let x = usize::from(sensor);
        let (Some(line), Some(pins)) = (self.lines.get_mut(x), self.pins.get_mut(x)) else { return };
        line.end_firing(self.settings.missing_after);
        line.triggered = now;
        line.pulse = Pulse::Idle;
        match pins.echo.is_high() {
            Ok(false) => {}
            Ok(true) => {
                line.health = Health::StuckHigh;
                self.ring.stuck(sensor);
                return;
            }
            Err(_) => {
                line.health = Health::PinError;
                self.ring.stuck(sensor);
                return;
            }
        }
        line.pulse = Pulse::Awaited;
        let rose = pins.trigger.set_high();
        self.delay.delay_us(self.settings.trigger.as_micros());
        // Also after an error: a trigger must not stay high.
        if pins.trigger.set_low().is_err() || rose.is_err() {
            line.health = Health::PinError;
        }
    }
}
