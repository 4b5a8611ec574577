//! [`Schedule`]: when each sensor fires, checked once so that everything else may rely on it.
//!
//! This module holds the table, its limits and its errors; it depends only on [`time`](crate::time).

mod build;
mod error;
mod limits;
mod refire;
#[cfg(feature = "serde")]
mod serde;
mod verified_for;

use core::hash::{Hash, Hasher};

use crate::time::Micros;

pub use error::ScheduleError;
pub use limits::{MAX_PERIOD, MAX_PHASES, MAX_SENSORS, Phase};
pub use verified_for::VerifiedFor;

/// Firing times: each sensor fires once per period, at `T_fire = T_lag + T_wait`, where `T_wait` changes with the phase
/// (Sec. 3.1).
///
/// `K` is the number of sensors of a table written as arrays. For tables whose size is known only at run time it is the
/// capacity, and [`sensors`](Self::sensors) is the number (see [`from_slices`](Self::from_slices)). `M` is the number
/// of phases: two in the paper, one for the conventional method with constant waits.
///
/// A `Schedule` is proof of a check: 1 to 64 sensors, each firing inside its period, in every phase. It does not prove
/// that its waits meet Eqs. (13a), (13b): see [`verify`](Schedule::verify), or [`schedule!`](crate::schedule!) for a
/// table that is checked when the firmware is compiled.
///
/// ```
/// use eeruf_core::{Micros, Phase, Schedule};
/// let ms = |ms: [u32; 3]| ms.map(Micros::from_millis);
/// let ring = Schedule::new(Micros::from_millis(60), ms([0, 20, 40]), [ms([9, 9, 9]), ms([7, 5, 3])])?;
/// assert_eq!(ring.t_fire(Phase::B, 1), Some(Micros::from_millis(25)));
/// # Ok::<(), eeruf_core::ScheduleError>(())
/// ```
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// In this order: a Cortex-M0 reaches only the first 124 bytes of a structure in one instruction.
#[repr(C)]
pub struct Schedule<const K: usize, const M: usize = 2> {
    firings: [Firings<K>; M],
    period: Micros,
    /// The shortest time between two firings of one sensor. Stored, since computing it takes time and stack on a
    /// target.
    min_refire: Micros,
    t_lag: [Micros; K],
    t_wait: [[Micros; K]; M],
    sensors: u8,
    /// The requirements of a [`VerifiedSchedule`](crate::VerifiedSchedule), also in copies of it; else `None`.
    verified_for: Option<VerifiedFor>,
}

/// The firings of one phase in the order in which they come, so that a plan need not look for the next one.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
struct Firings<const K: usize> {
    /// The sensors by firing time; then 255.
    order: [u8; K],
    /// Time from the previous firing, or from the start of the period, to each firing; then `after_last`.
    gap: [Micros; K],
    /// Time from the last firing to the end of the period.
    after_last: Micros,
}

/// Equality of lags, waits and periods, whether or not the schedules were verified.
impl<const K: usize, const M: usize> PartialEq for Schedule<K, M> {
    fn eq(&self, other: &Self) -> bool {
        (self.period, self.sensors, self.t_lag, self.t_wait) == (other.period, other.sensors, other.t_lag, other.t_wait)
    }
}

impl<const K: usize, const M: usize> Eq for Schedule<K, M> {}

impl<const K: usize, const M: usize> Hash for Schedule<K, M> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.period, self.sensors, self.t_lag, self.t_wait).hash(state);
    }
}

impl<const K: usize, const M: usize> Schedule<K, M> {
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

    /// `T_fire = T_lag + T_wait` after the start of the period, or `None` for a sensor or phase out of range.
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

    /// The sensor at a place in the firing order of a phase, and the time since the firing before it; beyond the last
    /// place a sensor out of range (`K` or more), and the time from the last firing to the end of the period. Each step
    /// of a plan calls this.
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

    /// Requirements that the schedule was verified for, if any.
    pub(crate) const fn verified_for(&self) -> Option<&VerifiedFor> {
        self.verified_for.as_ref()
    }

    /// Returns true if the schedule comes from a [`VerifiedSchedule`](crate::VerifiedSchedule).
    pub const fn is_verified(&self) -> bool {
        self.verified_for.is_some()
    }

    pub(crate) const fn with_verified_for(self, verified_for: VerifiedFor) -> Self {
        Self { verified_for: Some(verified_for), ..self }
    }

    /// Firing time for indices already known to be in range; the optimiser does not know that `sensors` is at most `K`,
    /// and the check spares a firmware image the code for a panic. Cannot overflow: both terms are at most
    /// `MAX_PERIOD`.
    pub(crate) const fn fire_at(&self, phase: usize, sensor: usize) -> Micros {
        if phase < M && sensor < K {
            Micros::new(self.t_lag[sensor].as_micros() + self.t_wait[phase][sensor].as_micros())
        } else {
            Micros::ZERO
        }
    }
}

/// The part of a table that is in use. It avoids `split_at`, whose panic would stay in a firmware image.
const fn used<T>(table: &[T], sensors: u8) -> &[T] {
    match table.split_at_checked(sensors as usize) {
        Some((used, _)) => used,
        // Unreachable: a schedule has at most `K` sensors.
        None => table,
    }
}

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
    fn each_error_has_a_fixed_text_for_compile_time_checks() {
        let (period, phase, t_fire) = (Micros::ZERO, Phase::A, Micros::ZERO);
        let texts = [
            ScheduleError::Sensors { sensors: 0, capacity: 1 },
            ScheduleError::Phases { phases: 0 },
            ScheduleError::Waits { phase, waits: 0, sensors: 1 },
            ScheduleError::Period { period },
            ScheduleError::Fire { sensor: 0, phase, t_fire, period },
            ScheduleError::Scale { num: 1 },
        ]
        .map(|error| error.as_str());
        let expected = [
            "a schedule has 1 to 64 sensors",
            "a schedule has 1 to 8 phases",
            "each phase needs one wait for each sensor",
            "a period is 1 us to 268 s",
            "each sensor must fire inside its period: t_lag + t_wait < period",
            "a scale needs a denominator above zero",
        ];
        assert_eq!(texts, expected);
    }

    // A table sized at run time reports the same as the table written as arrays.
    #[test]
    fn run_time_table_equals_array_table() {
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
        let together = Schedule::<4>::from_firing(Micros::from_millis(9), [ms([5, 3, 5, 3]), ms([0; 4])]).unwrap();
        assert_eq!(together.firing_order(Phase::A), [1, 3, 0, 2], "those that fire together keep their order");
        assert_eq!(together.firing_order(Phase::B), [0, 1, 2, 3]);
    }

    #[test]
    fn table_i_d_refires_after_76_to_124_ms() {
        assert_eq!(TABLE_I_D.min_refire(), Micros::from_millis(76));
        assert_eq!(TABLE_I_D.max_refire(), Micros::from_millis(124));
        let after = |phase, sensor| TABLE_I_D.refire_after(phase, sensor);
        let known = [(Phase::A, 0), (Phase::B, 0), (Phase::A, 11), (Phase::B, 11)].map(|(phase, x)| after(phase, x));
        assert_eq!(known, [94, 106, 80, 120].map(|refire| Some(Micros::from_millis(refire))));
        assert_eq!([after(Phase::A, 12), after(Phase(2), 0)], [None; 2]);
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
        let two = Schedule::<2>::from_firing(Micros::new(100), [[7, 8].map(Micros::new); 2]).unwrap();
        assert_eq!(two.scaled(1, 5).unwrap().t_wait(Phase::B), [1, 2].map(Micros::new));
        // Times beyond 32 bits do not wrap to small ones.
        let whole = Schedule::<1>::from_firing(Micros::new(1 << 16), [[Micros::ZERO]; 2]).unwrap();
        assert!(whole.scaled((1 << 16) + 1, 1).is_err());
    }

    #[test]
    fn what_just_fits_is_a_schedule_and_one_more_is_none() {
        let most = Schedule::<64, 8>::from_firing(MAX_PERIOD, [[MAX_PERIOD.saturating_sub(Micros::new(1)); 64]; 8]);
        assert_eq!(most.map(|most| (most.sensors(), most.min_refire())), Ok((64, MAX_PERIOD)));
        let long = MAX_PERIOD.saturating_add(Micros::new(1));
        assert_eq!(Schedule::<1>::from_firing(long, [[Micros::ZERO]; 2]), Err(ScheduleError::Period { period: long }));
        let period = Micros::from_millis(9);
        let none = Schedule::<1, 0>::from_firing(period, []);
        assert_eq!(none, Err(ScheduleError::Phases { phases: 0 }));
        let nine = Schedule::<1, 9>::from_firing(period, [[Micros::ZERO]; 9]);
        assert_eq!(nine, Err(ScheduleError::Phases { phases: 9 }));
        let (lags, waits) = ([Micros::ZERO; 65], [&[Micros::ZERO; 65][..]; 2]);
        let refused = |capacity| Some(ScheduleError::Sensors { sensors: 65, capacity });
        assert_eq!(Schedule::<100>::from_slices(period, &lags, waits).err(), refused(64));
        assert_eq!(Schedule::<64>::from_slices(period, &lags, waits).err(), refused(64));
        assert_eq!(Schedule::<3>::from_slices(period, &lags, waits).err(), refused(3));
        let (lags, waits) = ([Micros::ZERO; 3], [&[Micros::ZERO; 3][..]; 2]);
        assert!(Schedule::<3>::from_slices(period, &lags, waits).is_ok());
    }

    #[test]
    fn the_fastest_motion_stops_at_the_largest_number() {
        let short = Schedule::<1>::from_firing(Micros::new(1), [[Micros::ZERO]; 2]).unwrap();
        assert_eq!(short.max_speed_mm_s(Micros::new(3), u32::MAX), u32::MAX);
        assert_eq!(short.max_speed_mm_s(Micros::new(2), u32::MAX), u32::MAX);
        assert_eq!(short.max_speed_mm_s(Micros::new(1), u32::MAX), u32::MAX / 2);
    }
}
