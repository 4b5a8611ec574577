//! Points and the few operations on them that everything else is made of.
//! The types are nalgebra's; what is added is the cross product as an orientation test and reflection in a wall's line.

use nalgebra::{Point2, Vector2};

/// A point of the plane, in metres.
pub type Point = Point2<f64>;
/// A displacement or direction in the plane.
pub type Vector = Vector2<f64>;
/// Position and heading of a robot or a transducer.
pub type Pose = nalgebra::Isometry2<f64>;

/// Two points nearer than this are one: joined walls, doubles of one path, a source on top of its receiver.
pub const TOUCH_M: f64 = 1e-9;

/// An angle below this counts as none when a receiver is compared with a beam's limit. Rounding stays under 1e-15 per
/// bounce, so the figure separates "exactly on the limit" from every honest miss.
pub(crate) const SAME_DIRECTION: f64 = 1e-12;

/// Twice the signed area spanned by two vectors: positive when `b` points to the left of `a`.
#[inline(always)]
pub(crate) fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Wraps an angle into (-pi, pi].
#[inline]
pub(crate) fn wrap_angle(angle_rad: f64) -> f64 {
    use core::f64::consts::{PI, TAU};
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    // A conversion to an integer and back rounds without a call.
    let turns = (angle_rad / TAU + 0.5f64.copysign(angle_rad)) as i64;
    let wrapped = angle_rad - TAU * turns as f64;
    if wrapped <= -PI {
        wrapped + TAU
    } else if wrapped > PI {
        wrapped - TAU
    } else {
        wrapped
    }
}

/// The opposite of a direction in (-pi, pi], in the same range.
#[inline]
pub(crate) fn opposite(angle_rad: f64) -> f64 {
    use core::f64::consts::PI;
    if angle_rad > 0.0 { angle_rad - PI } else { angle_rad + PI }
}

/// The line of a wall as a mirror.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    on: Point,
    normal: Vector,
    /// Twice the line's own angle: reflection sends a direction `theta` to `turn - theta`.
    pub(crate) turn: f64,
    /// What a flat wall of its material returns.
    pub(crate) reflection: f64,
}

impl Mirror {
    /// The mirror along the line through two different points; its normal is on the left of `from` to `to`.
    pub(crate) fn through(from: Point, to: Point, reflection: f64) -> Self {
        let along = (to - from).normalize();
        Self { on: from, normal: Vector::new(-along.y, along.x), turn: 2.0 * along.y.atan2(along.x), reflection }
    }

    /// Signed distance, positive on the left.
    #[inline(always)]
    pub(crate) fn distance(&self, point: Point) -> f64 {
        (point - self.on).dot(&self.normal)
    }

    /// The mirrored point, given its [`distance`](Self::distance).
    #[inline(always)]
    pub(crate) fn image(&self, point: Point, distance: f64) -> Point {
        point - self.normal * (2.0 * distance)
    }

    /// The mirrored direction.
    #[inline(always)]
    pub(crate) fn turned(&self, direction: Vector) -> Vector {
        direction - self.normal * (2.0 * direction.dot(&self.normal))
    }

    /// Cosine of the angle of incidence of a unit direction.
    pub(crate) fn cos_incidence(&self, direction: Vector) -> f64 {
        direction.dot(&self.normal).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reflecting_twice_returns_the_point_and_the_direction() {
        let mirror = Mirror::through(Point::new(1.0, 2.0), Point::new(4.0, -1.5), 1.0);
        let point = Point::new(0.3, 7.0);
        let image = mirror.image(point, mirror.distance(point));
        assert!((mirror.image(image, mirror.distance(image)) - point).norm() < 1e-14);
        let direction = Vector::new(0.6, -0.8);
        let turned = mirror.turned(direction);
        let angle = wrap_angle(mirror.turn - direction.y.atan2(direction.x));
        assert!((turned.y.atan2(turned.x) - angle).abs() < 1e-14);
    }

    #[test]
    fn angles_wrap_to_the_half_open_circle() {
        use core::f64::consts::PI;
        assert_eq!(wrap_angle(PI), PI);
        assert_eq!(wrap_angle(-PI), PI);
        assert_eq!((opposite(PI), opposite(0.0)), (0.0, PI));
        assert!((wrap_angle(7.0 * PI + 0.25) - (0.25 - PI)).abs() < 1e-14);
    }
}
