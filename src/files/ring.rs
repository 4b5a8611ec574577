//! Ring files, for `design`.

use std::path::Path;

use eeruf_design::{RingFile, RingSpec};
use eeruf_files::Kind;

use super::error::InputError;
use super::toml::read_toml;

/// Reads a ring file.
pub(crate) fn read_ring(file: &Path) -> Result<RingSpec, InputError> {
    read_toml(file, Kind::Ring, |ring: RingFile| ring.spec())
}
