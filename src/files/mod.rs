//! The files that a user names: their contents and errors, and writing output files.
//!
//! Uses the libraries only; knows neither commands nor what is printed.

pub(crate) mod error;
pub(crate) mod firings;
pub(crate) mod flow;
pub(crate) mod implausible;
pub(crate) mod map;
pub(crate) mod mcap;
pub(crate) mod ring;
pub(crate) mod survey;
pub(crate) mod toml;
pub(crate) mod truth;
pub(crate) mod waits;
pub(crate) mod write;
