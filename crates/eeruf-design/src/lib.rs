//! Design of a ring, from its requirements to its shortest firing period: shared by `eeruf design` and the page in a
//! browser, so that both give the same answer.
//!
//! | file | content |
//! |---|---|
//! | `limits`, `layout` | ranges of the numbers in a ring file; arrangement of the sensors |
//! | `each`, `uneven` | one number for all sensors or one for each; needs of sensors that differ |
//! | `ring` | the ring file, turned into requirements on a schedule |
//! | `read`, `plausible` | the text of a ring file, refused if its numbers are in other units |
//! | `places`, `urdf`, `hearing` | places of the sensors on the robot, and pairs that hear each other there |
//! | `shortest` | the shortest period for requirements, from the atlas or by `eeruf-period` |
//! | `find`, `what_if` | the design of a ring, and changes that would shorten its period |
//! | `moving` | the shortest period of a ring that moves |
//! | `handling` | firings moved apart by the time that the controller needs for one |
//! | `questions` | schedules that fit into a given period, and the curve of a need |
//! | `found` | the answer in JSON |
//! | `atlas`, `atlas_making` | rings with known shortest periods; the making of their file |
//! | `certificate` | the proof, as a text that others check |
//! | `asked`, `rooms`, `cost`, `flow`, `way` | feature `rooms`: ways of firing a ring, judged by the simulator |
//!
//! ```
//! use eeruf_design::{RingSpec, Effort};
//! let ring = "sensors = 8\nt_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 36_000";
//! let spec = RingSpec::from_text(ring)?;
//! let design = spec.shortest(&Effort::default(), &mut ())?;
//! let period = design.found.value;
//! assert_eq!(period.map(|period| period.as_micros()), Some(66_000));
//! assert_eq!(RingSpec::from_text("sensors = 65").unwrap_err().to_string(), "line 1: 65 sensors; expected 1 to 64");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "rooms")]
mod asked;
pub mod atlas;
#[cfg(feature = "make-atlas")]
pub mod atlas_making;
pub mod certificate;
#[cfg(feature = "rooms")]
mod cost;
mod each;
mod find;
#[cfg(feature = "rooms")]
mod flow;
mod found;
mod handling;
mod hearing;
mod layout;
mod limits;
mod moving;
mod places;
mod placing;
mod plausible;
mod questions;
mod read;
mod ring;
#[cfg(feature = "rooms")]
mod rooms;
mod shortest;
mod uneven;
#[cfg(feature = "urdf")]
mod urdf;
#[cfg(feature = "rooms")]
mod way;
mod what_if;

pub use each::Each;
pub use eeruf_period::{PeriodProblem, ToSpare};
pub use find::{NoDesign, RingDesign};
pub use found::FoundJson;
pub use layout::{LayoutKey, LayoutName, OwnedLayout};
pub use limits::{four, neighbours_in_range, sensors_in_range};
pub use places::Places;
pub use questions::{CURVE_BUDGET, CURVE_POINTS, CurvePoint, Fit, Need};
pub use read::robot_ring;
pub use ring::RingSpec;
pub use shortest::{Effort, FoundPeriod, shortest};
pub use uneven::OwnedUneven;
pub use what_if::WhatIf;
#[cfg(feature = "rooms")]
pub use {
    asked::RoomsAsked,
    cost::{CHOICE, JudgedWay, KindCost, RoomsAnswer, UnderCondition},
    flow::{FlowDesign, needs_to_see_m, turns_of},
    rooms::RoomRobot,
    way::{How, Way},
};

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
