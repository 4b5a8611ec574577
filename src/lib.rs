//! The program `eeruf`: designs, verifies and studies firing schedules, and runs the filter on recorded readings.
//!
//! `commands` has one file for each verb; `files` reads their input, `report` prints and draws, and `console` is the
//! terminal. Other programs can do the same with the libraries on which this one is built: [`eeruf_core`],
//! [`eeruf_design`] and [`eeruf_sim`]. The public part only starts the program, so that the Python package can contain
//! it too, gives its example files, and records a simulation as an MCAP file while it runs.

// --help prints the doc comments of arguments in a terminal, where backticks would only disturb.
#![allow(clippy::doc_markdown)]
// Standard output and standard error have one writer, `console`: `println!` and `eprintln!` would panic where the disk
// is full.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod commands;
mod console;
pub mod examples;
mod files;
mod program;
mod report;

use std::ffi::OsString;

use clap::FromArgMatches as _;

use crate::commands::{Answer, Cli, program as command};
use crate::files::error::InputError;
pub use crate::files::firings::firing_log;
use crate::files::implausible::warn_of_options;
pub use crate::files::mcap::Recording;
use crate::files::write::check_outputs;

/// The exit code after Ctrl-C: 128 and the number of its signal.
const STOPPED: u8 = 130;

/// Runs the program with these arguments, its own name first, and returns its exit code: 0 for yes, 1 for
/// no (not verified, infeasible), 2 for bad input, which is named in one line on standard error, 3 if a search ended
/// before its answer, 74 if the output cannot be written, 130 if Ctrl-C ended it; what was done until then is printed.
///
/// It assumes that it owns the process: Ctrl-C ends the command, and so does a pipe whose reader has gone.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    sigpipe::reset();
    console::set(console::Settings::default());
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    report::watch::begin();
    let parsed = command().try_get_matches_from(&arguments);
    let (cli, matches) = match parsed.and_then(|matches| Ok((Cli::from_arg_matches(&matches)?, matches))) {
        Ok(parsed) => parsed,
        Err(error) => {
            return not_parsed(&error, &arguments);
        }
    };
    console::set(cli.output.settings());
    let _running = report::watch::said();
    let code = match check_outputs(&matches).and_then(|()| warn_of_options(&matches)).and_then(|()| cli.verb.run()) {
        Ok(Answer::Yes) => 0,
        Ok(Answer::No) => 1,
        Ok(Answer::NotDecided) => 3,
        Err(error) => failed(&error),
    };
    if report::watch::was_stopped() { STOPPED } else { code }
}

/// Prints help and version, or the error in the arguments.
fn not_parsed(error: &clap::Error, arguments: &[OsString]) -> u8 {
    let words: Vec<_> = arguments.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    console::set(commands::arguments::settings(&words));
    if error.use_stderr() && arguments.len() > 1 {
        return failed(&commands::arguments::describe(error, &words));
    }
    console::tell(error.render()).map_or_else(|error| failed(&error.into()), |()| 0)
}

fn failed(error: &InputError) -> u8 {
    if !error.is_silent() {
        console::error(error);
        if let Some(quoted) = error.quoted().filter(|_| console::settings().explains()) {
            console::note(quoted);
        }
    }
    error.code()
}
