//! How many tables there are: depth first over the sensors, with a memory of what was counted before.
//!
//! What the sensors already placed mean to those still to come is little: which `|d|` (and `s`) are still free, and which
//! waits remain to each sensor that conflicts with one of them. Two partial tables that leave the same remainder have the same
//! number of completions, so it is counted once and kept. The last sensor is not walked at all: for each free `|d|` the
//! waits left to it are the common bits of three words.
//!
//! The memory lent holds only remainders. It is compared word by word, never by a hash alone, so any amount gives the exact count,
//! even none; when it is full, older entries give way. Exchanging the phases changes neither `|d|` nor `s`, so a
//! remainder and its exchange share one entry.
//!
//! Waits above 63 ticks do not fit the words; such problems are counted one table at a time.

use super::memo::{Key, Memo, Ticket};
use super::options::{self, Options, Set, left_by};
use super::{Bits, Control, Criterion, Finish, MAX_SENSORS, Problem, Search};

/// A sensible amount of memory for [`Search::count`] where there is plenty, in words (4 MiB).
pub const COUNT_WORDS: usize = 1 << 20;

/// The outcome of counting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    /// Exhausted: the count is exact. Found: the limit was reached, there are at least as many. Budget spent: so many were counted
    /// before the search stopped.
    pub finish: Finish,
    /// The number of tables.
    pub count: u128,
    /// Nodes visited; the tables of the last sensor are not visited one by one.
    pub nodes: u64,
}

impl Search<'_> {
    /// Counts the tables; stops early when there are `limit` or more. More `memory` makes it faster ([`COUNT_WORDS`]); it may be empty.
    ///
    /// Without a limit, a count beyond `u128` ends with [`Finish::Found`] at its maximum.
    pub fn count(&self, limit: Option<u128>, memory: &mut [u32], control: &mut Control<'_>) -> Count {
        let before = control.nodes();
        let limit = limit.unwrap_or(u128::MAX);
        // Beyond capacity nothing needs setting up; what passes has D at most wait_max, or a single sensor.
        let (finish, count) = if self.problem.is_beyond_capacity() {
            (Finish::Exhausted, 0)
        } else if self.problem.wait_max > MASK_MAX {
            count_one_by_one(self, limit, control)
        } else {
            let problem = &self.problem;
            match options::words(problem.wait_max) {
                Some(1) => Counting::<1>::new(problem, memory).run(limit, control),
                Some(2) => Counting::<2>::new(problem, memory).run(limit, control),
                Some(3) => Counting::<3>::new(problem, memory).run(limit, control),
                Some(4) => Counting::<4>::new(problem, memory).run(limit, control),
                _ => Counting::<0>::new(problem, memory).run(limit, control),
            }
        };
        Count { finish, count, nodes: control.nodes() - before }
    }
}

/// The longest wait whose set of waits fits a word.
const MASK_MAX: u32 = 63;

fn count_one_by_one(search: &Search<'_>, limit: u128, control: &mut Control<'_>) -> (Finish, u128) {
    let mut all = search.all();
    let mut count = 0;
    while count < limit {
        match all.advance(control) {
            Finish::Found => count += 1,
            finish => return (finish, count),
        }
    }
    (Finish::Found, count)
}

/// What is still free for the separations: bit `v` of `d` for `|d| = v`, bit `v` of `s[p]` for `s = 2 v + p`.
#[derive(Clone, Copy, Default)]
struct Free {
    d: u64,
    s: [u64; 2],
}

/// Where the walk stands at one level, which places one sensor.
#[derive(Clone, Copy)]
struct Level<const N: usize> {
    free: Free,
    /// The same as pairs of waits.
    pairs: Set<N>,
    /// Waits a and b that the sensors placed before leave to this level's sensor.
    left: [u64; 2],
    /// The |d| still to be tried.
    d_left: u64,
    /// The d under way.
    d: i32,
    /// The waits a still to be tried with it.
    a_left: u64,
    /// The tables counted when the level was entered.
    entered_at: u128,
    /// Where the count goes when the level is finished.
    ticket: Option<Ticket>,
}

impl<const N: usize> Level<N> {
    const NONE: Self = Self {
        free: Free { d: 0, s: [0; 2] },
        pairs: [0; N],
        left: [0; 2],
        d_left: 0,
        d: 0,
        a_left: 0,
        entered_at: 0,
        ticket: None,
    };
}

struct Counting<'p, 'm, const N: usize> {
    problem: &'p Problem<'p>,
    /// Sensors in the order of the levels.
    order: [u8; MAX_SENSORS],
    /// By sensor: those that can fire too close to it.
    near: [u64; MAX_SENSORS],
    /// By level: the sensors to come, this level's included, that are near one placed before.
    touched: [u64; MAX_SENSORS],
    /// By level: the sensors placed before.
    placed: [u64; MAX_SENSORS],
    /// By sensor: its waits, while it is placed.
    wait: [[u8; 2]; MAX_SENSORS],
    /// By sensor: the waits a and b left to it at the level surveyed last.
    left: [[u64; 2]; MAX_SENSORS],
    levels: [Level<N>; MAX_SENSORS],
    key: Key,
    options: Options<N>,
    memo: Memo<'m>,
    total: u128,
}

// Indices: sensors and levels, both below `lag.len() <= MAX_SENSORS`.
impl<'p, 'm, const N: usize> Counting<'p, 'm, N> {
    fn new(problem: &'p Problem<'p>, memory: &'m mut [u32]) -> Self {
        let mut counting = Self {
            problem,
            order: [0; MAX_SENSORS],
            near: [0; MAX_SENSORS],
            touched: [0; MAX_SENSORS],
            placed: [0; MAX_SENSORS],
            wait: [[0; 2]; MAX_SENSORS],
            left: [[span(0, problem.wait_max as i32); 2]; MAX_SENSORS],
            levels: [Level::NONE; MAX_SENSORS],
            key: Key::new(problem.wait_max >= 32),
            options: Options::new(problem),
            memo: Memo::new(&mut [], 0),
            total: 0,
        };
        counting.find_near();
        let widest = counting.choose_order();
        let masks = 2 * widest + if problem.criterion == Criterion::Paper { 3 } else { 1 };
        counting.memo = Memo::new(memory, if problem.wait_max < 32 { masks } else { 2 * masks });
        counting
    }

    fn run(&mut self, limit: u128, control: &mut Control<'_>) -> (Finish, u128) {
        let sensors = self.problem.lag.len();
        let wait_max = self.problem.wait_max as i32;
        let last = sensors - 1;
        let mut level = 0;
        let everything = Free { d: span(0, wait_max), s: [span(0, wait_max), span(0, wait_max - 1)] };
        if last == 0 {
            self.total = self.completions(everything, [span(0, wait_max); 2]);
            return self.counted(limit);
        }
        if N > 0 {
            let [i, j] = [last - 1, last].map(|level| usize::from(self.order[level]));
            self.options.last_two(self.problem, (self.near[i] >> j & 1 == 1).then_some((i, j)));
        }
        let pairs = if N > 0 { self.options.rectangle([u64::MAX; 2]) } else { [0; N] };
        // With two sensors the first is the last but one: there is nothing to walk.
        if N > 0 && last == 1 {
            self.total = self.last_two(0, &pairs);
            return self.counted(limit);
        }
        self.enter(0, everything, pairs);
        loop {
            if self.total >= limit {
                return (Finish::Found, self.total);
            }
            if !control.enter() {
                return (Finish::BudgetSpent, self.total);
            }
            if let Some((free, pairs)) = self.place_next(level) {
                let below = level + 1;
                if N > 0 && below + 1 == last {
                    self.enter_last_two(below, free, pairs);
                } else if below == last {
                    if self.survey(last) {
                        let tables = self.completions(free, self.left[usize::from(self.order[last])]);
                        self.add(below, tables);
                    }
                } else if self.enter(below, free, pairs) {
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

    /// The total of a walk that looked at everything.
    fn counted(&self, limit: u128) -> (Finish, u128) {
        let finish = if self.total >= limit { Finish::Found } else { Finish::Exhausted };
        (finish, self.total)
    }

    /// Adds the tables below one pair of the level above `level`.
    fn add(&mut self, level: usize, tables: u128) {
        // Exchanging the phases turns each table whose first sensor has d > 0 into one with d < 0: the walk leaves those out.
        let twice = level == 1 && self.levels[0].d > 0;
        self.total = self.total.saturating_add(if twice { tables.saturating_mul(2) } else { tables });
    }

    /// Enters a level; `false` if it holds no table or is counted already.
    fn enter(&mut self, level: usize, free: Free, pairs: Set<N>) -> bool {
        let Some(ticket) = self.open(level, free) else {
            return false;
        };
        let left = self.left[usize::from(self.order[level])];
        self.levels[level] =
            Level { free, pairs, left, d_left: free.d, d: 0, a_left: 0, entered_at: self.total, ticket };
        true
    }

    /// Counts the last two levels.
    fn enter_last_two(&mut self, level: usize, free: Free, pairs: Set<N>) {
        let Some(ticket) = self.open(level, free) else {
            return;
        };
        let tables = self.last_two(level, &pairs);
        if let Some(ticket) = ticket {
            self.memo.keep(ticket, tables);
        }
        self.add(level, tables);
    }

    /// The tables of the last two levels, of which this is the first.
    fn last_two(&self, level: usize, pairs: &Set<N>) -> u128 {
        let [own, last] = [level, level + 1].map(|level| {
            let mut set = self.options.rectangle(self.left[usize::from(self.order[level])]);
            for n in 0..N {
                set[n] &= pairs[n];
            }
            set
        });
        u128::from(self.options.count(&own, &last))
    }

    /// Surveys a level and looks it up. `None` if it is counted, with its tables added, or holds none; else where its count is to be
    /// kept, if anywhere.
    fn open(&mut self, level: usize, free: Free) -> Option<Option<Ticket>> {
        if !self.has_room(free.d, self.problem.lag.len() - level) || !self.survey(level) {
            return None;
        }
        // Two sensors can be placed in different ways that leave the same; one cannot.
        if level < 2 || !self.memo.is_useful() {
            return Some(None);
        }
        self.set_key(level, free);
        match self.memo.look_up(&self.key) {
            Ok(tables) => {
                self.add(level, tables);
                None
            }
            Err(new) => Some(Some(new)),
        }
    }

    /// Finds the waits left to the sensors that those placed touch; `false` if one of them has none. To the others all are left, as
    /// they were from the start.
    fn survey(&mut self, level: usize) -> bool {
        Bits(self.touched[level]).all(|j| {
            self.left[j] = self.left_to(j, self.placed[level]);
            self.left[j][0] != 0 && self.left[j][1] != 0
        })
    }

    /// Places the next pair of waits of a level; returns what it leaves free.
    fn place_next(&mut self, level: usize) -> Option<(Free, Set<N>)> {
        let paper = self.problem.criterion == Criterion::Paper;
        let Level { free, pairs, left, mut d_left, mut d, mut a_left, .. } = self.levels[level];
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
        self.wait[usize::from(self.order[level])] = [a as u8, (a - d) as u8];
        let reach = reach(self.problem);
        let pairs = if N > 0 {
            self.options.without(&pairs, a as usize * self.options.waits() + (a - d) as usize)
        } else {
            pairs
        };
        let d = d.abs();
        let mut free = free;
        free.d &= !span(d - reach, d + reach);
        if paper {
            let s = 2 * a - here.d;
            free.s[0] &= !span((s - reach + 1).div_euclid(2), (s + reach).div_euclid(2));
            free.s[1] &= !span((s - reach).div_euclid(2), (s + reach - 1).div_euclid(2));
        }
        Some((free, pairs))
    }

    /// The number of pairs that complete a table for the last sensor.
    fn completions(&self, free: Free, left: [u64; 2]) -> u128 {
        let paper = self.problem.criterion == Criterion::Paper;
        let mut tables = 0;
        for d in Bits(free.d) {
            let d = d as i32;
            tables += waits_with(d, left, free.s, paper).count_ones();
            if d > 0 {
                tables += waits_with(-d, left, free.s, paper).count_ones();
            }
        }
        u128::from(tables)
    }

    /// Whether so many values `D` apart are still free.
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

    /// The waits that `placed` sensors leave to sensor `j`.
    fn left_to(&self, j: usize, placed: u64) -> [u64; 2] {
        let mut left = [span(0, self.problem.wait_max as i32); 2];
        for i in Bits(self.near[j] & placed) {
            let [(a_same, a_across), (b_same, b_across)] =
                self.wait[i].map(|wait| left_by(self.problem, i, j, i32::from(wait)));
            left[0] &= a_same & b_across;
            left[1] &= b_same & a_across;
        }
        left
    }

    /// Writes down what a level surveyed leaves to be counted, the same for partial tables with the same completions.
    fn set_key(&mut self, level: usize, free: Free) {
        self.key.start(level);
        self.key.push(free.d);
        if self.problem.criterion == Criterion::Paper {
            self.key.push(free.s[0]);
            self.key.push(free.s[1]);
        }
        let mut exchange = None;
        for j in Bits(self.touched[level]) {
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

    /// Notes which conflicting sensors can fire too close at all.
    fn find_near(&mut self) {
        let Problem { period, lag, wait_max, interval, conflicts, .. } = *self.problem;
        for (i, &row) in conflicts.iter().enumerate() {
            for j in Bits(row) {
                let apart = lag[i].abs_diff(lag[j]);
                if apart < wait_max + interval || period - apart < wait_max + interval {
                    self.near[i] |= 1 << j;
                }
            }
        }
    }

    /// Chooses the order of the sensors: few unfinished neighbours, and those without neighbours last. Returns the greatest number of
    /// sensors touched at a level.
    fn choose_order(&mut self) -> usize {
        let sensors = self.problem.lag.len();
        let (mut placed, mut touched, mut widest) = (0_u64, 0_u64, 0);
        for level in 0..sensors {
            (self.placed[level], self.touched[level]) = (placed, touched);
            widest = widest.max(touched.count_ones() as usize);
            let next = (0..sensors).filter(|i| placed >> i & 1 == 0).min_by_key(|&i| {
                let after = (touched | self.near[i]) & !placed & !(1 << i);
                (self.near[i] == 0, after.count_ones(), touched >> i & 1 == 0, i)
            });
            let Some(next) = next else { break };
            self.order[level] = next as u8;
            placed |= 1 << next;
            touched = (touched | self.near[next]) & !placed;
        }
        widest
    }
}

/// The waits a with `a - b = d`, `a` and `b` left to the sensor and `s = 2 a - d` free.
#[inline]
fn waits_with(d: i32, left: [u64; 2], s: [u64; 2], paper: bool) -> u64 {
    let waits = left[0] & shifted(left[1], d);
    if !paper {
        return waits;
    }
    let odd = d & 1;
    waits & shifted(s[odd as usize], (d + odd) / 2)
}

/// How far a value keeps others away: `D - 1`, or more than any wait if a single sensor has a greater `D`.
pub(super) fn reach(problem: &Problem<'_>) -> i32 {
    problem.separation.min(MASK_MAX + 1) as i32 - 1
}

/// Moves bits up by `by`, or down if it is negative; `by` is at most 63 either way.
#[inline]
const fn shifted(bits: u64, by: i32) -> u64 {
    if by >= 0 { bits << by } else { bits >> -by }
}

/// Bits `low ..= high`, as far as they lie in a word; none if `low > high`.
#[inline]
pub(super) const fn span(low: i32, high: i32) -> u64 {
    below(high + 1) & !below(low)
}

/// The bits below bit `end`.
#[inline]
const fn below(end: i32) -> u64 {
    if end <= 0 {
        0
    } else if end >= 64 {
        u64::MAX
    } else {
        (1 << end) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting_keeps_less_than_32_kibibytes_beside_the_memory_lent() {
        let sizes = [
            size_of::<Counting<'_, '_, 0>>(),
            size_of::<Counting<'_, '_, 1>>(),
            size_of::<Counting<'_, '_, 2>>(),
            size_of::<Counting<'_, '_, 3>>(),
            size_of::<Counting<'_, '_, 4>>(),
        ];
        assert!(sizes.iter().all(|&size| size < 32 * 1024), "{sizes:?}");
    }
}
