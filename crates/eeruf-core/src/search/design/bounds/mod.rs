//! Lower bounds on the period: below them no schedule exists, by counting alone.
//!
//! Write I for the interval, D for the separation, R for the window, and `own = min(I, R)` for the time that a firing
//! keeps free of the sensor's own next one (the window, or as much of it as matters).
//!
//! - **Capacity.** The K values `|d|` are D apart and the smallest is at least `least` (0, or half of D with the
//!   stale-echo option), so the largest is at least `least + D (K - 1)`; that sensor fires twice within `T_p - |d|`,
//!   which the window bounds: `T_p >= R + least + D (K - 1)`.
//! - **Clique.** w sensors that all conflict fire 2 w times in two periods. Between consecutive ones of these firings
//!   pass at least I, or at least R where both are of the same sensor, which happens only where one phase ends and the
//!   next begins, twice in two periods: `T_p >= (w - 1) I + own`; with n neighbours and `R >= I` this is `n I`. Within
//!   one phase: `T_p >= (w - 1) I + 1`.
//! - **Density.** At any time at most alpha of the intervals `[t, t + I)` that begin with a firing are open, as sensors
//!   with open intervals do not conflict. Each sensor keeps at least `I + own` open in two periods:
//!   `2 alpha T_p >= K (I + own)`. Here alpha is the size of the largest set without conflicts, or a number of cliques
//!   that cover all sensors, which is no smaller.
//! - **Classes.** How few `|d|` fit where clique and interval leave little to spare: [`classes`].
//!
//! The counting is that of `docs/explanation/theory.md`, section 5. It uses the problem and its symmetry alone, nothing
//! of the search.

mod classes;
mod cliques;

pub(super) use classes::Classes;
pub(super) use cliques::cliques;

use super::problem::CheckedProblem;
use cliques::ring_at_once;

/// A lower bound with the argument that gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Bound {
    /// The window, and behind it all `|d|` with their separation.
    Capacity {
        /// K.
        sensors: u32,
        /// D in ticks.
        separation: u32,
        /// R in ticks.
        window: u32,
        /// The smallest `|d|`, not 0 only with the stale-echo option.
        least: u32,
    },
    /// Sensors that all conflict with each other fire one after the other.
    Clique {
        /// The number of such sensors.
        sensors: u32,
        /// I in ticks.
        interval: u32,
        /// The gap after the last of them: I, or the window if that is shorter.
        own: u32,
    },
    /// At most this many sensors can keep their interval at the same time.
    Density {
        /// K.
        sensors: u32,
        /// At most this many at once.
        at_once: u32,
        /// I in ticks.
        interval: u32,
        /// The gap that each sensor keeps after its second firing: I, or the window if that is shorter.
        own: u32,
    },
    /// Sensors that all conflict fire one after the other, and too few `|d|` fit into the little time that leaves.
    Classes {
        /// The number of such sensors.
        clique: u32,
        /// The number of sensors whose `|d|` must fit.
        sensors: u32,
        /// I in ticks.
        interval: u32,
        /// D in ticks.
        separation: u32,
        /// The period from which on they may fit, in ticks.
        period: u32,
    },
    /// A period has at least one tick.
    OneTick,
}

impl Bound {
    /// The period below which there is no schedule, in ticks.
    #[must_use]
    pub fn period(&self) -> u32 {
        let times = |count: u32, time: u32| u64::from(count) * u64::from(time);
        match *self {
            Self::Capacity { sensors, separation, window, least } => {
                in_range(times(sensors.saturating_sub(1), separation) + times(1, window) + times(1, least)).max(1)
            }
            Self::Clique { sensors, interval, own } => {
                in_range(times(sensors.saturating_sub(1), interval) + times(1, own.max(1)))
            }
            Self::Density { sensors, at_once, interval, own } => {
                let twice = times(sensors, interval) + times(sensors, own);
                in_range(twice.div_ceil(2 * u64::from(at_once.max(1))))
            }
            Self::Classes { period, .. } => period,
            Self::OneTick => 1,
        }
    }
}

/// Where the largest of a need is asked for, a bound can be far longer than any period: the longest signed one stands
/// for these.
fn in_range(period: u64) -> u32 {
    const LONGEST: u32 = i32::MAX as u32;
    u32::try_from(period).map_or(LONGEST, |period| period.min(LONGEST))
}

/// The largest of the bounds.
pub(crate) fn strongest(problem: &CheckedProblem) -> Bound {
    // All times are checked to be positive and below 2^26 (`ProblemError::TooLong`).
    let k = problem.sensors as u32;
    let (interval, window) = (problem.interval as u32, problem.window as u32);
    let own = interval.min(window);
    let capacity =
        Bound::Capacity { sensors: k, separation: problem.separation as u32, window, least: problem.least as u32 };
    let (clique, cover) = cliques(problem);
    let mut best = capacity;
    // A single sensor, or none that conflict: then the interval plays no part.
    if clique >= 2 {
        let density = Bound::Density { sensors: k, at_once: ring_at_once(problem).unwrap_or(cover), interval, own };
        for bound in [Bound::Clique { sensors: clique, interval, own }, density] {
            if bound.period() > best.period() {
                best = bound;
            }
        }
    }
    if let Some(classes) = Classes::new(problem) {
        let (clique, cliques, separation) = (classes.n as u32, classes.cliques as u32, problem.separation as u32);
        let period = classes.period(problem);
        if period > best.period() {
            best = Bound::Classes { clique, sensors: clique * cliques, interval, separation, period };
        }
    }
    if best.period() <= 1 { Bound::OneTick } else { best }
}
