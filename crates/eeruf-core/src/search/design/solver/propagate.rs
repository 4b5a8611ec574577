//! Consequences of the decisions made so far (`docs/explanation/theory.md`, sections 6.1 and 6.2).
//!
//! Three arguments, repeated until nothing is new: an order that has become impossible leaves the other one; ranked
//! neighbours are D apart; and K values `|d|` must fit ([`spacing`](super::spacing)).
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`.

use super::difference_bounds::Conflict;
use super::spacing::Intervals;
use super::state::State;
use crate::search::common::Members;

/// Rounds after each decision. Almost always a few are enough. In fine ticks conclusions can go round in circles and
/// gain a tick each time: then it is far cheaper to go on here than to let the search try value by value.
const ROUNDS: usize = 400;

impl State<'_, '_> {
    /// Draws conclusions from all decisions so far.
    pub(super) fn propagate(&mut self) -> Result<(), Conflict> {
        let mut spaced = Intervals::NONE;
        // How many bounds were new when each argument last started: without another since, it finds nothing.
        let mut started = [u64::MAX; 3];
        for _ in 0..ROUNDS {
            let before = self.differences.changes();
            for (argument, started) in started.iter_mut().enumerate() {
                let now = self.differences.changes();
                // The one that costs more waits until the others have nothing new.
                if argument == 2 && now != before {
                    break;
                }
                if core::mem::replace(started, now) == now {
                    continue;
                }
                match argument {
                    0 => self.force_orders()?,
                    1 => self.space_ranks()?,
                    _ => self.space_sizes(&mut spaced)?,
                }
            }
            if self.differences.changes() == before {
                break;
            }
        }
        Ok(())
    }

    /// Where one order of two conflicting firings is impossible, adds the other.
    fn force_orders(&mut self) -> Result<(), Conflict> {
        let interval = self.problem.interval;
        if interval == 0 {
            return Ok(());
        }
        loop {
            let before = self.differences.changes();
            for x in 1..self.problem.sensors {
                for y in Members(self.problem.conflicts[x] & ((1 << x) - 1)) {
                    for phase in 0..2 {
                        let (u, v) = (self.node(x, phase), self.node(y, phase));
                        if self.differences.at_most(u, v) < interval {
                            self.differences.add_bound(u, v, -interval)?;
                        } else if self.differences.at_most(v, u) < interval {
                            self.differences.add_bound(v, u, -interval)?;
                        }
                    }
                }
            }
            if self.differences.changes() == before {
                return Ok(());
            }
        }
    }

    /// Adds the separation between sensors whose order of `|d|` is known.
    fn space_ranks(&mut self) -> Result<(), Conflict> {
        let ranks = self.ranks;
        for pair in ranks.highs().windows(2) {
            self.behind(usize::from(pair[1]), usize::from(pair[0]))?;
        }
        if let Some(&last) = ranks.highs().last() {
            for x in Members(self.problem.all() & !ranks.ranked) {
                self.behind(x, usize::from(last))?;
            }
        }
        Ok(())
    }

    /// The nodes whose difference is `|d|` of sensor `x`, later first; `None` while the sign is open.
    fn signed(&self, x: usize) -> Option<(usize, usize)> {
        let (low, high) = self.span(x);
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        if low >= 0 {
            Some((a, b))
        } else if high <= 0 {
            Some((b, a))
        } else {
            None
        }
    }

    /// Adds `|d_x| + D <= |d_y|`: of four times, each pair of differences bounds the other.
    fn behind(&mut self, x: usize, y: usize) -> Result<(), Conflict> {
        let (Some((late_x, early_x)), Some((late_y, early_y))) = (self.signed(x), self.signed(y)) else {
            return Ok(());
        };
        let d = self.problem.separation;
        // (late_y - early_y) + (early_x - late_x) >= D
        self.differences.add_bound(early_y, late_y, self.differences.at_most(early_x, late_x) - d)?;
        self.differences.add_bound(late_x, early_x, self.differences.at_most(late_y, early_y) - d)?;
        // (late_y - late_x) + (early_x - early_y) >= D
        self.differences.add_bound(late_x, late_y, self.differences.at_most(early_x, early_y) - d)?;
        self.differences.add_bound(early_y, early_x, self.differences.at_most(late_y, late_x) - d)
    }

    /// Adds that `|d|` of sensor `x` is within `low..=high`, as far as the sign is known; for ranked sensors it is.
    pub(super) fn bound_size(&mut self, x: usize, low: i32, high: i32) -> Result<(), Conflict> {
        if low > high {
            return Err(Conflict);
        }
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        self.differences.add_bound(a, b, high)?;
        self.differences.add_bound(b, a, high)?;
        let (least, most) = self.span(x);
        let ranked = self.ranks.ranked >> x & 1 == 1;
        let negative = self.ranks.negative >> x & 1 == 1;
        if (ranked && !negative) || -low < least {
            self.differences.add_bound(b, a, -low)?;
        }
        if (ranked && negative) || low > most {
            self.differences.add_bound(a, b, -low)?;
        }
        Ok(())
    }

    /// All `|d|` must fit with the separation between them; `spaced` is what came out the last time.
    fn space_sizes(&mut self, spaced: &mut Intervals) -> Result<(), Conflict> {
        let mut intervals = self.intervals();
        let k = self.problem.sensors;
        if intervals.low[..k] == spaced.low[..k] && intervals.high[..k] == spaced.high[..k] {
            return Ok(());
        }
        if (0..k).any(|x| intervals.low[x] > intervals.high[x]) {
            return Err(Conflict);
        }
        intervals.round(k, self.problem.separation, self.problem.least, self.widest)?;
        intervals.enforce(k, self.problem.separation)?;
        for x in 0..k {
            self.bound_size(x, intervals.low[x], intervals.high[x])?;
        }
        *spaced = intervals;
        Ok(())
    }
}
