//! [`Schedule`]: when each sensor fires, checked once so that everything else may rely on it.

use core::fmt;

use crate::time::Micros;

/// The most sensors one schedule can hold.
pub const MAX_SENSORS: usize = 64;
/// The most phases one schedule can have.
pub const MAX_PHASES: usize = 8;
/// The longest period: 2^28 us (268 s), so that a cycle of [`MAX_PHASES`] periods never outruns a wrapping clock.
pub const MAX_PERIOD: Micros = Micros::new(1 << 28);

/// One of the phases of a schedule, counted from 0 and printed `a`, `b`, ...
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Phase(pub u8);

impl Phase {
    /// The first phase, in which the paper's waits are `T_wait,a`.
    pub const A: Self = Self(0);
    /// The second phase, in which the paper's waits are `T_wait,b`.
    pub const B: Self = Self(1);
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", char::from(b'a'.saturating_add(self.0)))
    }
}

/// When each sensor fires: once per period, at `T_fire = T_lag + T_wait`, where `T_wait` changes with the phase (Sec. 3.1).
///
/// `K` is the number of sensors a table written as arrays has; for tables whose size is known only at run time it is the
/// capacity, and [`sensors`](Self::sensors) counts (see [`from_slices`](Self::from_slices)). `M` is the number of phases:
/// two in the paper, one for the conventional method with constant waits.
///
/// A `Schedule` is proof of a check: 1 to 64 sensors, each firing inside its period, in every phase. That its waits
/// meet Eqs. (13a), (13b) is another matter: see [`verify`](Schedule::verify), or [`schedule!`](crate::schedule!) for a
/// table that is checked when the firmware is compiled.
///
/// ```
/// use eeruf_core::{Micros, Phase, Schedule};
/// let ms = |ms: [u32; 3]| ms.map(Micros::from_millis);
/// let ring = Schedule::new(Micros::from_millis(60), ms([0, 20, 40]), [ms([9, 9, 9]), ms([7, 5, 3])])?;
/// assert_eq!(ring.t_fire(Phase::B, 1), Some(Micros::from_millis(25)));
/// # Ok::<(), eeruf_core::ScheduleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
// In this order: a Cortex-M0 reaches only the first 124 bytes of a structure in one instruction.
#[repr(C)]
pub struct Schedule<const K: usize, const M: usize = 2> {
    firings: [Firings<K>; M],
    period: Micros,
    /// The shortest time between two firings of one sensor. Kept, since working it out takes time and stack on a target.
    min_refire: Micros,
    t_lag: [Micros; K],
    t_wait: [[Micros; K]; M],
    sensors: u8,
}

/// The firings of one phase in the order in which they come, so that the scheduler need not look for the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(C)]
struct Firings<const K: usize> {
    /// The sensors by firing time; then nobody (255).
    order: [u8; K],
    /// How long each fires after the one before it, the first after the start of the period; then `after_last`.
    gap: [Micros; K],
    /// From the last firing to the end of the period.
    after_last: Micros,
}

impl<const K: usize, const M: usize> Schedule<K, M> {
    /// The paper's form: lags that do not change, and one set of waits for each phase.
    ///
    /// # Errors
    /// [`ScheduleError`] unless 1 to 64 sensors fire in 1 to 8 phases, each inside its period: `t_lag + t_wait < period`.
    pub const fn new(period: Micros, t_lag: [Micros; K], t_wait: [[Micros; K]; M]) -> Result<Self, ScheduleError> {
        Self::with_sensors(period, K, t_lag, t_wait)
    }

    /// The free form: the firing times of each phase. The lags are zero, so that `t_wait` is `t_fire`.
    ///
    /// # Errors
    /// As for [`Schedule::new`].
    pub const fn from_firing(period: Micros, t_fire: [[Micros; K]; M]) -> Result<Self, ScheduleError> {
        Self::new(period, [Micros::ZERO; K], t_fire)
    }

    /// As [`Schedule::new`], for a number of sensors known only at run time: `t_lag.len()`, at most the capacity `K`.
    ///
    /// # Errors
    /// As for [`Schedule::new`], and if the slices differ in length.
    pub const fn from_slices(period: Micros, t_lag: &[Micros], t_wait: [&[Micros]; M]) -> Result<Self, ScheduleError> {
        let sensors = t_lag.len();
        if sensors > K {
            return Err(ScheduleError::Sensors { sensors, capacity: if K < MAX_SENSORS { K } else { MAX_SENSORS } });
        }
        let mut lags = [Micros::ZERO; K];
        let mut waits = [[Micros::ZERO; K]; M];
        let mut x = 0;
        while x < sensors {
            lags[x] = t_lag[x];
            x += 1;
        }
        let mut phase = 0;
        while phase < M {
            if t_wait[phase].len() != sensors {
                return Err(ScheduleError::Waits { phase: Phase(phase as u8), waits: t_wait[phase].len(), sensors });
            }
            let mut x = 0;
            while x < sensors {
                waits[phase][x] = t_wait[phase][x];
                x += 1;
            }
            phase += 1;
        }
        Self::with_sensors(period, sensors, lags, waits)
    }

    const fn with_sensors(
        period: Micros,
        sensors: usize,
        t_lag: [Micros; K],
        t_wait: [[Micros; K]; M],
    ) -> Result<Self, ScheduleError> {
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(ScheduleError::Sensors { sensors, capacity: MAX_SENSORS });
        }
        if M == 0 || M > MAX_PHASES {
            return Err(ScheduleError::Phases { phases: M });
        }
        if period.as_micros() == 0 || period.as_micros() > MAX_PERIOD.as_micros() {
            return Err(ScheduleError::Period { period });
        }
        let nobody = Firings { after_last: period, gap: [Micros::ZERO; K], order: [u8::MAX; K] };
        let mut firings = [nobody; M];
        let mut phase = 0;
        while phase < M {
            let Firings { after_last, gap, order } = &mut firings[phase];
            // Firing times in order, until they become gaps.
            let times = gap;
            let mut x = 0;
            while x < sensors {
                let t_fire = t_lag[x].saturating_add(t_wait[phase][x]);
                if t_fire.as_micros() >= period.as_micros() {
                    return Err(ScheduleError::Fire { sensor: x as u8, phase: Phase(phase as u8), t_fire, period });
                }
                // Insertion sort by firing time; sensors that fire together keep their order.
                order[x] = x as u8;
                times[x] = t_fire;
                let mut at = x;
                while at > 0 && times[at - 1].as_micros() > t_fire.as_micros() {
                    order.swap(at, at - 1);
                    times.swap(at, at - 1);
                    at -= 1;
                }
                x += 1;
            }
            let mut last = Micros::ZERO;
            let mut at = 0;
            while at < sensors {
                let t_fire = times[at];
                times[at] = t_fire.abs_diff(last);
                last = t_fire;
                at += 1;
            }
            *after_last = period.abs_diff(last);
            if sensors < K {
                times[sensors] = *after_last;
            }
            phase += 1;
        }
        let mut schedule = Self { period, sensors: sensors as u8, t_lag, t_wait, min_refire: Micros::MAX, firings };
        schedule.min_refire = schedule.shortest_refire();
        Ok(schedule)
    }

    /// `T_p`: every sensor fires once in each period.
    #[doc(alias = "T_p")]
    pub const fn period(&self) -> Micros {
        self.period
    }

    /// The number of sensors, 1 to 64.
    pub const fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// The number of phases, 1 to 8.
    pub const fn phases(&self) -> usize {
        M
    }

    /// `T_lag` of each sensor.
    #[doc(alias = "T_lag")]
    pub const fn t_lag(&self) -> &[Micros] {
        used(&self.t_lag, self.sensors)
    }

    /// `T_wait` of each sensor in a phase; empty for a phase the schedule does not have.
    #[doc(alias = "T_wait")]
    pub const fn t_wait(&self, phase: Phase) -> &[Micros] {
        if (phase.0 as usize) < M { used(&self.t_wait[phase.0 as usize], self.sensors) } else { &[] }
    }

    /// `T_fire = T_lag + T_wait` after the start of the period, or `None` for a sensor or phase that is not there.
    #[doc(alias = "T_fire")]
    pub const fn t_fire(&self, phase: Phase, sensor: usize) -> Option<Micros> {
        if sensor < self.sensors as usize && (phase.0 as usize) < M {
            Some(self.fire_at(phase.0 as usize, sensor))
        } else {
            None
        }
    }

    /// The sensors of a phase in the order in which they fire; empty for a phase the schedule does not have.
    pub const fn firing_order(&self, phase: Phase) -> &[u8] {
        if (phase.0 as usize) < M { used(&self.firings[phase.0 as usize].order, self.sensors) } else { &[] }
    }

    /// The sensor at a place in the firing order of a phase, and how long it fires after the one before it; beyond the
    /// last place a sensor that is not there (`K` or more), and the time from the last firing to the end of the period. Each
    /// step of the scheduler asks.
    #[inline]
    pub(crate) const fn firing(&self, phase: u8, place: u8) -> (u8, Micros) {
        if phase as usize >= M {
            return (u8::MAX, self.period);
        }
        let firings = &self.firings[phase as usize];
        if (place as usize) < K {
            (firings.order[place as usize], firings.gap[place as usize])
        } else {
            (place, firings.after_last)
        }
    }

    /// From a sensor's firing in a phase to its next one, `T_p - d` or `T_p + d` with two phases: the `dt` over which a
    /// good reading changes by `2 v dt / c`. `None` for a sensor or phase that is not there.
    pub const fn refire_after(&self, phase: Phase, sensor: usize) -> Option<Micros> {
        if sensor < self.sensors as usize && (phase.0 as usize) < M {
            Some(self.refire(phase.0 as usize, sensor))
        } else {
            None
        }
    }

    /// The shortest time between two firings of one sensor: `T_p - max |d|` with two phases. No listening window may be
    /// longer.
    pub const fn min_refire(&self) -> Micros {
        self.min_refire
    }

    const fn shortest_refire(&self) -> Micros {
        let mut least = Micros::MAX;
        let mut x = 0;
        while x < self.sensors as usize {
            let mut phase = 0;
            while phase < M {
                let refire = self.refire(phase, x);
                if refire.as_micros() < least.as_micros() {
                    least = refire;
                }
                phase += 1;
            }
            x += 1;
        }
        least
    }

    /// The longest time between two firings of one sensor: `T_p + max |d|` with two phases.
    pub const fn max_refire(&self) -> Micros {
        let mut most = Micros::ZERO;
        let mut x = 0;
        while x < self.sensors as usize {
            let mut phase = 0;
            while phase < M {
                let refire = self.refire(phase, x);
                if refire.as_micros() > most.as_micros() {
                    most = refire;
                }
                phase += 1;
            }
            x += 1;
        }
        most
    }

    /// The fastest motion, in mm/s, at which a good reading still changes by no more than `t_delta` from one firing to
    /// the next, where sound travels at `c` mm/s: the change is `2 v dt / c` (Sec. 3.1), and `dt` up to
    /// [`max_refire`](Self::max_refire).
    pub const fn max_speed_mm_s(&self, t_delta: Micros, c_mm_s: u32) -> u32 {
        let speed = t_delta.as_micros() as u64 * c_mm_s as u64 / (2 * self.max_refire().as_micros() as u64);
        if speed > u32::MAX as u64 { u32::MAX } else { speed as u32 }
    }

    /// Proportional scaling (Sec. 3.1): every time multiplied by `num / den`, each rounded to the nearest microsecond.
    ///
    /// Separation and smallest interval shrink with the rest, and by up to a few microseconds more through rounding:
    /// [`verify`](Schedule::verify) the result to see what is left of `t_delta`.
    ///
    /// # Errors
    /// [`ScheduleError`] if `den` is zero, or if the scaled times no longer make a schedule.
    pub const fn scaled(&self, num: u32, den: u32) -> Result<Self, ScheduleError> {
        if den == 0 {
            return Err(ScheduleError::Scale { num });
        }
        let period = scale(self.period, num, den);
        let mut t_lag = self.t_lag;
        let mut t_wait = self.t_wait;
        let mut x = 0;
        while x < self.sensors as usize {
            t_lag[x] = scale(t_lag[x], num, den);
            let mut phase = 0;
            while phase < M {
                t_wait[phase][x] = scale(t_wait[phase][x], num, den);
                phase += 1;
            }
            x += 1;
        }
        Self::with_sensors(period, self.sensors as usize, t_lag, t_wait)
    }

    /// For indices already known to be in range; the optimiser does not know that `sensors` is at most `K`, and the check
    /// spares a firmware image the code for a panic. Cannot overflow: both terms are at most `MAX_PERIOD`.
    pub(crate) const fn fire_at(&self, phase: usize, sensor: usize) -> Micros {
        if phase < M && sensor < K {
            Micros::new(self.t_lag[sensor].as_micros() + self.t_wait[phase][sensor].as_micros())
        } else {
            Micros::ZERO
        }
    }

    /// From this sensor's firing in a phase to its next one.
    pub(crate) const fn refire(&self, phase: usize, sensor: usize) -> Micros {
        let next = self.fire_at((phase + 1) % M, sensor).as_micros() + self.period.as_micros();
        Micros::new(next - self.fire_at(phase, sensor).as_micros())
    }
}

/// The part of a table that is in use. Without `split_at`, whose panic would stay in a firmware image.
const fn used<T>(table: &[T], sensors: u8) -> &[T] {
    match table.split_at_checked(sensors as usize) {
        Some((used, _)) => used,
        // Never: a schedule has at most `K` sensors.
        None => table,
    }
}

const fn scale(time: Micros, num: u32, den: u32) -> Micros {
    let scaled = (time.as_micros() as u64 * num as u64 + den as u64 / 2) / den as u64;
    Micros::new(if scaled > u32::MAX as u64 { u32::MAX } else { scaled as u32 })
}

/// Why raw numbers do not make a [`Schedule`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ScheduleError {
    /// No sensors, or more than fit.
    Sensors {
        /// How many were given.
        sensors: usize,
        /// How many fit.
        capacity: usize,
    },
    /// No phase, or more than eight.
    Phases {
        /// How many were given.
        phases: usize,
    },
    /// A phase lists waits for more or fewer sensors than there are lags.
    Waits {
        /// The phase.
        phase: Phase,
        /// How many waits it has.
        waits: usize,
        /// How many sensors there are.
        sensors: usize,
    },
    /// The period is zero or beyond [`MAX_PERIOD`].
    Period {
        /// The period given.
        period: Micros,
    },
    /// A sensor would fire after its period has ended.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase.
        phase: Phase,
        /// `T_lag + T_wait`.
        t_fire: Micros,
        /// The period.
        period: Micros,
    },
    /// A scale with a zero denominator.
    Scale {
        /// Its numerator.
        num: u32,
    },
}

impl ScheduleError {
    /// The kind of error as fixed text, for compile-time checks, which cannot print numbers.
    pub const fn as_str(&self) -> &'static str {
        match self {
            Self::Sensors { .. } => "a schedule has 1 to 64 sensors",
            Self::Phases { .. } => "a schedule has 1 to 8 phases",
            Self::Waits { .. } => "each phase needs one wait for each sensor",
            Self::Period { .. } => "a period is 1 us to 268 s",
            Self::Fire { .. } => "each sensor must fire inside its period: t_lag + t_wait < period",
            Self::Scale { .. } => "a scale needs a denominator above zero",
        }
    }
}

impl fmt::Display for ScheduleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Sensors { sensors, capacity } => write!(f, "{sensors} sensors; expected 1 to {capacity}"),
            Self::Phases { phases } => write!(f, "{phases} phases; expected 1 to {MAX_PHASES}"),
            Self::Waits { phase, waits, sensors } => {
                write!(f, "phase {phase} has {waits} waits; expected one for each of {sensors} sensors")
            }
            Self::Period { period } => write!(f, "a period of {period}; expected 1 us to {MAX_PERIOD}"),
            Self::Fire { sensor, phase, t_fire, period } => write!(
                f,
                "sensor {} fires {t_fire} into phase {phase}; expected less than the period of {period}",
                sensor + 1
            ),
            Self::Scale { num } => write!(f, "a scale of {num}/0; expected a denominator above zero"),
        }
    }
}

impl core::error::Error for ScheduleError {}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::tables::TABLE_I_D;
    use std::string::ToString;

    fn ms<const K: usize>(times: [u32; K]) -> [Micros; K] {
        times.map(Micros::from_millis)
    }

    #[test]
    fn each_error_names_sensor_value_and_what_is_expected() {
        let late = Schedule::new(Micros::from_millis(40), ms([0, 30]), [ms([9, 9]), ms([3, 10])]);
        assert_eq!(
            late.unwrap_err().to_string(),
            "sensor 2 fires 40 ms into phase b; expected less than the period of 40 ms"
        );
        let none = Schedule::<0>::new(Micros::from_millis(40), [], [[], []]);
        assert_eq!(none.unwrap_err().to_string(), "0 sensors; expected 1 to 64");
        let many = Schedule::<65>::from_firing(Micros::from_millis(40), [[Micros::ZERO; 65]; 2]);
        assert_eq!(many.unwrap_err().to_string(), "65 sensors; expected 1 to 64");
        let still = Schedule::<1>::from_firing(Micros::ZERO, [[Micros::ZERO]; 2]);
        assert_eq!(still.unwrap_err().to_string(), "a period of 0 us; expected 1 us to 268435.456 ms");
        let short = Schedule::<4>::from_slices(Micros::from_millis(9), &ms([1, 2]), [&ms([1, 1]), &ms([1])]);
        assert_eq!(short.unwrap_err().to_string(), "phase b has 1 waits; expected one for each of 2 sensors");
        let huge = Schedule::new(Micros::from_millis(9), [Micros::MAX], [[Micros::MAX]; 2]);
        assert!(matches!(huge, Err(ScheduleError::Fire { t_fire: Micros::MAX, .. })));
        assert_eq!(
            TABLE_I_D.scaled(1, 0).unwrap_err().to_string(),
            "a scale of 1/0; expected a denominator above zero"
        );
    }

    #[test]
    fn a_table_of_run_time_size_equals_the_same_table_as_arrays_in_all_it_tells() {
        let lags = ms([0, 20, 40]);
        let (a, b) = (ms([9, 9, 9]), ms([7, 5, 3]));
        let fixed = Schedule::new(Micros::from_millis(60), lags, [a, b]).unwrap();
        let sized = Schedule::<64>::from_slices(Micros::from_millis(60), &lags, [&a, &b]).unwrap();
        assert_eq!(sized.sensors(), 3);
        assert_eq!(sized.t_lag(), fixed.t_lag());
        for phase in [Phase::A, Phase::B, Phase(2)] {
            assert_eq!(sized.t_wait(phase), fixed.t_wait(phase));
            assert_eq!(sized.firing_order(phase), fixed.firing_order(phase));
            assert_eq!(sized.t_fire(phase, 3), None);
        }
        assert_eq!((sized.min_refire(), sized.max_refire()), (fixed.min_refire(), fixed.max_refire()));
    }

    #[test]
    fn the_firing_order_follows_the_firing_times() {
        for phase in [Phase::A, Phase::B] {
            let order = TABLE_I_D.firing_order(phase);
            let times: std::vec::Vec<_> = order.iter().map(|&x| TABLE_I_D.t_fire(phase, x.into())).collect();
            assert!(times.is_sorted());
            let mut all = order.to_vec();
            all.sort_unstable();
            assert!(all.into_iter().eq(0..12));
        }
    }

    #[test]
    fn table_i_d_refires_after_76_to_124_ms() {
        assert_eq!(TABLE_I_D.min_refire(), Micros::from_millis(76));
        assert_eq!(TABLE_I_D.max_refire(), Micros::from_millis(124));
        // Sec. 3.1: 999 us at 343.2 m/s allow 1.38 m/s.
        assert_eq!(TABLE_I_D.max_speed_mm_s(Micros::new(999), 343_200), 1382);
    }

    #[test]
    fn scaling_rounds_each_time_to_the_nearest_microsecond() {
        let scaled = TABLE_I_D.scaled(3, 5).unwrap();
        assert_eq!(scaled.period(), Micros::from_millis(60));
        assert_eq!(scaled.t_wait(Phase::A)[0], Micros::new(14_400));
        assert_eq!(TABLE_I_D.scaled(1, 3).unwrap().t_wait(Phase::B)[9], Micros::new(5333));
        assert!(TABLE_I_D.scaled(0, 5).is_err() && TABLE_I_D.scaled(u32::MAX, 1).is_err());
    }
}
