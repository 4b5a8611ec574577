//! Writing a file that the user asked for.

use std::fs;
use std::path::Path;

use super::error::InputError;

/// Writes a file that the user asked for.
pub(crate) fn write(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), InputError> {
    fs::write(file, contents).map_err(|error| InputError::writing(file, &error))
}
