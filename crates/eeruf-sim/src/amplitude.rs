//! What is left of the amplitude along one path, relative to 1 m on the transducer's axis:
//!
//! ```text
//! A = D(departure) D(arrival) * product of R_i * 10^(-alpha L / 20) / L
//! ```
//!
//! The patterns `D` belong to transducers and are applied in [`crosstalk`](crate::crosstalk); a pole replaces `1 / L` by the
//! spreading that its curvature causes.

use crate::{alhazen::Specular, paths::Bounce, plane::Vector, scene::Scene};

/// The product of all surfaces' reflections, roughness included.
///
/// Walls are followed from the receiver back to a pole (or the source), then from the source on to the pole, because a
/// surface's roughness counts by its own angle of incidence.
pub(crate) fn reflected(
    scene: &Scene,
    bounces: &[Bounce],
    [departure, arrival]: [f64; 2],
    pole_cos: [f64; 2],
    wave_number: f64,
) -> f64 {
    if !scene.rough {
        return bounces.iter().map(|bounce| surface(scene, *bounce).reflection).product();
    }
    let unit = |angle: f64| Vector::new(angle.cos(), angle.sin());
    let mut product = 1.0;
    let mut follow = |mut direction: Vector, wall: u32| {
        let mirror = &scene.mirrors[wall as usize];
        let material = scene.walls()[wall as usize].material;
        product *= material.amplitude(wave_number, mirror.cos_incidence(direction));
        direction = mirror.turned(direction);
        direction
    };
    let mut direction = unit(arrival);
    let mut back = bounces.iter().rev();
    for bounce in back.by_ref() {
        match *bounce {
            Bounce::Wall(wall) => direction = follow(direction, wall),
            Bounce::Pole(_) => break,
        }
    }
    direction = unit(departure);
    for bounce in bounces.iter().take(back.len()) {
        match *bounce {
            Bounce::Wall(wall) => direction = follow(direction, wall),
            Bounce::Pole(_) => break,
        }
    }
    let poles = bounces.iter().filter(|bounce| matches!(bounce, Bounce::Pole(_)));
    poles
        .zip(pole_cos)
        .fold(product, |product, (pole, cos)| product * surface(scene, *pole).amplitude(wave_number, cos))
}

fn surface(scene: &Scene, bounce: Bounce) -> &crate::material::Material {
    match bounce {
        Bounce::Wall(wall) => &scene.walls()[wall as usize].material,
        Bounce::Pole(pole) => &scene.poles()[pole as usize].material,
    }
}

/// Spreading along a path over poles, by geometric optics.
///
/// With `s'` the way to a pole of radius `a`, `i` the angle of incidence and `s` the way on,
///
/// ```text
/// 1 / rho = 1 / R + 2 / (a cos i),    A^2 = 1 / (s' L) * product of rho / (rho + s)
/// ```
///
/// where `R` is the wavefront's radius in the plane on arrival (`s'` at the first pole, the last `rho + s` after it). For one
/// pole this is `(1 / s') sqrt(rho s' / ((rho + s)(s' + s)))`.
pub(crate) fn pole_spread(hits: &[(Specular, f64)]) -> f64 {
    let mut length = 0.0;
    let mut front = 0.0;
    let mut kept = 1.0;
    for (index, (hit, radius)) in hits.iter().enumerate() {
        length += hit.before_m;
        if index == 0 {
            front = hit.before_m;
        }
        let on = hit.after_m;
        let rho = 1.0 / (1.0 / front + 2.0 / (radius * hit.incidence_rad.cos()));
        kept *= rho / (rho + on);
        front = rho + on;
    }
    let Some(first) = hits.first() else {
        return 0.0;
    };
    length += hits.last().map_or(0.0, |(hit, _)| hit.after_m);
    (kept / (first.0.before_m * length)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Point, alhazen::alhazen};

    #[test]
    fn an_eight_millimetre_pole_is_24_decibel_below_a_wall_at_one_metre() {
        let here = Point::origin();
        let hit = alhazen(here, here, Point::new(1.004, 0.0), 0.004).unwrap();
        let wall = 1.0 / 2.0;
        let ratio_db = 20.0 * (pole_spread(&[(hit, 0.004)]) / wall).log10();
        assert!((ratio_db + 24.0).abs() < 0.01, "{ratio_db}");
    }
}
