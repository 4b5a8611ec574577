//! Is there a table at all? Orders first, then ranks of `|d|`, then values only where ranks do not settle them.
//!
//! Sensors get their ranks from the greatest `|d|` down. The sensor of rank `r` has `|d| >= D r`, and as those above it take
//! their share, `|d| <= wait_max - D (K - 1 - r)`. Each choice is tested with the least waits that its difference constraints
//! allow ([`Least`]), so times stay intervals and a finer tick costs no more.
//!
//! **Where ranks suffice.** If conflicting sensors fire in the same order in both phases and the criterion is
//! [`Criterion::Exact`], then a table exists only if one exists with `|d| = D r` exactly. Let `(a, b)` solve the problem, with
//! `|d|` sorted as `v_0 < v_1 < ..`, and let `phi` be piecewise linear with `phi(0) = 0` and `phi(v_r) = D r`: neighbouring values
//! lie at least `D` apart, so `phi` never expands a difference. Put `m = min(a, b)`, `a' = m + phi(d+)`, `b' = m + phi(d-)`, where
//! `d+` and `d-` are the positive parts of `d` and `-d`. Exchanging the phases turns the set of constraints into itself; the
//! minimum of two solutions of difference constraints is a solution, so `m` in both phases is one. A constraint `q >= p + w`
//! holds for `m` and for `m + d+` (or `-`), and `phi(d_q) - phi(d_p)` lies between 0 and `d_q - d_p`, so it holds in between.
//!
//! In particular `n I + D (K - 1) <= T_p` for n mutual neighbours (THEORY: same order) needs no test of its own: the greatest rank
//! finds no sensor.

use super::least::{Least, Order};
use super::{Bits, Control, Criterion, Finish, MAX_SENSORS, Problem};

/// Words of memory that suffice for [`first`](super::Search::first), [`best`](super::Search::best) and
/// [`pareto`](super::Search::pareto) with so many sensors: 808 bytes for 8, 1,784 for 12.
#[must_use]
pub const fn memory_words(sensors: usize) -> usize {
    // Two choices of order a pair, one of s a pair, a rank and a value a sensor; two words a choice.
    let pairs = sensors * sensors.saturating_sub(1) / 2;
    2 * (3 * pairs + 2 * sensors) + 2
}

/// Decides whether a table exists, and leaves it in `wait` (`a` and `b` alternating).
pub(super) fn decide(
    problem: &Problem<'_>,
    memory: &mut [u32],
    control: &mut Control<'_>,
    wait: &mut [i32; 2 * MAX_SENSORS],
) -> Finish {
    let sensors = problem.lag.len();
    let conflict = problem.conflicts.iter().any(|&row| row != 0);
    // Sums below stay small after this.
    if problem.is_beyond_capacity() {
        return Finish::Exhausted;
    }
    // A single sensor is never compared with anything.
    let separation = if sensors == 1 { 0 } else { problem.separation };
    let interval = if conflict { problem.interval } else { 0 };
    let exact = Problem { criterion: Criterion::Exact, separation, interval, ..*problem };
    let finish = Decision::new(&exact, memory, Style::default()).run(control, wait);
    if problem.criterion == Criterion::Exact || finish != Finish::Found {
        // Without a table under the weaker criterion there is none under the stronger.
        return finish;
    }
    let paper = Problem { criterion: Criterion::Paper, ..exact };
    let mut slice = FIRST_SLICE;
    let mut tight = true;
    loop {
        // |d| = D r is only a good guess under this criterion: its failure proves nothing. Which way of walking is quick depends on
        // how tight the problem is, so each gets its turn, and more with every round.
        for style in STYLES {
            if style.tight && !tight {
                continue;
            }
            let finish = control.slice(slice, |control| Decision::new(&paper, memory, style).run(control, wait));
            match finish {
                Finish::Exhausted if style.tight => tight = false,
                Finish::BudgetSpent if !control.spent() => {}
                finish => return finish,
            }
        }
        slice = slice.saturating_mul(4);
    }
}

/// Nodes that each style may take in the first round.
const FIRST_SLICE: u64 = 200;

/// How a decision walks. Each style is exhaustive in what it looks at; only a tight one does not look at everything.
#[derive(Clone, Copy, Default)]
struct Style {
    /// Only `|d| = D r` is looked at.
    tight: bool,
    /// Sums are told apart as soon as there are two, not after all ranks.
    early_sums: bool,
    /// The greatest ranks go to the last sensors of a lag first.
    backwards: bool,
}

const STYLES: [Style; 5] = [
    Style { tight: true, early_sums: false, backwards: false },
    Style { tight: true, early_sums: true, backwards: false },
    Style { tight: true, early_sums: false, backwards: true },
    Style { tight: true, early_sums: true, backwards: true },
    Style { tight: false, early_sums: false, backwards: false },
];

/// Which choice comes next.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Choice {
    /// The order of two sensors in a phase.
    Order(Order),
    /// The sensor with this rank of `|d|`, and its sign.
    Rank(usize),
    /// The value of `|d|` with this rank.
    Value(usize),
    /// Which of two sensors has the greater `s`.
    Sum(usize, usize),
}

/// The trail: two words a choice, the choice itself and how many of its alternatives were tried.
struct Decision<'p, 'm> {
    problem: &'p Problem<'p>,
    sensors: usize,
    style: Style,
    trail: &'m mut [u32],
    least: Least<'p>,
    /// Sensors in the order in which ranks try them: by lag, then by number.
    preferred: [u8; MAX_SENSORS],
    /// By rank: the sensor that has it and whether its `d` is negative.
    holder: [(u8, bool); MAX_SENSORS],
    /// Sensors without a rank.
    unranked: u64,
    /// Ranks from this one up have a sensor; K when none has.
    ranked: usize,
    /// Ranks from this one up have a value; K when none has.
    valued: usize,
    /// By rank: its value.
    value: [i32; MAX_SENSORS],
}

// Indices are sensors or ranks below `sensors <= MAX_SENSORS`; the trail is read and written with `get`.
impl<'p, 'm> Decision<'p, 'm> {
    fn new(problem: &'p Problem<'p>, trail: &'m mut [u32], style: Style) -> Self {
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
            least: Least::new(problem),
            preferred,
            holder: [(0, false); MAX_SENSORS],
            unranked: if sensors == MAX_SENSORS { u64::MAX } else { (1 << sensors) - 1 },
            ranked: sensors,
            valued: sensors,
            value: [0; MAX_SENSORS],
        }
    }

    fn run(&mut self, control: &mut Control<'_>, wait: &mut [i32; 2 * MAX_SENSORS]) -> Finish {
        self.bound_d();
        if !self.fixed_orders() || !self.least.raise_anew() {
            return Finish::Exhausted;
        }
        let mut depth = 0;
        let Some(choice) = self.next_choice(None) else {
            *wait = self.least.wait;
            return Finish::Found;
        };
        let (mut choice, mut tried) = (choice, 0);
        loop {
            if !control.enter() {
                return Finish::BudgetSpent;
            }
            if let Some(taken) = self.take(choice, tried) {
                self.keep(depth, choice, taken);
                depth += 1;
                match self.next_choice(Some(choice)) {
                    Some(next) => (choice, tried) = (next, 0),
                    None => {
                        *wait = self.least.wait;
                        return Finish::Found;
                    }
                }
            } else {
                let Some(above) = depth.checked_sub(1) else {
                    return Finish::Exhausted;
                };
                depth = above;
                let taken;
                (choice, taken) = self.kept(depth);
                self.untake(choice, taken);
                // The constraints that remain were met before, so they are met now.
                self.least.raise_anew();
                tried = taken + 1;
            }
        }
    }

    /// Enters the orders that the lags force; `false` if two sensors can fire in neither order.
    fn fixed_orders(&mut self) -> bool {
        for i in 0..self.sensors {
            for j in Bits(self.problem.conflicts[i]) {
                if !self.least.can_follow(i, j) && !self.least.can_follow(j, i) {
                    return false;
                }
                if !self.least.can_follow(j, i) {
                    for phase in 0..2 {
                        self.least.order(Order { phase, first: i, second: j });
                    }
                }
            }
        }
        true
    }

    /// The choice after `last`: open orders, sums that are too close, ranks from the top, values from the top.
    fn next_choice(&self, last: Option<Choice>) -> Option<Choice> {
        let order = match last {
            None => self.open_order(0, 0),
            Some(Choice::Order(Order { phase, first, second })) => {
                self.open_order(first.max(second), 2 * first.min(second) + phase + 1)
            }
            Some(_) => None,
        };
        if let Some(order) = order {
            return Some(Choice::Order(order));
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
            return Some(Choice::Rank(self.ranked - 1));
        }
        if self.valued > 0 && !self.is_tight() {
            return Some(Choice::Value(self.valued - 1));
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
                if conflict && self.least.can_follow(i, j) && self.least.can_follow(j, i) {
                    return Some(Order { phase, first: j, second: i });
                }
            }
            start = 0;
        }
        None
    }

    /// Two sensors of known `d` whose `s` lie less than `D` apart in the least solution.
    fn close_sums(&self) -> Option<Choice> {
        let known = |i: usize| self.least.d[i][0] == self.least.d[i][1];
        for i in (0..self.sensors).filter(|&i| known(i)) {
            for j in (0..i).filter(|&j| known(j)) {
                if self.least.s(i).abs_diff(self.least.s(j)) < self.problem.separation {
                    return Some(if self.least.s(i) < self.least.s(j) { Choice::Sum(i, j) } else { Choice::Sum(j, i) });
                }
            }
        }
        None
    }

    /// Takes the first alternative of a choice, from `tried` on, that leaves the constraints satisfiable.
    fn take(&mut self, choice: Choice, tried: u32) -> Option<u32> {
        let before = self.least.wait;
        let mut alternative = tried;
        loop {
            match self.apply(choice, alternative) {
                Applied::None => return None,
                Applied::Skip => {}
                Applied::Done => {
                    if self.least.raise() {
                        return Some(alternative);
                    }
                    self.least.wait = before;
                    self.untake(choice, alternative);
                }
            }
            alternative += 1;
        }
    }

    /// Enters one alternative of a choice.
    fn apply(&mut self, choice: Choice, alternative: u32) -> Applied {
        match choice {
            Choice::Order(order) => {
                if alternative > 1 {
                    return Applied::None;
                }
                self.least.order(self.oriented(order, alternative));
            }
            Choice::Rank(rank) => {
                let (place, negative) = (alternative as usize / 2, alternative % 2 == 1);
                if place >= self.sensors {
                    return Applied::None;
                }
                let sensor = self.preferred[place];
                // Exchanging the phases changes every sign, so the greatest |d| may be taken as positive; and 0 has one sign.
                let one_sign = rank + 1 == self.sensors || rank == 0 && self.is_tight();
                if self.unranked >> sensor & 1 == 0 || negative && one_sign {
                    return Applied::Skip;
                }
                self.holder[rank] = (sensor, negative);
                self.unranked &= !(1 << sensor);
                self.ranked = rank;
                self.bound_d();
            }
            Choice::Value(rank) => {
                let value = self.low(rank) + alternative as i32;
                if value > self.high(rank) {
                    return Applied::None;
                }
                self.value[rank] = value;
                self.valued = rank;
                self.bound_d();
            }
            Choice::Sum(low, high) => match alternative {
                0 => self.least.put_above(low, high),
                1 => self.least.put_above(high, low),
                _ => return Applied::None,
            },
        }
        Applied::Done
    }

    /// Withdraws an alternative.
    fn untake(&mut self, choice: Choice, alternative: u32) {
        match choice {
            Choice::Order(order) => self.least.forget_order(self.oriented(order, alternative)),
            Choice::Rank(rank) => {
                self.unranked |= 1 << self.holder[rank].0;
                self.ranked = rank + 1;
                self.bound_d();
            }
            Choice::Value(rank) => {
                self.valued = rank + 1;
                self.bound_d();
            }
            Choice::Sum(low, high) if alternative == 0 => self.least.forget_above(low, high),
            Choice::Sum(low, high) => self.least.forget_above(high, low),
        }
    }

    /// The order by lag first, the opposite one second.
    fn oriented(&self, order: Order, alternative: u32) -> Order {
        let Order { phase, first, second } = order;
        let by_lag = self.problem.lag[first] <= self.problem.lag[second];
        if by_lag == (alternative == 0) { order } else { Order { phase, first: second, second: first } }
    }

    /// Whether `|d| = D r` is all that needs looking at; known once the orders are chosen.
    fn is_tight(&self) -> bool {
        self.style.tight || self.problem.criterion == Criterion::Exact && self.least.same_orders()
    }

    /// The least `|d|` of a rank.
    fn low(&self, rank: usize) -> i32 {
        let low = self.problem.separation as i32 * rank as i32;
        // Zero counts as positive.
        if self.holder[rank].1 && rank >= self.ranked { low.max(1) } else { low }
    }

    /// The greatest `|d|` of a rank, which leaves room for those above it.
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
            self.least.d[usize::from(sensor)] = if negative { [-high, -low] } else { [low, high] };
        }
        let cap = match self.ranked.checked_sub(1) {
            Some(rank) => self.high(rank),
            None => return,
        };
        for sensor in Bits(self.unranked) {
            self.least.d[sensor] = [-cap, cap];
        }
    }

    /// Writes a choice and the alternative taken to the trail.
    fn keep(&mut self, depth: usize, choice: Choice, taken: u32) {
        let (kind, x, y, z) = match choice {
            Choice::Order(Order { phase, first, second }) => (0, first, second, phase),
            Choice::Rank(rank) => (1, rank, 0, 0),
            Choice::Value(rank) => (2, rank, 0, 0),
            Choice::Sum(low, high) => (3, low, high, 0),
        };
        if let Some([word, alternative]) = self.trail.get_mut(2 * depth..2 * depth + 2) {
            *word = kind | (x as u32) << 8 | (y as u32) << 16 | (z as u32) << 24;
            *alternative = taken;
        }
    }

    /// Reads it back.
    fn kept(&self, depth: usize) -> (Choice, u32) {
        let Some(&[word, taken]) = self.trail.get(2 * depth..2 * depth + 2) else {
            return (Choice::Rank(0), u32::MAX);
        };
        let (x, y, z) = ((word >> 8 & 255) as usize, (word >> 16 & 255) as usize, (word >> 24) as usize);
        let choice = match word & 255 {
            0 => Choice::Order(Order { phase: z, first: x, second: y }),
            1 => Choice::Rank(x),
            2 => Choice::Value(x),
            _ => Choice::Sum(x, y),
        };
        (choice, taken)
    }
}

/// What became of an alternative.
enum Applied {
    /// It stands.
    Done,
    /// It is covered by another one.
    Skip,
    /// There is none of that number.
    None,
}

#[cfg(test)]
mod tests {
    use super::super::memory_words;
    use super::*;

    #[test]
    fn twelve_sensors_are_decided_in_sixteen_kibibytes() {
        // A decision, the waits it hands out and sets aside, and the memory lent; what else a call keeps is a few words.
        let waits = 2 * size_of::<[i32; 2 * MAX_SENSORS]>();
        let lent = memory_words(12) * size_of::<u32>();
        assert_eq!(lent, 1784);
        assert!(size_of::<Decision<'_, '_>>() + waits + lent < 8 * 1024);
    }
}
