//! [`Lines`]: the pins of all sensors. It triggers them, and makes echoes of their edges.

use eeruf_core::{Edge, Instant, Micros};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::error::SetupError;
use crate::health::Health;
use crate::line::{Line, Pulse};
use crate::settings::Settings;

/// The two pins of one sensor.
#[derive(Clone, Debug)]
pub struct Pins<T, I> {
    /// The trigger.
    pub trigger: T,
    /// The echo line. It is read only just before a trigger; its edges come in through
    /// [`HcSr04Ring::edge`](crate::HcSr04Ring::edge).
    pub echo: I,
}

/// The pins of `K` sensors, and what their lines show.
#[derive(Debug)]
pub(crate) struct Lines<T, I, D, const K: usize> {
    pins: [Pins<T, I>; K],
    delay: D,
    lines: [Line; K],
    settings: Settings,
}

impl<T, I, D, const K: usize> Lines<T, I, D, K> {
    pub(crate) const fn new(pins: [Pins<T, I>; K], delay: D, settings: Settings) -> Self {
        Self { pins, delay, lines: [Line::NEW; K], settings }
    }

    /// Whether a sensor may be triggered again after this time.
    pub(crate) fn allow(&self, min_refire: Micros) -> Result<(), SetupError> {
        self.settings.allow(min_refire)
    }

    /// When the echo of what was `fired` then came, if this edge is the end of one.
    pub(crate) fn edge(&mut self, edge: Edge, fired: Instant) -> Option<Instant> {
        let line = self.lines.get_mut(usize::from(edge.sensor))?;
        line.edge(edge, fired, &self.settings).map(|width| fired + width)
    }

    pub(crate) fn health(&self, sensor: u8) -> Health {
        self.lines.get(usize::from(sensor)).map_or(Health::Missing, |line| line.health)
    }
}

impl<T: OutputPin, I: InputPin, D: DelayNs, const K: usize> Lines<T, I, D, K> {
    /// Triggers a sensor, unless its line is high or cannot be read; whether it did.
    pub(crate) fn trigger(&mut self, sensor: u8) -> bool {
        let x = usize::from(sensor);
        let (Some(line), Some(pins)) = (self.lines.get_mut(x), self.pins.get_mut(x)) else { return true };
        line.end_firing(self.settings.missing_after);
        line.pulse = Pulse::Idle;
        match pins.echo.is_high() {
            Ok(false) => {}
            Ok(true) => {
                line.health = Health::StuckHigh;
                return false;
            }
            Err(_) => {
                line.health = Health::PinError;
                return false;
            }
        }
        line.pulse = Pulse::Awaited;
        let rose = pins.trigger.set_high();
        self.delay.delay_us(self.settings.trigger.as_micros());
        // Also after an error: a trigger must not stay high.
        if pins.trigger.set_low().is_err() || rose.is_err() {
            line.health = Health::PinError;
        }
        true
    }
}
