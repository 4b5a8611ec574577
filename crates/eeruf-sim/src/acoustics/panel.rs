//! Reflection of a wall that is not wide against the first Fresnel zone: Fresnel's integral over its width.

use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI};

/// No part of a wall returns more than this of what a whole wall does, `sqrt(2) |F(1.209)|`, 2.6 dB; rounded upwards.
pub(crate) const LOUDEST_PANEL: f64 = 1.342_17;

/// From here on the asymptotic series are used, below it the power series.
const FAR: f64 = 3.0;
/// As many terms as each of the power series has; they end below 1e-10 at [`FAR`].
const NEAR_TERMS: usize = 27;
/// As many terms as each of the asymptotic series has, the most that are worth it at [`FAR`].
const FAR_TERMS: usize = 7;

/// `(-1)^n / ((2 n + k)! (4 n + 2 k + 1))`, the power series of `C` for `k = 0`, of `S` for `k = 1`.
const fn near_terms(k: usize) -> [f64; NEAR_TERMS] {
    let mut terms = [0.0; NEAR_TERMS];
    let (mut n, mut factorial, mut sign) = (0, 1.0, 1.0);
    while n < NEAR_TERMS {
        let m = 2 * n + k;
        terms[n] = sign / (factorial * (2 * m + 1) as f64);
        factorial *= (m + 1) as f64 * (m + 2) as f64;
        (n, sign) = (n + 1, -sign);
    }
    terms
}

/// `(-1)^n (4 n + 2 k - 1)!!`, the asymptotic series of `f` for `k = 0`, of `g` for `k = 1`.
const fn far_terms(k: usize) -> [f64; FAR_TERMS] {
    let mut terms = [0.0; FAR_TERMS];
    let (mut n, mut factorial, mut sign) = (0, 1.0, 1.0);
    while n < FAR_TERMS {
        let m = 2 * n + k;
        terms[n] = sign * factorial;
        factorial *= ((2 * m + 1) * (2 * m + 3)) as f64;
        (n, sign) = (n + 1, -sign);
    }
    terms
}

const NEAR: [[f64; NEAR_TERMS]; 2] = [near_terms(0), near_terms(1)];
const ASYMPTOTIC: [[f64; FAR_TERMS]; 2] = [far_terms(0), far_terms(1)];

/// Horner's rule.
fn polynomial(terms: &[f64], at: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| sum * at + term)
}

/// Fresnel's integrals `C` and `S` from 0 to `x`, which is no less than 0 and may be infinite:
///
/// ```text
/// C(x) + i S(x) = integral of exp(i pi t^2 / 2) from 0 to x
/// ```
///
/// With `z = pi x^2 / 2` by their power series in `z` (DLMF 7.6.4 and 7.6.6), or from [`FAR`] on by `f` and `g`
/// (DLMF 7.5.3 and 7.5.4) and their asymptotic series in `1 / (2 z)` (DLMF 7.12.2 and 7.12.3). The error is below 2e-7.
pub(crate) fn fresnel(x: f64) -> [f64; 2] {
    if x == f64::INFINITY {
        return [0.5, 0.5];
    }
    let z = FRAC_PI_2 * x * x;
    if x < FAR {
        return [x * polynomial(&NEAR[0], z * z), x * z * polynomial(&NEAR[1], z * z)];
    }
    let (small, (sin, cos)) = (0.5 / z, libm::sincos(z));
    let [f, g] = ASYMPTOTIC.map(|terms| polynomial(&terms, small * small) / (PI * x));
    let g = g * small;
    [0.5 + f * sin - g * cos, 0.5 - f * cos - g * sin]
}

/// Share of an endless wall's reflection that a part of it returns, which ends at two edges. Each is given by how much
/// longer the way by it is than the path, in wavelengths; infinite where the wall does not end. `beside` says that the
/// point of reflection does not lie between them.
///
/// ```text
/// |F(v2) -+ F(v1)| / sqrt(2),    v = 2 sqrt(detour / lambda),    F = C + i S
/// ```
///
/// The difference of two numbers that are nearly equal is no better than the error of [`fresnel`]: below 2e-7.
pub(crate) fn panel_share(detours: [f64; 2], beside: bool) -> f64 {
    let [near, far] = detours.map(|detour| fresnel(2.0 * detour.max(0.0).sqrt()));
    let sign = if beside { -1.0 } else { 1.0 };
    libm::hypot(far[0] + sign * near[0], far[1] + sign * near[1]) * FRAC_1_SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By Simpson's rule in steps of 1e-4.
    fn integrated(to: f64) -> [f64; 2] {
        let steps = 2 * (to * 5e3).ceil().max(1.0) as u32;
        let step = to / f64::from(steps);
        let mut sum = [0.0; 2];
        for k in 0..=steps {
            let weight = if k == 0 || k == steps { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
            let t = f64::from(k) * step;
            let (sin, cos) = libm::sincos(FRAC_PI_2 * t * t);
            sum[0] += weight * cos;
            sum[1] += weight * sin;
        }
        sum.map(|sum| sum * step / 3.0)
    }

    #[test]
    fn fresnels_integrals_are_what_quadrature_gives() {
        let mut worst: f64 = 0.0;
        // Both series where they meet, too.
        for x in (0..140).map(|k| 0.05 * f64::from(k)).chain([3.0 - 1e-12, 3.0 + 1e-12, 11.3]) {
            let (found, expected) = (fresnel(x), integrated(x));
            for k in 0..2 {
                worst = worst.max((found[k] - expected[k]).abs());
            }
        }
        assert!(worst < 2e-7, "{worst}");
        assert_eq!(fresnel(f64::INFINITY), [0.5; 2]);
        let far = fresnel(1e9);
        assert!((far[0] - 0.5).abs() < 1e-9 && (far[1] - 0.5).abs() < 1e-9, "{far:?}");
    }

    #[test]
    fn small_integrals_are_exact_to_the_last_digits() {
        for x in [1e-9, 1e-4, 0.01, 0.1] {
            let ([c, s], z) = (fresnel(x), FRAC_PI_2 * x * x);
            assert!((c / x - (1.0 - z * z / 10.0)).abs() < 1e-7, "{x}");
            assert!((s / (x * z) - (1.0 / 3.0 - z * z / 42.0)).abs() < 1e-7, "{x}");
        }
    }

    // A whole wall returns all half of one half and a narrow one as much as it is wide.
    #[test]
    fn panel_returns_a_share_of_a_whole_wall() {
        assert!((panel_share([f64::INFINITY; 2], false) - 1.0).abs() < 1e-15);
        assert!((panel_share([0.0, f64::INFINITY], false) - 0.5).abs() < 1e-15);
        assert!((panel_share([0.0, f64::INFINITY], true) - 0.5).abs() < 1e-15);
        assert!((panel_share([1e4; 2], false) - 1.0).abs() < 4e-3);
        for half in [1e-5, 1e-4, 1e-3] {
            let detour = half * half / 4.0;
            assert!((panel_share([detour; 2], false) / (2f64.sqrt() * half) - 1.0).abs() < 1e-6, "{half}");
        }
    }

    // The loudest panel is loudest and beside the reflection there is at most half as much.
    #[test]
    fn loudest_panel_is_loudest() {
        let (mut most, mut beside): (f64, f64) = (0.0, 0.0);
        for a in (0..600).map(|k| 0.02 * f64::from(k)) {
            for b in (0..600).map(|k| 0.02 * f64::from(k)) {
                let detours = [a * a / 4.0, b * b / 4.0];
                most = most.max(panel_share(detours, false));
                beside = beside.max(panel_share(detours, true));
            }
        }
        assert!(most <= LOUDEST_PANEL && most > LOUDEST_PANEL - 1e-3, "{most}");
        assert!(beside <= 0.5 * LOUDEST_PANEL && beside > 0.5 * LOUDEST_PANEL - 1e-3, "{beside}");
        let exact = (1000..1400).map(|k| 1e-3 * f64::from(k)).map(|half| half * half / 4.0);
        let exact = exact.map(|detour| panel_share([detour; 2], false)).fold(0.0, f64::max);
        assert!(exact <= LOUDEST_PANEL && exact > LOUDEST_PANEL - 1e-5, "{exact}");
    }
}
