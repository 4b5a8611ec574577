//! [`FlowSettings`]: how a flow ring spaces its firings and weighs its readings.

use super::slot::quiet;
use crate::time::Micros;
use crate::tracker::TrackerSettings;

/// The gaps of a [`FlowRing`](super::FlowRing) and the weights of its readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct FlowSettings {
    /// Weights of readings.
    pub tracker: TrackerSettings,
    /// Step of the code: crosstalk moves by at least as much from phase to phase. Above the tracker's `t_delta`.
    pub step: Micros,
    /// Least time between two firings, at most 65 ms, as all times of quiet.
    pub shortest_gap: Micros,
    /// Quiet that a reading adds that comes before what is believed.
    pub masked_adds: Micros,
    /// Quiet that a believed reading takes away.
    pub believed_takes: Micros,
    /// Quiet that a sensor gains after each [`unserved_after`](Self::unserved_after) firings with nothing believed.
    pub unserved_adds: Micros,
    /// Firings with nothing believed after which a sensor gains quiet, at least 1.
    pub unserved_after: u8,
    /// Shortest time from a cycle to the next.
    pub shortest_cycle: Micros,
    /// Longest time from a cycle to the next, of a robot that stands.
    pub longest_cycle: Micros,
    /// Change of an echo by odometry that a cycle may bring: it bounds the cycle of a robot that moves.
    pub travel: Micros,
}

impl FlowSettings {
    /// For every robot.
    pub const DEFAULT: Self = Self {
        tracker: TrackerSettings::BALANCED.with_memory(5),
        step: Micros::new(240),
        shortest_gap: Micros::new(7_500),
        masked_adds: Micros::from_millis(4),
        believed_takes: Micros::new(1_500),
        unserved_adds: Micros::from_millis(6),
        unserved_after: 3,
        shortest_cycle: Micros::from_millis(60),
        longest_cycle: Micros::from_millis(400),
        travel: Micros::new(380),
    };
}

impl Default for FlowSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The settings that are about firing, as the plan keeps them: the tracker has the others.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Pace {
    pub(super) least: u8,
    pub(super) most: u8,
    pub(super) masked_adds: u8,
    pub(super) believed_takes: u8,
    pub(super) unserved_adds: u8,
    pub(super) unserved_after: u8,
    pub(super) travel_us: u16,
    pub(super) shortest_cycle: Micros,
    pub(super) longest_cycle: Micros,
}

impl Pace {
    /// `longest`: the most quiet that helps.
    pub(super) fn of(settings: &FlowSettings, longest: Micros) -> Self {
        let most = quiet(longest);
        Self {
            least: quiet(settings.shortest_gap).min(most),
            most,
            masked_adds: quiet(settings.masked_adds),
            believed_takes: quiet(settings.believed_takes),
            unserved_adds: quiet(settings.unserved_adds),
            unserved_after: settings.unserved_after.max(1),
            travel_us: u16::try_from(settings.travel.as_micros()).unwrap_or(u16::MAX),
            shortest_cycle: settings.shortest_cycle,
            longest_cycle: settings.longest_cycle.max(settings.shortest_cycle),
        }
    }
}
