//! The restricted problem: these pairs of waits, in any arrangement over the sensors.
//!
//! What separates two pairs does not depend on who has them, so only the intervals are left to search for. Depth first over the
//! sensors by number; a pair stays a candidate for a sensor while it fires far enough from the conflicting sensors before it. It
//! needs no memory but its own, about 2 KiB, and no arithmetic beyond 32 bits but the counters.

use super::{Best, Bits, Control, Count, Criterion, Finish, MAX_SENSORS, ProblemError, Search, gap};

/// The problem of arranging given pairs over the sensors.
#[derive(Debug, Clone, Copy)]
pub struct Rearrange<'p> {
    search: Search<'p>,
    pairs: &'p [(u32, u32)],
    /// Whether the pairs are separated as the criterion asks.
    separate: bool,
}

impl<'p> Search<'p> {
    /// Restricts the problem to arrangements of `pairs` of waits `(a, b)`, in ticks, one for each sensor. Pairs that the criterion does
    /// not separate have no arrangement.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if there are fewer pairs than sensors, [`ProblemError::Pair`] if a wait is above `wait_max`.
    pub fn rearrange(&self, pairs: &'p [(u32, u32)]) -> Result<Rearrange<'p>, ProblemError> {
        Self::needs("pairs", pairs.len(), self.sensors())?;
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
        Ok(Rearrange { search: *self, pairs, separate })
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

impl Rearrange<'_> {
    /// Finds an arrangement, the first in lexicographic order of pair numbers, or proves that there is none.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `a` or `b` is too short.
    pub fn first(&self, control: &mut Control<'_>, a: &mut [u32], b: &mut [u32]) -> Result<Finish, ProblemError> {
        self.check(a, b)?;
        let mut trail = self.start();
        let finish = self.advance(&mut trail, self.search.problem.interval, control);
        if finish == Finish::Found {
            self.hand_out(&trail, a, b);
        }
        Ok(finish)
    }

    /// Counts the arrangements: as different sensors are different, all `K!` of them if nothing conflicts and no pair is twice
    /// among the pairs (equal pairs count as different).
    pub fn count(&self, control: &mut Control<'_>) -> Count {
        let before = control.nodes();
        let mut trail = self.start();
        let mut count: u64 = 0;
        let finish = loop {
            match self.advance(&mut trail, self.search.problem.interval, control) {
                Finish::Found => count += 1,
                finish => break finish,
            }
        };
        Count { finish, count: u128::from(count), nodes: control.nodes() - before }
    }

    /// Finds the arrangement with the greatest smallest interval and proves that none has a greater one.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `a` or `b` is too short.
    pub fn best_interval(&self, control: &mut Control<'_>, a: &mut [u32], b: &mut [u32]) -> Result<Best, ProblemError> {
        self.check(a, b)?;
        let before = control.nodes();
        let problem = &self.search.problem;
        // Of two conflicting sensors one fires before and after the other on the circle of 2 T_p; without conflicts the interval is the
        // period.
        let mut bound = problem.period;
        let (mut value, mut target) = (None, problem.interval);
        // Bisection: a large interval is refuted near the root, and a small one found without much walking.
        let finish = loop {
            if target > bound {
                break if value.is_some() { Finish::Found } else { Finish::Exhausted };
            }
            let mut trail = self.start();
            match self.advance(&mut trail, target, control) {
                Finish::Found => {
                    self.hand_out(&trail, a, b);
                    value = Some(self.search.smallest_interval(a, b));
                }
                Finish::Exhausted => bound = target.saturating_sub(1),
                Finish::BudgetSpent => break Finish::BudgetSpent,
            }
            (control.value, control.bound) = (value, Some(bound));
            target = match value {
                None => break Finish::Exhausted,
                Some(value) if value >= bound => break Finish::Found,
                Some(value) => value + (bound - value).div_ceil(2),
            };
        };
        Ok(Best { finish, value, bound, nodes: control.nodes() - before })
    }

    fn check(&self, a: &[u32], b: &[u32]) -> Result<(), ProblemError> {
        Search::needs("a", a.len(), self.search.sensors())?;
        Search::needs("b", b.len(), self.search.sensors())
    }

    fn start(&self) -> Trail {
        let free = if self.pairs.len() == MAX_SENSORS { u64::MAX } else { (1 << self.pairs.len()) - 1 };
        Trail { pair: [0; MAX_SENSORS], fire: [[0; 2]; MAX_SENSORS], free, depth: 0 }
    }

    /// Moves to the next arrangement with this interval. Indices are sensors and pairs, both below `sensors <= MAX_SENSORS`.
    fn advance(&self, trail: &mut Trail, interval: u32, control: &mut Control<'_>) -> Finish {
        let sensors = self.pairs.len();
        if !self.separate {
            return Finish::Exhausted;
        }
        // A walk that continues withdraws the last pair first; one that starts has none.
        let mut from = 0;
        if trail.depth == sensors {
            from = trail.withdraw();
        }
        loop {
            if !control.enter() {
                return Finish::BudgetSpent;
            }
            match self.fitting(trail, from, interval) {
                Some((pair, fire)) => {
                    trail.pair[trail.depth] = pair as u8;
                    trail.fire[trail.depth] = fire;
                    trail.free &= !(1 << pair);
                    trail.depth += 1;
                    from = 0;
                    if trail.depth == sensors {
                        return Finish::Found;
                    }
                }
                None if trail.depth == 0 => return Finish::Exhausted,
                None => from = trail.withdraw(),
            }
        }
    }

    /// The first free pair from number `from` on that keeps the interval for the next sensor.
    fn fitting(&self, trail: &Trail, from: u32, interval: u32) -> Option<(usize, [u32; 2])> {
        let problem = &self.search.problem;
        let sensor = trail.depth;
        let lag = problem.lag[sensor];
        let before = Bits(problem.conflicts[sensor] & ((1 << sensor) - 1));
        let candidates = trail.free & u64::MAX.checked_shl(from).unwrap_or(0);
        Bits(candidates).find_map(|pair| {
            let (a, b) = self.pairs[pair];
            let fire = [lag + a, lag + b];
            let fits = Bits(before.0).all(|j| gap(problem.period, fire, trail.fire[j]) >= interval);
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
