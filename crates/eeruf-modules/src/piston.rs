//! The directivity of a round transducer in a baffle: the amplitude at an angle off its axis.

use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI, TAU};

use crate::fresnel::fresnel;
use crate::module::Beam;

/// The first zero of `J1`: where the main lobe ends.
const FIRST_NULL: f64 = 3.831_705_970_207_512;

/// A baffled circular piston whose nulls have a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piston {
    /// Wave number times radius.
    pub ka: f64,
    /// The least amplitude of the endless baffle's pattern. Nulls are an artefact of a single frequency; a short burst
    /// has none.
    pub floor: f64,
    /// The pattern near 90 degrees and beyond.
    pub beam: Beam,
}

impl Piston {
    /// -28 dB (a choice).
    pub const DEFAULT_FLOOR: f64 = 0.039_810_717_055_349_72;

    /// Makes a piston of radius `radius_m` at wave number `wave_number` (rad/m), with the default floor and beam.
    pub fn new(wave_number: f64, radius_m: f64) -> Self {
        Self { ka: wave_number * radius_m, floor: Self::DEFAULT_FLOOR, beam: Beam::default() }
    }

    /// Returns the amplitude at an angle off the axis, 1 on it:
    ///
    /// ```text
    /// D = |2 J1(x) / x|,   x = k a sin(theta)
    /// ```
    ///
    /// but not below the floor, and behind 90 degrees according to the [`beam`](Self::beam). A continuous beam keeps
    /// the value of 90 degrees behind, and multiplies the whole pattern by the shadow of a half plane with its edge at
    /// the piston's rim, relative to the axis:
    ///
    /// ```text
    /// B = (1 - |F(x)|) / (1 - |F(sqrt(ka))|) in front,  |F(-x)| / (1 - |F(sqrt(ka))|) behind,
    /// x = sqrt(2 ka) cos(pi / 4 + theta / 2),  |F(x)| = |integral of exp(i t^2) from x to infinity| / sqrt(pi)
    /// ```
    /// This is Sommerfeld's shadow at grazing incidence (Born and Wolf, Principles of Optics, Sec. 11.5) without the
    /// edge wave's ripple in front, which a round rim and a short burst smear.
    ///
    /// ```
    /// use eeruf_modules::{Beam, Piston};
    /// let polaroid = Piston { ka: 17.364439394387222, floor: 0.0, beam: Beam::CutAt90 };
    /// assert!((polaroid.pattern(7.5f64.to_radians()) - 0.48150582532629144).abs() < 1e-9);
    /// assert_eq!(polaroid.pattern(2.0), 0.0);
    /// let behind = Piston { beam: Beam::Continuous, ..polaroid }.pattern(2.0);
    /// assert!(behind > 0.0 && behind < polaroid.pattern(1.57));
    /// ```
    pub fn pattern(&self, off_axis_rad: f64) -> f64 {
        let off = wrap_angle(off_axis_rad).abs();
        match self.beam {
            Beam::CutAt90 if off >= FRAC_PI_2 => 0.0,
            Beam::CutAt90 => self.endless(off),
            Beam::Continuous => self.endless(off.min(FRAC_PI_2)) * self.rim(off),
        }
    }

    /// Returns the pattern in an endless baffle, up to 90 degrees.
    fn endless(&self, off: f64) -> f64 {
        self.lobe(self.ka * libm::sin(off)).max(self.floor)
    }

    /// Returns the share of the amplitude that the end of the baffle leaves at an angle of 0 to pi, 1 on the axis.
    fn rim(&self, off: f64) -> f64 {
        let edge_wave = |x: f64| {
            let [c, s] = fresnel(x.abs() * libm::sqrt(2.0 / PI));
            libm::hypot(0.5 - c, 0.5 - s) * FRAC_1_SQRT_2
        };
        let x = libm::sqrt(2.0 * self.ka) * libm::cos(FRAC_PI_4 + 0.5 * off);
        let left = if x >= 0.0 { 1.0 - edge_wave(x) } else { edge_wave(x) };
        left / (1.0 - edge_wave(libm::sqrt(self.ka)))
    }

    fn lobe(&self, x: f64) -> f64 {
        if x < 1e-6 {
            return 1.0 - x * x / 8.0;
        }
        (2.0 * libm::j1(x) / x).abs()
    }

    /// Returns the angle, within the main lobe, at which the pattern has fallen to a level in dB (negative). `None` if
    /// the lobe does not fall that far within 90 degrees, or the level is above 0 dB.
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

/// Wraps an angle into (-pi, pi].
#[inline]
pub fn wrap_angle(angle_rad: f64) -> f64 {
    if angle_rad > -PI && angle_rad <= PI {
        return angle_rad;
    }
    // A conversion to an integer and back rounds without a call.
    let turns = (angle_rad / TAU + 0.5f64.copysign(angle_rad)) as i64;
    let wrapped = angle_rad - TAU * turns as f64;
    if wrapped <= -PI {
        wrapped + TAU
    } else if wrapped > PI {
        wrapped - TAU
    } else {
        wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_wrap_to_the_half_open_circle() {
        assert_eq!((wrap_angle(PI), wrap_angle(-PI)), (PI, PI));
        assert!((wrap_angle(7.0 * PI + 0.25) - (0.25 - PI)).abs() < 1e-14);
    }

    #[test]
    fn polaroid_and_hc_sr04_have_the_lobes_of_the_data_sheets() {
        let degrees =
            |ka: f64, db: f64| Piston { ka, floor: 0.0, beam: Beam::CutAt90 }.angle_at_db(db).unwrap().to_degrees();
        assert!((degrees(17.364, -3.0) - 5.33).abs() < 0.01);
        assert!((degrees(17.364, -6.0) - 7.32).abs() < 0.01);
        assert!((degrees(17.364, -20.0) - 11.36).abs() < 0.01);
        assert!((degrees(5.858, -3.0) - 16.0).abs() < 0.05);
        let side_lobe = (1275..2500)
            .map(|k| Piston { ka: 17.364, floor: 0.0, beam: Beam::CutAt90 }.pattern(f64::from(k).to_radians() / 100.0));
        assert!((20.0 * libm::log10(side_lobe.fold(0.0, f64::max)) + 17.57).abs() < 0.01);
    }

    #[test]
    fn the_floor_fills_the_nulls_in_front_and_nothing_behind() {
        let piston = Piston { ka: 17.364, floor: Piston::DEFAULT_FLOOR, beam: Beam::CutAt90 };
        let null = libm::asin(FIRST_NULL / 17.364);
        assert_eq!(piston.pattern(null), Piston::DEFAULT_FLOOR);
        assert_eq!(piston.pattern(PI), 0.0);
        assert_eq!(piston.angle_at_db(1.0), None);
        assert_eq!(Piston { ka: 0.5, floor: 0.0, beam: Beam::CutAt90 }.angle_at_db(-20.0), None);
    }

    #[test]
    fn continuous_beam_has_no_step_and_keeps_the_main_lobe() {
        for ka in [5.858, 17.364] {
            let [cut, continuous] =
                [Beam::CutAt90, Beam::Continuous].map(|beam| Piston { ka, floor: Piston::DEFAULT_FLOOR, beam });
            assert_eq!(continuous.pattern(0.0), 1.0);
            // No step anywhere: a hundredth of a degree changes little of the amplitude.
            let at = |k: u32| continuous.pattern((0.01 * f64::from(k)).to_radians());
            for k in 0..18_000 {
                assert!((at(k + 1) - at(k)).abs() < 2e-2 * at(k).max(Piston::DEFAULT_FLOOR), "{ka} {k}");
            }
            // Half of the wave is left at the edge of the shadow; the main lobe hardly changes.
            let db = |off: f64| 20.0 * libm::log10(continuous.pattern(off) / cut.pattern(off));
            let half = db(FRAC_PI_2 - 1e-9);
            assert!((-6.1..-4.8).contains(&half), "{half}");
            let lobe = cut.angle_at_db(-3.0).unwrap();
            assert!((0..=100).all(|k| db(0.01 * f64::from(k) * lobe).abs() < 0.3));
            // The pattern falls steadily behind.
            assert!((9_000..18_000).all(|k| at(k + 1) < at(k)));
        }
    }
}
