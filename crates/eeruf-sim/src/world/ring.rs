//! Where the sensors of a ring stand.

use crate::geometry::{Pose, Vector};

/// Transducers evenly spread over an arc of a circle, facing outwards.
///
/// `pose` is the robot's; the first sensor stands `first_rad` from its heading, the next ones `spacing_rad` further
/// each.
///
/// ```
/// use eeruf_sim::{Pose, ring_of};
/// let ring: Vec<_> = ring_of(&Pose::identity(), 24, 0.3, 0.0, 15f64.to_radians()).collect();
/// assert!((ring[6].translation.y - 0.3).abs() < 1e-15);
/// ```
pub fn ring_of(
    pose: &Pose,
    sensors: usize,
    radius_m: f64,
    first_rad: f64,
    spacing_rad: f64,
) -> impl Iterator<Item = Pose> {
    let pose = *pose;
    (0..sensors).map(move |sensor| {
        let heading = first_rad + spacing_rad * sensor as f64;
        let place = Vector::new(radius_m * libm::cos(heading), radius_m * libm::sin(heading));
        pose * Pose::new(place, heading)
    })
}
