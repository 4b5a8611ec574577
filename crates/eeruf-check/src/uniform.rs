//! The most frequent problem, sensors that are all alike, in the microseconds that the user knows.

use crate::problem::Problem;
use crate::read::Claim;

/// Sensors that are all alike, with times in microseconds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Uniform {
    /// The grid of firing times and period, 1 or more.
    pub tick_us: u32,
    /// How many sensors.
    pub sensors: usize,
    /// Readings that differ by no more are near-identical.
    pub t_delta_us: u32,
    /// How long a sensor listens.
    pub window_us: u32,
    /// The least time between the firings of the two of a pair.
    pub interval_us: u32,
    /// Whether a sensor's own echo from the period before must be rejected too.
    pub stale_echo: bool,
    /// The pairs x < y that keep the interval, in ascending order.
    pub pairs: Vec<(usize, usize)>,
}

impl Uniform {
    /// The problem in whole ticks: the separation is the smallest number of ticks above twice `t_delta`, window and
    /// interval the smallest that are as long.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let ticks = |time_us: u32| time_us.div_ceil(self.tick_us);
        let separation = 2 * u64::from(self.t_delta_us) / u64::from(self.tick_us) + 1;
        let separation = u32::try_from(separation).unwrap_or(u32::MAX);
        let interval = ticks(self.interval_us);
        let pairs = self.pairs.iter().filter(|_| interval > 0);
        Problem {
            tick_us: (self.tick_us, 1),
            separation: vec![separation; self.sensors],
            window: vec![ticks(self.window_us); self.sensors],
            stale_echo: self.stale_echo,
            over_reals: false,
            together: Vec::new(),
            gaps: pairs.map(|&(x, y)| (x, y, interval, interval)).collect(),
        }
    }

    /// The claim that the answer makes: what is left of a tick is not counted, and there is no bound below one tick.
    #[must_use]
    pub fn claim(&self, answer: &Answer) -> Claim {
        let ticks = |time_us: &u32| time_us / self.tick_us;
        Claim {
            problem: self.problem(),
            period: ticks(&answer.period_us),
            fire: answer.fire_us.each_ref().map(|times| times.iter().map(ticks).collect()),
            bound: ticks(&answer.bound_us).max(1),
        }
    }
}

/// A schedule, and what a search says of it, with times in microseconds that are whole ticks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The schedule's period.
    pub period_us: u32,
    /// When each sensor fires in phases a and b.
    pub fire_us: [Vec<u32>; 2],
    /// No period is below this, as far as is known.
    pub bound_us: u32,
}
