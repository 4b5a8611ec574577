//! Reads ring files, and refuses them if their numbers are in other units than their keys say.

use std::path::Path;

use eeruf_files::{FileError, RobotRing, build};

use crate::plausible;
use crate::ring::{RingFile, RingSpec};

/// The checked ring of a file, or of a text without a file.
fn checked(ring: &RingFile, file: Option<&Path>) -> Result<RingSpec, String> {
    let spec = ring.spec(file)?;
    plausible::check(ring, &spec).map(|()| spec)
}

impl RingSpec {
    /// Reads the text of a ring file that names no URDF.
    ///
    /// # Errors
    /// The first error in the text.
    pub fn from_text(text: &str) -> Result<Self, FileError> {
        build(text, |ring: RingFile| checked(&ring, None))
    }

    /// Reads the text of a ring file at this path. A URDF that it names is looked up beside it.
    ///
    /// # Errors
    /// The first error in the text, with the file's name.
    pub fn in_file(file: &Path, text: &str) -> Result<Self, FileError> {
        build(text, |ring: RingFile| checked(&ring, Some(file))).map_err(|error| error.in_file(file))
    }
}

/// The robot of a ring file in a scene, as `eeruf_sim::World::from_text_with` reads one.
///
/// # Errors
/// The first error in the text.
///
/// ```
/// let text = "sensors = 2\nmodule = \"ping\"\njitter_us = 100\nmin_interval_us = 0\nspacing_deg = 30\nradius_m = 0.2";
/// let ring = eeruf_design::robot_ring("ring.toml".as_ref(), text)?;
/// assert_eq!((ring.modules[1].name, ring.limits[1].t_delta.as_micros()), ("ping", 100));
/// # Ok::<(), eeruf_files::FileError>(())
/// ```
pub fn robot_ring(file: &Path, text: &str) -> Result<RobotRing, FileError> {
    Ok(RingSpec::in_file(file, text)?.robot_ring())
}
