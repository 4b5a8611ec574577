//! Alhazen's problem: the point of a circle at which sound from one point is reflected to another, with equal angles.
//! For points outside the circle there is exactly one, unless the circle stands between them.

use super::plane::{Point, Vector, cross};

/// A specular reflection at the outside of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Where the circle is met.
    pub point: Point,
    /// Angle of incidence and of reflection, in radians from the normal, 0 to pi/2.
    pub incidence_rad: f64,
    /// From the source to the point, in metres.
    pub before_m: f64,
    /// From the point to the receiver, in metres.
    pub after_m: f64,
}

/// Solves for the specular point to the last digits, or says that there is none: a point inside the circle, or the
/// circle in between.
///
/// With `t` the angle at the centre from the source's direction towards the receiver's, the angle of incidence seen
/// from the source grows with `t` and the one seen from the receiver falls, so their difference has one root. Newton's
/// method finds it; bisection takes over where a step would leave the bracket.
///
/// ```
/// use eeruf_sim::{Point, alhazen};
/// let here = Point::origin();
/// let echo = alhazen(here, here, Point::new(2.0, 0.0), 0.004).unwrap();
/// assert!((echo.before_m + echo.after_m - 3.992).abs() < 1e-15);
/// ```
pub fn alhazen(source: Point, receiver: Point, centre: Point, radius_m: f64) -> Option<Specular> {
    let point = balance(source, receiver, centre, radius_m)?;
    let normal = (point - centre) / radius_m;
    let (back, on) = (source - point, receiver - point);
    let incidence_rad = libm::atan2(cross(normal, back).abs(), normal.dot(&back));
    // With the circle in between, the angles balance on its far side.
    (normal.dot(&back) > 0.0 && normal.dot(&on) > 0.0).then(|| Specular {
        point,
        incidence_rad,
        before_m: back.norm(),
        after_m: on.norm(),
    })
}

/// The point of the circle with equal angles, in sight or not; none when a point is not outside the circle.
fn balance(source: Point, receiver: Point, centre: Point, radius_m: f64) -> Option<Point> {
    let (to_source, to_receiver) = (source - centre, receiver - centre);
    let (far_s, far_r) = (to_source.norm(), to_receiver.norm());
    // Written so that a NaN gives none.
    if !(far_s > radius_m && far_r > radius_m && radius_m > 0.0) {
        return None;
    }
    let between = libm::atan2(cross(to_source, to_receiver).abs(), to_source.dot(&to_receiver));
    let half = |far: f64| Half { far, radius: radius_m };
    let t = solve(half(far_s), half(far_r), between);

    let towards_receiver = if cross(to_source, to_receiver) < 0.0 { -1.0 } else { 1.0 };
    let (sin, cos) = libm::sincos(towards_receiver * t);
    let unit = to_source / far_s;
    let normal = Vector::new(cos * unit.x - sin * unit.y, sin * unit.x + cos * unit.y);
    Some(centre + normal * radius_m)
}

/// One of the two points, seen from the circle.
#[derive(Clone, Copy)]
struct Half {
    far: f64,
    radius: f64,
}

impl Half {
    /// Angle of incidence at the circle's point `t` away from this point's direction, and how fast it grows with `t`.
    fn incidence(self, t: f64) -> (f64, f64) {
        let (sin, cos) = libm::sincos(t);
        let (across, along) = (self.far * sin, self.far * cos - self.radius);
        let slope = self.far * (self.far - self.radius * cos) / (across * across + along * along);
        (libm::atan2(across, along), slope)
    }
}

fn solve(source: Half, receiver: Half, between: f64) -> f64 {
    let (mut low, mut high) = (0.0, between);
    let weight = |half: Half| half.far / (half.far - half.radius);
    let (from_s, from_r) = (weight(source), weight(receiver));
    let mut t = (between * from_r / (from_s + from_r)).clamp(low, high);
    for _ in 0..100 {
        let ((i_s, slope_s), (i_r, slope_r)) = (source.incidence(t), receiver.incidence(between - t));
        let difference = i_s - i_r;
        if difference > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let step = difference / (slope_s + slope_r);
        let mut next = t - step;
        if !(low..=high).contains(&next) {
            next = 0.5 * (low + high);
        }
        if (next - t).abs() <= 2e-16 * between || next == t {
            return next;
        }
        t = next;
    }
    t
}

/// Source, one circle, another circle, receiver: the two specular points of the path that bounces once at each.
///
/// Solving one circle with the other's point held still converges quickly, since a convex circle spreads what it
/// reflects.
pub fn alhazen_twice(
    source: Point,
    receiver: Point,
    first: (Point, f64),
    second: (Point, f64),
) -> Option<(Specular, Specular)> {
    // The first guess aims at the nearer side of the second circle.
    let aside = first.0 - second.0;
    let apart = aside.norm();
    if apart <= first.1 + second.1 {
        return None;
    }
    let mut on_second = second.0 + aside * (second.1 / apart);
    let mut last_step = f64::INFINITY;
    for _ in 0..200 {
        // On the way a point may be hidden; only the answer must be seen.
        let on_first = balance(source, on_second, first.0, first.1)?;
        let next = balance(on_first, receiver, second.0, second.1)?;
        let step = (next - on_second).norm();
        on_second = next;
        // Steps shrink until rounding stops them.
        if step == 0.0 || (step < 1e-12 * apart && step >= last_step) {
            let one = alhazen(source, on_second, first.0, first.1)?;
            return Some((one, alhazen(one.point, receiver, second.0, second.1)?));
        }
        last_step = step;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_circle_between_the_points_reflects_nothing_to_the_other() {
        let circle = Point::new(1.0, 0.0);
        assert_eq!(alhazen(Point::origin(), Point::new(2.0, 0.1), circle, 0.5), None);
        assert_eq!(alhazen(Point::new(0.9, 0.0), Point::new(2.0, 2.0), circle, 0.5), None);
        assert_eq!(alhazen(Point::new(f64::NAN, 0.0), Point::new(2.0, 2.0), circle, 0.5), None);
    }

    proptest! {
        #[test]
        fn the_specular_point_has_equal_angles_and_is_the_shortest_way(
            s in (-5.0..5.0f64, -5.0..5.0f64), r in (-5.0..5.0f64, -5.0..5.0f64), radius in 0.001..2.0f64,
        ) {
            let (source, receiver) = (Point::new(s.0, s.1), Point::new(r.0, r.1));
            if let Some(found) = alhazen(source, receiver, Point::origin(), radius) {
                let normal = found.point.coords / radius;
                let (back, on) = ((source - found.point).normalize(), (receiver - found.point).normalize());
                prop_assert!((cross(normal, back) + cross(normal, on)).abs() < 1e-9);
                let (sin, cos) = libm::sincos(1e-4);
                for turn in [sin, -sin] {
                    let Point { coords: at } = found.point;
                    let near = Point::new(cos * at.x - turn * at.y, turn * at.x + cos * at.y);
                    let longer = (source - near).norm() + (near - receiver).norm();
                    prop_assert!(longer >= found.before_m + found.after_m - 1e-12);
                }
                let back = alhazen(receiver, source, Point::origin(), radius).unwrap();
                prop_assert!((back.point - found.point).norm() < 1e-9);
            }
        }

        #[test]
        fn a_path_over_two_poles_has_equal_angles_at_both(
            s in (-3.0..0.0f64, -3.0..3.0f64),
            r in (-3.0..0.0f64, -3.0..3.0f64),
            a in 0.002..0.3f64,
            b in 0.002..0.3f64,
        ) {
            let (source, receiver) = (Point::new(s.0, s.1), Point::new(r.0, r.1));
            let (first, second) = (Point::new(1.0, 1.0), Point::new(1.2, -1.0));
            if let Some((one, two)) = alhazen_twice(source, receiver, (first, a), (second, b)) {
                let bounces =
                    [(first, a, source, one.point, two.point), (second, b, one.point, two.point, receiver)];
                for (circle, radius, before, here, after) in bounces {
                    let normal = (here - circle) / radius;
                    let skew = cross(normal, (before - here).normalize()) + cross(normal, (after - here).normalize());
                    prop_assert!(skew.abs() < 1e-9, "{skew}");
                }
            }
        }
    }
}
