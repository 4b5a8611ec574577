//! Transducers and their ranging modules: frequency, size, burst, blanking, range, gain over time and threshold of
//! hearing.

use eeruf_modules::{Beam, Gain as GainProfile, Module, Piston};

use crate::scene::Air;

/// Number of steps of [`GainProfile::Stepped`].
const GAIN_STEPS: f64 = 12.0;

/// The clock of the TL851 in Hz, a ceramic resonator, and its cycles until each step of the gain: 1,000, then 1,152
/// more for each step, and 2,304 more for each of the last three.
const TL851_HZ: f64 = 420e3;
const TL851_STEPS: [u32; 11] = [1000, 2152, 3304, 4456, 5608, 6760, 7912, 9064, 11_368, 13_672, 15_976];
/// Height of a step of [`GainProfile::Polaroid6500`], in dB.
const STEP_DB: f64 = 1.15;

/// Returns the gain of a receiver at a time after firing, relative to the gain from `full_s` on. The Polaroid's own
/// steps reach 1 after 38 ms, whatever `full_s` is.
///
/// [`GainProfile::Polaroid6500`] has the twelve steps of the Polaroid 6500 module. Its control circuit, the TL851
/// (Texas Instruments, SLSS004, March 1988), ends a step 2.38, 5.12, 7.87, .. 38.04 ms after firing, for any range.
/// Each step adds 1.15 dB, a choice: the TL852's relative gain is published only as a drawing (SLSS003, Fig. 2), and
/// regions of constant depth suggest 1.1 to 1.2 dB a step; see `docs/explanation/physics.md`.
///
/// ```
/// use eeruf_sim::{GainProfile, gain_at};
/// assert_eq!(gain_at(GainProfile::Linear, 0.01, 0.04), 0.25);
/// assert_eq!(gain_at(GainProfile::SquareRoot, 0.01, 0.04), 0.5);
/// assert_eq!([0.0, 0.0033, 0.0034].map(|t| 12.0 * gain_at(GainProfile::Stepped, t, 0.04)), [1.0, 1.0, 2.0]);
/// let polaroid_db = |t: f64| 20.0 * gain_at(GainProfile::Polaroid6500, t, 0.04).log10();
/// for (t, expected) in [(2.3e-3, -12.65), (2.4e-3, -11.5), (38.0e-3, -1.15), (38.1e-3, 0.0)] {
///     assert!((polaroid_db(t) - expected).abs() < 1e-9);
/// }
/// ```
pub fn gain_at(profile: GainProfile, time_s: f64, full_s: f64) -> f64 {
    let share = (time_s / full_s).clamp(0.0, 1.0);
    match profile {
        GainProfile::Constant => 1.0,
        GainProfile::SquareRoot => share.sqrt(),
        GainProfile::Linear => share,
        GainProfile::Stepped => ((GAIN_STEPS * share).floor() + 1.0).min(GAIN_STEPS) / GAIN_STEPS,
        GainProfile::Polaroid6500 => {
            let to_come = TL851_STEPS.iter().filter(|&&cycles| f64::from(cycles) > time_s * TL851_HZ).count();
            libm::exp10(-STEP_DB * to_come as f64 / 20.0)
        }
    }
}

/// An ultrasonic transducer with its ranging module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transducer {
    /// Frequency in Hz.
    pub frequency_hz: f64,
    /// Width of the band for sending and hearing, around the frequency, in Hz.
    pub bandwidth_hz: f64,
    /// Radius of the piston in metres.
    pub radius_m: f64,
    /// Least amplitude of the pattern in front; see [`Piston::floor`].
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
    /// Polaroid 600 series electrostatic transducer with the 6500 module. The gain here is constant, unlike the
    /// module's; [`GainProfile::Polaroid6500`] is closer to it.
    pub const POLAROID_6500: Self = Self::of(&eeruf_modules::POLAROID_6500);

    /// HC-SR04 module. Its gain is constant, as in the module, which has amplifiers of fixed gain before a comparator;
    /// see `docs/explanation/physics.md`.
    pub const HC_SR04: Self = Self::of(&eeruf_modules::HC_SR04);

    /// Takes the acoustics from a module.
    pub const fn of(module: &Module) -> Self {
        Self {
            frequency_hz: module.frequency_hz as f64,
            bandwidth_hz: module.bandwidth_hz as f64,
            radius_m: module.radius_um as f64 / 1e6,
            pattern_floor: Piston::DEFAULT_FLOOR,
            beam: module.beam,
            cycles: module.burst_cycles,
            blanking_s: module.blanking_us as f64 / 1e6,
            max_range_m: module.sees_to_mm as f64 / 1e3,
            gain: module.gain,
        }
    }

    /// Describes the transducer as a module, in whole numbers; all but the acoustics is taken from `like`.
    pub(crate) fn described(&self, like: &Module) -> Module {
        let whole = |value: f64| value.round() as u32;
        Module {
            sees_to_mm: whole(1e3 * self.max_range_m),
            blanking_us: whole(1e6 * self.blanking_s),
            frequency_hz: whole(self.frequency_hz),
            bandwidth_hz: whole(self.bandwidth_hz),
            burst_cycles: self.cycles,
            gain: self.gain,
            radius_um: whole(1e6 * self.radius_m),
            beam: self.beam,
            ..*like
        }
    }

    /// Returns `k = 2 pi f / c` in rad/m.
    pub fn wave_number(&self, air: Air) -> f64 {
        core::f64::consts::TAU * self.frequency_hz / air.speed_of_sound()
    }

    /// Returns the pattern in this air.
    pub fn piston(&self, air: Air) -> Piston {
        Piston { floor: self.pattern_floor, beam: self.beam, ..Piston::new(self.wave_number(air), self.radius_m) }
    }

    /// Returns true if the transducer hears another kind, which it does if their bands overlap. Hearing is mutual.
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

    /// Returns the length of the burst in seconds.
    pub fn burst_s(&self) -> f64 {
        f64::from(self.cycles) / self.frequency_hz
    }

    /// Returns the least amplitude that is heard: a perfect wall at the farthest range, on axis.
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

    /// Returns the level after the time-varying gain, on the scale of [`detection_floor`](Self::detection_floor).
    pub fn received(&self, amplitude: f64, length_m: f64, air: Air) -> f64 {
        let c = air.speed_of_sound();
        amplitude * gain_at(self.gain, length_m / c, 2.0 * self.max_range_m / c)
    }

    /// Returns the level above the [`detection_floor`](Self::detection_floor) in dB; below 0 nothing is heard.
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
    fn modules_hear_to_five_sigma_of_fading_beyond_their_range() {
        let air = Air::default();
        for preset in eeruf_modules::PRESETS {
            let transducer = Transducer::of(preset);
            let length_m = 2.0 * f64::from(preset.hears_to_mm) / 1e3;
            let loss_db = air.absorption_db_per_m(transducer.frequency_hz) * length_m;
            let amplitude = libm::exp10(-loss_db / 20.0) / length_m;
            let below_db = -20.0 * libm::log10(amplitude / transducer.detection_floor(air));
            assert!((below_db - 5.0 * 1.5).abs() < 0.05, "{}: {below_db} dB", preset.name);
        }
    }

    #[test]
    fn presets_have_the_ka_of_their_data_sheets() {
        let air = Air::default();
        assert!((Transducer::POLAROID_6500.piston(air).ka - 17.364_439_394_387_222).abs() < 1e-9);
        assert!((Transducer::HC_SR04.piston(air).ka - 5.858_447_838_862_085_5).abs() < 1e-9);
    }
}
