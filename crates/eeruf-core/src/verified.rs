//! [`VerifiedSchedule`]: proof that a schedule meets its requirements.

use core::ops::Deref;

use crate::conditions::{Criterion, Requirements};
use crate::schedule::{Promise, Schedule};
use crate::time::Micros;
use crate::verify::{Verification, Violation, stale_separation};

/// A [`Schedule`] that was verified, and what for: [`schedule!`](crate::schedule!) makes it when the program is
/// compiled, and [`Verification::verified`] at run time. It can be used wherever a schedule can.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(transparent)]
pub struct VerifiedSchedule<const K: usize>(Schedule<K>);

impl<const K: usize> VerifiedSchedule<K> {
    /// The schedule. It remembers what it was verified for: a ring that changes to it or restarts keeps its intervals.
    pub const fn schedule(&self) -> &Schedule<K> {
        &self.0
    }

    /// The `t_delta` that (13a), (13b) were verified for.
    #[doc(alias = "T_delta")]
    pub const fn t_delta(&self) -> Micros {
        self.promise().t_delta
    }

    /// The least time between the firings of two neighbours that it was verified for.
    pub const fn min_interval_verified(&self) -> Micros {
        self.promise().min_interval
    }

    /// The listening window that it was verified for; the longest that it allows where none was asked for.
    #[doc(alias = "T_wind")]
    pub const fn window(&self) -> Micros {
        self.promise().window
    }

    const fn promise(&self) -> Promise {
        match self.0.promise() {
            Some(promise) => promise,
            // Never: it is made with one.
            None => Promise {
                t_delta: Micros::ZERO,
                min_interval: Micros::ZERO,
                window: Micros::ZERO,
                separation: Micros::ZERO,
            },
        }
    }
}

impl<const K: usize> Deref for VerifiedSchedule<K> {
    type Target = Schedule<K>;

    fn deref(&self) -> &Schedule<K> {
        &self.0
    }
}

impl<const K: usize> Verification<'_, K> {
    /// The schedule with the proof that it meets the requirements.
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
        let window = if requirements.window.as_micros() == 0 { min_refire } else { requirements.window };
        let Requirements { t_delta, min_interval, stale_echo, .. } = *requirements;
        // What crosstalk moves by is the size of d_x - d_y and d_x + d_y under either criterion.
        let mut separation = match schedule.separation(Criterion::Exact) {
            Some(separation) => separation.value,
            None => requirements.separation(),
        };
        let mut x = 0;
        while stale_echo && x < schedule.sensors() {
            let stale = stale_separation(schedule, x);
            if stale.as_micros() < separation.as_micros() {
                separation = stale;
            }
            x += 1;
        }
        Ok(VerifiedSchedule(schedule.with_promise(Promise { t_delta, min_interval, window, separation })))
    }
}
