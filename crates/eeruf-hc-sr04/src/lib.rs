//! A ring of HC-SR04 sensors (and their many relatives with a trigger and an echo pin) on `embedded-hal` 1.0 pins.
//!
//! The echo line of an HC-SR04 rises about half a millisecond after the trigger and falls when the echo is in; the echo
//! time is the width of that pulse. Without an echo the line falls after the sensor's own time-out, 38 ms or more. The
//! driver turns pulses into echoes for [`Ring`], and keeps out what real wiring adds:
//!
//! - edges within 100 us of the trigger, which are the trigger itself seen through the cable;
//! - pulses too short for an echo, and further pulses of a line that chatters;
//! - a line stuck high: the sensor is not triggered, and the firing is told as [`ReadingKind::Stuck`](eeruf_core::ReadingKind::Stuck);
//! - a sensor that is not there, or edges that get lost on the way: [`HcSr04Ring::health`] says so;
//! - a schedule that would trigger a sensor again too soon: it is refused when the ring is set up.
//!
//! It is a crate beside `eeruf-core` and not a feature of it, because core has no dependencies at all and a major version
//! of `embedded-hal` must not become a major version of core.
//!
//! ```no_run
//! # use embedded_hal::{delay::DelayNs, digital::{InputPin, OutputPin}};
//! # fn sleep_until(_: eeruf_core::Instant) {}
//! # use eeruf_hc_sr04::Pins as P;
//! # fn run<T: OutputPin, I: InputPin>(pins: [P<T, I>; 12], delay: impl DelayNs, now: fn() -> eeruf_core::Instant)
//! # -> Result<(), eeruf_hc_sr04::SetupError> {
//! use eeruf_core::{RingConfig, RingEvent, ReadingKind, Micros, Ring, tables::TABLE_I_D};
//! use eeruf_hc_sr04::{EdgeQueue, HcSr04Ring, Settings};
//!
//! static EDGES: EdgeQueue<32> = EdgeQueue::new(); // filled by the edge interrupt
//!
//! let config = RingConfig::new(Micros::new(999), Micros::from_millis(40));
//! let ring = Ring::new(&TABLE_I_D, config, now())?;
//! let mut ring = HcSr04Ring::new(ring, pins, delay, Settings::default())?;
//! loop {
//!     while let Some(event) = ring.poll_with_edges(&EDGES, now()) {
//!         if let RingEvent::Reading(reading) = event {
//!             if reading.kind == ReadingKind::Accepted { /* believe reading.t_echo */ }
//!         }
//!     }
//!     sleep_until(ring.next_deadline());
//! }
//! # }
//! ```
#![no_std]

mod edges;

use core::fmt;

use eeruf_core::{Instant, Micros, Ring, RingError, RingEvent, Scheduler};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

pub use edges::{Edge, EdgeQueue};

/// The two pins of one sensor.
#[derive(Clone, Debug)]
pub struct Pins<T, I> {
    /// The trigger.
    pub trigger: T,
    /// The echo line. It is read only just before a trigger; its edges come in through [`HcSr04Ring::edge`].
    pub echo: I,
}

/// What the sensors need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Settings {
    /// How long the trigger stays high; the data sheet asks for 10 us at least.
    pub trigger: Micros,
    /// Edges sooner than this after the trigger are the trigger itself, seen through the cable.
    pub deaf: Micros,
    /// Shorter pulses are no echoes: 100 us is 17 mm, less than the sensor can measure.
    pub shortest: Micros,
    /// Pulses as long as this are the sensor's own time-out: no echo.
    pub longest: Micros,
    /// No sensor may be triggered again sooner; the data sheet advises 60 ms.
    pub min_retrigger: Micros,
    /// After so many firings running without a pulse a sensor counts as missing.
    pub missing_after: u8,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            trigger: Micros::new(10),
            deaf: Micros::new(100),
            shortest: Micros::new(100),
            longest: Micros::from_millis(36),
            min_retrigger: Micros::from_millis(60),
            missing_after: 3,
        }
    }
}

/// How a sensor is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Health {
    /// Its line answers, or it has not been asked often enough to know.
    #[default]
    Well,
    /// Nothing comes from its line when it is triggered: no sensor there, a cut wire, or no interrupts at all.
    Missing,
    /// Its line was high when it was to be triggered.
    StuckHigh,
    /// Several pulses followed one trigger.
    Chatters,
    /// Its line fell without having risen, or rose and was low again without having fallen: edges get lost on the way.
    LosesEdges,
    /// One of its pins reported an error.
    PinError,
}

impl fmt::Display for Health {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Well => "well",
            Self::Missing => "missing",
            Self::StuckHigh => "stuck high",
            Self::Chatters => "chatters",
            Self::LosesEdges => "loses edges",
            Self::PinError => "pin error",
        })
    }
}

/// Where a sensor is between trigger and echo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pulse {
    /// Nothing is expected: before the first trigger, and after one that could not be given.
    Idle,
    /// Triggered; the line has not risen.
    Awaited,
    /// The line rose at this instant.
    Rose(Instant),
    /// The pulse is over.
    Over,
}

#[derive(Clone, Copy, Debug)]
struct Line {
    triggered: Instant,
    pulse: Pulse,
    /// Firings running without a pulse.
    silent: u8,
    /// What is wrong with this firing: more than one pulse or one too short, or an edge without its counterpart.
    flaw: Health,
    health: Health,
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
        let line = Line {
            triggered: Instant::from_micros(0),
            pulse: Pulse::Idle,
            silent: 0,
            flaw: Health::Well,
            health: Health::Well,
        };
        Ok(Self { ring, pins, delay, lines: [line; K], settings })
    }

    /// As [`Ring::poll`]. [`RingEvent::Fire`] is told for information: the sensor has been triggered.
    ///
    /// A trigger takes [`Settings::trigger`], 10 us, during which the driver waits: setting an alarm would take as long.
    pub fn poll(&mut self, now: Instant) -> Option<RingEvent> {
        let event = self.ring.poll(now)?;
        if let RingEvent::Fire(sensor) = event {
            self.trigger(sensor, now);
        }
        Some(event)
    }

    /// Hands in all edges that wait, then [polls](Self::poll). Read the clock for `now` just before: whatever held the main
    /// loop up since it was here, no window closes on an edge that came in time.
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

    /// How a sensor was at its last complete firing, as far as its line tells; [`Health::Missing`] for one that the ring does not have.
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

impl Line {
    /// The width of the pulse that an edge ends, if that is an echo.
    fn edge(&mut self, edge: Edge, settings: &Settings) -> Option<Micros> {
        if !edge.at.has_reached(self.triggered) || edge.at.since(self.triggered) < settings.deaf {
            return None;
        }
        match (self.pulse, edge.high) {
            (Pulse::Awaited, true) => {
                self.pulse = Pulse::Rose(edge.at);
                self.silent = 0;
                None
            }
            (Pulse::Rose(rose), false) => {
                let width = edge.at.since(rose);
                if width < settings.shortest {
                    self.pulse = Pulse::Awaited;
                    self.flaw = Health::Chatters;
                    return None;
                }
                self.pulse = Pulse::Over;
                (width < settings.longest).then_some(width)
            }
            (Pulse::Over, true) => {
                self.flaw = Health::Chatters;
                None
            }
            (Pulse::Awaited, false) => {
                if self.flaw == Health::Well {
                    self.flaw = Health::LosesEdges;
                }
                self.silent = 0;
                None
            }
            _ => None,
        }
    }

    /// Before the next trigger: what the one before came to.
    fn end_firing(&mut self, missing_after: u8) {
        match self.pulse {
            Pulse::Awaited if self.flaw == Health::Well => {
                self.silent = self.silent.saturating_add(1);
                if self.silent >= missing_after {
                    self.health = Health::Missing;
                }
            }
            // A pulse may follow what was taken for the end of one whose beginning was too soon after the trigger.
            Pulse::Over if self.flaw == Health::LosesEdges => self.health = Health::Well,
            Pulse::Awaited | Pulse::Over => self.health = self.flaw,
            // If the line is still high it is stuck, as will be seen.
            Pulse::Rose(_) => self.health = Health::LosesEdges,
            Pulse::Idle => {}
        }
        self.flaw = Health::Well;
    }
}

/// Why a ring of sensors cannot be set up as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetupError {
    /// A sensor would be triggered again too soon.
    Retrigger {
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
        /// The time that a sensor needs.
        min_retrigger: Micros,
    },
    /// The ring itself.
    Ring(RingError),
}

impl From<RingError> for SetupError {
    fn from(error: RingError) -> Self {
        Self::Ring(error)
    }
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Retrigger { min_refire, min_retrigger } => write!(
                f,
                "a sensor of this schedule fires again after {min_refire}; an HC-SR04 needs at least {min_retrigger}"
            ),
            Self::Ring(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SetupError {}
