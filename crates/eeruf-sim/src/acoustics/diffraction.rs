//! Waves at small and sharp objects: poles as rigid cylinders, and outward edges of two walls. They correct or complete
//! geometric optics; the course of a path remains the same.

use core::f64::consts::{PI, TAU};

/// Returns the far scattered pressure of a rigid cylinder, `|p_s / p_i| sqrt(r / a)`, for `ka`, the wave number times
/// the radius, and the scattering angle `phi_rad`; pi is back towards the source.
///
/// ```text
/// sqrt(2 / (pi k a)) | sum e_n J_n'(ka) / H_n'(ka) cos(n phi) |,    e_0 = 1, e_n = 2
/// ```
///
/// ```
/// let form = eeruf_sim::rigid_cylinder_form(3.619, std::f64::consts::PI);
/// assert!((form - 0.6715548430307726).abs() < 1e-6);
/// ```
pub fn rigid_cylinder_form(ka: f64, phi_rad: f64) -> f64 {
    // Terms decay quickly once the order is above ka.
    let last = (ka + 12.0 * libm::cbrt(ka) + 12.0).min(100_000.0) as i32;
    let (mut real, mut imaginary) = (0.0, 0.0);
    for n in 0..=last {
        let (j, y) = if n == 0 {
            (-libm::j1(ka), -libm::y1(ka))
        } else {
            let half = |lower: f64, upper: f64| 0.5 * (lower - upper);
            (half(libm::jn(n - 1, ka), libm::jn(n + 1, ka)), half(libm::yn(n - 1, ka), libm::yn(n + 1, ka)))
        };
        let size = j * j + y * y;
        if !size.is_finite() {
            break;
        }
        // j / (j + i y)
        let weight = if n == 0 { 1.0 } else { 2.0 } * libm::cos(f64::from(n) * phi_rad);
        real += weight * j * j / size;
        imaginary -= weight * j * y / size;
    }
    (2.0 / (PI * ka)).sqrt() * libm::hypot(real, imaginary)
}

/// Returns a rigid cylinder's reflection relative to geometric optics, `sqrt(cos(i) / 2)`, at an incidence `i`.
///
/// ```
/// let eight_millimetres = eeruf_sim::pole_wave_correction(std::f64::consts::TAU * 49_400.0 / 343.2 * 0.004, 0.0);
/// assert!((eight_millimetres - 0.950).abs() < 1e-3);
/// ```
pub fn pole_wave_correction(ka: f64, incidence_rad: f64) -> f64 {
    rigid_cylinder_form(ka, PI - 2.0 * incidence_rad) / (0.5 * libm::cos(incidence_rad)).sqrt()
}

/// Returns Keller's diffraction coefficient of a rigid edge, in the square root of a metre.
///
/// `wave_number` is in rad/m. `outside_rad` is the open angle around the edge (3 pi / 2 at a right-angle corner seen
/// from outside). The two directions are measured from one of the walls. At distances `s'` and `s` the amplitude
/// relative to 1 m is the coefficient over `sqrt(s' s (s' + s))`. It grows without bound where a wall's own reflection
/// or shadow begins, where geometric optics fails too.
pub fn edge_diffraction(wave_number: f64, outside_rad: f64, from_rad: f64, to_rad: f64) -> f64 {
    let n = outside_rad / PI;
    let turn = libm::cos(PI / n);
    let term = |angle: f64| 1.0 / (turn - libm::cos(angle / n));
    libm::sin(PI / n) / (n * (TAU * wave_number).sqrt()) * (term(from_rad - to_rad) + term(from_rad + to_rad))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_edge_is_36_8_decibel_below_a_wall_at_one_metre() {
        let k = TAU * 49_400.0 / 343.2;
        let edge = edge_diffraction(k, 1.5 * PI, 0.75 * PI, 0.75 * PI).abs() / 2f64.sqrt();
        assert!((20.0 * libm::log10(edge / 0.5) + 36.8).abs() < 0.05);
    }

    #[test]
    fn a_thick_cylinder_returns_what_geometric_optics_says() {
        for incidence in [0.0, 0.3, 0.6] {
            assert!((pole_wave_correction(60.0, incidence) - 1.0).abs() < 0.01);
        }
    }

    #[test]
    fn form_values_of_the_corpus_at_one_and_three_point_six() {
        for (ka, expected) in [(3.619, 0.671_554_843_030_772_6), (1.0, 0.738_107_047_855_437_7)] {
            assert!((rigid_cylinder_form(ka, PI) / expected - 1.0).abs() < 1e-6);
        }
    }
}
