//! Fresnel's integrals.

use core::f64::consts::{FRAC_PI_2, PI};

/// From here on the asymptotic series are used; below, the power series.
const FAR: f64 = 3.0;
/// Number of terms of each power series: the last is below 1e-10 at [`FAR`].
const NEAR_TERMS: usize = 27;
/// Number of terms of each asymptotic series, the most that help at [`FAR`].
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

/// Evaluates a polynomial by Horner's rule.
fn polynomial(terms: &[f64], at: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, term| sum * at + term)
}

/// Returns Fresnel's integrals `C` and `S` from 0 to `x`, for `x >= 0`, which may be infinite:
///
/// ```text
/// C(x) + i S(x) = integral of exp(i pi t^2 / 2) from 0 to x
/// ```
///
/// Up to `FAR`, with `z = pi x^2 / 2`, by their power series in `z` (DLMF 7.6.4 and 7.6.6); beyond it by `f` and `g`
/// (DLMF 7.5.3 and 7.5.4) and their asymptotic series in `1 / (2 z)` (DLMF 7.12.2 and 7.12.3). The error is below 2e-7.
pub fn fresnel(x: f64) -> [f64; 2] {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates by Simpson's rule in steps of 1e-4.
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
        // The points include both sides of the border between the series.
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
}
