//! [`HoppingSchedule`]: a code, a period and the lags of the start.

use super::code::HoppingCode;
use super::error::HoppingError;
use crate::own_limits::{EachSensor, SensorLimits};
use crate::phases::PhaseTable;
use crate::requirements::{Least, Requirements};
use crate::schedule::{MAX_PERIOD, MAX_SENSORS, Phase, VerifiedFor, scale};
use crate::time::Micros;
use crate::verify::{Verification, Violation};

/// When the sensors of a [`HoppingRing`](super::HoppingRing) fire: each once a period, at its lag plus the wait of the
/// code. `K` is the most sensors that it has room for; the code says how many there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HoppingSchedule<const K: usize> {
    code: HoppingCode,
    period: Micros,
    lags: [Micros; K],
}

impl<const K: usize> HoppingSchedule<K> {
    /// With these lags. What does not depend on them is that crosstalk moves by at least the step of the code; what
    /// does is how far apart neighbours fire.
    ///
    /// # Errors
    /// [`HoppingError`] if `K` is less than the code's sensors, if the period is longer than
    /// [`MAX_PERIOD`](crate::MAX_PERIOD) or does not exceed the width of the code, or if a sensor would fire after its
    /// period has ended.
    pub const fn new(code: HoppingCode, period: Micros, mut lags: [Micros; K]) -> Result<Self, HoppingError> {
        if code.sensors() > K {
            return Err(HoppingError::Sensors { sensors: code.sensors(), most: K });
        }
        let least = code.width().saturating_add(Micros::new(1));
        if period.as_micros() < least.as_micros() || period.as_micros() > MAX_PERIOD.as_micros() {
            return Err(HoppingError::Period { period, least });
        }
        let most = Self { code, period, lags }.longest_lag();
        let mut sensor = 0;
        while sensor < K {
            if sensor >= code.sensors() {
                // So that schedules of the same sensors are equal.
                lags[sensor] = Micros::ZERO;
            } else if lags[sensor].as_micros() > most.as_micros() {
                return Err(HoppingError::Lag { sensor: sensor as u8, lag: lags[sensor], most });
            }
            sensor += 1;
        }
        Ok(Self { code, period, lags })
    }

    /// With even lags, as far as the code leaves room: sensors fire in their order, spread over the whole period.
    ///
    /// # Errors
    /// As for [`HoppingSchedule::new`].
    ///
    /// ```
    /// use eeruf_core::{Micros, hopping::{HoppingCode, HoppingSchedule}};
    /// let code = HoppingCode::new(8, 2, Micros::new(240))?;
    /// let ring = HoppingSchedule::<8>::spread(code, Micros::from_millis(60))?;
    /// assert_eq!(ring.t_fire(1, 2), Some(Micros::new(14_460 + 5 * 240)));
    /// # Ok::<(), eeruf_core::hopping::HoppingError>(())
    /// ```
    pub const fn spread(code: HoppingCode, period: Micros) -> Result<Self, HoppingError> {
        let mut lags = [Micros::ZERO; K];
        let room = period.saturating_sub(code.width()).as_micros() as u64;
        let sensors = code.sensors() as u64;
        let mut sensor = 0;
        while sensor < K && sensor < code.sensors() {
            lags[sensor] = Micros::new((sensor as u64 * room / sensors) as u32);
            sensor += 1;
        }
        Self::new(code, period, lags)
    }

    /// Proportional scaling of the period and the lags, each rounded to the nearest microsecond. The code stays, so a
    /// ring may [change](crate::Ring::change_hopping) to it. With `num` no less than `den` it keeps every interval,
    /// window, shared line and group that the schedule keeps; else [`verify`](Self::verify) the result.
    ///
    /// # Errors
    /// As for [`HoppingSchedule::new`]; [`HoppingError::Period`] for a `den` of 0.
    pub const fn scaled(&self, num: u32, den: u32) -> Result<Self, HoppingError> {
        if den == 0 {
            return Err(HoppingError::Period { period: Micros::MAX, least: self.code.two_ages() });
        }
        let mut lags = self.lags;
        let mut sensor = 0;
        while sensor < K {
            lags[sensor] = scale(lags[sensor], num, den);
            sensor += 1;
        }
        Self::new(self.code, scale(self.period, num, den), lags)
    }

    /// The firing times as a table of `M` phases, for [`PhaseTable`](crate::phases::PhaseTable): of the code's first
    /// `M`, or from the first again if there are more. Sensors that are not there fire at once.
    pub const fn table<const M: usize>(&self) -> [[Micros; K]; M] {
        self.table_together(&[])
    }

    /// As [`table`](Self::table), where these sets of sensors fire together, bit x for sensor x: they share the waits
    /// of the first of them, and must share its lag.
    pub const fn table_together<const M: usize>(&self, together: &[u64]) -> [[Micros; K]; M] {
        let mut table = [[Micros::ZERO; K]; M];
        let mut phase = 0;
        while phase < M {
            let mut sensor = 0;
            while sensor < self.code.sensors() && sensor < K {
                let (number, turn) =
                    ((phase % self.code.phases() as usize) as u8, self.turn(first_of(together, sensor)));
                table[phase][sensor] = self.lags[sensor].saturating_add(self.code.wait(turn, number));
                sensor += 1;
            }
            phase += 1;
        }
        table
    }

    /// Checks the schedule: every limit, pair and phase. Sensors that must fire together share the waits of the first
    /// of them. That crosstalk moves by the step is proven (`docs/explanation/theory.md`, section 9.1) and not worked
    /// out again where the period is at least twice the code and a step, so that this is cheap enough for the compiler;
    /// [`PhaseTable::verify`] works it out.
    pub const fn verify<'r>(&self, requirements: &'r Requirements<'r>) -> Verification<'r, K> {
        let rows = self.table_together::<{ HoppingCode::MAX_PHASES as usize }>(requirements.together());
        let (cycle, _) = rows.split_at(self.code.phases() as usize);
        let table = PhaseTable::new(self.period, cycle).with_sensors(self.code.sensors());
        // All pairs and phases are alike.
        let step = Least { value: self.code.step(), sensors: (0, 1), phases: (Phase(0), Phase(1)), ages: (0, 0) };
        let is_proven =
            self.period.as_micros() >= self.code.two_ages().as_micros() && !self.hears_the_same(requirements);
        table.verify_with(if is_proven { Some(step) } else { None }, requirements)
    }

    /// The limits of each sensor for a [`HoppingPlan`](super::HoppingPlan), if the schedule meets the requirements.
    ///
    /// # Errors
    /// The first [`Violation`] if it does not.
    pub const fn limits(&self, requirements: &Requirements<'_>) -> Result<EachSensor<K>, Violation> {
        if let Some(violation) = self.verify(requirements).first_violation() {
            return Err(violation);
        }
        let sensors = self.code.sensors();
        let (t_delta, min_interval, window) = requirements.strictest(sensors);
        let audible = match requirements.audible {
            Some(audible) => audible,
            None => requirements.window,
        };
        let separation = self.code.step();
        let verified_for = VerifiedFor { t_delta, min_interval, window, separation, path_change: None, audible };
        let mut limits = [SensorLimits { t_delta: Micros::ZERO, window: Micros::ZERO }; K];
        let mut x = 0;
        while x < sensors && x < K {
            limits[x] = SensorLimits { t_delta: requirements.t_delta_of(x), window: requirements.window_of(x) };
            x += 1;
        }
        Ok(EachSensor::new(verified_for, sensors, limits, Micros::ZERO, requirements.together()))
    }

    /// Returns true if the sound of the sensor that fires before another, from the period before, is still audible:
    /// with Welch's sequence it moves as the other does.
    const fn hears_the_same(&self, requirements: &Requirements<'_>) -> bool {
        let reach = match requirements.audible {
            Some(audible) => audible,
            None => requirements.window,
        };
        let (dies, period) = (reach.saturating_sub(requirements.blanking).as_micros(), self.period.as_micros());
        self.code.is_welch() && (dies > period || requirements.window.as_micros() > period)
    }

    /// The code.
    pub const fn code(&self) -> &HoppingCode {
        &self.code
    }

    /// `T_p`.
    pub const fn period(&self) -> Micros {
        self.period
    }

    /// The longest lag that leaves room for the code.
    pub const fn longest_lag(&self) -> Micros {
        longest_lag(&self.code, self.period)
    }

    /// The lag of a sensor; `None` for one out of range.
    pub const fn t_lag(&self, sensor: usize) -> Option<Micros> {
        if sensor < self.code.sensors() && sensor < K { Some(self.lags[sensor]) } else { None }
    }

    /// When a sensor fires in a phase, after the start of the period; phases are counted modulo the code's. `None` for
    /// a sensor out of range.
    pub const fn t_fire(&self, phase: u8, sensor: usize) -> Option<Micros> {
        match self.t_lag(sensor) {
            Some(lag) => Some(lag.saturating_add(self.code.wait(self.turn(sensor), phase))),
            None => None,
        }
    }

    /// The place of a sensor in the code: in the order of lags for Welch's sequence, so that only the sensor that fires
    /// before it, in the period before, moves as it does.
    pub(crate) const fn turn(&self, sensor: usize) -> usize {
        if !self.code.is_welch() || sensor >= K {
            return sensor;
        }
        let (mut turn, mut other) = (0, 0);
        while other < self.code.sensors() && other < K {
            let (lag, own) = (self.lags[other].as_micros(), self.lags[sensor].as_micros());
            if lag < own || (lag == own && other < sensor) {
                turn += 1;
            }
            other += 1;
        }
        turn
    }
}

/// The first sensor of the set that a sensor fires together with, or itself.
const fn first_of(together: &[u64], sensor: usize) -> usize {
    let mut at = 0;
    while at < together.len() {
        if sensor < MAX_SENSORS && together[at] >> sensor & 1 == 1 {
            return together[at].trailing_zeros() as usize;
        }
        at += 1;
    }
    sensor
}

/// The longest lag that leaves room for a code in a period.
pub(super) const fn longest_lag(code: &HoppingCode, period: Micros) -> Micros {
    period.saturating_sub(code.width()).saturating_sub(Micros::new(1))
}
