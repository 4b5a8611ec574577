//! Files of firings, whatever their format.

use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::path::Path;

use crate::error::LogError;
use crate::firing_messages;
use crate::firings::FiringLog;

impl FiringLog {
    /// Reads a log, CSV or MCAP, as its first bytes say.
    ///
    /// # Errors
    /// A file that cannot be read, columns that are missing, or a value that is none, with its line; MCAP in which
    /// there is no firing, or there are those of several rings.
    pub fn read(file: &Path) -> Result<Self, LogError> {
        let mut opened = BufReader::new(File::open(file).map_err(|error| LogError::new(file, error))?);
        let first = opened.fill_buf().map_err(|error| LogError::new(file, error))?;
        if first.starts_with(&crate::mcap::MAGIC) {
            drop(opened);
            return firing_messages::read(file);
        }
        Self::read_from(opened, file)
    }
}
