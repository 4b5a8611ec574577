//! Writing files and folders that the user asked for.

use std::fs;
use std::path::Path;

use eeruf_files::FileError;

use super::error::InputError;

/// Writes a file that the user asked for.
pub(crate) fn write(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), InputError> {
    fs::write(file, contents).map_err(|error| FileError::writing(file, &error).into())
}

/// Makes a folder that the user asked for, and those around it.
pub(crate) fn make_folder(folder: &Path) -> Result<(), InputError> {
    fs::create_dir_all(folder).map_err(|error| FileError::writing(folder, &error).into())
}
