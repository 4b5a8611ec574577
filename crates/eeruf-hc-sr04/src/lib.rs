//! A ring of HC-SR04 sensors (and their many relatives with a trigger and an echo pin) on `embedded-hal` 1.0 pins.
//!
//! The echo line of an HC-SR04 rises about half a millisecond after the trigger and falls when the echo is in; the echo
//! time is the width of that pulse. Without an echo the line falls after the sensor's own time-out, 38 ms or more. The
//! driver turns pulses into echoes for [`Ring`](eeruf_core::Ring), and handles the faults of real wiring:
//!
//! - edges within 100 us of the trigger, which are crosstalk of the trigger in the cable;
//! - pulses too short for an echo, and further pulses of a line that chatters;
//! - a line stuck high: the sensor is not triggered, and its reading is
//!   [`ReadingKind::Stuck`](eeruf_core::ReadingKind::Stuck);
//! - a line that never rises after its trigger: the reading is
//!   [`ReadingKind::Unanswered`](eeruf_core::ReadingKind::Unanswered), never free space;
//! - a sensor that is missing, or edges that get lost: [`HcSr04Ring::health`] reports it;
//! - a schedule that would trigger a sensor again too soon: it is refused when the ring is set up;
//! - a loop that polls too rarely: [`Pace`] reports it.
//!
//! The ring can also be a [`FlowRing`](eeruf_core::flow::FlowRing), which fires by flow.
//!
//! With feature `async` a ring is a task: `ring.next().await` waits for lines and deadlines through
//! `embedded-hal-async` and returns the next reading (`HcSr04Ring::awaited`).
//!
//! A loop that samples lines instead of using interrupts reports edges as intervals: see [`Sampler`].
//!
//! If hardware such as PIO, RMT or a timer triggers the modules and times their lines, see [`capture`]. Modules that
//! measure by themselves and report a value, over I2C, a serial line or a pulse, are in [`measuring`].
//!
//! This crate is not a feature of `eeruf-core`, because core has no dependencies and a major version of `embedded-hal`
//! must not become a major version of core.
//!
//! ```no_run
//! # use embedded_hal::{delay::DelayNs, digital::{InputPin, OutputPin}};
//! # fn sleep_until(_: eeruf_core::Instant) {}
//! # use eeruf_hc_sr04::Pins as P;
//! # fn run<T: OutputPin, I: InputPin>(pins: [P<T, I>; 12], delay: impl DelayNs, now: fn() -> eeruf_core::Instant)
//! # -> Result<(), eeruf_hc_sr04::SetupError> {
//! use eeruf_core::{EdgeQueue, Micros, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
//! use eeruf_hc_sr04::{HcSr04Ring, Settings};
//!
//! static EDGES: EdgeQueue<32> = EdgeQueue::new(); // filled by the edge interrupt
//!
//! let ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), now())?;
//! let mut ring = HcSr04Ring::with_edges(ring, pins, delay, Settings::default(), &EDGES)?;
//! loop {
//!     while let Some(event) = ring.poll(now()) {
//!         if let RingEvent::Reading(reading) = event {
//!             if reading.kind == ReadingKind::Accepted { /* something is at reading.t_echo */ }
//!         }
//!     }
//!     sleep_until(ring.next_deadline());
//! }
//! # }
//! ```
#![no_std]

#[cfg(feature = "async")]
mod awaited;
pub mod capture;
mod error;
mod hands_on;
mod health;
mod line;
mod lines;
pub mod measuring;
mod pace;
mod ring;
mod sampler;
mod settings;

#[cfg(feature = "async")]
pub use awaited::Awaited;
pub use eeruf_modules as modules;
pub use error::SetupError;
pub use health::Health;
pub use lines::{FlexPin, Pins};
pub use pace::Pace;
pub use ring::{Edges, HcSr04Ring};
pub use sampler::Sampler;
pub use settings::{Settings, flow_ring};
