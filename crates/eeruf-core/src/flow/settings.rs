//! [`FlowSettings`]: how a flow ring spaces its firings and weighs its readings.

use super::slot::{LONGEST_QUIET, QUIET_US, quiet};
use crate::hopping::{CATCHES_UP, HoppingCode, HoppingError};
use crate::own_limits::{EachSensor, SensorLimits};
use crate::requirements::Requirements;
use crate::requirements_error::RequirementsError;
use crate::schedule::MAX_PERIOD;
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
    /// Least time between two firings of a sensor, where its module rests for longer than it listens. At most 16.7 s.
    pub rest: Micros,
    /// Time before a cycle begins at which the one before ends and it is planned, for processors that take long for it:
    /// else its first firing would be late. At most 65 ms and the shortest cycle.
    pub lead: Micros,
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
        rest: Micros::ZERO,
        lead: Micros::ZERO,
        longest_cycle: Micros::from_millis(400),
        travel: Micros::new(260),
    };
}

impl FlowSettings {
    /// The step of the code differs by this from one fleet number to the next.
    const STEP_OF_NUMBER: Micros = Micros::new(40);
    /// The number of fleet numbers that differ.
    const NUMBERS: u8 = 6;

    /// These settings for the robot with this number among robots of one make that hear each other: 0 to 5 have steps
    /// 40 us apart, larger ones are counted from 0 again.
    ///
    /// Two robots with the same step can read each other alike in every phase of a cycle. With unlike numbers, whatever
    /// their offset, and with a `t_delta` of 150 us, no more phases agree than 4 up to 11 sensors, 5 up to 15, 6 up to
    /// 17, 7 up to 21 and 9 up to 27 (`docs/explanation/theory.md`, section 9); five make an echo believed.
    ///
    /// ```
    /// use eeruf_core::{Micros, flow::FlowSettings};
    /// assert_eq!(FlowSettings::DEFAULT.with_fleet_number(2).step, Micros::new(320));
    /// ```
    #[must_use]
    pub const fn with_fleet_number(mut self, number: u8) -> Self {
        let more = (number % Self::NUMBERS) as u32 * Self::STEP_OF_NUMBER.as_micros();
        self.step = self.step.saturating_add(Micros::new(more));
        self
    }

    /// The limits of each sensor for [`FlowPlan::with_limits`](super::FlowPlan::with_limits): its window, its
    /// `t_delta`, of which no more counts than the tracker's, and the sensors that it fires together with. All other
    /// requirements are for tables.
    ///
    /// # Errors
    /// [`RequirementsError`] if what single sensors need is invalid for this many sensors.
    pub fn limits<const K: usize>(
        sensors: usize,
        requirements: &Requirements<'_>,
    ) -> Result<EachSensor<K>, RequirementsError> {
        let Some(uneven) = requirements.uneven else { return Ok(EachSensor::NONE) };
        uneven.check(sensors)?;
        let none = SensorLimits { t_delta: Micros::MAX, window: Micros::MAX };
        let limits = core::array::from_fn(|x| match x < sensors {
            true => SensorLimits { t_delta: requirements.t_delta_of(x), window: requirements.window_of(x) },
            false => none,
        });
        Ok(EachSensor::for_flow(limits, requirements.together()))
    }

    /// These settings with what modules need that are not all alike: the rest of the one that rests for longest, since
    /// each fires once a cycle, and where sensors share an echo line, gaps in which each has stopped listening.
    ///
    /// # Errors
    /// [`HoppingError`] as for [`HoppingCode::new`], or for a shared line on which a sensor listens for longer than the
    /// longest gap.
    pub fn keeping(mut self, sensors: usize, requirements: &Requirements<'_>) -> Result<Self, HoppingError> {
        let Some(uneven) = requirements.uneven else { return Ok(self) };
        self.rest = uneven.refire.iter().copied().fold(self.rest, Micros::max);
        let shares = |x: usize| uneven.shared_lines.iter().any(|line| line >> x & 1 == 1);
        let listens = (0..sensors).filter(|&x| shares(x)).map(|x| requirements.window_of(x)).max();
        if let Some(window) = listens {
            // Waits bring two firings closer by the width of the code, lateness by what is caught up with.
            let code = HoppingCode::new(sensors, self.tracker.votes, self.step)?;
            let closer = code.width().saturating_add(CATCHES_UP).saturating_add(Micros::new(QUIET_US));
            let most = LONGEST_QUIET.saturating_sub(closer);
            if window > most {
                return Err(HoppingError::Window { window, most });
            }
            self.shortest_gap = self.shortest_gap.max(window.saturating_add(closer));
        }
        Ok(self)
    }
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
    /// The gap of the least quiet, in units of the grid.
    pub(super) least_gap: u8,
    /// Time before its end at which a cycle ends for the plan, in units of quiet.
    pub(super) lead: u8,
    /// The distance in the ring from one firing to the next.
    pub(super) stride: u8,
    /// The shortest cycle was rounded up to whole units.
    pub(super) rounded_up: bool,
    pub(super) travel_us: u16,
    /// The shortest cycle, in units of the grid.
    pub(super) shortest: u32,
    /// The longest cycle of a robot that stands, in units of the grid.
    pub(super) longest: u32,
    /// Units of the grid in one of quiet, in 1/2^24; 0 if there is a whole one or more.
    pub(super) per_quiet: u32,
}

impl Pace {
    /// `longest`: the most quiet that helps; `unit`: that of the grid.
    pub(super) fn of(settings: &FlowSettings, sensors: u8, longest: Micros, unit: u32) -> Self {
        let least = quiet(settings.shortest_gap);
        let most = quiet(longest).max(least);
        let unit = unit.max(1);
        let shortest = settings.shortest_cycle.as_micros();
        Self {
            least,
            most,
            masked_adds: quiet(settings.masked_adds),
            believed_takes: quiet(settings.believed_takes),
            unserved_adds: quiet(settings.unserved_adds),
            unserved_after: settings.unserved_after.max(1),
            least_gap: in_units(u32::from(least) * QUIET_US, unit).clamp(1, 255) as u8,
            lead: quiet(settings.lead.min(settings.shortest_cycle)),
            stride: stride(sensors),
            rounded_up: in_units(shortest, unit) * unit != shortest,
            travel_us: u16::try_from(settings.travel.as_micros()).unwrap_or(u16::MAX),
            shortest: in_units(shortest, unit),
            longest: settings.longest_cycle.min(MAX_PERIOD).as_micros().max(shortest) / unit,
            per_quiet: if unit > QUIET_US { u32::MAX / unit } else { 0 },
        }
    }
}

/// The distance in the ring from one firing to the next: neighbours hear each other loudest.
const fn stride(sensors: u8) -> u8 {
    let mut stride = if sensors > 6 { sensors / 3 + 1 } else { 1 };
    while !coprime(stride, sensors) {
        stride += 1;
    }
    stride
}

const fn coprime(mut a: u8, mut b: u8) -> bool {
    // By subtraction: small processors do not divide.
    while b > 0 && a > 0 {
        if a < b { b -= a } else { a -= b }
    }
    a + b <= 1
}

/// A time in whole units, rounded up.
pub(super) const fn in_units(time: u32, unit: u32) -> u32 {
    let unit = if unit > 0 { unit } else { 1 };
    time.saturating_add(unit - 1) / unit
}
