//! Why a period is not shorter, in words that say which need to relax.

use core::fmt;

use super::bounds::{self, Bound};
use super::problem::CheckedProblem;
use crate::time::Micros;

/// Why there is no shorter period, or none is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Explanation {
    /// A bound that follows by counting is met.
    Bound(Bound),
    /// The search went through every schedule that is one tick shorter, and found that none works.
    Exhausted {
        /// The period that was searched, in ticks.
        period: u32,
        /// The best bound by counting.
        counted: Bound,
    },
    /// The budget was spent, or the caller stopped the search: the period may not be the shortest.
    BudgetSpent {
        /// The shortest period that is not excluded, in ticks.
        bound: u32,
    },
}

impl Explanation {
    /// Why there is nothing shorter than the shortest period.
    pub(crate) fn of(problem: &CheckedProblem, shortest: u32) -> Self {
        Self::by(bounds::strongest(problem), shortest)
    }

    pub(super) fn by(counted: Bound, shortest: u32) -> Self {
        if shortest == counted.period() {
            Self::Bound(counted)
        } else {
            Self::Exhausted { period: shortest.saturating_sub(1), counted }
        }
    }

    /// The same in words, with times instead of ticks.
    #[must_use]
    pub const fn in_ticks_of(&self, tick: Micros) -> InTime<'_> {
        InTime { explanation: self, tick: Some(tick) }
    }
}

/// An [`Explanation`] in words: see [`Explanation::in_ticks_of`].
#[derive(Clone, Copy, Debug)]
pub struct InTime<'r> {
    explanation: &'r Explanation,
    tick: Option<Micros>,
}

impl InTime<'_> {
    const fn time(&self, ticks: u32) -> Time {
        Time { ticks, tick: self.tick }
    }

    fn bound(&self, bound: &Bound, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let period = self.time(bound.period());
        match *bound {
            Bound::Capacity { sensors, separation, window, least } => {
                let (separation, window) = (self.time(separation), self.time(window));
                write!(f, "window and separation: {sensors} sensors need {sensors} refire times {separation} apart")?;
                if least > 0 {
                    write!(f, ", the first {} from the period for the sake of stale echoes", self.time(least))?;
                }
                write!(f, ", and the shortest must leave a window of {window}, which takes {period}; ")?;
                f.write_str(
                    "a shorter window, a smaller separation or fewer sensors would help, a shorter interval would not",
                )
            }
            Bound::Clique { sensors, interval, .. } => write!(
                f,
                "interval: {sensors} sensors that are all neighbours must fire {} apart, which takes {period}; \
                 a shorter interval or fewer neighbours would help, a smaller separation would not",
                self.time(interval)
            ),
            Bound::Density { sensors, at_once, interval, .. } => write!(
                f,
                "interval and number of sensors: at most {at_once} of {sensors} sensors can fire within the same {}, \
                 which takes {period}; a shorter interval or fewer neighbours would help, a smaller separation \
                 would not",
                self.time(interval)
            ),
            Bound::Classes { clique, sensors, interval, separation, .. } => write!(
                f,
                "interval and separation together: {clique} sensors that are all neighbours and fire {} \
                 apart leave too little time to tell {sensors} refire times {} apart, which takes {period}; \
                 a shorter interval, a smaller separation or fewer neighbours would help",
                self.time(interval),
                self.time(separation)
            ),
            Bound::OneTick => f.write_str("the tick: a period has at least one"),
        }
    }
}

impl fmt::Display for InTime<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.explanation {
            Explanation::Bound(bound) => self.bound(bound, f),
            Explanation::Exhausted { period, counted } => {
                let alone = match counted {
                    Bound::Capacity { .. } => "window and separation alone",
                    Bound::Classes { .. } => "the sizes of the refire times",
                    _ => "the interval alone",
                };
                write!(
                    f,
                    "interval and separation together: no firing order of the sensors meets both within {}, though {} \
                     would do for {alone} (every order was searched)",
                    self.time(*period),
                    self.time(counted.period())
                )
            }
            Explanation::BudgetSpent { bound } => {
                write!(
                    f,
                    "the search, which ended early: periods from {} on are neither found nor excluded, and \
                     a larger budget may settle that",
                    self.time(*bound)
                )
            }
        }
    }
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        InTime { explanation: self, tick: None }.fmt(f)
    }
}

/// A number of ticks, or the time they take.
#[derive(Clone, Copy)]
struct Time {
    ticks: u32,
    tick: Option<Micros>,
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.tick {
            Some(tick) => Micros::new(tick.as_micros().saturating_mul(self.ticks)).fmt(f),
            None => write!(f, "{} ticks", self.ticks),
        }
    }
}
