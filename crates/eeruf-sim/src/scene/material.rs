//! The effect of a wall on the sound that it reflects: a pressure reflection coefficient and a surface roughness.

/// The surface of a wall or a pole.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Material {
    /// Share of the pressure amplitude that a perfectly flat piece returns, 0 to 1.
    pub reflection: f64,
    /// Root-mean-square height of the surface, in metres.
    pub roughness_m: f64,
}

impl Material {
    /// Plaster, glass, sheet metal: 0.95 (a choice; no source settles it).
    pub const SMOOTH: Self = Self::flat(0.95);
    /// A painted wall: 0.9 (a choice).
    pub const PAINTED: Self = Self::flat(0.9);
    /// Curtain or foam: at most 0.5 (a choice).
    pub const SOFT: Self = Self::flat(0.5);
    /// Perfect reflection, for checks against plain geometry.
    pub const PERFECT: Self = Self::flat(1.0);

    /// Makes a perfectly flat surface.
    pub const fn flat(reflection: f64) -> Self {
        Self { reflection, roughness_m: 0.0 }
    }

    /// Returns the amplitude of the coherent reflection at one bounce:
    ///
    /// ```text
    /// R exp(-2 (k sigma cos theta)^2)
    /// ```
    ///
    /// `wave_number` is `k = 2 pi f / c` in rad/m and `theta` the angle of incidence. Roughness scatters the remaining
    /// energy in all directions; it counts as lost.
    ///
    /// ```
    /// use eeruf_sim::Material;
    /// let k = std::f64::consts::TAU * 49_400.0 / 343.2;
    /// let rough = Material { reflection: 1.0, roughness_m: 0.5e-3 };
    /// assert!((rough.amplitude(k, 1.0) - 0.6643).abs() < 1e-4);
    /// ```
    pub fn amplitude(&self, wave_number: f64, cos_incidence: f64) -> f64 {
        if self.roughness_m == 0.0 {
            return self.reflection;
        }
        let phase = wave_number * self.roughness_m * cos_incidence;
        self.reflection * libm::exp(-2.0 * phase * phase)
    }

    /// Returns true if both numbers are in range.
    pub(crate) fn is_valid(&self) -> bool {
        (0.0..=1.0).contains(&self.reflection) && self.roughness_m >= 0.0 && self.roughness_m.is_finite()
    }
}

impl Default for Material {
    fn default() -> Self {
        Self::SMOOTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // A roughness of 0.1 mm hardly matters, and 1 mm nearly silences the reflection.
    #[test]
    fn roughness_of_one_millimetre_silences() {
        let k = core::f64::consts::TAU * 49_400.0 / 343.2;
        for (sigma, expected) in [(0.1e-3, 0.9838), (0.5e-3, 0.6643), (1e-3, 0.1948)] {
            let material = Material { reflection: 1.0, roughness_m: sigma };
            assert!((material.amplitude(k, 1.0) - expected).abs() < 5e-5, "{sigma}");
        }
    }
}
