//! [`RingEvent`]: the events that a ring gives to its caller.

use crate::reading::{Explanation, ReadingKind, Tally};
use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// An event that a [`Ring`](super::Ring) hands to its caller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RingEvent {
    /// Fire this sensor, now.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase whose wait applies to the firing.
        phase: Phase,
        /// Time when the firing was due: in the past if the poll was late.
        due: Instant,
    },
    /// The outcome of an earlier firing.
    Reading(Reading),
    /// A period has ended.
    PeriodEnded(PeriodStats),
}

/// The outcome of one firing of one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reading {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase of the firing.
    pub phase: Phase,
    /// The period in which it fired, counted from 0; valid if that was fewer than eight periods ago.
    pub period: u32,
    /// The outcome of the firing.
    pub kind: ReadingKind,
    /// The echo time; `None` without echo.
    pub t_echo: Option<Micros>,
    /// The echo time that it was compared with.
    pub previous: Option<Micros>,
    /// Number of firings since this sensor's last accepted reading; `None` if none ever was.
    pub age: Option<u16>,
    /// The explanation of an [`Ambiguous`](ReadingKind::Ambiguous) reading; `None` for all other kinds.
    pub explained_by: Option<Explanation>,
}

/// Statistics of one period, counted since the end of the previous period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PeriodStats {
    /// The period, counted from 0.
    pub period: u32,
    /// The phase of the period.
    pub phase: Phase,
    /// The readings emitted since the previous period ended, by kind.
    pub tally: Tally<u8>,
    /// Greatest lateness of the period's firings and its end, from due to polled, at most 65,535 us. If a reading
    /// brings a firing forward, lateness counts from the poll that returned the reading.
    pub max_late: Micros,
    /// Sum of the lateness of the period's firings, by which the timetable got longer; at most 65,535 us.
    pub sum_late: Micros,
}
