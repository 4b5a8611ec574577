//! Reflection of a wall that is narrow compared with the first Fresnel zone, by Fresnel's integral over its width.

use core::f64::consts::FRAC_1_SQRT_2;

use eeruf_modules::fresnel;

/// Largest reflection of a part of a wall relative to the whole wall's, `sqrt(2) |F(1.209)|`, 2.6 dB; rounded up.
pub(crate) const LOUDEST_PANEL: f64 = 1.342_17;

/// Returns the share of an endless wall's reflection that a part between two edges returns. Each edge is given by the
/// detour over it, in wavelengths; infinite if the wall does not end there. `beside` is true if the point of reflection
/// does not lie between the edges.
///
/// ```text
/// |F(v2) -+ F(v1)| / sqrt(2),    v = 2 sqrt(detour / lambda),    F = C + i S
/// ```
///
/// The absolute error is that of [`fresnel`], below 2e-7.
pub(crate) fn panel_share(detours: [f64; 2], beside: bool) -> f64 {
    let [near, far] = detours.map(|detour| fresnel(2.0 * detour.max(0.0).sqrt()));
    let sign = if beside { -1.0 } else { 1.0 };
    libm::hypot(far[0] + sign * near[0], far[1] + sign * near[1]) * FRAC_1_SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;

    // A whole wall returns everything, half of it half, and a narrow one in proportion to its width.
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

    // No panel exceeds `LOUDEST_PANEL`; beside the point of reflection a panel returns at most half as much.
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
