//! Errors in the files of eeruf: the file, the place in it, then `thing: value; expected X`, in one line.
//!
//! The program, the libraries and the Python package report errors in files by the one type [`FileError`]. [`Kind`]
//! recognises a file before it is parsed. The feature `toml` adds `parse` for TOML, `doubts_in` for legal but
//! implausible values, `ScheduleFile` for a schedule and `RobotRing` for the parts of a ring file that a scene uses.
//! The feature `emit` adds the module `emit`, which writes a ring as source text for firmware.

#[cfg(feature = "emit")]
pub mod emit;
mod error;
mod firing_row;
#[cfg(feature = "toml")]
mod implausible;
mod kind;
#[cfg(feature = "toml")]
mod meant;
#[cfg(feature = "toml")]
mod parse;
#[cfg(feature = "toml")]
mod robot_ring;
mod rotation;
#[cfg(feature = "toml")]
mod schedule;

pub use error::FileError;
pub use firing_row::{FIRING_COLUMNS, firing_row};
#[cfg(feature = "toml")]
pub use implausible::{doubt, doubt_list, doubted_keys, doubts_in, is_likely_rad};
pub use kind::Kind;
#[cfg(feature = "toml")]
pub use meant::meant;
#[cfg(feature = "toml")]
pub use parse::{build, explain, explain_json, parse};
#[cfg(feature = "toml")]
pub use robot_ring::{Pose, RobotRing, arc};
pub use rotation::rotation;
#[cfg(feature = "toml")]
pub use schedule::{AnySchedule, ScheduleFile, as_file};
