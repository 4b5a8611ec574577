//! The program `eeruf`: design, verify and study firing schedules, and see what the filter makes of recorded readings.
//!
//! `commands` has one file for each verb; `files` is what they read, `report` what they print and draw. What the
//! program can do, other programs do with the libraries that it stands on: [`eeruf_core`], [`eeruf_design`] and
//! [`eeruf_sim`]. Here is only what starts it, so that the Python package can hold it too, its example files, and what
//! writes a simulation into an MCAP file while it goes on.

// Doc comments of arguments are what --help prints in a terminal, where backticks only disturb.
#![allow(clippy::doc_markdown)]

mod commands;
pub mod examples;
mod files;
mod report;

use std::ffi::OsString;

use clap::Parser;

use crate::commands::{Answer, Cli};
pub use crate::files::mcap::Recording;

/// Runs the program with these arguments, of which the first is its own name, and gives its exit code: 0 for yes, 1 for
/// no (not verified, infeasible), 2 for bad input, which is named in one line on standard error.
///
/// It takes the process for its own: Ctrl-C ends what it does, and so does a pipe whose reader went away.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    sigpipe::reset();
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version come this way too. Where nobody reads it there is nothing to be done.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    match cli.verb.run() {
        Ok(Answer::Yes) => 0,
        Ok(Answer::No) => 1,
        Err(error) => {
            eprintln!("eeruf: {error}");
            2
        }
    }
}
