//! [`HoppingCode`]: by how much each sensor's firing moves from phase to phase, a linear congruence.

use super::error::HoppingError;
use crate::schedule::MAX_SENSORS;
use crate::time::Micros;

/// The waits of a cycle of `q` phases, `q` prime: sensor `i` (from 0) waits `step ((i + a) m mod q)` in phase `m`,
/// where `a` is 1 unless asked otherwise.
///
/// What sound of sensor x, sent j periods before, moves by from phase m to phase m' of sensor y is a multiple of the
/// step, and modulo `q` it is `(x - y)(m - m')`, which is not 0. So it moves by at least one step, for each pair of
/// sensors, each j and each pair of phases, whatever the lags are (`docs/theory.md`, section 9).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingCode {
    sensors: u8,
    phases: u8,
    /// `a`.
    first: u8,
    step: Micros,
}

impl HoppingCode {
    /// The most phases: the smallest prime above 64.
    pub const MAX_PHASES: u8 = 67;

    /// The narrowest such code for 1 to 64 sensors: `q` is the smallest prime that is above their number and at least
    /// `phases`, 2 to 67. The step is 1 to 65,535 us.
    ///
    /// # Errors
    /// [`HoppingError`] outside these ranges.
    ///
    /// ```
    /// use eeruf_core::{Micros, hopping::HoppingCode};
    /// let code = HoppingCode::new(8, 2, Micros::new(240))?;
    /// assert_eq!((code.phases(), code.width()), (11, Micros::new(2400)));
    /// # Ok::<(), eeruf_core::hopping::HoppingError>(())
    /// ```
    pub const fn new(sensors: usize, phases: u8, step: Micros) -> Result<Self, HoppingError> {
        match Self::of_phases(sensors, phases, step, sensors + 1) {
            Ok(phases) => Ok(Self { sensors: sensors as u8, phases, first: 1, step }),
            Err(error) => Err(error),
        }
    }

    /// The code with which the period can be shortest: one sensor always waits alike, and the waits of all others
    /// shrink by 1 to `K - 1` steps from period to period, for `q` at least the number of sensors `K` and `phases`.
    ///
    /// A sensor's two firings are then never closer than `T_p - (K - 1) step`. No code of any kind that moves sound of
    /// every age by a step does better (`docs/theory.md`, section 9.3).
    ///
    /// # Errors
    /// As for [`HoppingCode::new`].
    ///
    /// ```
    /// use eeruf_core::{Micros, hopping::HoppingCode};
    /// let code = HoppingCode::shortest(8, 2, Micros::new(240))?;
    /// assert_eq!((code.phases(), code.longest_drop()), (11, Micros::new(7 * 240)));
    /// assert_eq!(HoppingCode::new(8, 2, Micros::new(240))?.longest_drop(), Micros::new(10 * 240));
    /// # Ok::<(), eeruf_core::hopping::HoppingError>(())
    /// ```
    pub const fn shortest(sensors: usize, phases: u8, step: Micros) -> Result<Self, HoppingError> {
        match Self::of_phases(sensors, phases, step, sensors) {
            Ok(phases) => {
                let sensors = sensors as u8;
                Ok(Self { sensors, phases, first: (phases - sensors + 1) % phases, step })
            }
            Err(error) => Err(error),
        }
    }

    /// The code with exactly so many phases, and the multiplier `a` of sensor 0: what files and sources say.
    ///
    /// # Errors
    /// [`HoppingError`] as for [`HoppingCode::new`]; [`HoppingError::NotPrime`] for phases that are no prime or fewer
    /// than the sensors, [`HoppingError::Multiplier`] for one that is not below them.
    pub const fn of(sensors: usize, phases: u8, first_multiplier: u8, step: Micros) -> Result<Self, HoppingError> {
        let prime = match Self::of_phases(sensors, phases, step, sensors) {
            Ok(prime) => prime,
            Err(error) => return Err(error),
        };
        if prime != phases {
            return Err(HoppingError::NotPrime { phases, next: prime });
        }
        if first_multiplier >= phases {
            return Err(HoppingError::Multiplier { first_multiplier, phases });
        }
        Ok(Self { sensors: sensors as u8, phases, first: first_multiplier, step })
    }

    /// The number of phases: a prime, at least `phases` and at least `least`.
    const fn of_phases(sensors: usize, phases: u8, step: Micros, least: usize) -> Result<u8, HoppingError> {
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(HoppingError::Sensors { sensors, most: MAX_SENSORS });
        }
        if phases < 2 || phases > Self::MAX_PHASES {
            return Err(HoppingError::Phases { phases });
        }
        if step.as_micros() == 0 || step.as_micros() > u16::MAX as u32 {
            return Err(HoppingError::Step { step });
        }
        let mut q = if phases as usize > least { phases } else { least as u8 };
        while !is_prime(q) {
            q += 1;
        }
        Ok(q)
    }

    /// How many sensors it is for.
    pub const fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// `q`: the number of phases of a cycle.
    pub const fn phases(&self) -> u8 {
        self.phases
    }

    /// The shortest period at which no path reads the same with two ages: twice the width and a step.
    pub(super) const fn two_ages(&self) -> Micros {
        self.width().saturating_add(self.width()).saturating_add(self.step)
    }

    /// `a`: the multiplier of sensor 0.
    pub const fn first_multiplier(&self) -> u8 {
        self.first
    }

    /// By how much crosstalk moves at least from one phase to another.
    pub const fn step(&self) -> Micros {
        self.step
    }

    /// The longest wait, `(q - 1) step`.
    pub const fn width(&self) -> Micros {
        Micros::new((self.phases as u32 - 1) * self.step.as_micros())
    }

    /// By how much less than a period two firings of a sensor are apart at most.
    pub const fn longest_drop(&self) -> Micros {
        let (mut most, mut sensor) = (0, 0);
        while sensor < self.sensors as usize {
            let multiplier = self.multiplier(sensor);
            let drop = if multiplier == 0 { 0 } else { self.phases as u32 - multiplier };
            most = if drop > most { drop } else { most };
            sensor += 1;
        }
        Micros::new(most * self.step.as_micros())
    }

    /// What the phase is multiplied by for a sensor, modulo the number of phases.
    const fn multiplier(&self, sensor: usize) -> u32 {
        remainder(sensor as u32 + self.first as u32, self.phases)
    }

    /// Of a sensor's wait, in steps: what it is in the phase after the one in which it is `place`. Without a division,
    /// which small processors do not have.
    pub(super) const fn next_place(&self, sensor: u8, place: u8) -> u8 {
        // All three are less than twice the number of phases, which is at most 67.
        let multiplier = sensor + self.first;
        let multiplier = if multiplier >= self.phases { multiplier - self.phases } else { multiplier };
        let next = place + multiplier;
        if next >= self.phases { next - self.phases } else { next }
    }

    /// How long a sensor waits after its lag in a phase; phases are counted modulo `q`.
    pub const fn wait(&self, sensor: usize, phase: u8) -> Micros {
        let place = remainder(self.multiplier(sensor) * phase as u32, self.phases);
        Micros::new(place * self.step.as_micros())
    }
}

/// There is at least one phase, which the compiler does not know: no path to a panic.
const fn remainder(number: u32, phases: u8) -> u32 {
    match number.checked_rem(phases as u32) {
        Some(remainder) => remainder,
        None => 0,
    }
}

const fn is_prime(number: u8) -> bool {
    let mut divisor = 2;
    while divisor * divisor <= number {
        if number % divisor == 0 {
            return false;
        }
        divisor += 1;
    }
    number > 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_waits_worked_out_one_from_the_other_are_those_of_the_code() {
        let step = Micros::new(240);
        for sensors in 1..=MAX_SENSORS {
            for code in [HoppingCode::new(sensors, 2, step), HoppingCode::shortest(sensors, 2, step)] {
                let code = code.unwrap();
                for sensor in 0..sensors as u8 {
                    let mut place = 0;
                    for phase in 0..code.phases() {
                        let waits = Micros::new(u32::from(place) * step.as_micros());
                        assert_eq!(waits, code.wait(sensor.into(), phase), "{code:?}, sensor {sensor}, phase {phase}");
                        place = code.next_place(sensor, place);
                    }
                }
            }
        }
    }
}
