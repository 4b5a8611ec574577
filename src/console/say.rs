//! Errors and warnings on standard error.

use std::fmt;
use std::io::{self, Write as _};

use super::fit::wrap_line;
use super::settings::settings;

const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const PLAIN: &str = "\x1b[0m";

/// Prints an error.
pub(crate) fn error(message: impl fmt::Display) {
    say("eeruf: ", RED, &message);
}

/// Prints what was done besides the answer, such as a file that was written.
pub(crate) fn note(message: impl fmt::Display) {
    say("", "", &message);
}

/// Prints a warning, unless the user wants none.
pub(crate) fn warning(message: impl fmt::Display) {
    if !settings().quiet {
        say("eeruf: warning: ", YELLOW, &message);
    }
}

fn say(prefix: &str, colour: &str, message: &dyn fmt::Display) {
    let line = format!("{prefix}{message}");
    let mut text = String::new();
    match settings().err_width() {
        Some(width) => wrap_line(&mut text, &line, width),
        None => text = line + "\n",
    }
    if settings().is_err_coloured() && !prefix.is_empty() && text.starts_with(prefix) {
        text = format!("{colour}{prefix}{PLAIN}{}", &text[prefix.len()..]);
    }
    // If standard error is closed, there is nowhere left to report it.
    _ = io::stderr().lock().write_all(text.as_bytes());
}
