//! A robot's body: a disc, a box or a convex polygon that reflects and shades the sound of other robots.

use core::fmt;

use crate::geometry::{Point, Pose, TOUCH_M, cross};
use parry2d_f64::{
    math::Pose as ParryPose,
    query::intersection_test,
    shape::{Ball, ConvexPolygon, Cuboid, Shape},
};

/// Largest number of corners of a polygon: a choice.
pub const MAX_CORNERS: usize = 8;

/// A robot's outline, centred on its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// A disc of this radius in metres.
    Disc(f64),
    /// A box of this length (along the heading) and width, in metres.
    Box(f64, f64),
    /// A convex polygon.
    Polygon(Outline),
}

/// A convex polygon of 3 to [`MAX_CORNERS`] corners, counter-clockwise, in the robot's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outline {
    corners: [Point; MAX_CORNERS],
    count: usize,
}

/// Reason why corners do not form a convex polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum OutlineError {
    /// The outline has too few or too many corners.
    Corners {
        /// The number given.
        count: usize,
    },
    /// A corner is not a number, or the outline does not turn left there.
    Corner {
        /// The index.
        corner: usize,
        /// Position, in metres.
        at: [f64; 2],
    },
}

impl fmt::Display for OutlineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Corners { count } => write!(f, "{count} corners; expected 3 to {MAX_CORNERS}"),
            Self::Corner { corner, at: [x, y] } => {
                write!(f, "corner {corner} is ({x}, {y}) m; expected a convex outline, counter-clockwise")
            }
        }
    }
}

impl core::error::Error for OutlineError {}

impl Outline {
    /// Checks corners in metres: convex, counter-clockwise, no two in one place.
    ///
    /// # Errors
    /// The number of corners if it is out of range, or the first invalid corner.
    ///
    /// ```
    /// use eeruf_sim::Outline;
    /// assert_eq!(Outline::new(&[[0.0, 0.0], [0.3, 0.0], [0.0, 0.3]])?.corners().len(), 3);
    /// let error = Outline::new(&[[0.0, 0.0], [0.0, 0.3], [0.3, 0.0]]).unwrap_err();
    /// assert_eq!(error.to_string(), "corner 0 is (0, 0) m; expected a convex outline, counter-clockwise");
    /// # Ok::<(), eeruf_sim::OutlineError>(())
    /// ```
    pub fn new(corners: &[[f64; 2]]) -> Result<Self, OutlineError> {
        let count = corners.len();
        if !(3..=MAX_CORNERS).contains(&count) {
            return Err(OutlineError::Corners { count });
        }
        let at = |corner: usize| Point::from(corners[corner % count]);
        let mut turned_rad = 0.0;
        for corner in 0..count {
            let (back, on) = (at(corner) - at(corner + count - 1), at(corner + 1) - at(corner));
            // The comparison is written so that a NaN fails.
            if !(back.norm() > TOUCH_M && cross(back, on) > 0.0 && on.norm() < f64::INFINITY) {
                return Err(OutlineError::Corner { corner, at: corners[corner] });
            }
            turned_rad += libm::atan2(cross(back, on), back.dot(&on));
        }
        // The outline turns twice, like a star.
        if turned_rad > 1.5 * core::f64::consts::TAU {
            return Err(OutlineError::Corner { corner: 0, at: corners[0] });
        }
        let mut outline = Self { corners: [Point::origin(); MAX_CORNERS], count };
        for corner in 0..count {
            outline.corners[corner] = at(corner);
        }
        Ok(outline)
    }

    /// Returns the corners.
    pub fn corners(&self) -> &[Point] {
        &self.corners[..self.count]
    }
}

impl Body {
    /// Calls a function with the parry shape of the body.
    pub(super) fn with_shape<R>(&self, call: impl FnOnce(&dyn Shape) -> R) -> R {
        match *self {
            Self::Disc(radius) => call(&Ball::new(radius)),
            Self::Box(length, width) => call(&Cuboid::new([0.5 * length, 0.5 * width].into())),
            Self::Polygon(outline) => {
                let corners = outline.corners().iter().map(|corner| corner.coords.into()).collect();
                match ConvexPolygon::from_convex_polyline(corners) {
                    Some(polygon) => call(&polygon),
                    // The area is negligible.
                    None => call(&Ball::new(TOUCH_M)),
                }
            }
        }
    }

    /// Returns true if the body overlaps another one.
    pub fn overlaps(&self, pose: &Pose, other: &Self, there: &Pose) -> bool {
        self.with_shape(|shape| other.with_shape(|other| meets(&placed(pose), shape, &placed(there), other)))
    }

    /// Returns true if a point is within the body.
    pub fn holds(&self, pose: &Pose, point: Point) -> bool {
        self.overlaps(pose, &Self::Disc(TOUCH_M), &Pose::from(point.coords))
    }

    /// Returns the corners at a pose, clockwise like a pillar's walls, with the first one repeated at the end; empty
    /// for a disc.
    pub(crate) fn walls_around(&self, pose: &Pose) -> Vec<[f64; 2]> {
        let mut corners: Vec<Point> = match *self {
            Self::Disc(_) => return Vec::new(),
            Self::Box(length, width) => [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
                .map(|[x, y]| Point::new(x * length, y * width))
                .into(),
            Self::Polygon(outline) => outline.corners().to_vec(),
        };
        corners.reverse();
        corners.push(corners[0]);
        corners.iter().map(|corner| pose * corner).map(|corner| [corner.x, corner.y]).collect()
    }

    /// Returns the number of walls around the body; 0 for a disc.
    pub(crate) fn sides(&self) -> usize {
        match self {
            Self::Disc(_) => 0,
            Self::Box(..) => 4,
            Self::Polygon(outline) => outline.count,
        }
    }

    /// Returns true if the body's dimensions are positive numbers.
    pub(crate) fn is_valid(&self) -> bool {
        let fits = |size: f64| size > 0.0 && size <= super::MAX_POLE_M;
        match *self {
            Self::Disc(radius) => fits(radius),
            Self::Box(length, width) => fits(length) && fits(width),
            Self::Polygon(_) => true,
        }
    }
}

/// Converts a pose to parry's form.
pub(super) fn placed(pose: &Pose) -> ParryPose {
    ParryPose::new(pose.translation.vector.into(), pose.rotation.angle())
}

/// Returns true if two shapes touch. Parry knows all pairs used here, so "not supported" does not occur.
pub(super) fn meets(at: &ParryPose, shape: &dyn Shape, there: &ParryPose, other: &dyn Shape) -> bool {
    intersection_test(at, shape, there, other).is_ok_and(|found| found.intersecting)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    #[test]
    fn bodies_of_any_shape_overlap_where_they_do() {
        let triangle = Body::Polygon(Outline::new(&[[-0.2, -0.2], [0.4, 0.0], [-0.2, 0.2]]).unwrap());
        let at = |x: f64| Pose::new(Vector::new(x, 0.0), 0.0);
        for (other, reach_m) in [(Body::Disc(0.3), 0.7), (Body::Box(0.6, 0.2), 0.7), (triangle, 0.6)] {
            assert!(triangle.overlaps(&at(0.0), &other, &at(reach_m - 1e-3)), "{other:?}");
            assert!(!triangle.overlaps(&at(0.0), &other, &at(reach_m + 1e-3)), "{other:?}");
        }
        assert!(triangle.holds(&at(1.0), Point::new(1.39, 0.0)) && !triangle.holds(&at(1.0), Point::new(1.41, 0.0)));
    }

    #[test]
    fn outlines_that_are_not_convex_are_refused_with_the_corner() {
        let refused = |corners: &[[f64; 2]]| Outline::new(corners).unwrap_err().to_string();
        assert_eq!(refused(&[[0.0, 0.0], [1.0, 0.0]]), "2 corners; expected 3 to 8");
        let dent = [[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]];
        assert_eq!(refused(&dent), "corner 2 is (0.2, 0.2) m; expected a convex outline, counter-clockwise");
        assert!(refused(&[[0.0, 0.0], [1.0, 0.0], [f64::NAN, 1.0]]).starts_with("corner"));
        let star = [0, 2, 4, 1, 3].map(|k| [libm::cos(1.2566 * f64::from(k)), libm::sin(1.2566 * f64::from(k))]);
        assert!(refused(&star).starts_with("corner 0"));
    }
}
