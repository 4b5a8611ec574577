//! A wall: a straight reflecting piece between two points, and the behaviour of its two sides.

use serde::{Deserialize, Serialize};

use super::material::Material;
use crate::geometry::Point;

/// The behaviour of a wall's sides towards sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Faces {
    /// Reflects on the left of the direction `from` to `to`, where the free space is; the back absorbs. A room is a
    /// loop walked counter-clockwise, a pillar a loop walked clockwise.
    #[default]
    Left,
    /// A free-standing panel: reflects on both sides.
    Both,
    /// An opening: no sound returns from either side.
    Open,
}

/// A straight wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Start point.
    pub from: Point,
    /// End point.
    pub to: Point,
    /// Sides that reflect.
    pub faces: Faces,
    /// Surface of the wall.
    pub material: Material,
}

impl Wall {
    /// Makes a smooth wall with the free space on its left; coordinates are in metres.
    pub fn new(x1: f64, y1: f64, x2: f64, y2: f64) -> Self {
        Self { from: Point::new(x1, y1), to: Point::new(x2, y2), faces: Faces::Left, material: Material::SMOOTH }
    }

    /// Returns the wall with other faces.
    #[must_use]
    pub fn with_faces(self, faces: Faces) -> Self {
        Self { faces, ..self }
    }

    /// Returns the wall of another material.
    #[must_use]
    pub fn with_material(self, material: Material) -> Self {
        Self { material, ..self }
    }

    /// Returns the walls of a polyline in order, free space on the left. Repeat the first corner at the end for a loop.
    ///
    /// ```
    /// use eeruf_sim::Wall;
    /// let room = Wall::polyline(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    /// assert_eq!(room.count(), 4);
    /// ```
    pub fn polyline(corners: &[[f64; 2]]) -> impl Iterator<Item = Self> + '_ {
        corners.windows(2).map(|pair| Self::new(pair[0][0], pair[0][1], pair[1][0], pair[1][1]))
    }

    /// Returns true if the wall is an opening.
    pub fn is_open(&self) -> bool {
        self.faces == Faces::Open
    }

    /// Returns the length in metres.
    pub fn length_m(&self) -> f64 {
        (self.to - self.from).norm()
    }
}
