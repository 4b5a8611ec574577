//! Files of firings, whatever their format.

use std::fs::File;
use std::path::Path;

use crate::firing_messages;
use crate::firings::FiringLog;
use crate::form::{self, Form};
use crate::serial;
use eeruf_files::FileError;

/// The error for a log of ranges where one of firings is expected.
fn not_firings(file: &Path, form: &str) -> FileError {
    let message = format!(
        "{form}, which holds ranges and no firings; expected text with sensor, fired_us, period, phase and t_echo_us, \
         or MCAP with eeruf_msgs/msg/Firing; `eeruf logs` and `eeruf replay` read ranges"
    );
    FileError::new(file, message)
}

impl FiringLog {
    /// Reads a log, text, MCAP or frames of the serial line, as its first bytes say.
    ///
    /// # Errors
    /// A file that cannot be read, columns that are missing, or text without a whole line; MCAP in which there is no
    /// firing, or there are those of several rings.
    pub fn read(file: &Path) -> Result<Self, FileError> {
        if file.is_dir() {
            return Err(not_firings(file, "a folder"));
        }
        let failed = |error: std::io::Error| FileError::reading(file, &error);
        match Form::of_file(file)? {
            Form::Mcap => firing_messages::read(file),
            Form::Text => Self::read_from(File::open(file).map_err(failed)?, file),
            Form::Serial => serial::firings(File::open(file).map_err(failed)?, file),
            Form::Packed(packing) => {
                let input = packing.unpack(File::open(file).map_err(failed)?).map_err(failed)?;
                let (unpacked, error) = form::to_file(input, "csv").map_err(failed)?;
                if let Some(error) = error {
                    return Err(FileError::new(file, format!("it cannot be unpacked: {error}")));
                }
                match Form::of_file(unpacked.path())? {
                    Form::Mcap => firing_messages::read(unpacked.path()),
                    Form::Serial => serial::firings(File::open(unpacked.path()).map_err(failed)?, file),
                    Form::Text => Self::read_from(File::open(unpacked.path()).map_err(failed)?, file),
                    other => Err(not_firings(file, other.name())),
                }
            }
            Form::Foreign(foreign) => Err(foreign.refuse(file)),
            other @ (Form::Ros1 | Form::Sqlite) => Err(not_firings(file, other.name())),
        }
    }
}
