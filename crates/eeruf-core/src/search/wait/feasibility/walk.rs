//! The depth-first walk over orders, ranks and values, with the least waits that the difference constraints allow.

use super::super::difference_constraints::{Constraints, Order};
use super::super::{Budget, Problem};
use super::branch::Branch;
use crate::requirements::Criterion;
use crate::schedule::MAX_SENSORS;
use crate::search::{Members, Outcome};

/// The style of a search. All styles are exhaustive in what they search; only the tight one does not search everything.
#[derive(Clone, Copy, Default)]
pub(super) struct Style {
    /// True to search only `|d| = D r`.
    pub(super) tight: bool,
    /// True to separate sums as soon as there are two, not after all ranks.
    pub(super) early_sums: bool,
    /// True to try the last sensors of a lag first for the greatest ranks.
    pub(super) backwards: bool,
}

/// A walk. Its trail has two words for each branch: the branch, and how many of its alternatives were tried.
pub(super) struct Feasibility<'p, 'm> {
    problem: &'p Problem<'p>,
    sensors: usize,
    style: Style,
    trail: &'m mut [u32],
    constraints: Constraints<'p>,
    /// Sensors in the order in which ranks try them: by lag, then by number.
    preferred: [u8; MAX_SENSORS],
    /// For each rank, its sensor and the sign of that sensor's `d`.
    holder: [(u8, bool); MAX_SENSORS],
    /// Sensors without a rank.
    unranked: u64,
    /// The lowest rank that has a sensor; K if none has.
    ranked: usize,
    /// The lowest rank that has a value; K if none has.
    valued: usize,
    /// For each rank, its value.
    value: [i32; MAX_SENSORS],
}

// Indices are sensors or ranks below `sensors <= MAX_SENSORS`; the trail is read and written with `get`.
impl<'p, 'm> Feasibility<'p, 'm> {
    pub(super) fn new(problem: &'p Problem<'p>, trail: &'m mut [u32], style: Style) -> Self {
        let sensors = problem.lag.len();
        let mut preferred = [0; MAX_SENSORS];
        for (k, p) in preferred.iter_mut().enumerate() {
            *p = k as u8;
        }
        preferred[..sensors]
            .sort_unstable_by_key(|&i| (problem.lag[usize::from(i)], if style.backwards { u8::MAX - i } else { i }));
        Self {
            problem,
            sensors,
            style,
            trail,
            constraints: Constraints::new(problem),
            preferred,
            holder: [(0, false); MAX_SENSORS],
            unranked: if sensors == MAX_SENSORS { u64::MAX } else { (1 << sensors) - 1 },
            ranked: sensors,
            valued: sensors,
            value: [0; MAX_SENSORS],
        }
    }

    pub(super) fn run(&mut self, budget: &mut Budget<'_>, wait: &mut [i32; 2 * MAX_SENSORS]) -> Outcome {
        self.bound_d();
        if !self.fixed_orders() || !self.constraints.raise_anew() {
            return Outcome::Exhausted;
        }
        let mut depth = 0;
        let Some(branch) = self.next_branch(None) else {
            *wait = self.constraints.wait;
            return Outcome::Found(());
        };
        let (mut branch, mut tried) = (branch, 0);
        loop {
            if !budget.enter() {
                return Outcome::BudgetSpent;
            }
            if let Some(taken) = self.take(branch, tried) {
                self.keep(depth, branch, taken);
                depth += 1;
                match self.next_branch(Some(branch)) {
                    Some(next) => (branch, tried) = (next, 0),
                    None => {
                        *wait = self.constraints.wait;
                        return Outcome::Found(());
                    }
                }
            } else {
                let Some(above) = depth.checked_sub(1) else {
                    return Outcome::Exhausted;
                };
                depth = above;
                let taken;
                (branch, taken) = self.read_back(depth);
                self.untake(branch, taken);
                // The constraints that remain were met before, so they are met now.
                self.constraints.raise_anew();
                tried = taken + 1;
            }
        }
    }

    /// Enters the orders that the lags force; `false` if two sensors can fire in neither order.
    fn fixed_orders(&mut self) -> bool {
        for i in 0..self.sensors {
            for j in Members(self.problem.conflicts[i]) {
                if !self.constraints.can_follow(i, j) && !self.constraints.can_follow(j, i) {
                    return false;
                }
                if !self.constraints.can_follow(j, i) {
                    for phase in 0..2 {
                        self.constraints.order(Order { phase, first: i, second: j });
                    }
                }
            }
        }
        true
    }

    /// The branch after `last`: open orders first, then sums that are too close, then ranks and values from the top.
    fn next_branch(&self, last: Option<Branch>) -> Option<Branch> {
        let order = match last {
            None => self.open_order(0, 0),
            Some(Branch::Order(Order { phase, first, second })) => {
                self.open_order(first.max(second), 2 * first.min(second) + phase + 1)
            }
            Some(_) => None,
        };
        if let Some(order) = order {
            return Some(Branch::Order(order));
        }
        let close_sums = || {
            if self.problem.criterion == Criterion::Paper { self.close_sums() } else { None }
        };
        if self.style.early_sums {
            let sums = close_sums();
            if sums.is_some() {
                return sums;
            }
        }
        if self.ranked > 0 {
            return Some(Branch::Rank(self.ranked - 1));
        }
        if self.valued > 0 && !self.is_tight() {
            return Some(Branch::Value(self.valued - 1));
        }
        close_sums()
    }

    /// The next pair of conflicting sensors that can fire in either order, from sensor `i` and half pair `start` on.
    fn open_order(&self, i: usize, start: usize) -> Option<Order> {
        let mut start = start;
        for i in i..self.sensors {
            for half in start..2 * i {
                let (j, phase) = (half / 2, half % 2);
                let conflict = self.problem.conflicts[i] >> j & 1 == 1;
                if conflict && self.constraints.can_follow(i, j) && self.constraints.can_follow(j, i) {
                    return Some(Order { phase, first: j, second: i });
                }
            }
            start = 0;
        }
        None
    }

    /// Two sensors of known `d` whose `s` lie less than `D` apart in the least solution.
    fn close_sums(&self) -> Option<Branch> {
        let known = |i: usize| self.constraints.d[i][0] == self.constraints.d[i][1];
        for i in (0..self.sensors).filter(|&i| known(i)) {
            for j in (0..i).filter(|&j| known(j)) {
                if self.constraints.s(i).abs_diff(self.constraints.s(j)) < self.problem.separation {
                    return Some(if self.constraints.s(i) < self.constraints.s(j) {
                        Branch::Sum(i, j)
                    } else {
                        Branch::Sum(j, i)
                    });
                }
            }
        }
        None
    }

    /// Takes the first alternative of a branch, from `tried` on, for which the constraints can be met.
    fn take(&mut self, branch: Branch, tried: u32) -> Option<u32> {
        let before = self.constraints.wait;
        let mut alternative = tried;
        loop {
            match self.apply(branch, alternative) {
                Applied::None => return None,
                Applied::Skip => {}
                Applied::Done => {
                    if self.constraints.raise() {
                        return Some(alternative);
                    }
                    self.constraints.wait = before;
                    self.untake(branch, alternative);
                }
            }
            alternative += 1;
        }
    }

    /// Enters one alternative of a branch.
    fn apply(&mut self, branch: Branch, alternative: u32) -> Applied {
        match branch {
            Branch::Order(order) => {
                if alternative > 1 {
                    return Applied::None;
                }
                self.constraints.order(self.oriented(order, alternative));
            }
            Branch::Rank(rank) => {
                let (place, negative) = (alternative as usize / 2, alternative % 2 == 1);
                if place >= self.sensors {
                    return Applied::None;
                }
                let sensor = self.preferred[place];
                // Exchanging the phases changes every sign, so the greatest |d| may be taken as positive; and 0 has one
                // sign.
                let one_sign = rank + 1 == self.sensors || rank == 0 && self.is_tight();
                if self.unranked >> sensor & 1 == 0 || negative && one_sign {
                    return Applied::Skip;
                }
                self.holder[rank] = (sensor, negative);
                self.unranked &= !(1 << sensor);
                self.ranked = rank;
                self.bound_d();
            }
            Branch::Value(rank) => {
                let value = self.low(rank) + alternative as i32;
                if value > self.high(rank) {
                    return Applied::None;
                }
                self.value[rank] = value;
                self.valued = rank;
                self.bound_d();
            }
            Branch::Sum(low, high) => match alternative {
                0 => self.constraints.put_above(low, high),
                1 => self.constraints.put_above(high, low),
                _ => return Applied::None,
            },
        }
        Applied::Done
    }

    /// Withdraws an alternative.
    fn untake(&mut self, branch: Branch, alternative: u32) {
        match branch {
            Branch::Order(order) => self.constraints.forget_order(self.oriented(order, alternative)),
            Branch::Rank(rank) => {
                self.unranked |= 1 << self.holder[rank].0;
                self.ranked = rank + 1;
                self.bound_d();
            }
            Branch::Value(rank) => {
                self.valued = rank + 1;
                self.bound_d();
            }
            Branch::Sum(low, high) if alternative == 0 => self.constraints.forget_above(low, high),
            Branch::Sum(low, high) => self.constraints.forget_above(high, low),
        }
    }

    /// The order by lag first, the opposite one second.
    fn oriented(&self, order: Order, alternative: u32) -> Order {
        let Order { phase, first, second } = order;
        let by_lag = self.problem.lag[first] <= self.problem.lag[second];
        if by_lag == (alternative == 0) { order } else { Order { phase, first: second, second: first } }
    }

    /// Returns true if only `|d| = D r` need be searched; known once the orders are chosen.
    fn is_tight(&self) -> bool {
        self.style.tight || self.problem.criterion == Criterion::Exact && self.constraints.same_orders()
    }

    /// The least `|d|` of a rank.
    fn low(&self, rank: usize) -> i32 {
        let low = self.problem.separation as i32 * rank as i32;
        // Zero counts as positive.
        if self.holder[rank].1 && rank >= self.ranked { low.max(1) } else { low }
    }

    /// The greatest `|d|` of a rank, which leaves room for the ranks above.
    fn high(&self, rank: usize) -> i32 {
        let separation = self.problem.separation as i32;
        if self.ranked < self.sensors && self.is_tight() {
            separation * rank as i32
        } else if self.valued < self.sensors {
            self.value[self.valued] - separation * (self.valued as i32 - rank as i32)
        } else {
            self.problem.wait_max as i32 - separation * (self.sensors as i32 - 1 - rank as i32)
        }
    }

    /// Sets the range of every `d` from the ranks and values chosen.
    fn bound_d(&mut self) {
        for rank in self.ranked..self.sensors {
            let (low, high) = if rank >= self.valued {
                (self.value[rank], self.value[rank])
            } else {
                (self.low(rank), self.high(rank))
            };
            let (sensor, negative) = self.holder[rank];
            self.constraints.d[usize::from(sensor)] = if negative { [-high, -low] } else { [low, high] };
        }
        let cap = match self.ranked.checked_sub(1) {
            Some(rank) => self.high(rank),
            None => return,
        };
        for sensor in Members(self.unranked) {
            self.constraints.d[sensor] = [-cap, cap];
        }
    }

    /// Writes a branch and its current alternative to the trail.
    fn keep(&mut self, depth: usize, branch: Branch, taken: u32) {
        if let Some([word, alternative]) = self.trail.get_mut(2 * depth..2 * depth + 2) {
            (*word, *alternative) = (branch.pack(), taken);
        }
    }

    /// Reads a branch and its alternative from the trail.
    fn read_back(&self, depth: usize) -> (Branch, u32) {
        match self.trail.get(2 * depth..2 * depth + 2) {
            Some(&[word, taken]) => (Branch::unpack(word), taken),
            _ => (Branch::Rank(0), u32::MAX),
        }
    }
}

/// The result of entering an alternative.
enum Applied {
    /// The alternative stands.
    Done,
    /// Another alternative covers this one.
    Skip,
    /// No alternative has that number.
    None,
}

#[cfg(test)]
mod tests {
    use super::super::memory_words;
    use super::*;

    #[test]
    fn twelve_sensors_are_decided_in_sixteen_kibibytes() {
        // A decision, the waits it hands out and sets aside, and the memory lent; the rest of a call is a few words.
        let waits = 2 * size_of::<[i32; 2 * MAX_SENSORS]>();
        let lent = memory_words(12) * size_of::<u32>();
        assert_eq!(lent, 1784);
        assert!(size_of::<Feasibility<'_, '_>>() + waits + lent < 8 * 1024);
    }
}
