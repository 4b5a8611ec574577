//! Files of firings, in any format.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::form::{Form, Opened};
use super::{firing_messages, firing_text, serial};
use crate::firings::FiringLog;
use eeruf_files::FileError;

/// The error for a log of ranges instead of firings.
fn not_firings(file: &Path, form: &str) -> FileError {
    let message = format!(
        "{form}, which holds ranges and no firings; expected text with sensor, fired_us, period, phase and t_echo_us, \
         or MCAP with eeruf_msgs/msg/Firing; `eeruf logs` and `eeruf replay` read ranges"
    );
    FileError::new(file, message)
}

impl FiringLog {
    /// Reads a log, text, MCAP or frames of the serial line, recognised by its first bytes, packed or not.
    ///
    /// # Errors
    /// A file that cannot be read, columns that are missing, or text without a whole line; MCAP without firings,
    /// or with those of several rings.
    pub fn read(file: &Path) -> Result<Self, FileError> {
        if file.is_dir() {
            return Err(not_firings(file, "a folder"));
        }
        Self::read_from(File::open(file).map_err(|error| FileError::reading(file, &error))?, file)
    }

    /// Reads a log from a stream, like [`FiringLog::read`]; `name` is used in errors, and its ending helps if the first
    /// bytes do not show the form.
    ///
    /// # Errors
    /// See [`FiringLog::read`].
    pub fn read_from(mut input: impl Read, name: &Path) -> Result<Self, FileError> {
        let failed = |error: io::Error| FileError::reading(name, &error);
        let mut opened = Opened::new(&mut input, name).map_err(failed)?;
        let read = match opened.form {
            Form::Mcap => firing_messages::read(&mut opened, name),
            Form::Text => firing_text::read(&mut opened, name),
            Form::Serial => serial::firings(&mut opened, name),
            Form::Foreign(foreign) => Err(foreign.refuse(name)),
            other => Err(not_firings(name, other.name())),
        };
        match opened.error {
            Some(error) => Err(FileError::new(name, format!("it cannot be unpacked: {error}"))),
            None => read,
        }
    }
}
