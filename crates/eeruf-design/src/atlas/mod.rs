//! The atlas: rings whose shortest period is known, each with its schedule.
//!
//! A text with a line for each ring, in whole ticks, so that it serves for every tick: rings are the same if their
//! needs are as many ticks. `rings` says which rings it holds, `row` is a line, `find` looks a ring up, and `make`
//! searches (feature `make-atlas`).

mod find;
#[cfg(feature = "make-atlas")]
mod make;
mod rings;
mod row;

pub use find::{ATLAS, answer};
#[cfg(feature = "make-atlas")]
pub use make::{certificate_of, hash_of, header, make};
pub use rings::{Neighbourhood, Ring, all_rings, is_in_shard};
pub use row::{Row, rows};
