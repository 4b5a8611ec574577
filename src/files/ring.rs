//! Ring files, for `design`.

use std::path::Path;

use eeruf_design::RingSpec;
use eeruf_files::Kind;

use super::error::InputError;
use super::implausible::{warn, warn_of};

/// Reads a ring file.
pub(crate) fn read_ring(file: &Path) -> Result<RingSpec, InputError> {
    let text = Kind::Ring.read(file)?;
    let spec = RingSpec::in_file(file, &text)?;
    warn_of(file, &text)?;
    let most = spec.sensors;
    // The default is 4, whatever the number of sensors.
    if usize::from(spec.neighbours) > most.max(4) {
        warn(InputError::new(file, format!("neighbours: {}; expected at most {most}, all of them", spec.neighbours)))?;
    }
    Ok(spec)
}
