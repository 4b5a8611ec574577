//! The *assignment* problem: given pairs of waits, which sensor gets which.
//!
//! What separates two pairs does not depend on who has them, so only the intervals are left to search for. Depth first
//! over the sensors by number; a pair stays a candidate for a sensor while it fires far enough from the conflicting
//! sensors before it. It needs no memory but its own, about 2 KiB, and no arithmetic beyond 32 bits but the counters.

use super::problem::gap;
use super::{Best, Budget, Count, Search};
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Members, Outcome, ProblemError};

/// The problem of assigning given pairs to the sensors.
#[derive(Debug, Clone, Copy)]
pub struct Assignment<'p> {
    search: Search<'p>,
    pairs: &'p [(u32, u32)],
    /// True if the pairs are separated as the criterion asks.
    separate: bool,
}

impl<'p> Search<'p> {
    /// Restricts the problem to assignments of `pairs` of waits `(a, b)`, in ticks, one for each sensor. Pairs that the
    /// criterion does not separate have no assignment.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if there are fewer pairs than sensors, [`ProblemError::Pair`] if a wait is above
    /// `wait_max`.
    pub fn assign(&self, pairs: &'p [(u32, u32)]) -> Result<Assignment<'p>, ProblemError> {
        Self::check_length("pairs", pairs.len(), self.sensors())?;
        let pairs = &pairs[..self.sensors()];
        let wait_max = self.problem.wait_max;
        for (pair, &(a, b)) in pairs.iter().enumerate() {
            if a.max(b) > wait_max {
                return Err(ProblemError::Pair { pair, wait: a.max(b), wait_max });
            }
        }
        let paper = self.problem.criterion == Criterion::Paper;
        let separation = self.problem.separation;
        let separate = pairs.iter().enumerate().all(|(k, &(a, b))| {
            pairs[..k].iter().all(|&(c, d)| {
                a.abs_diff(b).abs_diff(c.abs_diff(d)) >= separation && (!paper || (a + b).abs_diff(c + d) >= separation)
            })
        });
        Ok(Assignment { search: *self, pairs, separate })
    }
}

/// The trail: which pair each sensor has.
struct Trail {
    pair: [u8; MAX_SENSORS],
    /// Firing times within phase a and phase b.
    fire: [[u32; 2]; MAX_SENSORS],
    free: u64,
    depth: usize,
}

impl Assignment<'_> {
    /// Finds an assignment, the first in lexicographic order of pair numbers, or proves that there is none.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `a` or `b` is too short.
    pub fn first(&self, budget: &mut Budget<'_>, a: &mut [u32], b: &mut [u32]) -> Result<Outcome, ProblemError> {
        self.check(a, b)?;
        let mut trail = self.start();
        let outcome = self.advance(&mut trail, self.search.problem.interval, budget);
        if outcome == Outcome::Found(()) {
            self.hand_out(&trail, a, b);
        }
        Ok(outcome)
    }

    /// Counts the assignments: as different sensors are different, all `K!` of them if nothing conflicts and no pair is
    /// twice among the pairs (equal pairs count as different).
    pub fn count(&self, budget: &mut Budget<'_>) -> Count {
        let before = budget.nodes();
        let mut trail = self.start();
        let mut count: u64 = 0;
        let outcome = loop {
            match self.advance(&mut trail, self.search.problem.interval, budget) {
                Outcome::Found(()) => count += 1,
                outcome => break outcome,
            }
        };
        Count { outcome, count: u128::from(count), nodes: budget.nodes() - before }
    }

    /// Finds the assignment with the greatest smallest interval and proves that none has a greater one.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `a` or `b` is too short.
    pub fn best_interval(&self, budget: &mut Budget<'_>, a: &mut [u32], b: &mut [u32]) -> Result<Best, ProblemError> {
        self.check(a, b)?;
        let before = budget.nodes();
        let problem = &self.search.problem;
        // Of two conflicting sensors one fires before and after the other on the circle of 2 T_p; without conflicts the
        // interval is the period.
        let mut bound = problem.period;
        let (mut value, mut target) = (None, problem.interval);
        // Bisection: a large interval is refuted near the root, and a small one found without much walking.
        let outcome = loop {
            if target > bound {
                break if value.is_some() { Outcome::Found(()) } else { Outcome::Exhausted };
            }
            let mut trail = self.start();
            match self.advance(&mut trail, target, budget) {
                Outcome::Found(()) => {
                    self.hand_out(&trail, a, b);
                    value = Some(self.search.smallest_interval(a, b));
                }
                Outcome::Exhausted => bound = target.saturating_sub(1),
                Outcome::BudgetSpent => break Outcome::BudgetSpent,
            }
            (budget.best, budget.bound) = (value, Some(bound));
            target = match value {
                None => break Outcome::Exhausted,
                Some(value) if value >= bound => break Outcome::Found(()),
                Some(value) => value + (bound - value).div_ceil(2),
            };
        };
        Ok(Best { outcome, value, bound, nodes: budget.nodes() - before })
    }

    fn check(&self, a: &[u32], b: &[u32]) -> Result<(), ProblemError> {
        Search::check_length("a", a.len(), self.search.sensors())?;
        Search::check_length("b", b.len(), self.search.sensors())
    }

    fn start(&self) -> Trail {
        let free = if self.pairs.len() == MAX_SENSORS { u64::MAX } else { (1 << self.pairs.len()) - 1 };
        Trail { pair: [0; MAX_SENSORS], fire: [[0; 2]; MAX_SENSORS], free, depth: 0 }
    }

    /// Moves to the next assignment with this interval. Indices are sensors and pairs, both below
    /// `sensors <= MAX_SENSORS`.
    fn advance(&self, trail: &mut Trail, interval: u32, budget: &mut Budget<'_>) -> Outcome {
        let sensors = self.pairs.len();
        if !self.separate {
            return Outcome::Exhausted;
        }
        // A walk that continues withdraws the last pair first; one that starts has none.
        let mut from = 0;
        if trail.depth == sensors {
            from = trail.withdraw();
        }
        loop {
            if !budget.enter() {
                return Outcome::BudgetSpent;
            }
            match self.fitting(trail, from, interval) {
                Some((pair, fire)) => {
                    trail.pair[trail.depth] = pair as u8;
                    trail.fire[trail.depth] = fire;
                    trail.free &= !(1 << pair);
                    trail.depth += 1;
                    from = 0;
                    if trail.depth == sensors {
                        return Outcome::Found(());
                    }
                }
                None if trail.depth == 0 => return Outcome::Exhausted,
                None => from = trail.withdraw(),
            }
        }
    }

    /// The first free pair from number `from` on that keeps the interval for the next sensor.
    fn fitting(&self, trail: &Trail, from: u32, interval: u32) -> Option<(usize, [u32; 2])> {
        let problem = &self.search.problem;
        let sensor = trail.depth;
        let lag = problem.lag[sensor];
        let before = Members(problem.conflicts[sensor] & ((1 << sensor) - 1));
        let candidates = trail.free & u64::MAX.checked_shl(from).unwrap_or(0);
        Members(candidates).find_map(|pair| {
            let (a, b) = self.pairs[pair];
            let fire = [lag + a, lag + b];
            let fits = Members(before.0).all(|j| gap(problem.period, fire, trail.fire[j]) >= interval);
            fits.then_some((pair, fire))
        })
    }

    fn hand_out(&self, trail: &Trail, a: &mut [u32], b: &mut [u32]) {
        for ((&pair, a), b) in trail.pair.iter().zip(a).zip(b).take(self.pairs.len()) {
            (*a, *b) = self.pairs[usize::from(pair)];
        }
    }
}

impl Trail {
    /// Withdraws the last pair; returns the number from which its sensor goes on.
    fn withdraw(&mut self) -> u32 {
        self.depth -= 1;
        let pair = self.pair[self.depth];
        self.free |= 1 << pair;
        u32::from(pair) + 1
    }
}
