//! Enumerates every table, one at a time, in lexicographic order of `a_0, b_0, a_1, b_1, ..`.

use super::{Budget, Problem, Search};
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Members, Outcome};

/// A walk over all tables. The table itself is the trail; it takes no memory from the caller.
#[derive(Debug, Clone)]
pub(crate) struct Enumeration<'p> {
    problem: Problem<'p>,
    a: [u32; MAX_SENSORS],
    b: [u32; MAX_SENSORS],
    /// Number of sensors whose waits fit together; `None` when all tables were returned.
    depth: Option<usize>,
    /// True if the current table was returned: the next one starts after it.
    handed_out: bool,
}

impl<'p> Search<'p> {
    /// A walk over all tables, in lexicographic order of `a_0, b_0, a_1, b_1, ..`.
    pub(crate) fn enumerate(&self) -> Enumeration<'p> {
        Enumeration {
            problem: self.problem,
            a: [0; MAX_SENSORS],
            b: [0; MAX_SENSORS],
            depth: Some(0),
            handed_out: false,
        }
    }

    /// Returns a walk over the tables that follow these waits, in ticks.
    pub(crate) fn enumerate_after(&self, a: [u32; MAX_SENSORS], b: [u32; MAX_SENSORS]) -> Enumeration<'p> {
        let mut rest = Enumeration { a, b, ..self.enumerate() };
        let sensors = self.sensors();
        // Continue at the first sensor whose waits do not fit, from those waits.
        let unfit = (0..sensors).find(|&k| !rest.fits(k));
        rest.depth = Some(unfit.unwrap_or(sensors - 1));
        rest.handed_out = unfit.is_none();
        rest
    }
}

// Indices are sensors, below `lag.len() <= MAX_SENSORS`.
impl Enumeration<'_> {
    /// The waits of the current table, in ticks.
    pub(crate) const fn waits(&self) -> (&[u32; MAX_SENSORS], &[u32; MAX_SENSORS]) {
        (&self.a, &self.b)
    }

    /// Moves to the next table; `Exhausted` after the last. After `BudgetSpent` the walk resumes where it stopped.
    pub(crate) fn advance(&mut self, budget: &mut Budget<'_>) -> Outcome {
        let last = self.problem.lag.len() - 1;
        let Some(mut k) = self.depth else {
            return Outcome::Exhausted;
        };
        if core::mem::take(&mut self.handed_out) {
            self.b[k] += 1;
        }
        loop {
            if !budget.enter() {
                self.depth = Some(k);
                return Outcome::BudgetSpent;
            }
            if self.seek(k) {
                if k == last {
                    (self.depth, self.handed_out) = (Some(k), true);
                    return Outcome::Found(());
                }
                k += 1;
                (self.a[k], self.b[k]) = (0, 0);
            } else {
                let Some(above) = k.checked_sub(1) else {
                    self.depth = None;
                    return Outcome::Exhausted;
                };
                k = above;
                self.b[k] += 1;
            }
        }
    }

    /// Returns true if the waits of sensor `k` are valid and fit the sensors before it.
    fn fits(&self, k: usize) -> bool {
        let in_range = self.a[k].max(self.b[k]) <= self.problem.wait_max;
        in_range && self.is_separate(k) && self.in_time(k, 0) && self.in_time(k, 1)
    }

    /// Moves sensor `k` to the first pair of waits, from the current one on, that fits the sensors before it.
    fn seek(&mut self, k: usize) -> bool {
        let wait_max = self.problem.wait_max;
        while self.a[k] <= wait_max {
            if self.in_time(k, 0) {
                while self.b[k] <= wait_max {
                    if self.is_separate(k) && self.in_time(k, 1) {
                        return true;
                    }
                    self.b[k] += 1;
                }
            }
            self.a[k] += 1;
            self.b[k] = 0;
        }
        false
    }

    /// Returns true if sensor `k` fires `I` away from the sensors before it, in one phase.
    fn in_time(&self, k: usize, phase: usize) -> bool {
        let Problem { period, lag, interval, conflicts, .. } = self.problem;
        let (own, other) = if phase == 0 { (&self.a, &self.b) } else { (&self.b, &self.a) };
        let time = lag[k] + own[k];
        Members(conflicts[k]).take_while(|&j| j < k).all(|j| {
            time.abs_diff(lag[j] + own[j]) >= interval && period - time.abs_diff(lag[j] + other[j]) >= interval
        })
    }

    /// Returns true if `|d|` (and `s`) of sensor `k` lie `D` from those of the sensors before it.
    fn is_separate(&self, k: usize) -> bool {
        let separation = self.problem.separation;
        let (d, s) = (self.a[k].abs_diff(self.b[k]), self.a[k] + self.b[k]);
        let paper = self.problem.criterion == Criterion::Paper;
        (0..k).all(|j| {
            d.abs_diff(self.a[j].abs_diff(self.b[j])) >= separation
                && (!paper || s.abs_diff(self.a[j] + self.b[j]) >= separation)
        })
    }
}
