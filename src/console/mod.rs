//! The terminal: the only writer of standard output, warnings and errors on standard error, and the width and colour
//! of lines.
//!
//! Depends on no other part of the program.

mod fit;
mod out;
mod say;
mod settings;

pub(crate) use out::{OutputError, print, print_line, tell};
pub(crate) use say::{error, note, warning};
pub(crate) use settings::{Settings, set, settings};
