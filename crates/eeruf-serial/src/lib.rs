//! Frames of a ring on a serial line: a few bytes for each firing, which firmware writes without an allocator and a
//! program on the other side reads. The format: `docs/reference/serial.md`.
//!
//! - [`Recorder`] follows the events of a ring and makes the frames: `no_std`, no allocator, no dependency but
//!   `eeruf-core`. It uses [`Encoder`], which writes the bytes.
//! - `Decoder`, with the feature `decode`, reads them: whatever gets lost or flipped on the way costs only the frames
//!   that it hits.
//!
//! ```
//! use eeruf_core::{Instant, Ring, RingConfig, tables::PAPER_12};
//! use eeruf_serial::Recorder;
//! let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
//! let mut recorder = Recorder::<12>::new("board");
//! let mut line = Vec::new();
//! for _ in 0..100 {
//!     let now = ring.next_deadline();
//!     while let Some(event) = ring.poll(now) {
//!         if let Some(frame) = recorder.event(&event, now, |_sensor| 0, 0) {
//!             line.extend_from_slice(frame.as_bytes());
//!         }
//!     }
//! }
//! assert!(line.len() > 1_000 && line.ends_with(&[0]));
//! # Ok::<(), eeruf_core::RingError>(())
//! ```
#![no_std]

#[cfg(feature = "decode")]
extern crate alloc;

#[cfg(feature = "decode")]
mod decode;
mod encode;
mod firing;
mod recorder;

#[cfg(feature = "decode")]
pub use decode::{Decoder, FrameError, Message, Received};
pub use encode::{Encoder, Frame, LONGEST_CLOCK, LONGEST_FRAME};
pub use firing::FiringMessage;
pub use recorder::Recorder;

/// The version of the protocol: the upper four bits of each frame's first byte.
pub const VERSION: u8 = 2;

/// The oldest version that `Decoder` reads: its firings lack the byte that explains ambiguous readings.
#[cfg(feature = "decode")]
const OLDEST_VERSION: u8 = 1;

/// The kinds of frames: the lower four bits of the first byte.
const HELLO: u8 = 0;
const FIRING: u8 = 1;
const PERIOD: u8 = 2;
/// A firing of a hopping ring, which boards of earlier versions send.
#[cfg(feature = "decode")]
const OF_HOPPING: u8 = 3;

/// Codes of explanations other than sensors, which count from 0.
const BY_HISTORY: u8 = 0xFE;
const BY_NOTHING: u8 = 0xFF;

/// Marker for no echo.
const NO_ECHO: u32 = u32::MAX;

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
