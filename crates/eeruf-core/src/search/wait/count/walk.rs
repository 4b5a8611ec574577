//! The depth-first walk of a count over the sensors by number, each of which is a level.

use super::super::{Budget, Problem};
use super::bits::{left_by, reach, span, waits_with};
use super::memo::{Key, Memo, Ticket};
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Members, Outcome};

/// Values still free for the separations: bit `v` of `d` for `|d| = v`, bit `v` of `s[p]` for `s = 2 v + p`.
#[derive(Clone, Copy, Default)]
struct Free {
    d: u64,
    s: [u64; 2],
}

/// State of the walk at one level, which places one sensor.
#[derive(Clone, Copy)]
struct Level {
    free: Free,
    /// Waits a and b that the sensors of earlier levels leave to this level's sensor.
    left: [u64; 2],
    /// Values of |d| still to be tried.
    d_left: u64,
    /// The current d.
    d: i32,
    /// Waits a still to be tried with it.
    a_left: u64,
    /// The count of tables when the level was entered.
    entered_at: u128,
    /// Ticket for the count of the finished level.
    ticket: Option<Ticket>,
}

impl Level {
    const NONE: Self =
        Self { free: Free { d: 0, s: [0; 2] }, left: [0; 2], d_left: 0, d: 0, a_left: 0, entered_at: 0, ticket: None };
}

/// A count in progress.
pub(super) struct Counting<'p, 'm> {
    problem: &'p Problem<'p>,
    /// For each sensor, those that can fire too close to it.
    near: [u64; MAX_SENSORS],
    /// For each level, the sensors to come, its own included, that can fire too close to one placed before.
    touched: [u64; MAX_SENSORS],
    /// For each sensor, its waits while it is placed.
    wait: [[u8; 2]; MAX_SENSORS],
    /// For each sensor, the waits a and b left to it at the level surveyed last.
    left: [[u64; 2]; MAX_SENSORS],
    levels: [Level; MAX_SENSORS],
    key: Key,
    memo: Memo<'m>,
    total: u128,
}

// Indices: sensors and levels, both below `lag.len() <= MAX_SENSORS`.
impl<'p, 'm> Counting<'p, 'm> {
    pub(super) fn new(problem: &'p Problem<'p>, memory: &'m mut [u32]) -> Self {
        let Problem { period, lag, wait_max, interval, conflicts, .. } = *problem;
        let (mut near, mut touched) = ([0_u64; MAX_SENSORS], [0_u64; MAX_SENSORS]);
        for (i, &row) in conflicts.iter().enumerate() {
            for j in Members(row) {
                let apart = lag[i].abs_diff(lag[j]);
                if apart < wait_max + interval || period - apart < wait_max + interval {
                    near[i] |= 1 << j;
                }
            }
        }
        for level in 1..lag.len() {
            touched[level] = (touched[level - 1] | near[level - 1]) & (u64::MAX << level);
        }
        let widest = touched.iter().map(|touched| touched.count_ones() as usize).max().unwrap_or(0);
        let masks = 2 * widest + if problem.criterion == Criterion::Paper { 3 } else { 1 };
        Self {
            problem,
            near,
            touched,
            wait: [[0; 2]; MAX_SENSORS],
            left: [[span(0, wait_max as i32); 2]; MAX_SENSORS],
            levels: [Level::NONE; MAX_SENSORS],
            key: Key::new(wait_max >= 32),
            memo: Memo::new(memory, if wait_max < 32 { masks } else { 2 * masks }),
            total: 0,
        }
    }

    pub(super) fn run(&mut self, limit: u128, budget: &mut Budget<'_>) -> (Outcome, u128) {
        let wait_max = self.problem.wait_max as i32;
        let last = self.problem.lag.len() - 1;
        let mut level = 0;
        let everything = Free { d: span(0, wait_max), s: [span(0, wait_max), span(0, wait_max - 1)] };
        if last == 0 {
            self.total = self.completions(everything, [span(0, wait_max); 2]);
            return self.counted(limit);
        }
        self.enter(0, everything);
        loop {
            if self.total >= limit {
                return (Outcome::Found(()), self.total);
            }
            if !budget.enter() {
                return (Outcome::BudgetSpent, self.total);
            }
            if let Some(free) = self.place_next(level) {
                let below = level + 1;
                if below == last {
                    if self.survey(last) {
                        let tables = self.completions(free, self.left[last]);
                        self.add(below, tables);
                    }
                } else if self.enter(below, free) {
                    level = below;
                }
            } else {
                let Level { entered_at, ticket, .. } = self.levels[level];
                let tables = self.total - entered_at;
                if let Some(ticket) = ticket {
                    self.memo.keep(ticket, tables);
                }
                let Some(above) = level.checked_sub(1) else {
                    return self.counted(limit);
                };
                self.total = entered_at;
                self.add(level, tables);
                level = above;
            }
        }
    }

    /// The total of a finished walk.
    fn counted(&self, limit: u128) -> (Outcome, u128) {
        let outcome = if self.total >= limit { Outcome::Found(()) } else { Outcome::Exhausted };
        (outcome, self.total)
    }

    /// Adds the tables below one pair of the level before `level`.
    fn add(&mut self, level: usize, tables: u128) {
        // Exchanging the phases turns each table whose first sensor has d > 0 into one with d < 0: the walk leaves
        // those out.
        let twice = level == 1 && self.levels[0].d > 0;
        self.total = self.total.saturating_add(if twice { tables.saturating_mul(2) } else { tables });
    }

    /// Enters a level; `false` if it has no table or was counted already.
    fn enter(&mut self, level: usize, free: Free) -> bool {
        if !self.has_room(free.d, self.problem.lag.len() - level) || !self.survey(level) {
            return false;
        }
        let mut ticket = None;
        // Two sensors can be placed in different ways that leave the same remainder; one cannot.
        if level >= 2 && self.memo.is_useful() {
            self.set_key(level, free);
            match self.memo.look_up(&self.key) {
                Ok(tables) => {
                    self.add(level, tables);
                    return false;
                }
                Err(new) => ticket = Some(new),
            }
        }
        let left = self.left[level];
        self.levels[level] = Level { free, left, d_left: free.d, d: 0, a_left: 0, entered_at: self.total, ticket };
        true
    }

    /// Finds the waits left to the sensors that can fire too close to placed ones; `false` if one has none. All other
    /// sensors still have all waits.
    fn survey(&mut self, level: usize) -> bool {
        Members(self.touched[level]).all(|j| {
            self.left[j] = self.left_to(j, level);
            self.left[j][0] != 0 && self.left[j][1] != 0
        })
    }

    /// Places the next pair of waits of a level; returns the values that it leaves free.
    fn place_next(&mut self, level: usize) -> Option<Free> {
        let paper = self.problem.criterion == Criterion::Paper;
        let Level { free, left, mut d_left, mut d, mut a_left, .. } = self.levels[level];
        while a_left == 0 {
            // The first sensor's negative d are the exchanged phases of its positive ones.
            if d > 0 && level != 0 {
                d = -d;
            } else {
                if d_left == 0 {
                    return None;
                }
                d = d_left.trailing_zeros() as i32;
                d_left &= d_left - 1;
            }
            a_left = waits_with(d, left, free.s, paper);
        }
        let a = a_left.trailing_zeros() as i32;
        let here = &mut self.levels[level];
        (here.d_left, here.d, here.a_left) = (d_left, d, a_left & (a_left - 1));
        self.wait[level] = [a as u8, (a - d) as u8];
        let reach = reach(self.problem);
        let d = d.abs();
        let mut free = free;
        free.d &= !span(d - reach, d + reach);
        if paper {
            let s = 2 * a - here.d;
            free.s[0] &= !span((s - reach + 1).div_euclid(2), (s + reach).div_euclid(2));
            free.s[1] &= !span((s - reach).div_euclid(2), (s + reach - 1).div_euclid(2));
        }
        Some(free)
    }

    /// The number of pairs with which the last sensor completes a table.
    fn completions(&self, free: Free, left: [u64; 2]) -> u128 {
        let paper = self.problem.criterion == Criterion::Paper;
        let mut tables = 0;
        for d in Members(free.d) {
            let d = d as i32;
            tables += waits_with(d, left, free.s, paper).count_ones();
            if d > 0 {
                tables += waits_with(-d, left, free.s, paper).count_ones();
            }
        }
        u128::from(tables)
    }

    /// Returns true if this many values `D` apart are still free.
    fn has_room(&self, mut free: u64, sensors: usize) -> bool {
        let separation = self.problem.separation.max(1);
        for _ in 0..sensors {
            if free == 0 {
                return self.problem.separation == 0;
            }
            let next = free.trailing_zeros() + separation;
            free &= u64::MAX.checked_shl(next).unwrap_or(0);
        }
        true
    }

    /// The waits that the sensors before `level` leave to sensor `j`.
    fn left_to(&self, j: usize, level: usize) -> [u64; 2] {
        let mut left = [span(0, self.problem.wait_max as i32); 2];
        for i in Members(self.near[j] & ((1 << level) - 1)) {
            let [(a_same, a_across), (b_same, b_across)] =
                self.wait[i].map(|wait| left_by(self.problem, i, j, i32::from(wait)));
            left[0] &= a_same & b_across;
            left[1] &= b_same & a_across;
        }
        left
    }

    /// Builds the key of a surveyed level, which is equal for partial tables with the same completions.
    fn set_key(&mut self, level: usize, free: Free) {
        self.key.start(level);
        self.key.push(free.d);
        if self.problem.criterion == Criterion::Paper {
            self.key.push(free.s[0]);
            self.key.push(free.s[1]);
        }
        let mut exchange = None;
        for j in Members(self.touched[level]) {
            let left = self.left[j];
            // The greater side of the first difference goes first.
            if exchange.is_none() && left[0] != left[1] {
                exchange = Some(left[0] < left[1]);
            }
            let first = usize::from(exchange == Some(true));
            self.key.push(left[first]);
            self.key.push(left[1 - first]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting_keeps_less_than_16_kibibytes_beside_the_memory_lent() {
        assert!(size_of::<Counting<'_, '_>>() < 16 * 1024, "{}", size_of::<Counting<'_, '_>>());
    }
}
