//! The best table: largest smallest interval, largest separation, and the front of both.
//!
//! Both values are monotone: what holds at a value holds at each smaller one. So a bisection over [`decide`] is exact, and its
//! last infeasible value is the proof. Values that take long wait until the quick ones are settled.

use super::decide::{decide, memory_words};
use super::{Control, Criterion, Finish, MAX_SENSORS, Problem, ProblemError, Search};

/// What is to be as large as possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Objective {
    /// The smallest interval between conflicting sensors, at the separation of the problem.
    Interval,
    /// The separation `D`, at the smallest interval of the problem.
    Separation,
}

/// The outcome of a search for the best table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Best {
    /// Found: the value is proven best. Exhausted: there is no table at all. Budget spent: value and bound are what is known.
    pub finish: Finish,
    /// The best value found, in ticks; the table was written where the caller asked.
    pub value: Option<u32>,
    /// No table has a greater value, in ticks.
    pub bound: u32,
    /// Nodes visited.
    pub nodes: u64,
}

impl Best {
    /// Whether the value is proven to be the best, or that no table exists.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.finish != Finish::BudgetSpent
    }
}

impl Search<'_> {
    /// Finds one table, or proves that there is none. `memory` of [`memory_words`] words; `a` and `b` receive the waits in ticks.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `memory`, `a` or `b` is too short.
    pub fn first(
        &self,
        memory: &mut [u32],
        control: &mut Control<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<Finish, ProblemError> {
        self.check(memory, a, b)?;
        let mut wait = [0; 2 * MAX_SENSORS];
        let finish = decide(self.problem(), memory, control, &mut wait);
        if finish == Finish::Found {
            self.hand_out(&wait, a, b);
        }
        Ok(finish)
    }

    /// Finds the table with the greatest value and proves that none is better. `a` and `b` hold the best table found, also when the
    /// budget ends.
    ///
    /// With nothing in conflict the interval is the period; a single sensor has the separation `wait_max`.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if `memory` ([`memory_words`]), `a` or `b` is too short.
    pub fn best(
        &self,
        objective: Objective,
        memory: &mut [u32],
        control: &mut Control<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<Best, ProblemError> {
        self.check(memory, a, b)?;
        let before = control.nodes();
        let pairs = self.sensors() as u32 - 1;
        let mut bound = match objective {
            // Of two conflicting sensors one fires before and after the other on the circle of 2 T_p; without conflicts there is no
            // interval to measure.
            Objective::Interval if self.problem().conflicts.iter().any(|&row| row != 0) => self.problem().period,
            Objective::Interval => self.problem().period.max(self.problem().interval),
            // Capacity: K values |d| in 0 ..= wait_max.
            Objective::Separation => match self.problem().wait_max.checked_div(pairs) {
                Some(most) => most,
                None => self.problem().wait_max.max(self.problem().separation),
            },
        };
        if self.problem().criterion == Criterion::Paper {
            // The weaker criterion is settled much faster, and what it excludes is excluded.
            let exact = Self::new(Problem { criterion: Criterion::Exact, ..*self.problem() })?;
            let exact = control.slice(BOUND_SLICE, |control| exact.best(objective, memory, control, a, b))?;
            if exact.finish == Finish::Exhausted {
                return Ok(exact);
            }
            bound = bound.min(exact.bound);
        }
        let mut wait = [0; 2 * MAX_SENSORS];
        let mut value: Option<u32> = None;
        let mut slice = FIRST_SLICE;
        // Each round settles what takes at most `slice` nodes a value; the next round allows more.
        'rounds: loop {
            let mut top = bound;
            loop {
                let target = match value {
                    None => self.least_of(objective),
                    Some(value) if value < top => value + (top - value).div_ceil(2),
                    Some(_) => break,
                };
                if value.is_none() && target > bound {
                    bound = target;
                    break 'rounds;
                }
                let search = self.at(objective, target);
                (control.value, control.bound) = (value, Some(bound));
                let limit = if value.is_none() { u64::MAX } else { slice };
                match control.slice(limit, |control| decide(search.problem(), memory, control, &mut wait)) {
                    Finish::Found => {
                        self.hand_out(&wait, a, b);
                        value = Some(self.value_of(objective, a, b).clamp(target, bound));
                    }
                    Finish::Exhausted if value.is_none() => break 'rounds,
                    Finish::Exhausted => {
                        bound = target - 1;
                        top = bound;
                    }
                    Finish::BudgetSpent if control.spent() => break 'rounds,
                    Finish::BudgetSpent => top = target - 1,
                }
            }
            if value == Some(bound) {
                break;
            }
            slice = slice.saturating_mul(4);
        }
        let finish = match value {
            Some(value) if value == bound => Finish::Found,
            None if !control.spent() => Finish::Exhausted,
            _ => Finish::BudgetSpent,
        };
        Ok(Best { finish, value, bound, nodes: control.nodes() - before })
    }

    /// The tables of which no other is better in one of interval and separation without being worse in the other, from the greatest
    /// interval to the greatest separation; both at least those of the problem.
    pub fn pareto<'m>(&self, memory: &'m mut [u32]) -> Pareto<'_, 'm> {
        Pareto { search: *self, separation: Some(self.problem().separation), memory }
    }

    fn least_of(&self, objective: Objective) -> u32 {
        match objective {
            Objective::Interval => self.problem().interval,
            Objective::Separation => self.problem().separation,
        }
    }

    fn at(&self, objective: Objective, value: u32) -> Self {
        match objective {
            Objective::Interval => self.with(self.problem().separation, value),
            Objective::Separation => self.with(value, self.problem().interval),
        }
    }

    fn value_of(&self, objective: Objective, a: &[u32], b: &[u32]) -> u32 {
        match objective {
            Objective::Interval => self.smallest_interval(a, b),
            Objective::Separation => self.separation_of(a, b),
        }
    }

    fn check(&self, memory: &[u32], a: &[u32], b: &[u32]) -> Result<(), ProblemError> {
        Self::needs("memory", memory.len(), memory_words(self.sensors()))?;
        Self::needs("a", a.len(), self.sensors())?;
        Self::needs("b", b.len(), self.sensors())
    }

    fn hand_out(&self, wait: &[i32; 2 * MAX_SENSORS], a: &mut [u32], b: &mut [u32]) {
        for (node, &wait) in wait.iter().enumerate().take(2 * self.sensors()) {
            let phase = if node % 2 == 0 { &mut *a } else { &mut *b };
            if let Some(place) = phase.get_mut(node / 2) {
                *place = wait as u32;
            }
        }
    }
}

/// Nodes a value may take in the first round of a bisection.
const FIRST_SLICE: u64 = 1000;
/// Nodes spent on a bound from the weaker criterion.
const BOUND_SLICE: u64 = 20_000;

/// One point of the front, in ticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParetoPoint {
    /// The smallest interval; no table with at least this separation has a greater one.
    pub interval: u32,
    /// The separation; no table with at least this interval has a greater one.
    pub separation: u32,
}

/// Walks the front of interval and separation; each step hands out a table.
#[derive(Debug)]
pub struct Pareto<'p, 'm> {
    search: Search<'p>,
    /// The separation from which the next point is sought.
    separation: Option<u32>,
    memory: &'m mut [u32],
}

impl Pareto<'_, '_> {
    /// The next point, with its waits in `a` and `b`; `Exhausted` after the last, `BudgetSpent` if the budget ended before the
    /// point was proven. A step that ran out of budget may be repeated with a new one.
    ///
    /// # Errors
    /// [`ProblemError::Short`] if the memory lent, `a` or `b` is too short.
    pub fn next_into(
        &mut self,
        control: &mut Control<'_>,
        a: &mut [u32],
        b: &mut [u32],
    ) -> Result<(Finish, Option<ParetoPoint>), ProblemError> {
        let Some(from) = self.separation else {
            return Ok((Finish::Exhausted, None));
        };
        let search = self.search.with(from, self.search.problem().interval);
        let interval = search.best(Objective::Interval, self.memory, control, a, b)?;
        let (Finish::Found, Some(interval)) = (interval.finish, interval.value) else {
            if interval.finish == Finish::Exhausted {
                self.separation = None;
            }
            return Ok((interval.finish, None));
        };
        let separation = search.with(from, interval).best(Objective::Separation, self.memory, control, a, b)?;
        let (Finish::Found, Some(separation)) = (separation.finish, separation.value) else {
            return Ok((Finish::BudgetSpent, None));
        };
        // A single sensor is at no distance from another: its one point is the whole front.
        self.separation = if search.sensors() == 1 { None } else { separation.checked_add(1) };
        Ok((Finish::Found, Some(ParetoPoint { interval, separation })))
    }
}
