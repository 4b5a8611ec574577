//! [`OwnLimits`]: the window and the `t_delta` of each sensor, for schedules whose sensors are not all alike.
//!
//! The kind of limits is a type parameter, so that a ring of identical sensors pays nothing for them.

use core::fmt;

use crate::schedule::VerifiedFor;
use crate::time::{Micros, longer};

/// The longest window of one sensor, and its largest `t_delta`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SensorLimits {
    /// `T_delta` of the sensor, for which (13a), (13b) hold.
    pub t_delta: Micros,
    /// `T_wind` of the sensor; if no window was asked for, the time until it fires again.
    pub window: Micros,
}

/// Per-sensor limits of a schedule: `()` for none, or [`EachSensor`]. A plan that can change its schedule holds
/// references, `&EachSensor`.
pub trait OwnLimits: Copy + fmt::Debug + sealed::Sealed {
    /// The form in which a plan that can change its schedule holds the limits.
    type Held<'s>: OwnLimits
    where
        Self: 's;

    /// Borrows the limits in the form that a plan holds.
    #[doc(hidden)]
    fn hold(&self) -> Self::Held<'_>;

    /// The limits of one sensor; `None` if it has none.
    #[doc(hidden)]
    #[inline]
    fn limits_of(&self, _sensor: u8) -> Option<SensorLimits> {
        None
    }

    /// Returns true if `receiver` can hear `emitter`.
    #[doc(hidden)]
    #[inline]
    fn hears(&self, _receiver: u8, _emitter: u8) -> bool {
        true
    }

    /// The first of the sensors that fire together with this one; the sensor itself if it fires alone.
    #[doc(hidden)]
    #[inline(always)]
    fn leader_of(&self, sensor: u8) -> u8 {
        sensor
    }

    /// The group that a sensor fires together with, from 1; 0 for none.
    #[doc(hidden)]
    #[inline(always)]
    fn group_of(&self, _sensor: u8) -> u8 {
        0
    }

    /// The echo line that a sensor shares with others, from 1; 0 for one of its own.
    #[doc(hidden)]
    #[inline(always)]
    fn line_of(&self, _sensor: u8) -> u8 {
        0
    }

    /// The greatest limits that the schedule was verified for, if sensors have limits of their own.
    #[doc(hidden)]
    #[inline]
    fn most(&self) -> Option<&VerifiedFor> {
        None
    }
}

mod sealed {
    pub trait Sealed {}
}

impl sealed::Sealed for () {}

/// No per-sensor limits: all sensors listen and compare alike.
impl OwnLimits for () {
    type Held<'s> = Self;

    #[inline]
    fn hold(&self) {}
}

/// Limits for each sensor; entries beyond the last sensor are ignored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EachSensor<const K: usize> {
    /// The largest `t_delta` and window, and the separation of the pair with the smallest margin over its `t_delta`;
    /// `None` if all sensors are alike.
    most: Option<VerifiedFor>,
    limits: [SensorLimits; K],
    /// The group in which each sensor fires, from 1; 0 for none.
    groups: [u8; K],
    /// For each sensor, the echo line that it shares, from 1; 0 for a line of its own.
    lines: [u8; K],
}

impl<const K: usize> EachSensor<K> {
    /// No limits, for callers that learn only at run time whether sensors are alike.
    pub const NONE: Self = Self {
        most: None,
        limits: [SensorLimits { t_delta: Micros::MAX, window: Micros::MAX }; K],
        groups: [0; K],
        lines: [0; K],
    };

    /// Limits for [`FlowRing::with_limits`](crate::flow::FlowRing::with_limits), with sets of sensors that fire
    /// together, bit x for sensor x. A ring with a table refuses them, since no table was verified for them.
    pub const fn for_flow(limits: [SensorLimits; K], together: &[u64]) -> Self {
        const NOTHING: VerifiedFor = VerifiedFor {
            t_delta: Micros::ZERO,
            min_interval: Micros::ZERO,
            window: Micros::ZERO,
            separation: Micros::ZERO,
            path_change: None,
            audible: Micros::ZERO,
        };
        Self { most: Some(NOTHING), ..Self::new(NOTHING, K, limits, Micros::ZERO, together) }
    }

    /// Adds sets of sensors that share an echo line, bit x for sensor x, for rings without a table: none fires before
    /// the windows of the others have ended. Sets with a common sensor form one line.
    #[must_use]
    pub const fn with_shared_lines(mut self, shared_lines: &[u64]) -> Self {
        let mut at = 0;
        while at < shared_lines.len() {
            let line = at as u8 + 1;
            let mut sensor = 0;
            while sensor < K && sensor < 64 {
                if shared_lines[at] >> sensor & 1 == 1 {
                    let (before, mut other) = (self.lines[sensor], 0);
                    while other < K {
                        if before > 0 && self.lines[other] == before {
                            self.lines[other] = line;
                        }
                        other += 1;
                    }
                    self.lines[sensor] = line;
                }
                sensor += 1;
            }
            at += 1;
        }
        self
    }

    /// Makes the limits for which a schedule of this many sensors was verified, from each sensor's limits and the sets
    /// of sensors that fire together, bit x for sensor x.
    pub(crate) const fn new(
        verified_for: VerifiedFor,
        sensors: usize,
        limits: [SensorLimits; K],
        spare: Micros,
        together: &[u64],
    ) -> Self {
        let (mut t_delta, mut window) = (Micros::ZERO, Micros::ZERO);
        let mut groups = [0; K];
        let mut sensor = 0;
        while sensor < sensors && sensor < K {
            t_delta = longer(t_delta, limits[sensor].t_delta);
            window = longer(window, limits[sensor].window);
            let mut group = 0;
            while group < together.len() {
                if sensor < 64 && together[group] >> sensor & 1 == 1 {
                    // Groups are disjoint, so there are at most 32.
                    groups[sensor] = group as u8 + 1;
                }
                group += 1;
            }
            sensor += 1;
        }
        let most = VerifiedFor { t_delta, window, separation: t_delta.saturating_add(spare), ..verified_for };
        Self { most: Some(most), limits, groups, lines: [0; K] }
    }

    /// The limits of a sensor; `None` if it has none.
    #[inline]
    pub fn of(&self, sensor: u8) -> Option<SensorLimits> {
        self.most?;
        self.limits.get(usize::from(sensor)).copied()
    }

    /// The group in which each sensor fires, from 1; 0 for none.
    pub const fn groups(&self) -> &[u8; K] {
        &self.groups
    }

    /// The greatest limits that the schedule was verified for.
    pub const fn most(&self) -> Option<&VerifiedFor> {
        self.most.as_ref()
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        let group = self.group_of(receiver);
        receiver == emitter || group == 0 || group != self.group_of(emitter)
    }

    fn group_of(&self, sensor: u8) -> u8 {
        self.groups.get(usize::from(sensor)).copied().unwrap_or(0)
    }

    fn line_of(&self, sensor: u8) -> u8 {
        self.lines.get(usize::from(sensor)).copied().unwrap_or(0)
    }
}

impl<const K: usize> sealed::Sealed for EachSensor<K> {}

impl<const K: usize> OwnLimits for EachSensor<K> {
    type Held<'s> = &'s Self;

    fn hold(&self) -> &Self {
        self
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.of(sensor)
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        self.hears(receiver, emitter)
    }

    fn leader_of(&self, sensor: u8) -> u8 {
        match self.groups.get(usize::from(sensor)) {
            // There are at most 64.
            Some(&group) if group > 0 => self.groups.iter().position(|&other| other == group).unwrap_or(0) as u8,
            _ => sensor,
        }
    }

    fn group_of(&self, sensor: u8) -> u8 {
        self.group_of(sensor)
    }

    fn line_of(&self, sensor: u8) -> u8 {
        self.line_of(sensor)
    }

    fn most(&self) -> Option<&VerifiedFor> {
        self.most()
    }
}

impl<const K: usize> sealed::Sealed for &EachSensor<K> {}

impl<const K: usize> OwnLimits for &EachSensor<K> {
    type Held<'s>
        = Self
    where
        Self: 's;

    fn hold(&self) -> Self {
        self
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.of(sensor)
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        (**self).hears(receiver, emitter)
    }

    fn leader_of(&self, sensor: u8) -> u8 {
        (**self).leader_of(sensor)
    }

    fn group_of(&self, sensor: u8) -> u8 {
        (**self).group_of(sensor)
    }

    fn line_of(&self, sensor: u8) -> u8 {
        (**self).line_of(sensor)
    }

    fn most(&self) -> Option<&VerifiedFor> {
        (**self).most()
    }
}

/// The limits of the schedules in the current period, the previous one and the next; empty if sensors are alike.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct InUse<U> {
    now: U,
    /// Limits of the previous period, whose firings may still be listened for.
    before: U,
    /// Limits of the next period; those of the current one unless another schedule begins then.
    next: U,
}

impl<U: OwnLimits> InUse<U> {
    /// Limits for a plan that begins.
    pub(crate) fn begin(own_limits: U) -> Self {
        Self { now: own_limits, before: own_limits, next: own_limits }
    }

    /// Changes to other limits when the period ends.
    pub(crate) fn change(&mut self, own_limits: U) {
        self.next = own_limits;
    }

    /// Ends the period, and forgets the limits before the last change.
    pub(crate) fn end_period(&mut self) {
        self.before = self.now;
        self.now = self.next;
    }

    /// The limits of one sensor; in the first period after a change, the lesser of the old and the new.
    #[inline]
    pub(crate) fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        let (now, before) = (self.now.limits_of(sensor), self.before.limits_of(sensor));
        let (Some(one), Some(other)) = (now, before) else { return now.or(before) };
        Some(SensorLimits { t_delta: one.t_delta.min(other.t_delta), window: one.window.min(other.window) })
    }

    /// Returns true if `receiver` can hear `emitter`; in the first period after a change, if either schedule lets it.
    #[inline]
    pub(crate) fn hears(&self, receiver: u8, emitter: u8) -> bool {
        self.now.hears(receiver, emitter) || self.before.hears(receiver, emitter)
    }

    /// The greatest limits that the schedule was verified for, if sensors have limits of their own.
    pub(crate) fn most(&self) -> Option<&VerifiedFor> {
        self.now.most()
    }

    /// The greatest limits of the schedule that begins next.
    pub(crate) fn next_most(&self) -> Option<&VerifiedFor> {
        self.next.most()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;
    use crate::requirements::Requirements;
    use crate::schedule::Schedule;
    use crate::uneven::Uneven;

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
        let exact = exact.verified_each(&requirements).unwrap();
        let roomy = roomy.verified_each(&requirements).unwrap();
        assert_eq!(exact.own_limits().most(), roomy.own_limits().most());
        for sensor in 0..5 {
            assert_eq!(exact.limits_of(sensor), roomy.limits_of(sensor));
        }
        assert_eq!((exact.limits_of(2).is_some(), roomy.limits_of(3)), (true, None));
    }
}
