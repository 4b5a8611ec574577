//! *Error Eliminating Rapid Ultrasonic Firing* (EERUF) for rings of ultrasonic range sensors, without an allocator.
//!
//! Sensors that fire at the same time hear each other: *crosstalk*. Firing one by one avoids it but is slow. EERUF
//! fires every sensor once per period `T_p` at `T_fire = T_lag + T_wait`, where `T_wait` alternates between two values
//! that differ from sensor to sensor, and accepts a reading only if it is near-identical to the previous one. A true
//! echo does not depend on the waits; crosstalk shifts with them and is rejected. The proofs are in [`theory`].
//!
//! ```
//! use eeruf_core::{Instant, ReadingKind, Ring, RingConfig, RingEvent, tables::PAPER_12};
//!
//! // `eeruf design RING.toml --period-only --emit rust` writes a table for a ring of one's own.
//! let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0))?;
//! let now = ring.next_deadline(); // sleep until then
//! while let Some(event) = ring.poll(now) {
//!     match event {
//!         RingEvent::Fire { sensor, .. } => println!("trigger sensor {sensor}"),
//!         RingEvent::Reading(reading) if reading.kind == ReadingKind::Accepted => println!("{reading:?}"),
//!         _ => {}
//!     }
//! }
//! // From the interrupt of an echo line, or through an `EdgeQueue`: ring.echo(sensor, at)
//! # Ok::<(), eeruf_core::RingError>(())
//! ```
//!
//! | To .. | there is |
//! |---|---|
//! | fire and judge a ring of sensors | [`Ring`], [`RingConfig`], [`RingEvent`], [`Reading`] |
//! | define when each sensor fires | [`Schedule`], [`VerifiedSchedule`], [`schedule!`] |
//! | check a schedule, and list its violations | [`Requirements`], [`conditions`] |
//! | use sensors that are not all alike | [`Uneven`], [`EachSensor`] |
//! | filter readings that other code fires | [`EchoFilter`] |
//! | fire or judge by rules of your own | [`plan`], [`judge`] |
//! | leave no sensor blind, even if polls are late | [`flow`] |
//! | know what is in front of each sensor now | [`watch`] |
//! | fire more slowly when many readings are rejected | [`adaptation`] |
//! | measure which sensors hear each other | [`survey`] |
//! | pass edges from an interrupt to the main loop | [`EdgeQueue`] |
//! | turn echo times into distances | [`SpeedOfSound`] |
//! | find a schedule | [`search`], the crate `eeruf-period`, or the program `eeruf` |
//!
//! The crate is `no_std` and uses no allocator, no floats and no clock: the caller passes `now` in and sleeps until the
//! deadline it gets back, so the same code runs in an interrupt, in a simulator and in a test. Sensors are counted from
//! 0 in code and printed from 1, as in the paper.
//!
//! Features: `search`, on by default, is the search for waits, which firmware with a table can leave out (and must on
//! an AVR). The others are off by default, for crates that firmware already uses: `defmt` (formats), `serde`
//! (schedules, readings and times), `fugit` and `embassy-time` (conversions of times).
//!
//! Equations and sections are those of J. Borenstein and Y. Koren, *Error Eliminating Rapid Ultrasonic Firing for
//! Mobile Robot Obstacle Avoidance*, IEEE Transactions on Robotics and Automation 11(1), February 1995, pp. 132-138.
#![no_std]

pub mod adaptation;
mod checked;
mod edges;
mod filter;
pub mod flow;
mod interop;
mod judging;
mod layout;
mod needs;
mod own_limits;
pub mod plan;
mod reading;
mod requirements;
mod requirements_error;
mod ring;
mod ring_error;
mod schedule;
#[cfg(feature = "search")]
pub mod search;
mod sensor_error;
mod sensor_set;
mod sound;
pub mod survey;
pub mod tables;
mod time;
mod uneven;
mod verified;
mod verify;
pub mod watch;

#[doc(hidden)]
pub use checked::{__checked, __checked_each, __fired, __micros};
pub use edges::{Edge, EdgeQueue};
pub use filter::EchoFilter;
pub use layout::Layout;
pub use own_limits::{EachSensor, SensorLimits};
pub use reading::{ReadingKind, Tally};
pub use requirements::{Criterion, Requirements};
pub use ring::{PeriodStats, Reading, Ring, RingConfig, RingEvent, ScheduledRing, Silence};
pub use ring_error::RingError;
pub use schedule::{MAX_PERIOD, MAX_PHASES, MAX_SENSORS, Phase, Schedule, ScheduleError};
pub use sensor_error::SensorError;
pub use sound::SpeedOfSound;
pub use time::{Instant, Micros};
pub use uneven::Uneven;
pub use verified::VerifiedSchedule;

/// Judges of readings: the trait [`Judge`](judge::Judge), and all judges except [`EchoFilter`].
pub mod judge {
    pub use crate::filter::MedianFilter;
    pub use crate::flow::m_of_n::MOfN;
    pub use crate::judging::{Agreement, Explained, FiringContext, Heard, Judge, NoSounds, Pace, Quiet, Sounds};
    pub use crate::reading::{Explanation, Verdict};
    pub use crate::ring::AgreementRing;
}

/// The findings of [`Schedule::verify`], and their parts.
pub mod conditions {
    pub use crate::layout::neighbour_rows;
    pub use crate::requirements::Least;
    pub use crate::requirements_error::RequirementsError;
    pub use crate::schedule::VerifiedFor;
    pub use crate::verify::{Verification, Violation, ViolationKind};
}

/// The proofs: `docs/explanation/theory.md`.
///
/// A symbolic link puts the text into the packaged crate too.
#[cfg(doc)]
#[doc = include_str!("../theory.md")]
pub mod theory {}

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
