//! The atlas: rings whose shortest period is known, each with its schedule.
//!
//! It is a text with a line for each ring, in whole ticks, so that it serves for every tick: two rings are the same if
//! their needs in ticks are equal. `rings` lists its rings, `row` is a line, and `find` looks a ring up; `atlas_making`
//! searches (feature `make-atlas`).

mod find;
mod rings;
mod row;

pub use find::{ATLAS, answer};
pub use rings::{Neighbourhood, Ring, all_rings, is_in_shard};
pub use row::{Row, rows};
