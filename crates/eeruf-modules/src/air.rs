//! The air: speed of sound and absorption (ISO 9613-1).

/// State of the air.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize, serde::Serialize), serde(default, deny_unknown_fields))]
pub struct Air {
    /// Temperature in degrees Celsius, -50 to 60.
    pub temperature_c: f64,
    /// Relative humidity in per cent, 0 to 100.
    pub humidity_percent: f64,
    /// Pressure in kilopascal, 20 to 200.
    pub pressure_kpa: f64,
}

impl Default for Air {
    /// The air of a room: 20 C, 50 %, 101.325 kPa.
    fn default() -> Self {
        Self { temperature_c: 20.0, humidity_percent: 50.0, pressure_kpa: 101.325 }
    }
}

impl Air {
    /// Makes the default air at another temperature.
    pub fn at(temperature_c: f64) -> Self {
        Self { temperature_c, ..Self::default() }
    }

    /// Returns the speed of sound in m/s:
    ///
    /// ```text
    /// c = 343.2 sqrt(T / 293.15 K)
    /// ```
    ///
    /// ```
    /// assert_eq!(eeruf_modules::Air::default().speed_of_sound(), 343.2);
    /// ```
    pub fn speed_of_sound(&self) -> f64 {
        343.2 * libm::sqrt((self.temperature_c + 273.15) / 293.15)
    }

    /// Returns the absorption in dB per metre at a frequency in Hz, ISO 9613-1 Eqs. (3) to (5) with the saturation
    /// pressure of its Annex B.
    ///
    /// ```
    /// let alpha = eeruf_modules::Air::default().absorption_db_per_m(49_400.0);
    /// assert!((alpha - 1.64140).abs() < 1e-5);
    /// ```
    pub fn absorption_db_per_m(&self, frequency_hz: f64) -> f64 {
        let t = self.temperature_c + 273.15;
        let t_rel = t / 293.15;
        let p_rel = self.pressure_kpa / 101.325;
        // Annex B: molar concentration of water vapour, in per cent; 273.16 K is the triple point.
        let saturation = libm::exp10(-6.8346 * libm::pow(273.16 / t, 1.261) + 4.6151);
        let h = self.humidity_percent * saturation / p_rel;
        // Eqs. (3) and (4): relaxation frequencies of oxygen and nitrogen.
        let oxygen = p_rel * (24.0 + 4.04e4 * h * (0.02 + h) / (0.391 + h));
        let nitrogen = p_rel
            * libm::pow(t_rel, -0.5)
            * (9.0 + 280.0 * h * libm::exp(-4.170 * (libm::pow(t_rel, -1.0 / 3.0) - 1.0)));
        // Eq. (5).
        let f2 = frequency_hz * frequency_hz;
        let classical = 1.84e-11 / p_rel * libm::sqrt(t_rel);
        let relaxation = libm::pow(t_rel, -2.5)
            * (0.01275 * libm::exp(-2239.1 / t) / (oxygen + f2 / oxygen)
                + 0.1068 * libm::exp(-3352.0 / t) / (nitrogen + f2 / nitrogen));
        8.686 * f2 * (classical + relaxation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absorption_at_ten_degrees_is_two_thirds_of_that_at_twenty() {
        for (frequency, expected) in [(40_000.0, 0.84791), (49_400.0, 1.00754), (50_000.0, 1.01822)] {
            let alpha = Air::at(10.0).absorption_db_per_m(frequency);
            assert!((alpha - expected).abs() < 1e-5, "{frequency} Hz: {alpha}");
        }
        assert!((Air::default().absorption_db_per_m(50_000.0) - 1.66112).abs() < 1e-5);
    }

    #[test]
    fn sound_is_slower_in_the_cold() {
        for (t, c) in [(0.0, 331.286), (10.0, 337.296), (30.0, 349.005)] {
            assert!((Air::at(t).speed_of_sound() - c).abs() < 1e-3);
        }
    }
}
