//! Errors in the files of eeruf: the file, the place in it, then `thing: value; expected X`, in one line.
//!
//! The program, the libraries and the Python package report errors in files by the one type [`FileError`]. [`Kind`]
//! recognises a file before it is parsed; with the feature `toml`, `parse` reads TOML, and `doubts_in` finds values in
//! it that are legal and implausible; with `emit`, the module `emit` writes a ring as source text for firmware.

#[cfg(feature = "emit")]
pub mod emit;
mod error;
#[cfg(feature = "toml")]
mod implausible;
mod kind;
#[cfg(feature = "toml")]
mod parse;

pub use error::FileError;
#[cfg(feature = "toml")]
pub use implausible::{doubt, doubt_list, doubted_keys, doubts_in};
pub use kind::Kind;
#[cfg(feature = "toml")]
pub use parse::{build, explain, explain_json, meant, parse};
