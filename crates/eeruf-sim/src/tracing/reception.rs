//! Reception at a moving receiver. Sound is emitted at one place and moment, and meets the receiver at a later place: a
//! quadratic equation for each image.

use crate::geometry::{Point, Vector};

/// Time and path length at which sound meets a moving receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reception {
    /// Time since the emission, in seconds.
    pub time_s: f64,
    /// Length of the path that the sound really took, in metres.
    pub length_m: f64,
}

/// Solves `|receiver + velocity t - image| = c t` for the first `t >= 0`.
///
/// `image` is the source mirrored in the path's walls, `receiver` the position at emission, `velocity` in m/s and
/// `speed_of_sound` in m/s. `None` if the receiver outruns the sound. The path's walls are found for the position at
/// emission: at 1 m/s a receiver moves a few millimetres while the sound is on its way.
///
/// ```
/// use eeruf_sim::{Point, Vector, reception};
/// // Towards a wall 3 m ahead at 1 m/s: the image is 6 m ahead.
/// let met = reception(Point::new(0.0, 6.0), Point::origin(), Vector::new(0.0, 1.0), 343.2).unwrap();
/// assert!((met.time_s - 0.017431725740848343).abs() < 1e-15);
/// ```
pub fn reception(image: Point, receiver: Point, velocity: Vector, speed_of_sound: f64) -> Option<Reception> {
    let from_image = receiver - image;
    solve(from_image.norm_squared(), from_image.dot(&velocity), velocity.norm_squared(), speed_of_sound)
}

/// Computes the reception from a path's length and direction of arrival instead of its image, in metres and radians.
///
/// For a path over a pole the image moves a little with the receiver. The error is of the order of the pole's radius
/// times the receiver's speed, divided by the speed of sound.
pub fn reception_along(length_m: f64, arrival_rad: f64, velocity: Vector, speed_of_sound: f64) -> Option<Reception> {
    reception_at(length_m, [arrival_rad, 0.0], velocity, speed_of_sound)
}

/// Computes the reception of a path that arrives at an azimuth and an elevation.
pub(crate) fn reception_at(
    length_m: f64,
    [azimuth_rad, elevation_rad]: [f64; 2],
    velocity: Vector,
    speed_of_sound: f64,
) -> Option<Reception> {
    let mut approach = velocity.x * libm::cos(azimuth_rad) + velocity.y * libm::sin(azimuth_rad);
    if elevation_rad != 0.0 {
        approach *= libm::cos(elevation_rad);
    }
    solve(length_m * length_m, -length_m * approach, velocity.norm_squared(), speed_of_sound)
}

/// Solves `(c^2 - v^2) t^2 - 2 (d . v) t - d^2 = 0`, with `d` the vector from the image to the receiver.
fn solve(d2: f64, d_v: f64, v2: f64, c: f64) -> Option<Reception> {
    let a = c * c - v2;
    // A subsonic receiver is always reached; the comparison is written so that a NaN gives none.
    if !(a > 0.0 && d2.is_finite() && d_v.is_finite()) {
        return None;
    }
    let root = (d_v * d_v + a * d2).sqrt();
    // Of two equal forms use the one without cancellation.
    let time_s = if d_v >= 0.0 { (d_v + root) / a } else { d2 / (root - d_v) };
    Some(Reception { time_s, length_m: c * time_s })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_receiver_faster_than_sound_is_not_reached() {
        assert_eq!(reception(Point::origin(), Point::new(1.0, 0.0), Vector::new(400.0, 0.0), 343.2), None);
        assert_eq!(reception(Point::origin(), Point::new(f64::NAN, 0.0), Vector::zeros(), 343.2), None);
    }

    proptest! {
        #[test]
        fn the_receiver_is_where_the_sound_is(
            x in -9.0..9.0f64,
            y in -9.0..9.0f64,
            vx in -30.0..30.0f64,
            vy in -30.0..30.0f64,
        ) {
            let (receiver, velocity) = (Point::new(x, y), Vector::new(vx, vy));
            let met = reception(Point::origin(), receiver, velocity, 343.2).unwrap();
            let there = receiver + velocity * met.time_s;
            prop_assert!((there.coords.norm() - met.length_m).abs() < 1e-12);
            let along = reception_along(receiver.coords.norm(), libm::atan2(-y, -x), velocity, 343.2).unwrap();
            prop_assert!((along.time_s - met.time_s).abs() < 1e-14);
        }
    }
}
