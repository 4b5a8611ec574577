//! [`UnevenSchedule`]: a verified schedule with the window and the `t_delta` of each sensor.

use core::ops::Deref;

use crate::conditions::Criterion;
use crate::schedule::VerifiedFor;
use crate::time::{Micros, longer, shorter};
use crate::uneven::Uneven;
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
    /// The group that each sensor fires together with, from 1; 0 for none.
    groups: [u8; K],
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

    const fn name_groups(&mut self, uneven: &Uneven<'_>) {
        let mut group = 0;
        while group < uneven.together.len() {
            let mut sensor = 0;
            while sensor < self.groups.len() {
                if uneven.together[group] >> sensor & 1 == 1 {
                    // Groups are disjoint, so there are at most 32.
                    self.groups[sensor] = group as u8 + 1;
                }
                sensor += 1;
            }
            group += 1;
        }
    }

    /// Returns true unless the two sensors fire together, and so were declared not to hear each other.
    pub(crate) fn hears(&self, receiver: u8, emitter: u8) -> bool {
        let group_of = |sensor: u8| self.groups.get(usize::from(sensor)).copied().unwrap_or(0);
        receiver == emitter || group_of(receiver) == 0 || group_of(receiver) != group_of(emitter)
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
        let separation = t_delta.saturating_add(spare);
        let most = VerifiedFor { t_delta, window, separation, ..verified.verified_for() };
        let mut schedule = UnevenSchedule { schedule: verified, most, each, groups: [0; K] };
        if let Some(uneven) = &requirements.uneven {
            schedule.name_groups(uneven);
        }
        Ok(schedule)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{conditions::Requirements, layout::Layout, schedule::Schedule};

    #[test]
    fn room_for_more_sensors_changes_nothing() {
        let firing = [[0, 5, 40], [2, 12, 24]].map(|phase| phase.map(Micros::from_millis));
        let requirements = Requirements {
            layout: Layout::Line(1),
            uneven: Some(Uneven { t_delta: &[1_500, 2_400, 900].map(Micros::new), ..Uneven::NONE }),
            ..Requirements::new(Micros::new(99))
        };
        let period = Micros::from_millis(60);
        let exact = Schedule::<3>::from_firing(period, firing).unwrap();
        let roomy = Schedule::<5>::from_slices(period, &[Micros::ZERO; 3], [&firing[0], &firing[1]]).unwrap();
        let (exact, roomy) = (exact.verify(&requirements), roomy.verify(&requirements));
        let (exact, roomy) = (exact.verified_uneven().unwrap(), roomy.verified_uneven().unwrap());
        assert_eq!(exact.most(), roomy.most());
        for sensor in 0..5 {
            assert_eq!(exact.limits_of(sensor), roomy.limits_of(sensor));
        }
        assert_eq!((exact.limits_of(2).is_some(), roomy.limits_of(3)), (true, None));
    }
}
