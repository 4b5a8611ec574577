//! Ring files, for `design`.

use std::path::Path;

use eeruf_design::{RingFile, RingSpec};

use super::error::InputError;
use super::toml::read_toml;

/// Reads a ring file.
pub(crate) fn read_ring(file: &Path) -> Result<RingSpec, InputError> {
    read_toml::<RingFile>(file)?.spec().map_err(|message| InputError::new(file, None, message))
}
