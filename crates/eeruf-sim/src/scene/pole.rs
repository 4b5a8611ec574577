//! A pole: an upright cylinder, a circle in the plane.

use super::material::Material;
use crate::geometry::Point;

/// An upright cylinder that reflects. Its radius and [`Physics::shadows`](crate::Physics::shadows) decide if it shades
/// objects behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// The axis.
    pub centre: Point,
    /// Radius in metres.
    pub radius_m: f64,
    /// The surface.
    pub material: Material,
}

impl Pole {
    /// Makes a perfectly reflecting pole; all lengths are in metres.
    pub fn new(x: f64, y: f64, radius_m: f64) -> Self {
        Self { centre: Point::new(x, y), radius_m, material: Material::PERFECT }
    }
}
