//! [`VerifiedSchedule`]: proof that a schedule meets its requirements.

use core::ops::Deref;

use crate::own_limits::{EachSensor, SensorLimits};
use crate::requirements::{Criterion, Requirements};
use crate::schedule::{Schedule, VerifiedFor};
use crate::time::{Micros, longer, shorter};
use crate::verify::{Violation, stale_separation};

/// A [`Schedule`] with the requirements that it was verified for: [`schedule!`](crate::schedule!) makes it at compile
/// time, [`Schedule::verified`] at run time. It can be used wherever a schedule can.
///
/// `L` is [`EachSensor`] if sensors have windows and `t_delta`s of their own, which a [`Ring`](crate::Ring) then keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VerifiedSchedule<const K: usize, const M: usize = 2, L = ()> {
    schedule: Schedule<K, M>,
    own_limits: L,
}

impl<const K: usize, const M: usize, L> VerifiedSchedule<K, M, L> {
    /// The schedule. It remembers its requirements: a ring that changes to it or restarts keeps its intervals.
    pub const fn schedule(&self) -> &Schedule<K, M> {
        &self.schedule
    }

    /// The plain schedule, for code that stores both kinds. It remembers its requirements.
    pub const fn into_schedule(self) -> Schedule<K, M>
    where
        L: Copy,
    {
        self.schedule
    }

    /// The sensors' own limits.
    pub const fn own_limits(&self) -> &L {
        &self.own_limits
    }

    /// The requirements that it was verified for; if sensors have their own limits, the values that all allow.
    pub const fn verified_for(&self) -> VerifiedFor {
        match self.schedule.verified_for() {
            Some(verified_for) => *verified_for,
            // Unreachable: a verified schedule has requirements.
            None => VerifiedFor::NOTHING,
        }
    }

    /// The `t_delta` that (13a), (13b) were verified for.
    #[doc(alias = "T_delta")]
    pub const fn t_delta(&self) -> Micros {
        self.verified_for().t_delta
    }

    /// The listening window that it was verified for; if none was asked for, the longest that it allows.
    #[doc(alias = "T_wind")]
    pub const fn window(&self) -> Micros {
        self.verified_for().window
    }
}

impl<const K: usize, const M: usize> VerifiedSchedule<K, M, EachSensor<K>> {
    /// The window and the `t_delta` of a sensor; `None` if it is out of range.
    pub fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.own_limits.of(sensor).filter(|_| usize::from(sensor) < self.sensors())
    }
}

impl<const K: usize, const M: usize, L> Deref for VerifiedSchedule<K, M, L> {
    type Target = Schedule<K, M>;

    fn deref(&self) -> &Schedule<K, M> {
        &self.schedule
    }
}

/// Serialization as a schedule. It cannot be deserialized as verified: read a [`Schedule`] and verify it.
#[cfg(feature = "serde")]
impl<const K: usize, const M: usize, L> serde::Serialize for VerifiedSchedule<K, M, L> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.schedule.serialize(serializer)
    }
}

impl<const K: usize> Schedule<K> {
    /// Verifies the schedule, and returns it with that proof. If sensors differ, it has the smallest `t_delta` and
    /// window for all; [`verified_each`](Self::verified_each) keeps each sensor's own.
    ///
    /// # Errors
    /// The first [`Violation`] if the requirements are not met.
    ///
    /// ```
    /// use eeruf_core::{Micros, Requirements, tables::TABLE_I_D};
    /// let asked = Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) };
    /// let verified = TABLE_I_D.verified(&asked)?;
    /// assert_eq!((verified.t_delta(), verified.period()), (Micros::new(999), Micros::from_millis(100)));
    /// assert!(TABLE_I_D.verified(&Requirements::new(Micros::new(1000))).is_err());
    /// # Ok::<(), eeruf_core::conditions::Violation>(())
    /// ```
    pub const fn verified(&self, requirements: &Requirements<'_>) -> Result<VerifiedSchedule<K>, Violation> {
        let schedule = self;
        if let Some(violation) = self.verify(requirements).first_violation() {
            return Err(violation);
        }
        let min_refire = schedule.min_refire();
        let Requirements { mut t_delta, mut min_interval, mut window, stale_echo, .. } = *requirements;
        if requirements.uneven.is_some() {
            (t_delta, min_interval, window) = requirements.strictest(schedule.sensors());
        }
        let window = if window.as_micros() == 0 { min_refire } else { window };
        // Under either criterion crosstalk moves by |d_x - d_y| or |d_x + d_y|. Pair by pair, since
        // `Schedule::separation` sorts, and would leave paths to a panic in a firmware image.
        let mut separation = Micros::MAX;
        let mut x = 0;
        while x < schedule.sensors() {
            let mut y = 0;
            while y < x {
                let (even, odd) = schedule.left_sides(Criterion::Exact, x, y);
                if !requirements.fire_together(x, y) {
                    separation = shorter(separation, shorter(even, odd));
                }
                y += 1;
            }
            if stale_echo {
                separation = shorter(separation, stale_separation(schedule, x));
            }
            x += 1;
        }
        let periods = if stale_echo { 2 } else { 1 };
        let longest = Micros::new(periods * schedule.period().as_micros());
        let audible = match requirements.audible {
            Some(asked) if asked.as_micros() > 0 => shorter(asked, longest),
            _ => longest,
        };
        let path_change = match requirements.criterion {
            Criterion::Paper | Criterion::Exact => None,
            // Crosstalk moves by more than `T_delta` plus this change.
            Criterion::Margin(margin) => Some(margin.saturating_sub(Micros::new(1))),
        };
        let verified_for = VerifiedFor { t_delta, min_interval, window, separation, path_change, audible };
        Ok(VerifiedSchedule { schedule: schedule.with_verified_for(verified_for), own_limits: () })
    }

    /// Verifies the schedule, and returns it with that proof and the limits of each sensor.
    ///
    /// # Errors
    /// The first [`Violation`] if the requirements are not met.
    pub const fn verified_each(
        &self,
        requirements: &Requirements<'_>,
    ) -> Result<VerifiedSchedule<K, 2, EachSensor<K>>, Violation> {
        let schedule = self;
        let verified = match self.verified(requirements) {
            Ok(verified) => verified,
            Err(violation) => return Err(violation),
        };
        let mut limits = [SensorLimits { t_delta: Micros::ZERO, window: Micros::ZERO }; K];
        let mut spare = Micros::MAX;
        let mut x = 0;
        while x < schedule.sensors() && x < K {
            let asked = requirements.window_of(x);
            let window = if asked.as_micros() == 0 { schedule.min_refire() } else { asked };
            limits[x] = SensorLimits { t_delta: requirements.t_delta_of(x), window };
            let mut y = 0;
            while y <= x {
                let (even, odd) = schedule.left_sides(Criterion::Exact, x, y);
                // A sensor's own stale echo moves by twice its |d|, if it is to be rejected.
                let moves = if x == y { odd } else { shorter(even, odd) };
                let larger = longer(requirements.t_delta_of(x), requirements.t_delta_of(y));
                if !requirements.fire_together(x, y) && (x != y || requirements.stale_echo) {
                    spare = shorter(spare, moves.saturating_sub(larger));
                }
                y += 1;
            }
            x += 1;
        }
        let (sensors, together) = (schedule.sensors(), requirements.together());
        let own_limits = EachSensor::new(verified.verified_for(), sensors, limits, spare, together);
        Ok(VerifiedSchedule { schedule: verified.schedule, own_limits })
    }
}
