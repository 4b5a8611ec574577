//! The line of a wall as a mirror: images of points, turned directions, angles of incidence.

use super::plane::{Point, Vector};

/// The line of a wall as a mirror.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mirror {
    on: Point,
    normal: Vector,
    /// Twice the line's own angle: reflection sends a direction `theta` to `turn - theta`.
    pub(crate) turn: f64,
    /// Reflection of a flat wall of its material.
    pub(crate) reflection: f64,
}

impl Mirror {
    /// Makes the mirror along the line through two different points; its normal is on the left of `from` to `to`.
    pub(crate) fn through(from: Point, to: Point, reflection: f64) -> Self {
        let along = (to - from).normalize();
        Self { on: from, normal: Vector::new(-along.y, along.x), turn: 2.0 * libm::atan2(along.y, along.x), reflection }
    }

    /// Returns the signed distance of a point, positive on the left.
    #[inline(always)]
    pub(crate) fn distance(&self, point: Point) -> f64 {
        (point - self.on).dot(&self.normal)
    }

    /// Returns the mirrored point, given its [`distance`](Self::distance).
    #[inline(always)]
    pub(crate) fn image(&self, point: Point, distance: f64) -> Point {
        point - self.normal * (2.0 * distance)
    }

    /// Returns the mirrored direction.
    #[inline(always)]
    pub(crate) fn turned(&self, direction: Vector) -> Vector {
        direction - self.normal * (2.0 * direction.dot(&self.normal))
    }

    /// Returns the cosine of the angle of incidence of a unit direction.
    pub(crate) fn cos_incidence(&self, direction: Vector) -> f64 {
        direction.dot(&self.normal).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_modules::wrap_angle;

    #[test]
    fn reflecting_twice_returns_the_point_and_the_direction() {
        let mirror = Mirror::through(Point::new(1.0, 2.0), Point::new(4.0, -1.5), 1.0);
        let point = Point::new(0.3, 7.0);
        let image = mirror.image(point, mirror.distance(point));
        assert!((mirror.image(image, mirror.distance(image)) - point).norm() < 1e-14);
        let direction = Vector::new(0.6, -0.8);
        let turned = mirror.turned(direction);
        let angle = wrap_angle(mirror.turn - libm::atan2(direction.y, direction.x));
        assert!((libm::atan2(turned.y, turned.x) - angle).abs() < 1e-14);
    }
}
