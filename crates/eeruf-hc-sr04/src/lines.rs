//! [`Lines`]: the pins of all sensors. It triggers them, and turns their edges into echoes.

use eeruf_core::{Edge, Instant, Micros};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

use crate::error::SetupError;
use crate::health::Health;
use crate::line::{Line, Pulse, Shown};
use crate::settings::Settings;

/// The two pins of one sensor.
#[derive(Clone, Debug)]
pub struct Pins<T, I> {
    /// The trigger.
    pub trigger: T,
    /// The echo line. It is read only just before a trigger; its edges are reported by
    /// [`HcSr04Ring::edge`](crate::HcSr04Ring::edge).
    pub echo: I,
}

/// An echo pin that can also drive its line, because it can change between input and output.
pub trait FlexPin: InputPin {
    /// Drives the line low.
    ///
    /// # Errors
    /// The error of the pin.
    fn drive_low(&mut self) -> Result<(), Self::Error>;

    /// Makes the pin an input again.
    ///
    /// # Errors
    /// The error of the pin.
    fn release(&mut self) -> Result<(), Self::Error>;
}

/// The pins of `K` sensors, and the state of their lines.
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

    /// Returns true if a sensor may be triggered again after this time.
    pub(crate) fn allow(&self, min_refire: Micros) -> Result<(), SetupError> {
        self.settings.allow(min_refire)
    }

    /// Returns the meaning of an edge for the firing at `fired`; the edge was seen at most `before` after it came.
    pub(crate) fn edge(&mut self, edge: Edge, before: Micros, fired: Instant) -> Shown {
        let line = self.lines.get_mut(usize::from(edge.sensor));
        line.map_or(Shown::Nothing, |line| line.edge(edge, before, fired, &self.settings))
    }

    /// Returns the meaning of a pulse measured by hardware.
    pub(crate) fn pulse(&mut self, sensor: u8, width: Micros) -> Shown {
        let line = self.lines.get_mut(usize::from(sensor));
        line.map_or(Shown::Nothing, |line| line.pulse(width, &self.settings))
    }

    /// Notes that hardware has triggered a sensor.
    pub(crate) fn triggered(&mut self, sensor: u8, now: Instant) -> Trigger {
        let given = Trigger::Given { lost_an_edge: false };
        let Some(line) = self.lines.get_mut(usize::from(sensor)) else { return given };
        // A sensor that holds its line ignores triggers. If it has held it for long, the end of its pulse was lost.
        if line.listens_still(now, self.settings.longest_hold) {
            return given;
        }
        let lost_an_edge = line.end_firing(self.settings.missing_after);
        line.pulse = Pulse::Awaited;
        Trigger::Given { lost_an_edge }
    }

    /// Longest gap in a pulse that does not end it.
    pub(crate) const fn shortest(&self) -> Micros {
        self.settings.shortest
    }

    pub(crate) fn health(&self, sensor: u8) -> Health {
        self.lines.get(usize::from(sensor)).map_or(Health::Missing, |line| line.health)
    }
}

impl<T: OutputPin, I: InputPin, D: DelayNs, const K: usize> Lines<T, I, D, K> {
    /// Triggers a sensor, unless its line is high or cannot be read.
    pub(crate) fn trigger(&mut self, sensor: u8, now: Instant) -> Trigger {
        let x = usize::from(sensor);
        let (Some(line), Some(pins)) = (self.lines.get_mut(x), self.pins.get_mut(x)) else {
            return Trigger::Given { lost_an_edge: false };
        };
        let level = pins.echo.is_high();
        if matches!(level, Ok(true)) && line.listens_still(now, self.settings.longest_hold) {
            line.is_held = true;
            return Trigger::ListensStill;
        }
        let lost_an_edge = line.end_firing(self.settings.missing_after);
        line.pulse = Pulse::Idle;
        match level {
            Ok(false) => {}
            Ok(true) => {
                line.health = Health::StuckHigh;
                return Trigger::Withheld;
            }
            Err(_) => {
                line.health = Health::PinError;
                return Trigger::Withheld;
            }
        }
        line.pulse = Pulse::Awaited;
        let rose = pins.trigger.set_high();
        self.delay.delay_us(self.settings.trigger.as_micros());
        // Also after an error: a trigger must not stay high.
        if pins.trigger.set_low().is_err() || rose.is_err() {
            line.health = Health::PinError;
        }
        Trigger::Given { lost_an_edge }
    }
}

#[cfg(feature = "async")]
impl<T, I: InputPin + embedded_hal_async::digital::Wait, D, const K: usize> Lines<T, I, D, K> {
    /// The level of a sensor's line; `None` if it cannot be read.
    pub(crate) fn level(&mut self, sensor: u8) -> Option<bool> {
        self.pins.get_mut(usize::from(sensor))?.echo.is_high().ok()
    }

    /// Waits for a delay, or until a line changes; returns that line.
    pub(crate) async fn wait(&mut self, us: u32) -> Option<u8>
    where
        D: embedded_hal_async::delay::DelayNs,
    {
        use embassy_futures::select::{Either, select, select_array};
        let edges = select_array(self.pins.each_mut().map(|pins| pins.echo.wait_for_any_edge()));
        match select(edges, self.delay.delay_us(us)).await {
            Either::First((Ok(()), sensor)) => u8::try_from(sensor).ok(),
            Either::First((Err(_), _)) => {
                // A pin that cannot wait must not keep the task from sleeping.
                self.delay.delay_us(us.min(1_000)).await;
                None
            }
            Either::Second(()) => None,
        }
    }
}

impl<T, I: FlexPin, D: DelayNs, const K: usize> Lines<T, I, D, K> {
    /// Pulls the line of a sensor low if its trigger was withheld because the line is stuck. Returns true if so.
    pub(crate) fn recover(&mut self, sensor: u8) -> bool {
        let x = usize::from(sensor);
        let (Some(line), Some(pins)) = (self.lines.get_mut(x), self.pins.get_mut(x)) else { return false };
        if (line.pulse, line.health) != (Pulse::Idle, Health::StuckHigh) {
            return false;
        }
        let driven = pins.echo.drive_low();
        self.delay.delay_us(self.settings.recovery.as_micros());
        // Also after an error: the pin must not go on driving.
        if pins.echo.release().is_err() || driven.is_err() {
            line.health = Health::PinError;
        }
        true
    }
}

/// The outcome of a trigger.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Trigger {
    /// The trigger was given.
    Given {
        /// True if the previous firing's pulse began and never ended: its silence may have been an echo.
        lost_an_edge: bool,
    },
    /// The trigger was withheld: the line is stuck, or cannot be read.
    Withheld,
    /// The trigger was withheld: the sensor still listens after an earlier firing and holds its line.
    ListensStill,
}
