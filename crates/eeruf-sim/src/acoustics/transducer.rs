//! Transducers and their ranging modules: frequency, size, burst, blanking, range, gain over time and what is just
//! heard.

use super::directivity::{Beam, Piston};
use crate::scene::Air;

/// The growth of a receiver's gain while it listens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum GainProfile {
    /// The same all the time.
    #[default]
    Constant,
    /// With the square root of time.
    SquareRoot,
    /// In proportion to time, which makes up for spherical spreading.
    Linear,
    /// As [`Linear`](Self::Linear), but in twelve equal steps, as ranging modules switch it (how many is a choice).
    Stepped,
    /// The twelve steps of the Polaroid 6500 module, by the clock of its control circuit, the TL851 (Texas Instruments,
    /// SLSS004, March 1988): whatever range it is used for, a step ends 2.38, 5.12, 7.87, .. 38.04 ms after firing.
    /// Each step adds 1.15 dB. That is a choice: the TL852's relative gain is published as a drawing only (SLSS003,
    /// Fig. 2), and regions of constant depth leave 1.1 to 1.2 dB a step; see `docs/physics.md`.
    Polaroid6500,
}

/// In how many steps [`GainProfile::Stepped`] grows.
const GAIN_STEPS: f64 = 12.0;

/// The clock of the TL851 in Hz, a ceramic resonator, and at how many of its cycles after firing the gain steps up:
/// 1,000, then 1,152 for each step, and 2,304 for each of the last three.
const TL851_HZ: f64 = 420e3;
const TL851_STEPS: [u32; 11] = [1000, 2152, 3304, 4456, 5608, 6760, 7912, 9064, 11_368, 13_672, 15_976];
/// What a step of [`GainProfile::Polaroid6500`] adds, in dB.
const STEP_DB: f64 = 1.15;

impl GainProfile {
    /// The profiles by their names in files.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("constant", Self::Constant),
        ("square_root", Self::SquareRoot),
        ("linear", Self::Linear),
        ("stepped", Self::Stepped),
        ("polaroid_6500", Self::Polaroid6500),
    ];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::SquareRoot => "square_root",
            Self::Linear => "linear",
            Self::Stepped => "stepped",
            Self::Polaroid6500 => "polaroid_6500",
        }
    }

    /// Gain at a time after firing, relative to the gain at `full_s`, from which on it stays 1. The Polaroid's own
    /// steps are at 1 after 38 ms, whatever `full_s` is.
    ///
    /// ```
    /// use eeruf_sim::GainProfile;
    /// assert_eq!(GainProfile::Linear.gain(0.01, 0.04), 0.25);
    /// assert_eq!(GainProfile::SquareRoot.gain(0.01, 0.04), 0.5);
    /// assert_eq!([0.0, 0.0033, 0.0034].map(|t| 12.0 * GainProfile::Stepped.gain(t, 0.04)), [1.0, 1.0, 2.0]);
    /// let polaroid_db = |t: f64| 20.0 * GainProfile::Polaroid6500.gain(t, 0.04).log10();
    /// for (t, expected) in [(2.3e-3, -12.65), (2.4e-3, -11.5), (38.0e-3, -1.15), (38.1e-3, 0.0)] {
    ///     assert!((polaroid_db(t) - expected).abs() < 1e-9);
    /// }
    /// ```
    pub fn gain(self, time_s: f64, full_s: f64) -> f64 {
        let share = (time_s / full_s).clamp(0.0, 1.0);
        match self {
            Self::Constant => 1.0,
            Self::SquareRoot => share.sqrt(),
            Self::Linear => share,
            Self::Stepped => ((GAIN_STEPS * share).floor() + 1.0).min(GAIN_STEPS) / GAIN_STEPS,
            Self::Polaroid6500 => {
                let to_come = TL851_STEPS.iter().filter(|&&cycles| f64::from(cycles) > time_s * TL851_HZ).count();
                libm::exp10(-STEP_DB * to_come as f64 / 20.0)
            }
        }
    }
}

/// An ultrasonic transducer with its ranging module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transducer {
    /// Frequency in Hz.
    pub frequency_hz: f64,
    /// Width of the band that it sends in and hears, around its frequency, in Hz.
    pub bandwidth_hz: f64,
    /// Radius of the piston in metres.
    pub radius_m: f64,
    /// Least amplitude of the pattern in front, see [`Piston::floor`].
    pub pattern_floor: f64,
    /// The pattern near 90 degrees and beyond.
    pub beam: Beam,
    /// Length of the burst in cycles.
    pub cycles: u32,
    /// Deaf time after firing, in seconds.
    pub blanking_s: f64,
    /// Farthest range in metres.
    pub max_range_m: f64,
    /// Gain over time.
    pub gain: GainProfile,
}

impl Transducer {
    /// Polaroid 600 series electrostatic transducer with the 6500 module. As wide as its burst: `f / cycles`, where the
    /// spectrum of so many cycles has fallen by 3.9 dB (a choice). Its gain is constant, which the module's is not;
    /// [`GainProfile::Polaroid6500`] is nearer to it.
    pub const POLAROID_6500: Self = Self {
        frequency_hz: 49_400.0,
        bandwidth_hz: 49_400.0 / 16.0,
        radius_m: 19.2e-3,
        pattern_floor: Piston::DEFAULT_FLOOR,
        beam: Beam::CutAt90,
        cycles: 16,
        blanking_s: 2.38e-3,
        max_range_m: 10.7,
        gain: GainProfile::Constant,
    };

    /// HC-SR04 module. Its time-out without an echo is 38 ms. As wide as its burst, too. Its gain is constant, as the
    /// module's is: amplifiers of fixed gain before a comparator; see `docs/physics.md`.
    pub const HC_SR04: Self = Self {
        frequency_hz: 40_000.0,
        bandwidth_hz: 40_000.0 / 8.0,
        radius_m: 8.0e-3,
        pattern_floor: Piston::DEFAULT_FLOOR,
        // Its cans stand free on a board.
        beam: Beam::Continuous,
        cycles: 8,
        blanking_s: 0.117e-3,
        max_range_m: 4.0,
        gain: GainProfile::Constant,
    };

    /// `k = 2 pi f / c` in rad/m.
    pub fn wave_number(&self, air: Air) -> f64 {
        core::f64::consts::TAU * self.frequency_hz / air.speed_of_sound()
    }

    /// Its pattern in this air.
    pub fn piston(&self, air: Air) -> Piston {
        Piston { floor: self.pattern_floor, beam: self.beam, ..Piston::new(self.wave_number(air), self.radius_m) }
    }

    /// Whether it hears the sound of another kind: whether their bands overlap. Whoever sends is heard in turn.
    ///
    /// ```
    /// use eeruf_sim::Transducer;
    /// let quiet = Transducer { max_range_m: 3.0, ..Transducer::POLAROID_6500 };
    /// assert!(quiet.hears(&Transducer::POLAROID_6500));
    /// assert!(!Transducer::HC_SR04.hears(&Transducer::POLAROID_6500)); // 40 and 49.4 kHz
    /// ```
    pub fn hears(&self, other: &Self) -> bool {
        (self.frequency_hz - other.frequency_hz).abs() < 0.5 * (self.bandwidth_hz + other.bandwidth_hz)
    }

    /// Length of the burst in seconds.
    pub fn burst_s(&self) -> f64 {
        f64::from(self.cycles) / self.frequency_hz
    }

    /// The least amplitude that is heard: a perfect wall at the farthest range, on axis.
    ///
    /// ```
    /// use eeruf_sim::{Air, Transducer};
    /// let floor = Transducer::POLAROID_6500.detection_floor(Air::default());
    /// assert!((floor - 8.190e-4).abs() < 1e-7); // -61.7 dB
    /// ```
    pub fn detection_floor(&self, air: Air) -> f64 {
        let length_m = 2.0 * self.max_range_m;
        libm::exp10(-air.absorption_db_per_m(self.frequency_hz) * length_m / 20.0) / length_m
    }

    /// Received level after the time-varying gain, on the scale of [`detection_floor`](Self::detection_floor).
    pub fn received(&self, amplitude: f64, length_m: f64, air: Air) -> f64 {
        let c = air.speed_of_sound();
        amplitude * self.gain.gain(length_m / c, 2.0 * self.max_range_m / c)
    }

    /// By how many decibels that is above the [`detection_floor`](Self::detection_floor); below 0 nothing is heard.
    ///
    /// ```
    /// use eeruf_sim::{Air, Transducer};
    /// let (transducer, air) = (Transducer::POLAROID_6500, Air::default());
    /// let at_the_end_of_its_range = transducer.detection_floor(air);
    /// let level_db = transducer.level_db(at_the_end_of_its_range, 2.0 * transducer.max_range_m, air);
    /// assert!(level_db.abs() < 1e-12);
    /// ```
    pub fn level_db(&self, amplitude: f64, length_m: f64, air: Air) -> f64 {
        20.0 * libm::log10(self.received(amplitude, length_m, air) / self.detection_floor(air))
    }
}

impl Default for Transducer {
    fn default() -> Self {
        Self::POLAROID_6500
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polaroid_blanks_the_first_forty_one_centimetres() {
        let range = Transducer::POLAROID_6500.blanking_s * Air::default().speed_of_sound() / 2.0;
        assert!((range - 0.41).abs() < 0.005);
    }

    #[test]
    fn presets_have_the_ka_of_their_data_sheets() {
        let air = Air::default();
        assert!((Transducer::POLAROID_6500.piston(air).ka - 17.364_439_394_387_222).abs() < 1e-9);
        assert!((Transducer::HC_SR04.piston(air).ka - 5.858_447_838_862_085_5).abs() < 1e-9);
    }
}
