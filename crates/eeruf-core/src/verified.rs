//! [`VerifiedSchedule`]: proof that a schedule meets its requirements.

use core::ops::Deref;

use crate::conditions::{Criterion, Requirements};
use crate::schedule::{Schedule, VerifiedFor};
use crate::time::{Micros, shorter};
use crate::verify::{Verification, Violation, stale_separation};

/// A [`Schedule`] that was verified, and what for: [`schedule!`](crate::schedule!) makes it when the program is
/// compiled, [`Verification::verified`] at run time. It can be used wherever a schedule can.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(transparent)]
pub struct VerifiedSchedule<const K: usize, const M: usize = 2>(Schedule<K, M>);

impl<const K: usize, const M: usize> VerifiedSchedule<K, M> {
    /// The schedule. It remembers what it was verified for: a ring that changes to it or restarts keeps its intervals.
    pub const fn schedule(&self) -> &Schedule<K, M> {
        &self.0
    }

    /// The schedule by itself, for those who keep schedules of both kinds. It remembers what it was verified for.
    pub const fn into_schedule(self) -> Schedule<K, M> {
        self.0
    }

    /// What it was verified for.
    pub const fn verified_for(&self) -> VerifiedFor {
        match self.0.verified_for() {
            Some(verified_for) => *verified_for,
            // Never: it is made with one.
            None => VerifiedFor::NOTHING,
        }
    }

    /// The `t_delta` that (13a), (13b) were verified for.
    #[doc(alias = "T_delta")]
    pub const fn t_delta(&self) -> Micros {
        self.verified_for().t_delta
    }

    /// The listening window that it was verified for; the longest that it allows where none was asked for.
    #[doc(alias = "T_wind")]
    pub const fn window(&self) -> Micros {
        self.verified_for().window
    }
}

impl<const K: usize, const M: usize> Deref for VerifiedSchedule<K, M> {
    type Target = Schedule<K, M>;

    fn deref(&self) -> &Schedule<K, M> {
        &self.0
    }
}

/// As the schedule. Nothing can be read back as verified: read a [`Schedule`] and verify it.
#[cfg(feature = "serde")]
impl<const K: usize, const M: usize> serde::Serialize for VerifiedSchedule<K, M> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<const K: usize> Verification<'_, K> {
    /// The schedule with the proof that it meets the requirements. Where sensors are not all alike, it holds for all
    /// what every one of them allows: the smallest `t_delta` and window. [`UnevenSchedule`](crate::UnevenSchedule)
    /// holds each one's own.
    ///
    /// # Errors
    /// The first [`Violation`] if it does not.
    ///
    /// ```
    /// use eeruf_core::{Micros, Requirements, tables::TABLE_I_D};
    /// let asked = Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) };
    /// let verified = TABLE_I_D.verify(&asked).verified()?;
    /// assert_eq!((verified.t_delta(), verified.period()), (Micros::new(999), Micros::from_millis(100)));
    /// assert!(TABLE_I_D.verify(&Requirements::new(Micros::new(1000))).verified().is_err());
    /// # Ok::<(), eeruf_core::Violation>(())
    /// ```
    pub const fn verified(&self) -> Result<VerifiedSchedule<K>, Violation> {
        let (schedule, requirements) = (self.schedule(), self.requirements());
        if let Some(violation) = self.violations().advance() {
            return Err(violation);
        }
        let min_refire = schedule.min_refire();
        let Requirements { mut t_delta, mut min_interval, mut window, stale_echo, .. } = *requirements;
        if requirements.uneven.is_some() {
            (t_delta, min_interval, window) = requirements.strictest(schedule.sensors());
        }
        let window = if window.as_micros() == 0 { min_refire } else { window };
        // What crosstalk moves by is the size of d_x - d_y and d_x + d_y under either criterion. Pair by pair, since
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
        let audible = Micros::new(periods * schedule.period().as_micros());
        let verified_for = VerifiedFor { t_delta, min_interval, window, separation, path_change: None, audible };
        Ok(VerifiedSchedule(schedule.with_verified_for(verified_for)))
    }
}
