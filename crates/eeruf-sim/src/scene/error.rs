//! Errors of a scene, and its limits. Walls and poles are counted from 0, as in code and files.

use core::fmt;

/// The highest ceiling, in metres.
pub(crate) const MAX_CEILING_M: f64 = 1000.0;

/// Largest number of walls in a scene: a choice, to limit memory.
pub const MAX_WALLS: usize = 10_000_000;
/// Greatest distance of a coordinate from the origin, in metres: a choice; an `f64` still resolves 1e-11 m there.
pub const MAX_COORDINATE_M: f64 = 1e5;
/// The shortest wall, in metres: a choice, a thousand times the distance at which two points are one.
pub const MIN_WALL_M: f64 = 1e-6;
/// Largest radius of a pole, in metres: a choice; use walls for rounder objects.
pub const MAX_POLE_M: f64 = 100.0;

/// Reason why a scene cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// A coordinate of a wall is not a number or too far away.
    WallCoordinate {
        /// Index of the wall.
        wall: usize,
        /// The coordinate, in metres.
        value: f64,
    },
    /// A wall is shorter than [`MIN_WALL_M`].
    WallTooShort {
        /// Index of the wall.
        wall: usize,
        /// The length in metres.
        length_m: f64,
    },
    /// Two walls share more than a point, or one wall is given twice.
    WallsOverlap {
        /// Indices of the two walls.
        walls: [usize; 2],
    },
    /// Two walls cross.
    WallsCross {
        /// Indices of the two walls.
        walls: [usize; 2],
        /// Point of crossing, in metres.
        at: [f64; 2],
    },
    /// There are more walls than the mesh can number.
    TooManyWalls {
        /// The number given.
        count: usize,
    },
    /// A wall's material has a reflection outside 0 to 1 or a negative roughness.
    WallMaterial {
        /// Index of the wall.
        wall: usize,
    },
    /// A pole's coordinate or radius is not a number, too large, or the radius is not positive.
    Pole {
        /// Index of the pole.
        pole: usize,
        /// The offending number, in metres.
        value: f64,
    },
    /// A pole's material has a reflection outside 0 to 1 or a negative roughness.
    PoleMaterial {
        /// Index of the pole.
        pole: usize,
    },
    /// Two poles have the same axis.
    SamePole {
        /// Indices of the two poles.
        poles: [usize; 2],
    },
    /// Temperature, humidity or pressure is outside the range of the formulas.
    Air {
        /// The name of the quantity.
        quantity: &'static str,
        /// The offending number.
        value: f64,
        /// The expected range.
        expected: &'static str,
    },
    /// The ceiling is too low or too high.
    Ceiling {
        /// The height in metres.
        ceiling_m: f64,
    },
    /// The material of floor or ceiling is invalid.
    RoomMaterial {
        /// The surface: floor or ceiling.
        surface: &'static str,
    },
    /// The walls meet in a way that the mesh cannot hold, such as many crossing within a nanometre.
    Tangled {
        /// Number of pieces of wall that were refused.
        pieces: usize,
    },
}

/// The end of the message about a material, after its owner.
const OUT_OF_RANGE: &str = "is out of range; expected a reflection of 0 to 1 and a roughness of 0 m or more";

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::WallCoordinate { wall, value } => {
                write!(f, "wall {wall} has a coordinate {value} m; expected a number within {MAX_COORDINATE_M} m")
            }
            Self::WallTooShort { wall, length_m } => {
                write!(f, "wall {wall} is {length_m} m long; expected at least {MIN_WALL_M} m")
            }
            Self::WallsOverlap { walls: [a, b] } => {
                write!(f, "walls {a} and {b} lie on top of each other; they may share one point only")
            }
            Self::WallsCross { walls: [a, b], at: [x, y] } => {
                write!(f, "walls {a} and {b} cross at ({x:.4}, {y:.4}); end one of them there")
            }
            Self::TooManyWalls { count } => write!(f, "{count} walls; expected at most {MAX_WALLS}"),
            Self::WallMaterial { wall } => {
                write!(f, "the material of wall {wall} {OUT_OF_RANGE}")
            }
            Self::Pole { pole, value } => {
                write!(
                    f,
                    "pole {pole} has {value} m; expected finite coordinates and a radius above 0 and up to \
                     {MAX_POLE_M} m"
                )
            }
            Self::PoleMaterial { pole } => {
                write!(f, "the material of pole {pole} {OUT_OF_RANGE}")
            }
            Self::SamePole { poles: [a, b] } => write!(f, "poles {a} and {b} have the same axis"),
            Self::Air { quantity, value, expected } => write!(f, "air {quantity} is {value}; expected {expected}"),
            Self::Ceiling { ceiling_m } => {
                write!(f, "the ceiling is at {ceiling_m} m; expected a height above 0 and up to {MAX_CEILING_M} m")
            }
            Self::RoomMaterial { surface } => write!(f, "the material of the {surface} {OUT_OF_RANGE}"),
            Self::Tangled { pieces } => {
                write!(f, "{pieces} pieces of wall cross within a nanometre of others; simplify the walls there")
            }
        }
    }
}

impl core::error::Error for SceneError {}
