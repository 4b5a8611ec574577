//! A room's height: floor and ceiling, between which walls and poles stand upright.

use super::error::{MAX_CEILING_M, SceneError};
use super::material::Material;

/// The default height of a sensor, in metres: a choice, about the height of a small robot's ring.
pub const DEFAULT_HEIGHT_M: f64 = 0.3;

/// Floor and ceiling. Walls and poles reach from one to the other, so that every path is a path in the plan with
/// alternate bounces at floor and ceiling.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Room {
    /// The height of the ceiling above the floor, in metres, above 0 and up to 1000.
    pub ceiling_m: f64,
    /// The floor's surface.
    pub floor: Material,
    /// The ceiling's surface.
    pub ceiling: Material,
}

impl Room {
    /// A ceiling at 2.6 m with a reflection of 0.9 above a floor with a reflection of 0.95 (choices).
    pub const DEFAULT: Self = Self { ceiling_m: 2.6, floor: Material::SMOOTH, ceiling: Material::PAINTED };

    /// Returns true if a height in metres is between floor and ceiling.
    pub fn holds(&self, height_m: f64) -> bool {
        height_m > 0.0 && height_m < self.ceiling_m
    }

    pub(super) fn check(&self) -> Result<(), SceneError> {
        if !(self.ceiling_m > 0.0 && self.ceiling_m <= MAX_CEILING_M) {
            return Err(SceneError::Ceiling { ceiling_m: self.ceiling_m });
        }
        match [("floor", &self.floor), ("ceiling", &self.ceiling)]
            .into_iter()
            .find(|(_, material)| !material.is_valid())
        {
            Some((surface, _)) => Err(SceneError::RoomMaterial { surface }),
            None => Ok(()),
        }
    }
}

impl Default for Room {
    fn default() -> Self {
        Self::DEFAULT
    }
}
