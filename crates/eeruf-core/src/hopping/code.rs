//! [`HoppingCode`]: the shift of each sensor's firing from phase to phase, Welch's Costas sequence or a linear
//! congruence.

use super::error::HoppingError;
use crate::schedule::MAX_SENSORS;
use crate::time::Micros;

/// The waits of a cycle of phases, in whole steps, of one of two families:
///
/// - **Welch's Costas sequence**, [`new`](Self::new): `q - 1` phases, `q` prime. With `g` the least primitive root of
///   `q`, the sensor that is `i`th in the order of lags (from 0) waits `step ((a g^(m - i) mod q) - 1)` in phase `m`;
///   `a` is 1 unless asked otherwise.
/// - **The linear congruence**, [`shortest`](Self::shortest): `q` phases. Sensor `i` waits `step ((i + a) m mod q)`.
///
/// What sound of one sensor, sent j periods before, moves by from one phase of another sensor to another is at least a
/// step (`docs/explanation/theory.md`, section 9). With the linear congruence it moves by the same from each period to
/// the next, as an obstacle does that a robot drives towards; with Welch's sequence few phases lie along any line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingCode {
    sensors: u8,
    phases: u8,
    /// `a`.
    first: u8,
    /// `g`; 0 for a linear congruence.
    root: u8,
    step: Micros,
}

impl HoppingCode {
    /// The most phases: the smallest prime above 64.
    pub const MAX_PHASES: u8 = 67;

    /// The narrowest code of Welch's sequence for 1 to 64 sensors: it has more phases than sensors, and at least
    /// `phases`, 2 to 67, as far as there are this many: 66 at most. The step is 1 to 65,535 us.
    ///
    /// # Errors
    /// [`HoppingError`] outside these ranges.
    ///
    /// ```
    /// use eeruf_core::{Micros, hopping::HoppingCode};
    /// let code = HoppingCode::new(8, 2, Micros::new(240))?;
    /// assert_eq!((code.phases(), code.width()), (10, Micros::new(2160)));
    /// # Ok::<(), eeruf_core::hopping::HoppingError>(())
    /// ```
    pub const fn new(sensors: usize, phases: u8, step: Micros) -> Result<Self, HoppingError> {
        if let Err(error) = Self::check(sensors, phases, step) {
            return Err(error);
        }
        let mut q = if phases as usize > sensors + 1 { phases } else { sensors as u8 + 1 };
        q = if q < Self::MAX_PHASES { q + 1 } else { q };
        // Two phases would be those of a linear congruence.
        q = if q < 5 { 5 } else { q };
        while !is_prime(q) {
            q += 1;
        }
        Ok(Self { sensors: sensors as u8, phases: q - 1, first: 1, root: primitive_root(q), step })
    }

    /// The linear congruence with which the period can be shortest: one sensor always waits alike, and the waits of all
    /// others shrink by 1 to `K - 1` steps from period to period, for `q` at least the number of sensors `K` and
    /// `phases`.
    ///
    /// A sensor's two firings are then never closer than `T_p - (K - 1) step`. No code of any kind that moves sound of
    /// every age by a step does better (`docs/explanation/theory.md`, section 9.3).
    ///
    /// # Errors
    /// As for [`HoppingCode::new`].
    ///
    /// ```
    /// use eeruf_core::{Micros, hopping::HoppingCode};
    /// let code = HoppingCode::shortest(8, 2, Micros::new(240))?;
    /// assert_eq!((code.phases(), code.longest_drop()), (11, Micros::new(7 * 240)));
    /// assert_eq!(HoppingCode::new(8, 2, Micros::new(240))?.longest_drop(), Micros::new(5 * 240));
    /// # Ok::<(), eeruf_core::hopping::HoppingError>(())
    /// ```
    pub const fn shortest(sensors: usize, phases: u8, step: Micros) -> Result<Self, HoppingError> {
        match Self::of_phases(sensors, phases, step, sensors) {
            Ok(phases) => {
                let sensors = sensors as u8;
                Ok(Self { sensors, phases, first: (phases - sensors + 1) % phases, root: 0, step })
            }
            Err(error) => Err(error),
        }
    }

    /// The code with exactly this number of phases, and `a`, as files and sources have them. It is a linear congruence
    /// if their number is a prime, Welch's sequence if it is one less than a prime and above the number of sensors.
    ///
    /// # Errors
    /// [`HoppingError`] as for [`HoppingCode::new`]; [`HoppingError::NotPrime`] for any other number of phases,
    /// [`HoppingError::Multiplier`] for an `a` that is not below it, or 0 with Welch's sequence.
    pub const fn of(sensors: usize, phases: u8, first_multiplier: u8, step: Micros) -> Result<Self, HoppingError> {
        let prime = match Self::of_phases(sensors, phases, step, sensors) {
            Ok(prime) => prime,
            Err(error) => return Err(error),
        };
        let is_linear = prime == phases;
        if !is_linear && (phases as usize <= sensors || !is_prime(phases + 1)) {
            return Err(HoppingError::NotPrime { phases, next: prime });
        }
        if first_multiplier >= phases || (first_multiplier == 0 && !is_linear) {
            return Err(HoppingError::Multiplier { first_multiplier, phases });
        }
        let root = if is_linear { 0 } else { primitive_root(phases + 1) };
        Ok(Self { sensors: sensors as u8, phases, first: first_multiplier, root, step })
    }

    /// The number of phases: a prime, at least `phases` and at least `least`.
    const fn of_phases(sensors: usize, phases: u8, step: Micros, least: usize) -> Result<u8, HoppingError> {
        if let Err(error) = Self::check(sensors, phases, step) {
            return Err(error);
        }
        let mut q = if phases as usize > least { phases } else { least as u8 };
        while !is_prime(q) {
            q += 1;
        }
        Ok(q)
    }

    const fn check(sensors: usize, phases: u8, step: Micros) -> Result<(), HoppingError> {
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(HoppingError::Sensors { sensors, most: MAX_SENSORS });
        }
        if phases < 2 || phases > Self::MAX_PHASES {
            return Err(HoppingError::Phases { phases });
        }
        if step.as_micros() == 0 || step.as_micros() > u16::MAX as u32 {
            return Err(HoppingError::Step { step });
        }
        Ok(())
    }

    /// Number of sensors it is for.
    pub const fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// The number of phases of a cycle.
    pub const fn phases(&self) -> u8 {
        self.phases
    }

    /// The shortest period at which no path reads the same with two ages: twice the width and a step.
    pub(super) const fn two_ages(&self) -> Micros {
        self.width().saturating_add(self.width()).saturating_add(self.step)
    }

    /// Returns true for Welch's sequence, false for a linear congruence.
    pub const fn is_welch(&self) -> bool {
        self.root != 0
    }

    /// `a`: the multiplier of sensor 0.
    pub const fn first_multiplier(&self) -> u8 {
        self.first
    }

    /// The least shift of crosstalk from one phase to another.
    pub const fn step(&self) -> Micros {
        self.step
    }

    /// The longest wait: a step less than there are phases.
    pub const fn width(&self) -> Micros {
        Micros::new((self.phases as u32 - 1) * self.step.as_micros())
    }

    /// Largest shortfall of two firings of a sensor against a period.
    pub const fn longest_drop(&self) -> Micros {
        // With Welch's sequence all sensors go through the same waits.
        let all = if self.is_welch() { self.phases } else { self.sensors };
        let (mut most, mut at) = (0, 0);
        while at < all {
            let drop = self.drop_at(at);
            most = if drop > most { drop } else { most };
            at += 1;
        }
        Micros::new(most as u32 * self.step.as_micros())
    }

    /// The same of the sensor with this number.
    pub const fn drop_of(&self, sensor: u8) -> Micros {
        if self.is_welch() {
            self.longest_drop()
        } else {
            Micros::new(self.drop_at(sensor) as u32 * self.step.as_micros())
        }
    }

    /// In steps: how much shorter a wait is than the one before, for a place of Welch's sequence or the sensor with
    /// this number.
    const fn drop_at(&self, at: u8) -> u8 {
        if self.is_welch() {
            return at.saturating_sub(self.times_root(at));
        }
        let multiplier = self.multiplier(at as usize) as u8;
        if multiplier == 0 { 0 } else { self.phases - multiplier }
    }

    /// Factor of the phase for a sensor, modulo the number of phases.
    const fn multiplier(&self, sensor: usize) -> u32 {
        remainder(sensor as u32 + self.first as u32, self.phases)
    }

    /// Of a sensor's wait, in steps: what it is in the phase after the one in which it is `place`. Without a division,
    /// which small processors do not have.
    pub(crate) const fn next_place(&self, sensor: u8, place: u8) -> u8 {
        if self.is_welch() {
            return self.times_root(place);
        }
        // All three are less than twice the number of phases, which is at most 67.
        let multiplier = sensor + self.first;
        let multiplier = if multiplier >= self.phases { multiplier - self.phases } else { multiplier };
        let next = place + multiplier;
        if next >= self.phases { next - self.phases } else { next }
    }

    /// `g` times one more than a place, modulo `q`, less one. Roots are small: at most 6.
    const fn times_root(&self, place: u8) -> u8 {
        let (q, number) = (self.phases + 1, place + 1);
        let (mut product, mut left) = (number, self.root);
        while left > 1 {
            product += number;
            product = if product >= q { product - q } else { product };
            left -= 1;
        }
        // It is never a multiple of a prime.
        product.saturating_sub(1)
    }

    /// The wait in steps in a phase, phases counted modulo their number: of the sensor with this number for a linear
    /// congruence, of the one with this place in the order of lags for Welch's sequence.
    pub(crate) const fn place(&self, sensor: usize, phase: u8) -> u8 {
        if !self.is_welch() {
            return remainder(self.multiplier(sensor) * phase as u32, self.phases) as u8;
        }
        let phases = self.phases as u32;
        let mut left = remainder(phase as u32 + phases - remainder(sensor as u32, self.phases), self.phases);
        let mut place = self.first.saturating_sub(1);
        while left > 0 {
            place = self.times_root(place);
            left -= 1;
        }
        place
    }

    /// The time that a sensor waits after its lag in a phase; both are counted as in [`HoppingSchedule::t_fire`] if
    /// lags are in the order of sensors.
    ///
    /// [`HoppingSchedule::t_fire`]: super::HoppingSchedule::t_fire
    pub const fn wait(&self, sensor: usize, phase: u8) -> Micros {
        Micros::new(self.place(sensor, phase) as u32 * self.step.as_micros())
    }
}

/// The least primitive root of a prime.
const fn primitive_root(q: u8) -> u8 {
    let mut root = 1;
    loop {
        let (mut power, mut order) = (root as u32, 1);
        while power != 1 && order < q {
            power = remainder(power * root as u32, q);
            order += 1;
        }
        // Every prime has one: that of 2 is 1.
        if order >= q - 1 {
            return root;
        }
        root += 1;
    }
}

/// By subtraction: numbers are small, and small processors have no division. There is at least one phase, which the
/// compiler does not know.
const fn remainder(mut number: u32, phases: u8) -> u32 {
    while phases > 0 && number >= phases as u32 {
        number -= phases as u32;
    }
    number
}

const fn is_prime(number: u8) -> bool {
    let mut divisor = 2;
    while divisor < number {
        if remainder(number as u32, divisor) == 0 {
            return false;
        }
        divisor += 1;
    }
    number > 1
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    // The waits worked out one from the other are those of the code.
    #[test]
    fn waits_worked_out_in_turn_are_those_of_the_code() {
        let step = Micros::new(240);
        for sensors in 1..=MAX_SENSORS {
            for code in [HoppingCode::new(sensors, 2, step), HoppingCode::shortest(sensors, 2, step)] {
                let code = code.unwrap();
                for sensor in 0..sensors as u8 {
                    let mut place = code.place(sensor.into(), 0);
                    for phase in 0..code.phases() {
                        let waits = Micros::new(u32::from(place) * step.as_micros());
                        assert_eq!(waits, code.wait(sensor.into(), phase), "{code:?}, sensor {sensor}, phase {phase}");
                        place = code.next_place(sensor, place);
                    }
                }
            }
        }
    }

    #[test]
    fn least_primitive_roots_are_those_of_the_tables() {
        let known = [(3, 2), (5, 2), (7, 3), (11, 2), (13, 2), (17, 3), (19, 2), (23, 5), (31, 3), (41, 6), (67, 2)];
        for (q, root) in known {
            assert_eq!(primitive_root(q), root, "{q}");
        }
    }

    #[test]
    fn welch_code_of_eight_sensors_is_that_of_the_textbook() {
        // Powers of 2 modulo 11, less one; each sensor is a phase behind the one before.
        let code = HoppingCode::new(8, 2, Micros::new(1)).unwrap();
        let waits = |sensor| (0..10).map(|phase| code.wait(sensor, phase).as_micros()).collect::<std::vec::Vec<_>>();
        assert_eq!(waits(0), [0, 1, 3, 7, 4, 9, 8, 6, 2, 5]);
        assert_eq!(waits(1), [5, 0, 1, 3, 7, 4, 9, 8, 6, 2]);
    }
}
