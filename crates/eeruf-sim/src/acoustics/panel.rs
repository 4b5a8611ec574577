//! What a panel returns that is narrower than its first Fresnel zone: Fresnel's integral over its width.

use core::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use crate::geometry::{Point, Vector};
use crate::scene::{Bounce, Scene, Side};

/// The width of the first Fresnel zone in units of Fresnel's integral. A panel that is half as wide again counts as a
/// wall; between the two its share goes over to a wall's (a choice).
const ZONE: f64 = 2.0 * SQRT_2;

/// Fresnel's integrals `C(x)` and `S(x)`, of `cos(pi t^2 / 2)` and `sin(pi t^2 / 2)` from 0 to `x`, to 1e-8.
///
/// By their power series up to 3.6, beyond by the asymptotic series of their auxiliary functions `f` and `g`.
fn fresnel(x: f64) -> [f64; 2] {
    let a = x.abs();
    let [c, s] = if a < 3.6 {
        // term = (pi / 2)^n x^(2n + 1) / n!
        let (mut c, mut s, mut term) = (0.0, 0.0, a);
        for n in 0..90 {
            let part = term / f64::from(2 * n + 1);
            match n % 4 {
                0 => c += part,
                1 => s += part,
                2 => c -= part,
                _ => s -= part,
            }
            term *= FRAC_PI_2 * a * a / f64::from(n + 1);
        }
        [c, s]
    } else {
        let z = 1.0 / (PI * a * a);
        let (mut f, mut g, mut term) = (0.0, 0.0, 1.0);
        for n in 0..10 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            f += sign * term;
            term *= f64::from(4 * n + 1) * z;
            g += sign * term;
            term *= f64::from(4 * n + 3) * z;
        }
        let (f, g) = (f / (PI * a), g / (PI * a));
        let (sin, cos) = libm::sincos(FRAC_PI_2 * a * a);
        [0.5 + f * sin - g * cos, 0.5 - f * cos - g * sin]
    };
    [c.copysign(x), s.copysign(x)]
}

/// What a strip returns of what a wall in its plane would, in pressure, by Kirchhoff's approximation:
///
/// ```text
/// |F(to) - F(from)| / sqrt(2),    F(u) = C(u) + i S(u)
/// ```
///
/// Its ends are measured from the specular point in the plane, in units of Fresnel's integral: at a distance `s` along
/// the strip, `u = s cos(th) sqrt(2 (d1 + d2) / (lambda d1 d2))`, where sound arrives at `th` and goes `d1` before and
/// `d2` after the bounce. The specular point may lie beside the strip.
///
/// ```
/// // A centimetre seen straight ahead from a metre away, at 49.4 kHz.
/// let u = 0.01 / (343.2f64 / 49_400.0).sqrt();
/// assert!((20.0 * eeruf_sim::strip_reflection(-u, u).log10() + 15.4).abs() < 0.1);
/// assert!((eeruf_sim::strip_reflection(-1e9, 1e9) - 1.0).abs() < 1e-9);
/// ```
pub fn strip_reflection(from: f64, to: f64) -> f64 {
    let ([c1, s1], [c2, s2]) = (fresnel(from), fresnel(to));
    libm::hypot(c2 - c1, s2 - s1) / SQRT_2
}

/// A bounce at a flat surface.
struct Incidence {
    at: Point,
    /// Along the surface.
    along: Vector,
    cos: f64,
    before_m: f64,
    after_m: f64,
}

impl Incidence {
    /// What a panel with these ends returns there of what a wall would, at most 1.
    fn share(&self, ends: [Point; 2], wavelength_m: f64) -> f64 {
        let &Self { at, along, cos, before_m, after_m } = self;
        let scale = cos * (2.0 * (before_m + after_m) / (wavelength_m * before_m * after_m)).sqrt();
        let [from, to] = ends.map(|end| (end - at).dot(&along) * scale);
        let narrow = ((1.5 * ZONE - (to - from).abs()) / (0.5 * ZONE)).clamp(0.0, 1.0);
        if narrow == 0.0 {
            return 1.0;
        }
        1.0 - narrow * (1.0 - strip_reflection(from, to).min(1.0))
    }
}

/// What narrow panels leave of the amplitude of a path with these corners, ends included.
///
/// Walls are mirrors, so the ways before and after a bounce are counted along the path, up to its ends or to a pole,
/// which makes the sound spread anew.
pub(crate) fn panels_share(scene: &Scene, corners: &[Point], bounces: &[Bounce], wavelength_m: f64) -> f64 {
    let leg = |corner: usize| (corners[corner + 1] - corners[corner]).norm();
    let is_wall = |corner: usize| matches!(bounces.get(corner.wrapping_sub(1)), Some(Bounce::Wall(_)));
    let mut share = 1.0;
    for (bounce, corner) in bounces.iter().zip(1..) {
        let Bounce::Wall(wall) = *bounce else { continue };
        let mirror = &scene.mirrors[wall as usize];
        let left = mirror.distance(corners[corner - 1]) > 0.0;
        let Some(ends) = scene.panels.of(Side { wall, left }) else { continue };
        let first = (0..corner).rev().find(|&corner| !is_wall(corner)).unwrap_or(0);
        let last = (corner + 1..corners.len()).find(|&corner| !is_wall(corner)).unwrap_or(corners.len() - 1);
        let way = corners[corner] - corners[corner - 1];
        let wall = &scene.walls()[wall as usize];
        let incidence = Incidence {
            at: corners[corner],
            along: (wall.to - wall.from) / wall.length_m(),
            cos: mirror.cos_incidence(way / way.norm()),
            before_m: (first..corner).map(leg).sum(),
            after_m: (corner..last).map(leg).sum(),
        };
        share *= incidence.share(ends, wavelength_m);
    }
    share
}

/// The most that sound around an edge can have of what a wall would return to the receiver: what the panels do together
/// whose end the edge is, if source and receiver look at them from the same side. None where they are no panels, or
/// where the sound passes by them.
pub(crate) fn panels_around(
    scene: &Scene,
    edge: usize,
    source: Point,
    receiver: Point,
    wavelength_m: f64,
) -> Option<f64> {
    let mut most = None;
    for side in scene.panels.sides(edge)? {
        let mirror = &scene.mirrors[side.wall as usize];
        let sign = if side.left { 1.0 } else { -1.0 };
        let [here, there] = [source, receiver].map(|at| sign * mirror.distance(at));
        if here <= 0.0 || there <= 0.0 {
            continue;
        }
        let ends = scene.panels.of(side)?;
        let wall = &scene.walls()[side.wall as usize];
        let way = mirror.image(receiver, sign * there) - source;
        let part = here / (here + there);
        let incidence = Incidence {
            at: source + way * part,
            along: (wall.to - wall.from) / wall.length_m(),
            cos: (here + there) / way.norm(),
            before_m: way.norm() * part,
            after_m: way.norm() * (1.0 - part),
        };
        *most.get_or_insert(0.0) += incidence.share(ends, wavelength_m);
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnels_integrals_are_those_of_tables_and_smooth_where_the_series_change() {
        // Abramowitz and Stegun, Table 7.7.
        for (x, c, s) in [
            (0.5, 0.492_344_2, 0.064_732_4),
            (1.0, 0.779_893_4, 0.438_259_1),
            (2.0, 0.488_253_4, 0.343_415_7),
            (5.0, 0.563_631_2, 0.499_191_4),
        ] {
            let [found_c, found_s] = fresnel(x);
            assert!((found_c - c).abs() < 1e-7 && (found_s - s).abs() < 1e-7, "{x}: {found_c} {found_s}");
            assert_eq!(fresnel(-x), [-found_c, -found_s]);
        }
        let ([c1, s1], [c2, s2]) = (fresnel(3.6 - 1e-9), fresnel(3.6 + 1e-9));
        assert!((c1 - c2).abs() < 2e-8 && (s1 - s2).abs() < 2e-8, "{c1} {c2} {s1} {s2}");
    }
}
