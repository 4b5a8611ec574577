//! Conditions of an experiment's rings besides its physics: floor and ceiling, and the module's own gain.

use core::fmt;

use serde::Serialize;

use crate::acoustics::GainProfile;
use crate::scene::Room;

/// Height and gain of an experiment; the defaults are flat and constant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Conditions {
    /// `"room"` between floor and ceiling.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height: Option<&'static str>,
    /// The gain's name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<&'static str>,
}

impl Conditions {
    /// Makes conditions from an optional room and a gain.
    pub fn of(room: Option<&Room>, gain: GainProfile) -> Self {
        let gain = Some(gain).filter(|gain| *gain != GainProfile::Constant);
        Self { height: room.map(|_| "room"), gain: gain.map(GainProfile::name) }
    }
}

/// The words after the name of the physics in a title; nothing for the defaults.
impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.height.map_or(Ok(()), |height| write!(f, ", height: {height}"))?;
        self.gain.map_or(Ok(()), |gain| write!(f, ", gain: {gain}"))
    }
}
