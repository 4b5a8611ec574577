//! [`HoppingCode`]: by how much each sensor's firing moves from phase to phase, a linear congruence.

use super::error::HoppingError;
use crate::schedule::MAX_SENSORS;
use crate::time::Micros;

/// The waits of a cycle of `q` phases, `q` prime: sensor `i` (from 0) waits `step ((i + 1) m mod q)` in phase `m`.
///
/// What sound of sensor x, sent j periods before, moves by from phase m to phase m' of sensor y is a multiple of the
/// step, and modulo `q` it is `(x - y)(m - m')`, which is not 0. So it moves by at least one step, for each pair of
/// sensors, each j and each pair of phases, whatever the lags are (`docs/theory.md`, section 9).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingCode {
    sensors: u8,
    phases: u8,
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
    /// use eeruf_core::{HoppingCode, Micros};
    /// let code = HoppingCode::new(8, 2, Micros::new(240))?;
    /// assert_eq!((code.phases(), code.width()), (11, Micros::new(2400)));
    /// # Ok::<(), eeruf_core::HoppingError>(())
    /// ```
    pub const fn new(sensors: usize, phases: u8, step: Micros) -> Result<Self, HoppingError> {
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(HoppingError::Sensors { sensors, most: MAX_SENSORS });
        }
        if phases < 2 || phases > Self::MAX_PHASES {
            return Err(HoppingError::Phases { phases });
        }
        if step.as_micros() == 0 || step.as_micros() > u16::MAX as u32 {
            return Err(HoppingError::Step { step });
        }
        let mut q = if phases as usize > sensors { phases } else { sensors as u8 + 1 };
        while !is_prime(q) {
            q += 1;
        }
        Ok(Self { sensors: sensors as u8, phases: q, step })
    }

    /// How many sensors it is for.
    pub const fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// `q`: the number of phases of a cycle.
    pub const fn phases(&self) -> u8 {
        self.phases
    }

    /// By how much crosstalk moves at least from one phase to another.
    pub const fn step(&self) -> Micros {
        self.step
    }

    /// The longest wait, `(q - 1) step`.
    pub const fn width(&self) -> Micros {
        Micros::new((self.phases as u32 - 1) * self.step.as_micros())
    }

    /// How long a sensor waits after its lag in a phase; phases are counted modulo `q`.
    pub const fn wait(&self, sensor: usize, phase: u8) -> Micros {
        let place = (sensor as u32 + 1) * phase as u32 % self.phases as u32;
        Micros::new(place * self.step.as_micros())
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
