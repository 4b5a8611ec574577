//! Decrease of the amplitude along a path over poles, by geometric optics.

use crate::geometry::Specular;

/// Returns the spreading along a path over poles, by geometric optics.
///
/// With `s'` the distance to a pole of radius `a`, `i` the angle of incidence and `s` the distance after it,
///
/// ```text
/// 1 / rho = 1 / R + 2 / (a cos i),    A^2 = 1 / (s' L) * product of rho / (rho + s)
/// ```
///
/// where `R` is the wavefront's radius in the plane on arrival (`s'` at the first pole, the last `rho + s` after it).
/// For one pole this is `(1 / s') sqrt(rho s' / ((rho + s)(s' + s)))`.
pub(crate) fn pole_spread(hits: &[(Specular, f64)]) -> f64 {
    let mut length = 0.0;
    let mut wavefront_m = 0.0;
    let mut gain = 1.0;
    for (index, (hit, radius)) in hits.iter().enumerate() {
        length += hit.before_m;
        if index == 0 {
            wavefront_m = hit.before_m;
        }
        let on = hit.after_m;
        let rho = 1.0 / (1.0 / wavefront_m + 2.0 / (radius * libm::cos(hit.incidence_rad)));
        gain *= rho / (rho + on);
        wavefront_m = rho + on;
    }
    let Some(first) = hits.first() else {
        return 0.0;
    };
    length += hits.last().map_or(0.0, |(hit, _)| hit.after_m);
    (gain / (first.0.before_m * length)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, alhazen};

    // A pole of 8 mm is 24 dB below a wall at 1 m.
    #[test]
    fn pole_of_8_mm_is_24_db_below_a_wall_at_1_m() {
        let here = Point::origin();
        let hit = alhazen(here, here, Point::new(1.004, 0.0), 0.004).unwrap();
        let wall = 1.0 / 2.0;
        let ratio_db = 20.0 * libm::log10(pole_spread(&[(hit, 0.004)]) / wall);
        assert!((ratio_db + 24.0).abs() < 0.01, "{ratio_db}");
    }
}
