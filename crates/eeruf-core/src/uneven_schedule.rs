//! [`UnevenSchedule`]: a verified schedule with the window and the `t_delta` of each sensor.

use core::ops::Deref;

use crate::conditions::{Criterion, Requirements};
use crate::schedule::{Schedule, ScheduleError, VerifiedFor};
use crate::time::{Micros, longer, shorter};
use crate::verified::VerifiedSchedule;
use crate::verify::{Verification, Violation};

/// For how long one sensor may listen, and what may count as the same echo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SensorLimits {
    /// `T_delta` of the sensor, for which (13a), (13b) hold.
    pub t_delta: Micros,
    /// `T_wind` of the sensor; the time until it fires again where no window was asked for.
    pub window: Micros,
}

/// A [`VerifiedSchedule`] for sensors that are not all alike, with the window and the `t_delta` of each:
/// [`uneven_schedule!`](crate::uneven_schedule!) makes it when the program is compiled,
/// [`Verification::verified_uneven`] at run time. [`Ring::uneven`](crate::Ring::uneven) runs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct UnevenSchedule<const K: usize> {
    schedule: VerifiedSchedule<K>,
    /// The largest `t_delta` and window, and a separation that is as much more than the `t_delta` as the pair with the
    /// least to spare has.
    most: VerifiedFor,
    each: [SensorLimits; K],
}

impl<const K: usize> UnevenSchedule<K> {
    /// The schedule, verified for what all sensors allow.
    pub const fn verified(&self) -> &VerifiedSchedule<K> {
        &self.schedule
    }

    /// The window and the `t_delta` of a sensor; `None` for one that is not there.
    pub fn limits_of(&self, sensor: usize) -> Option<SensorLimits> {
        self.each.get(sensor).copied().filter(|_| sensor < self.schedule.sensors())
    }

    /// The window and the `t_delta` of each sensor; places beyond the last sensor say nothing.
    #[inline]
    pub(crate) const fn each(&self) -> &[SensorLimits; K] {
        &self.each
    }

    pub(crate) const fn most(&self) -> &VerifiedFor {
        &self.most
    }
}

impl<const K: usize> Deref for UnevenSchedule<K> {
    type Target = VerifiedSchedule<K>;

    fn deref(&self) -> &VerifiedSchedule<K> {
        &self.schedule
    }
}

impl<const K: usize> Verification<'_, K> {
    /// The schedule with the proof that it meets the requirements, and with what each sensor allows.
    ///
    /// # Errors
    /// The first [`Violation`] if it does not.
    pub const fn verified_uneven(&self) -> Result<UnevenSchedule<K>, Violation> {
        let verified = match self.verified() {
            Ok(verified) => verified,
            Err(violation) => return Err(violation),
        };
        let (schedule, requirements) = (self.schedule(), self.requirements());
        let mut each = [SensorLimits { t_delta: Micros::ZERO, window: Micros::ZERO }; K];
        let (mut t_delta, mut window, mut spare) = (Micros::ZERO, Micros::ZERO, Micros::MAX);
        let mut x = 0;
        while x < schedule.sensors() && x < K {
            let asked = requirements.window_of(x);
            let own = if asked.as_micros() == 0 { schedule.min_refire() } else { asked };
            each[x] = SensorLimits { t_delta: requirements.t_delta_of(x), window: own };
            t_delta = longer(t_delta, each[x].t_delta);
            window = longer(window, own);
            let mut y = 0;
            while y <= x {
                let (even, odd) = schedule.left_sides(Criterion::Exact, x, y);
                // Its own stale echoes move by twice its |d|, if they are to be rejected.
                let moves = if x == y { odd } else { shorter(even, odd) };
                let larger = longer(requirements.t_delta_of(x), requirements.t_delta_of(y));
                if !requirements.fire_together(x, y) && (x != y || requirements.stale_echo) {
                    spare = shorter(spare, moves.saturating_sub(larger));
                }
                y += 1;
            }
            x += 1;
        }
        let min_interval = verified.verified_for().min_interval;
        let separation = t_delta.saturating_add(spare);
        let most = VerifiedFor { t_delta, min_interval, window, separation };
        Ok(UnevenSchedule { schedule: verified, most, each })
    }
}

/// An [`UnevenSchedule`] that is verified while the program is compiled, as [`schedule!`](crate::schedule!) does for
/// sensors that are all alike; `eeruf design --emit rust` writes the whole call.
///
/// ```
/// use eeruf_core::{Layout, Micros, Requirements, Uneven, UnevenSchedule, uneven_schedule};
///
/// const CORNER: UnevenSchedule<2> = uneven_schedule! {
///     period_us: 60_000,
///     t_fire_a_us: [0, 20_000],
///     t_fire_b_us: [0, 23_000],
///     meets: Requirements {
///         layout: Layout::Line(2),
///         min_interval: Micros::from_millis(15),
///         uneven: Some(Uneven {
///             window: &[Micros::from_millis(50), Micros::from_millis(12)],
///             t_delta: &[Micros::new(999), Micros::new(1_400)],
///             ..Uneven::NONE
///         }),
///         ..Requirements::new(Micros::new(999))
///     },
/// };
/// assert_eq!(CORNER.limits_of(1).unwrap().window, Micros::from_millis(12));
/// ```
#[macro_export]
macro_rules! uneven_schedule {
    (
        period_us: $period:expr,
        t_fire_a_us: $t_fire_a:expr,
        t_fire_b_us: $t_fire_b:expr,
        meets: $requirements:expr $(,)?
    ) => {
        const {
            $crate::__checked_uneven(
                $crate::Schedule::from_firing(
                    $crate::Micros::new($period),
                    [$crate::__micros($t_fire_a), $crate::__micros($t_fire_b)],
                ),
                &$requirements,
            )
        }
    };
}

/// For `uneven_schedule!`, which evaluates it when the program is compiled: its panics are compile errors.
#[doc(hidden)]
pub const fn __checked_uneven<const K: usize>(
    schedule: Result<Schedule<K>, ScheduleError>,
    requirements: &Requirements<'_>,
) -> UnevenSchedule<K> {
    let schedule = *crate::__checked(schedule, requirements).schedule();
    match schedule.verify(requirements).verified_uneven() {
        Ok(uneven) => uneven,
        // Never: it has just been verified.
        Err(_) => panic!("a schedule that does not meet its requirements"),
    }
}
