//! Answers of `design`: proven where tables are, bounded where problems are large, in one binary.

#[cfg(feature = "make-atlas")]
mod atlas;
mod budget;
#[path = "../../../eeruf-period/tests/all/common.rs"]
mod common;
#[cfg(feature = "rooms")]
mod cost;
#[cfg(feature = "rooms")]
mod flow;
mod handling;
mod moving;
#[cfg(feature = "rooms")]
mod pairs_simulated;
mod questions;
mod ticks;
mod uneven;
