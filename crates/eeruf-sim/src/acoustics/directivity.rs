//! The pattern of a round transducer in a baffle: how much of the sound leaves, or is heard, at an angle off its axis.

use core::f64::consts::FRAC_PI_2;

/// The first zero of `J1`: where the main lobe ends.
const FIRST_NULL: f64 = 3.831_705_970_207_512;

/// A baffled circular piston with a floor under its nulls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piston {
    /// Wave number times radius.
    pub ka: f64,
    /// The least amplitude within the half circle in front. Nulls are an artefact of a single frequency; a short burst
    /// has none.
    pub floor: f64,
}

impl Piston {
    /// -28 dB (a choice).
    pub const DEFAULT_FLOOR: f64 = 0.039_810_717_055_349_72;

    /// A piston of radius `radius_m` at wave number `wave_number` (rad/m), with the default floor.
    pub fn new(wave_number: f64, radius_m: f64) -> Self {
        Self { ka: wave_number * radius_m, floor: Self::DEFAULT_FLOOR }
    }

    /// Amplitude at an angle off the axis, 1 on it:
    ///
    /// ```text
    /// D = |2 J1(x) / x|,   x = k a sin(theta)
    /// ```
    ///
    /// but not below the floor, and 0 from 90 degrees on, behind the baffle.
    ///
    /// ```
    /// use eeruf_sim::Piston;
    /// let polaroid = Piston { ka: 17.364439394387222, floor: 0.0 };
    /// assert!((polaroid.pattern(7.5f64.to_radians()) - 0.48150582532629144).abs() < 1e-9);
    /// assert_eq!(polaroid.pattern(2.0), 0.0);
    /// ```
    pub fn pattern(&self, off_axis_rad: f64) -> f64 {
        let off = crate::geometry::wrap_angle(off_axis_rad).abs();
        if off >= FRAC_PI_2 {
            return 0.0;
        }
        self.lobe(self.ka * libm::sin(off)).max(self.floor)
    }

    fn lobe(&self, x: f64) -> f64 {
        if x < 1e-6 {
            return 1.0 - x * x / 8.0;
        }
        (2.0 * libm::j1(x) / x).abs()
    }

    /// The angle, within the main lobe, at which the pattern has fallen to a level in dB (negative). None if the lobe
    /// does not fall that far within 90 degrees, or the level is above 0 dB.
    pub fn angle_at_db(&self, level_db: f64) -> Option<f64> {
        let level = libm::exp10(level_db / 20.0);
        let (mut low, mut high) = (0.0, FIRST_NULL.min(self.ka));
        if !(level <= 1.0 && self.lobe(high) <= level) {
            return None;
        }
        while high - low > 1e-15 * high {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.lobe(middle) > level {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(libm::asin((high / self.ka).min(1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polaroid_and_hc_sr04_have_the_lobes_of_the_data_sheets() {
        let degrees = |ka: f64, db: f64| Piston { ka, floor: 0.0 }.angle_at_db(db).unwrap().to_degrees();
        assert!((degrees(17.364, -3.0) - 5.33).abs() < 0.01);
        assert!((degrees(17.364, -6.0) - 7.32).abs() < 0.01);
        assert!((degrees(17.364, -20.0) - 11.36).abs() < 0.01);
        assert!((degrees(5.858, -3.0) - 16.0).abs() < 0.05);
        let side_lobe =
            (1275..2500).map(|k| Piston { ka: 17.364, floor: 0.0 }.pattern(f64::from(k).to_radians() / 100.0));
        assert!((20.0 * libm::log10(side_lobe.fold(0.0, f64::max)) + 17.57).abs() < 0.01);
    }

    #[test]
    fn the_floor_fills_the_nulls_in_front_and_nothing_behind() {
        let piston = Piston { ka: 17.364, floor: Piston::DEFAULT_FLOOR };
        let null = libm::asin(FIRST_NULL / 17.364);
        assert_eq!(piston.pattern(null), Piston::DEFAULT_FLOOR);
        assert_eq!(piston.pattern(core::f64::consts::PI), 0.0);
        assert_eq!(piston.angle_at_db(1.0), None);
        assert_eq!(Piston { ka: 0.5, floor: 0.0 }.angle_at_db(-20.0), None);
    }
}
