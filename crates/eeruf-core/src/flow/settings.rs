//! [`TurnSettings`] and [`BeliefSettings`]: the settings of a ring that fires in turn.

use crate::own_limits::{EachSensor, SensorLimits};
use crate::requirements::Requirements;
use crate::requirements_error::RequirementsError;
use crate::ring_error::{PLAUSIBLE, RingError, within};
use crate::time::{Micros, longer, shorter};

/// Shortest valid quiet: a smaller number is probably in milliseconds.
const LEAST_QUIET: Micros = Micros::new(100);
/// The longest valid quiet; [`LONGEST_REST`] is the longest valid rest.
const LONGEST_QUIET: Micros = Micros::from_millis(250);
pub(super) const LONGEST_REST: Micros = Micros::from_millis(4_000);

/// Settings for firing in turn. If the least and the greatest quiet are equal, all gaps are alike, as [one by
/// one](Self::one_by_one).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TurnSettings {
    /// The least time from one firing to the next, at least 100 us; doubled while every echo is reported (see
    /// [`Votes`]).
    pub least: Micros,
    /// R: the greatest quiet, and how long sound is heard, its tail included. 1 to 250 ms.
    pub most: Micros,
    /// The least time between two firings of a sensor, which its module needs to rest. 1 ms to 4 s.
    pub rest: Micros,
    /// Longest random time in a gap while the robot stands still; twice as long while it moves. 0, or at least 8 us
    /// (eight ticks of the clock): with less, chance explains readings that agree.
    pub dice: Micros,
    /// The seed of the random gaps, not 0 and different on each robot, such as the chip's number.
    pub seed: u32,
}

impl TurnSettings {
    /// Settings for HC-SR04 modules and others that hear up to 4 m, with this seed.
    pub const fn new(seed: u32) -> Self {
        let (most, rest) = (Micros::new(33_500), Micros::from_millis(60));
        Self { least: Micros::new(6_000), most, rest, dice: Micros::from_millis(2), seed }
    }

    /// Settings for modules that listen for `window`, rest for `rest` and are deaf for `blanking`; if modules differ,
    /// give the longest window and rest, and the shortest blanking time.
    ///
    /// Sound is assumed to stay audible for two ninths of the window after it ends (its tail), but no longer than until
    /// a sensor listens again, or its own stale echoes would count as foreign.
    pub const fn for_module(seed: u32, window: Micros, rest: Micros, blanking: Micros) -> Self {
        let listens_again = longer(rest, window).saturating_add(blanking).saturating_sub(Micros::new(1));
        let tail = Micros::new(window.as_micros() / 9 * 2);
        let most = shorter(window.saturating_add(tail), listens_again);
        let least = Micros::new(most.as_micros() / 11 * 2);
        Self { least, most, rest, dice: Micros::from_millis(2), seed }
    }

    /// Returns settings that fire one by one, or group by group if sensors fire together, always with the most quiet.
    #[must_use]
    pub const fn one_by_one(self) -> Self {
        Self { least: self.most, ..self }
    }

    /// The limits of each sensor for [`FlowRing::with_limits`](crate::flow::FlowRing::with_limits): its window, its
    /// `t_delta` (at most the belief's), the sensors with which it fires together, such as those on one trigger
    /// line, and those with which it shares an echo line. All other requirements apply only to tables.
    ///
    /// # Errors
    /// [`RequirementsError`] if the needs of single sensors are invalid for this many sensors.
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
        Ok(EachSensor::for_flow(limits, requirements.together()).with_shared_lines(uneven.shared_lines))
    }

    /// Returns settings with the longest rest of any module.
    #[must_use]
    pub fn keeping(self, requirements: &Requirements<'_>) -> Self {
        let refire = requirements.uneven.map_or(&[][..], |uneven| uneven.refire);
        Self { rest: refire.iter().copied().fold(self.rest, Micros::max), ..self }
    }

    pub(super) const fn check(&self) -> Result<(), RingError> {
        if let Err(error) = within("most", self.most, PLAUSIBLE, LONGEST_QUIET) {
            return Err(error);
        }
        if let Err(error) = within("least", self.least, LEAST_QUIET, self.most) {
            return Err(error);
        }
        if let Err(error) = within("rest", self.rest, PLAUSIBLE, LONGEST_REST) {
            return Err(error);
        }
        let dice = within("dice", self.dice, Micros::new(8), LONGEST_QUIET);
        if let (Err(error), false) = (dice, self.dice.as_micros() == 0) {
            return Err(error);
        }
        Self::check_seed(self.seed)
    }

    pub(super) const fn check_seed(seed: u32) -> Result<(), RingError> {
        within("seed", Micros::new(seed), Micros::new(1), Micros::MAX)
    }

    /// Initial quiet.
    pub(super) const fn first(&self) -> Micros {
        self.least.saturating_add(Micros::new(self.most.saturating_sub(self.least).as_micros() / 5))
    }
}

/// The number of consecutive echoes needed to accept one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Votes {
    /// One while the robot moves and no other is near, else two.
    ByMotion,
    /// One: every echo is accepted, with twice the least quiet. Only quiet keeps foreign echoes out.
    EveryEcho,
    /// Two that nothing foreign explains, or one that fits what is believed.
    TwoInARow,
}

/// Settings of the [`Belief`](super::Belief) of a ring that fires in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BeliefSettings {
    /// `T_delta`: greatest difference between two consecutive readings that agree, on a stationary robot.
    pub t_delta: Micros,
    /// H: greatest difference between a reading and the belief, on a stationary robot. For an edge between two instants
    /// the middle counts, since no promise covers a reading that fits.
    pub near: Micros,
    /// P: the largest change of a foreign path between two readings of a stationary robot.
    pub path_change: Micros,
    /// Number of firings without confirmation after which a belief ends.
    pub memory: u8,
    /// Greatest number of confirmations that count: on a stationary robot, that many contradictions must come before a
    /// farther echo or silence replaces the belief.
    pub hold: u8,
    /// The assumed speed of a robot that reports none, in mm/s: 0, or at least 10.
    pub top_speed_mm_s: u16,
    /// True if no other robot sends sound nearby.
    pub alone: bool,
    /// Number of consecutive echoes needed to accept one.
    pub votes: Votes,
}

impl BeliefSettings {
    /// Settings for a robot that stands still unless it reports a speed.
    pub const DEFAULT: Self = Self {
        t_delta: Micros::new(80),
        near: Micros::new(150),
        path_change: Micros::new(150),
        memory: 8,
        hold: 4,
        top_speed_mm_s: 0,
        alone: false,
        votes: Votes::ByMotion,
    };

    /// Returns true if every echo is reported as accepted.
    pub(super) const fn every_echo(&self, moves: bool) -> bool {
        match self.votes {
            Votes::ByMotion => self.alone && moves,
            Votes::EveryEcho => true,
            Votes::TwoInARow => false,
        }
    }

    pub(super) const fn check(&self) -> Result<(), RingError> {
        let times = [("t_delta", self.t_delta), ("near", self.near), ("path_change", self.path_change)];
        let mut time = 0;
        while time < times.len() {
            if let Err(error) = within(times[time].0, times[time].1, Micros::ZERO, Micros::from_millis(10)) {
                return Err(error);
            }
            time += 1;
        }
        let speed = Micros::new(self.top_speed_mm_s as u32);
        let speed = within("top_speed_mm_s", speed, Micros::new(10), Micros::new(u16::MAX as u32));
        if let (Err(error), false) = (speed, self.top_speed_mm_s == 0) {
            return Err(error);
        }
        within("hold", Micros::new(self.hold as u32), Micros::new(1), Micros::new(100))
    }
}

impl Default for BeliefSettings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_follow_from_window_and_rest() {
        let ms = Micros::from_millis;
        let of = |window, rest, blanking| {
            let turns = TurnSettings::for_module(1, ms(window), ms(rest), Micros::new(blanking));
            assert_eq!(turns.check(), Ok(()));
            (turns.least.as_micros(), turns.most.as_micros(), turns.rest.as_micros())
        };
        // A Polaroid; a module that rests no longer than it listens; one that rests for less.
        assert_eq!(of(60, 80, 1_000), (13_332, 73_332, 80_000));
        assert_eq!(of(60, 60, 1_000), (11_090, 60_999, 60_000));
        assert_eq!(of(36, 20, 300), (6_598, 36_299, 20_000));
    }
}
