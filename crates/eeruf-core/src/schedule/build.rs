//! Constructors of [`Schedule`] from raw numbers, or from another schedule by scaling; each checks its numbers once.

use super::{Firings, MAX_PERIOD, MAX_PHASES, MAX_SENSORS, Phase, Schedule, ScheduleError};
use crate::time::Micros;

impl<const K: usize, const M: usize> Schedule<K, M> {
    /// The paper's form: lags that do not change, and one set of waits for each phase.
    ///
    /// # Errors
    /// [`ScheduleError`] unless 1 to 64 sensors fire in 1 to 8 phases, each inside its period: `t_lag + t_wait <
    /// period`.
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

    /// Makes a schedule like [`Schedule::new`], for a number of sensors known only at run time: `t_lag.len()`, at most
    /// the capacity `K`.
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
        let (sensors, min_refire, verified_for) = (sensors as u8, Micros::MAX, None);
        let mut schedule = Self { period, sensors, t_lag, t_wait, min_refire, firings, verified_for };
        schedule.min_refire = schedule.shortest_refire();
        Ok(schedule)
    }
}

const fn scale(time: Micros, num: u32, den: u32) -> Micros {
    let scaled = (time.as_micros() as u64 * num as u64 + den as u64 / 2) / den as u64;
    Micros::new(if scaled > u32::MAX as u64 { u32::MAX } else { scaled as u32 })
}
