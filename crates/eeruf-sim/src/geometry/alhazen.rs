//! Alhazen's problem: the point of a circle at which sound from one point is reflected to another, with equal angles.
//! For two points outside the circle there is exactly one such point, unless the circle lies between them.

use super::plane::{Point, Vector, cross};

/// A specular reflection at the outside of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Point of the circle.
    pub point: Point,
    /// Angle of incidence and of reflection, in radians from the normal, 0 to pi/2.
    pub incidence_rad: f64,
    /// Distance from the source to the point, in metres.
    pub before_m: f64,
    /// Distance from the point to the receiver, in metres.
    pub after_m: f64,
}

/// Finds the specular point to the last digits; `None` if a point is inside the circle or the circle lies between them.
///
/// As the point moves from the source's direction towards the receiver's, the angle of incidence seen from the source
/// grows and the one seen from the receiver falls, so their difference has one root. Newton's method finds it from
/// `start`, with rotations of the normal in place of angles; bisection takes over where a step would leave the bracket.
///
/// ```
/// use eeruf_sim::{Point, alhazen};
/// let here = Point::origin();
/// let echo = alhazen(here, here, Point::new(2.0, 0.0), 0.004).unwrap();
/// assert!((echo.before_m + echo.after_m - 3.992).abs() < 1e-15);
/// ```
pub fn alhazen(source: Point, receiver: Point, centre: Point, radius_m: f64) -> Option<Specular> {
    specular(source, receiver, centre, balance(source, receiver, (centre, radius_m))?)
}

/// Returns the reflection at the point of a circle with this normal; `None` if the circle lies in between.
fn specular(source: Point, receiver: Point, centre: Point, normal: Normal) -> Option<Specular> {
    let point = centre + normal.unit * normal.radius_m;
    let (back, on) = (source - point, receiver - point);
    // With the circle in between, the angles balance on its far side.
    let (up, down) = (normal.unit.dot(&back), normal.unit.dot(&on));
    (up > 0.0 && down > 0.0).then(|| Specular {
        point,
        incidence_rad: libm::atan2(cross(normal.unit, back).abs(), up),
        before_m: back.norm(),
        after_m: on.norm(),
    })
}

/// The direction of length 1 from a circle's centre to a point on it, and the circle's radius.
#[derive(Clone, Copy)]
struct Normal {
    unit: Vector,
    radius_m: f64,
}

/// Returns the point of the circle with equal angles, visible or not; `None` unless both points are outside the circle.
fn balance(source: Point, receiver: Point, circle: (Point, f64)) -> Option<Normal> {
    let (centre, radius_m) = circle;
    let (to_source, to_receiver) = (source - centre, receiver - centre);
    let (far_s, far_r) = (to_source.norm(), to_receiver.norm());
    // The comparison is written so that a NaN gives none.
    if !(far_s > radius_m && far_r > radius_m && radius_m > 0.0) {
        return None;
    }
    // Turn the frame so that the source lies ahead and the receiver to the left.
    let ahead = to_source / far_s;
    let left = if cross(ahead, to_receiver) < 0.0 { -perpendicular(ahead) } else { perpendicular(ahead) };
    let receiver = Vector::new(ahead.dot(&to_receiver), left.dot(&to_receiver).max(0.0));
    let problem = Problem { source: far_s, receiver, far_r, radius: radius_m };
    let found = problem.solve();
    // Normalising removes the rounding of the rotations.
    Some(Normal { unit: (ahead * found.x + left * found.y).normalize(), radius_m })
}

fn perpendicular(vector: Vector) -> Vector {
    Vector::new(-vector.y, vector.x)
}

/// A circle about the origin, a source on the positive x axis and a receiver that is not below that axis.
struct Problem {
    source: f64,
    receiver: Vector,
    far_r: f64,
    radius: f64,
}

/// Difference of the two angles, in radians, at which Newton's method stops: the remaining error is of the order of its
/// square.
const LAST: f64 = 1e-9;

impl Problem {
    fn solve(&self) -> Vector {
        let (mut low, mut high) = (Vector::new(1.0, 0.0), self.receiver / self.far_r);
        let mut normal = start(Vector::new(self.source, 0.0), self.receiver, self.radius);
        for _ in 0..100 {
            let along_s = self.source * normal.x - self.radius;
            let across_s = self.source * normal.y;
            let along_r = self.receiver.dot(&normal) - self.radius;
            let across_r = cross(normal, self.receiver);
            // Sine and cosine of the excess of the angle seen from the source over the other, times the same factor.
            let (sin, cos) = (across_s * along_r - along_s * across_r, along_s * along_r + across_s * across_r);
            if sin > 0.0 {
                high = normal;
            } else {
                low = normal;
            }
            let square_s = along_s * along_s + across_s * across_s;
            let square_r = along_r * along_r + across_r * across_r;
            let slope = self.source * (self.source - self.radius * normal.x) / square_s
                + (self.far_r * self.far_r - self.radius * (along_r + self.radius)) / square_r;
            let tangent = sin / cos;
            let step = arc_tangent(tangent) / slope;
            let next = rotated(normal, -step);
            if cos > 0.0 && Self::holds(low, high, next) {
                normal = next;
                if tangent.abs() <= LAST {
                    break;
                }
            } else {
                let middle = low + high;
                let length = middle.norm();
                if cross(low, high).abs() <= LAST && length > 1.0 {
                    break;
                }
                normal = if length > LAST { middle / length } else { perpendicular(low) };
            }
        }
        normal
    }

    /// Returns true for a direction between the two, counter-clockwise by at most half a turn.
    fn holds(low: Vector, high: Vector, direction: Vector) -> bool {
        cross(low, direction) >= 0.0 && cross(direction, high) >= 0.0 && (low + high).dot(&direction) >= 0.0
    }
}

/// Turns a direction by a small angle, to the angle's third power, without changing its length.
fn rotated(direction: Vector, angle: f64) -> Vector {
    let half = 0.5 * angle;
    let scale = 1.0 / (1.0 + half * half);
    let (cos, sin) = ((1.0 - half * half) * scale, angle * scale);
    Vector::new(cos * direction.x - sin * direction.y, sin * direction.x + cos * direction.y)
}

/// Finds the two specular points of the path from source over one circle and then another to receiver.
///
/// Newton's method moves both points at once. If it does not converge, for example between circles that nearly touch,
/// each circle is solved in turn with the other point fixed: while all legs are visible, the length is strictly convex
/// in both points, and each solution is its minimum in one of them.
pub fn alhazen_twice(
    source: Point,
    receiver: Point,
    first: (Point, f64),
    second: (Point, f64),
) -> Option<(Specular, Specular)> {
    let aside = first.0 - second.0;
    let apart = aside.norm();
    let outside = |at: Point, circle: (Point, f64)| (at - circle.0).norm() > circle.1 && circle.1 > 0.0;
    // The comparison is written so that a NaN gives none.
    if !(apart > first.1 + second.1 && outside(source, first) && outside(receiver, second)) {
        return None;
    }
    let facing = [first.0 - aside * (first.1 / apart), second.0 + aside * (second.1 / apart)];
    let starts = [(source, facing[1], first), (facing[0], receiver, second)]
        .map(|(here, there, (centre, radius_m))| start(here - centre, there - centre, radius_m));
    let seen = |normals: [Normal; 2]| {
        let one = specular(source, second.0 + normals[1].unit * second.1, first.0, normals[0])?;
        Some((one, specular(one.point, receiver, second.0, normals[1])?))
    };
    let circles = [first, second];
    let found = both_at_once(source, receiver, circles, starts).and_then(seen);
    // Angles balance at hidden points too, and each of these methods may end there.
    found.or_else(|| one_after_the_other(source, receiver, circles, facing[1], apart).and_then(seen)).or_else(|| {
        let [two, one] = one_after_the_other(receiver, source, [second, first], facing[0], apart)?;
        seen([one, two])
    })
}

/// Returns the first normal to try for two points, given relative to a circle's centre: a direction between them,
/// closer to the point that is nearer to the circle. It is exact in the limits of a flat mirror and of a circle that is
/// small compared with both distances.
fn start(to_here: Vector, to_there: Vector, radius_m: f64) -> Vector {
    let (far_here, far_there) = (to_here.norm(), to_there.norm());
    let [near_here, near_there] = [far_here, far_there].map(|far| 1.0 - radius_m / far);
    let between = to_here * (near_there / far_here) + to_there * (near_here / far_there);
    let length = between.norm();
    // If the circle lies exactly between the points, there is no direction between them.
    if length > LAST * (near_here + near_there) { between / length } else { perpendicular(to_here / far_here) }
}

/// Applies Newton's method to both normals; `None` if it does not converge.
fn both_at_once(
    source: Point,
    receiver: Point,
    [first, second]: [(Point, f64); 2],
    [mut one, mut two]: [Vector; 2],
) -> Option<[Normal; 2]> {
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        let (on_first, on_second) = (first.0 + one * first.1, second.0 + two * second.1);
        let (back, across, on) = (source - on_first, on_second - on_first, receiver - on_second);
        let (at_first, at_second) = (Balance::of(one, back, across), Balance::of(two, -across, on));
        let between = 1.0 / across.norm_squared();
        let own = [at_first.slope(back, across, first.1), at_second.slope(-across, on, second.1)];
        let cross_terms = [second.1 * two.dot(&across) * between, -first.1 * one.dot(&across) * between];
        let determinant = own[0] * own[1] - cross_terms[0] * cross_terms[1];
        let [g, h] = [at_first.excess()?, at_second.excess()?];
        let left = g.abs().max(h.abs());
        if left > last {
            return None;
        }
        one = rotated(one, (cross_terms[0] * h - own[1] * g) / determinant);
        two = rotated(two, (cross_terms[1] * g - own[0] * h) / determinant);
        if left <= LAST {
            let normal = |unit: Vector, radius_m| Normal { unit: unit.normalize(), radius_m };
            return Some([normal(one, first.1), normal(two, second.1)]);
        }
        last = left;
    }
    None
}

/// Components of both legs at a point of a circle, along its normal and across.
struct Balance {
    along: [f64; 2],
    across: [f64; 2],
}

impl Balance {
    fn of(normal: Vector, back: Vector, on: Vector) -> Self {
        Self { along: [normal.dot(&back), normal.dot(&on)], across: [cross(normal, back), cross(normal, on)] }
    }

    /// Returns the angle of one leg minus that of the other, 0 in balance; `None` if it is not small.
    fn excess(&self) -> Option<f64> {
        let sin = self.across[0] * self.along[1] + self.along[0] * self.across[1];
        let cos = self.along[0] * self.along[1] - self.across[0] * self.across[1];
        (cos > 0.0).then(|| arc_tangent(sin / cos))
    }

    /// Returns the derivative of [`excess`](Self::excess) by the angle of the normal.
    fn slope(&self, back: Vector, on: Vector, radius_m: f64) -> f64 {
        -2.0 - radius_m * (self.along[0] / back.norm_squared() + self.along[1] / on.norm_squared())
    }
}

/// Returns the arc tangent of a small number, to its sixth power.
fn arc_tangent(tangent: f64) -> f64 {
    let square = tangent * tangent;
    tangent * (15.0 + 4.0 * square) / (15.0 + 9.0 * square)
}

fn one_after_the_other(
    source: Point,
    receiver: Point,
    [first, second]: [(Point, f64); 2],
    mut on_second: Point,
    apart: f64,
) -> Option<[Normal; 2]> {
    let mut last_step = f64::INFINITY;
    for _ in 0..200 {
        // A point may be hidden in an intermediate step; only the answer must be visible.
        let one = balance(source, on_second, first)?;
        let two = balance(first.0 + one.unit * first.1, receiver, second)?;
        let next = second.0 + two.unit * second.1;
        let step = (next - on_second).norm();
        on_second = next;
        // Steps shrink until rounding stops them.
        if step == 0.0 || (step < 1e-12 * apart && step >= last_step) {
            return Some([one, two]);
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

    // Solved from one end, the points of these circles, 9 mm apart, are hidden.
    #[test]
    fn a_path_over_two_poles_goes_both_ways() {
        let (here, there) = (Point::new(-0.3119098673, 0.5597605183), Point::new(1.0186739892, 1.2544367654));
        let small = (Point::new(1.0248976353, -0.7581263519), 0.0078686882);
        let large = (Point::new(1.0426045299, -0.8440570767), 0.0706651552);
        let (one, two) = alhazen_twice(here, there, large, small).unwrap();
        let (back_two, back_one) = alhazen_twice(there, here, small, large).unwrap();
        assert!((one.point - back_one.point).norm() < 1e-12 && (two.point - back_two.point).norm() < 1e-12);
    }

    // Newton's method agrees with one circle after the other, even if circles nearly touch or a point is close to one.
    #[test]
    fn both_ways_to_two_poles_agree() {
        let mut random = crate::world::Random::new(1);
        let (mut settled, mut worst) = (0, 0.0_f64);
        for _ in 0..20_000 {
            let mut point = || Point::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0));
            let [source, receiver, first, second] = [point(), point(), point(), point()];
            let circles = [first, second].map(|at| (at, libm::exp10(random.between(-3.0, 0.3))));
            let apart = (first - second).norm();
            if apart <= circles[0].1 + circles[1].1 {
                continue;
            }
            let facing = second + (first - second) * (circles[1].1 / apart);
            let slow = one_after_the_other(source, receiver, circles, facing, apart);
            let seen = slow.and_then(|[one, two]| {
                let one = specular(source, second + two.unit * circles[1].1, first, one)?;
                specular(one.point, receiver, second, two).map(|two| one.before_m + two.before_m + two.after_m)
            });
            let found = alhazen_twice(source, receiver, circles[0], circles[1]);
            let length_m = found.map(|(one, two)| one.before_m + two.before_m + two.after_m);
            assert_eq!(length_m.is_some(), seen.is_some(), "{source} {receiver} {circles:?}");
            if let (Some(length_m), Some(seen)) = (length_m, seen) {
                (settled, worst) = (settled + 1, worst.max((length_m - seen).abs()));
            }
        }
        assert!(settled > 15_000 && worst < 1e-13, "{settled} {worst}");
    }

    /// Returns the normal with equal angles by bisection of the angle between the directions to both points.
    fn bisected(source: Point, receiver: Point, centre: Point, radius_m: f64) -> Vector {
        let [to_source, to_receiver] = [source - centre, receiver - centre];
        let side = if cross(to_source, to_receiver) < 0.0 { -1.0 } else { 1.0 };
        let (mut low, mut high) = (0.0, libm::atan2(cross(to_source, to_receiver).abs(), to_source.dot(&to_receiver)));
        let normal = |turn: f64| {
            let (sin, cos) = libm::sincos(side * turn);
            let ahead = to_source.normalize();
            Vector::new(cos * ahead.x - sin * ahead.y, sin * ahead.x + cos * ahead.y)
        };
        while high - low > 1e-16 {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let ahead = normal(middle);
            let at = centre + ahead * radius_m;
            let off = |end: Point| libm::atan2(cross(ahead, end - at).abs(), ahead.dot(&(end - at)));
            *(if off(source) > off(receiver) { &mut high } else { &mut low }) = middle;
        }
        normal(0.5 * (low + high))
    }

    /// Draws a point at this distance outside a circle.
    fn outside(random: &mut crate::world::Random, centre: Point, radius_m: f64, gap_m: f64) -> Point {
        let (sin, cos) = libm::sincos(random.between(-4.0, 4.0));
        centre + Vector::new(cos, sin) * (radius_m + gap_m)
    }

    // Radii are those of wires to walls, distances 1 um to 100 m, and some points lie in nearly one direction.
    #[test]
    fn specular_point_is_the_bisected_one() {
        let mut random = crate::world::Random::new(2);
        let (mut seen, mut worst) = (0, 0.0_f64);
        for number in 0..20_000 {
            let centre = Point::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0));
            let mut wide = |low: f64, high: f64| libm::exp10(random.between(low, high));
            let [radius_m, near_m, far_m] = [wide(-4.0, 3.0), wide(-6.0, 2.0), wide(-6.0, 2.0)];
            let source = outside(&mut random, centre, radius_m, near_m);
            let receiver = match number % 4 {
                0 => centre + (source - centre) * ((radius_m + far_m) / (radius_m + near_m)),
                1 => source + Vector::new(1e-7, -2e-7),
                _ => outside(&mut random, centre, radius_m, far_m),
            };
            if (receiver - centre).norm() <= radius_m {
                continue;
            }
            let expected = bisected(source, receiver, centre, radius_m);
            let at = centre + expected * radius_m;
            let lit = |end: Point| expected.dot(&(end - at).normalize());
            // Rounding decides on the limit of the shadow.
            if lit(source).abs() < 1e-5 || lit(receiver).abs() < 1e-5 {
                continue;
            }
            let found = alhazen(source, receiver, centre, radius_m);
            assert_eq!(found.is_some(), lit(source) > 0.0 && lit(receiver) > 0.0, "{source} {receiver} {radius_m}");
            if let Some(found) = found {
                (seen, worst) = (seen + 1, worst.max((found.point - at).norm()));
            }
        }
        assert!(seen > 10_000 && worst < 1e-9, "{seen} {worst:e}");
    }

    /// Finds the path's length by trying all points of the second circle, with the first solved by bisection.
    fn tried(source: Point, receiver: Point, circles: [(Point, f64); 2]) -> Option<f64> {
        let [first, second] = circles;
        // Deviation of the angles at the second point from balance, if all legs are visible, and the length.
        let try_at = |turn: f64| {
            let two = Vector::new(libm::cos(turn), libm::sin(turn));
            let on_second = second.0 + two * second.1;
            let one = bisected(source, on_second, first.0, first.1);
            let on_first = first.0 + one * first.1;
            let legs = [source - on_first, on_second - on_first, receiver - on_second];
            let lit = one.dot(&legs[0]) > 0.0
                && one.dot(&legs[1]) > 0.0
                && two.dot(&legs[1]) < 0.0
                && two.dot(&legs[2]) > 0.0;
            let excess = cross(two, -legs[1].normalize()) + cross(two, legs[2].normalize());
            lit.then(|| (excess, legs.map(|leg| leg.norm()).iter().sum::<f64>()))
        };
        const STEPS: i32 = 300;
        let turns = (0..=STEPS).map(|k| core::f64::consts::TAU * f64::from(k) / f64::from(STEPS));
        let tries: Vec<_> = turns.map(|turn| (turn, try_at(turn))).collect();
        tries.windows(2).find_map(|pair| {
            let [(mut low, before), (mut high, after)] = [pair[0], pair[1]];
            let (before, after) = (before?.0, after?.0);
            if before * after > 0.0 {
                return None;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *(if try_at(middle)?.0 * before > 0.0 { &mut low } else { &mut high }) = middle;
            }
            try_at(0.5 * (low + high)).map(|found| found.1)
        })
    }

    #[test]
    fn path_over_two_poles_is_found_by_trying_all() {
        let mut random = crate::world::Random::new(3);
        let (mut seen, mut worst) = (0, 0.0_f64);
        for number in 0..300 {
            let first = Point::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0));
            let mut wide = |low: f64, high: f64| libm::exp10(random.between(low, high));
            let (radii, gap_m) = ([wide(-3.0, 0.5), wide(-3.0, 0.5)], wide(-5.0, 0.7));
            let near_m = [wide(-5.0, 0.7), wide(-5.0, 0.7)];
            let second = outside(&mut random, first, radii[0] + radii[1], gap_m);
            let circles = [(first, radii[0]), (second, radii[1])];
            let ends = [0, 1].map(|end| outside(&mut random, circles[end].0, circles[end].1, near_m[end]));
            let found = alhazen_twice(ends[0], ends[1], circles[0], circles[1]);
            let length_m = found.map(|(one, two)| one.before_m + two.before_m + two.after_m);
            if let Some(expected) = tried(ends[0], ends[1], circles) {
                let length_m = length_m.unwrap_or(f64::INFINITY);
                (seen, worst) = (seen + 1, worst.max((length_m - expected).abs()));
                assert!((length_m - expected).abs() < 1e-9, "{number}: {length_m} {expected} {ends:?} {circles:?}");
            }
        }
        assert!(seen > 60, "{seen} {worst:e}");
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
