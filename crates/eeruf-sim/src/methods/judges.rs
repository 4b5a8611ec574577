//! The judges of simulated rings: core's own, and the judges of a robot's sketch.

use eeruf_core::{
    EchoFilter, Micros, ReadingKind, RingConfig, RingError,
    flow::BeliefSettings,
    judge::{Agreement, Heard, Judge, MOfN, MedianFilter, NoSounds, Sounds, Verdict},
};

use crate::world::Robot;

/// Largest number of readings for a median.
pub(crate) const MAX_MEDIAN: usize = 15;

/// A judge of a method's readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JudgeKind {
    /// Every echo is accepted.
    EveryEcho,
    /// Two of three votes: an echo is accepted if it agrees with one of the sensor's two previous readings.
    TwoOfThree,
    /// The median of the last few readings.
    Median,
    /// Consecutive readings are accepted if they agree.
    Agreement,
    /// Consecutive readings are accepted if they agree and nothing foreign explains them.
    Unexplained,
    /// Readings are accepted if they fit the belief of a flow ring, or agree and nothing foreign explains them.
    Belief,
    /// Every echo, or consecutive readings that agree: according to the robot's sketch.
    AsSketched,
}

impl JudgeKind {
    /// Returns true if the judge checks explanations.
    pub(super) const fn asks(self) -> bool {
        matches!(self, Self::Unexplained | Self::Belief)
    }

    /// Returns the judge of a robot that may fire by another method than the `asked` one. The asked method's judge is
    /// used, unless both compare consecutive readings, or the caller's own filter replaces it.
    pub(crate) fn of_robot(self, asked: Self, robot: &Robot, has_filter: bool) -> Self {
        match asked {
            Self::AsSketched if robot.firing.consecutive == 1 && !has_filter => Self::EveryEcho,
            Self::EveryEcho | Self::TwoOfThree | Self::Median if !has_filter => asked,
            _ if self.asks() => self,
            _ => Self::Agreement,
        }
    }
}

/// A judge, and its settings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judging {
    pub(crate) kind: JudgeKind,
    /// Number of readings of a median, 1 to [`MAX_MEDIAN`].
    pub(crate) median_of: u8,
    /// Settings of a flow ring's belief.
    pub(crate) belief: BeliefSettings,
    /// Number of echoes of a firing that a sensor reports.
    pub(crate) echoes: usize,
}

/// A running judge, for all rings except flow rings.
#[derive(Clone)]
pub(super) enum RunningJudge<const K: usize, const E: usize> {
    Compares(EchoFilter<K, E>),
    Agrees(Agreement<EchoFilter<K, E>>),
    Votes(Agreement<MOfN<K, 3>>),
    Median(MedianFilter<K, MAX_MEDIAN>),
}

impl<const K: usize, const E: usize> RunningJudge<K, E> {
    pub(super) fn new(judging: &Judging, config: &RingConfig) -> Result<Self, RingError> {
        let t_delta = config.t_delta.unwrap_or_default();
        let filter = EchoFilter::new(t_delta, config.consecutive)?;
        let votes = |m, n| MOfN::new(m, n, t_delta).map(|votes| Self::Votes(Agreement(votes)));
        match judging.kind {
            JudgeKind::EveryEcho => votes(1, 1),
            JudgeKind::TwoOfThree => votes(2, 3),
            JudgeKind::Median => MedianFilter::new(judging.median_of, t_delta).map(Self::Median),
            kind if kind.asks() => Ok(Self::Compares(filter)),
            _ => Ok(Self::Agrees(Agreement(filter))),
        }
    }
}

/// Calls the judge of any variant.
macro_rules! each {
    ($running:ident, $judge:ident => $answer:expr) => {
        match $running {
            RunningJudge::Compares($judge) => $answer,
            RunningJudge::Agrees($judge) => $answer,
            RunningJudge::Votes($judge) => $answer,
            RunningJudge::Median($judge) => $answer,
        }
    };
}

impl<const K: usize, const E: usize> Judge for RunningJudge<K, E> {
    fn t_delta(&self) -> Micros {
        each!(self, judge => judge.t_delta())
    }

    fn judge(&mut self, heard: &Heard<'_>, sounds: &impl Sounds) -> Verdict {
        each!(self, judge => judge.judge(heard, sounds))
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        match self {
            Self::Compares(judge) => judge.skip(heard, kind),
            Self::Agrees(judge) => judge.skip(heard, kind),
            // A loop without a filter takes an early edge for an echo.
            Self::Votes(_) | Self::Median(_) => self.judge(heard, &NoSounds),
        }
    }

    fn hold(&mut self, heard: &Heard<'_>) {
        each!(self, judge => judge.hold(heard));
    }

    fn age(&self, sensor: u8) -> Option<u16> {
        each!(self, judge => judge.age(sensor))
    }

    fn is_clear(&self, sensor: u8) -> bool {
        each!(self, judge => judge.is_clear(sensor))
    }

    fn stands_for(&self, sensor: u8) -> u8 {
        each!(self, judge => judge.stands_for(sensor))
    }

    fn forget(&mut self, sensor: u8) {
        each!(self, judge => Judge::forget(judge, sensor));
    }

    fn restart(&mut self) {
        each!(self, judge => judge.restart());
    }

    fn fired_later(&mut self, sensor: u8, later_us: i32) {
        each!(self, judge => judge.fired_later(sensor, later_us));
    }
}
