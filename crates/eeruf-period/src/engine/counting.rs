//! Bounds on the period by counting (docs/explanation/theory.md, section 5).
//!
//! If sensors differ, a ring whose sensors all have the smallest separation, gap and window requires less, so a bound
//! on its period is a bound on theirs. Write I for that gap, D for the separation, R for the window, and `own = min(I,
//! R)` for the time that a firing keeps free of the sensor's own next one.
//!
//! - **Clique.** w sensors that all have gaps to each other fire one by one: `T >= (w - 1) I + own`.
//! - **Density.** At any time at most alpha of the intervals `[t, t + I)` that begin with a firing are open. Each
//!   sensor keeps at least `I + own` open in two periods: `2 alpha T >= K (I + own)`. Here alpha is the size of the
//!   largest set without gaps, or a number of cliques that cover all sensors, which is no smaller.
//! - **Places.** The number of |d| that fit if density leaves little to spare: [`Pace`].
//! - **Classes.** The number of |d| that fit if clique and gap leave little to spare: [`Classes`].

use crate::engine::classes::{Classes, Kind};
use crate::engine::problem::Merged;
use crate::engine::sets::{Pace, cover};

/// An even ring that requires no more than a problem.
#[derive(Clone, Debug)]
pub(crate) struct Even {
    pub(crate) count: usize,
    /// Row x has bit y if there is a gap between x and y.
    pub(crate) rows: Vec<u64>,
    pub(crate) separation: i32,
    pub(crate) interval: i32,
    pub(crate) window: i32,
    /// The smallest |d| allowed.
    pub(crate) least: i32,
}

/// The numbers in a set of bits, in ascending order.
pub(crate) fn members(mut set: u64) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let least = set.trailing_zeros() as usize;
        set &= set.wrapping_sub(1);
        (least < 64).then_some(least)
    })
}

/// A period below which there is no schedule, by counting.
pub(crate) fn least_period(merged: &Merged) -> u32 {
    let one_by_one = cliques(merged).into_iter().map(|clique| one_by_one(merged, clique)).max();
    capacity(merged).max(in_sequence(merged)).max(of_even(merged)).max(one_by_one.unwrap_or(1))
}

/// Some large cliques: each sensor with those after it, cyclically, that have gaps to all sensors taken before.
fn cliques(merged: &Merged) -> Vec<u64> {
    let count = merged.count();
    let has_gaps = |x: usize, y: usize| merged.gap[x][y] > 0 && merged.gap[y][x] > 0;
    let from = |first: usize| {
        let grown = |set: u64, y: usize| if members(set).all(|x| has_gaps(x, y)) { set | 1 << y } else { set };
        (1..count).map(|step| (first + step) % count).fold(1 << first, grown)
    };
    (0..count).map(from).collect()
}

/// **One by one.** In two periods each sensor of a clique fires twice. After each firing of x the next firing of the
/// clique comes after the smallest gap of x or later; if it is x again, which happens only where a phase ends, twice in
/// two periods, after its window.
fn one_by_one(merged: &Merged, clique: u64) -> u32 {
    let least = |x: usize| members(clique).filter(|&y| y != x).map(|y| merged.gap[x][y]).min();
    let least = |x: usize| least(x).unwrap_or(merged.window[x]);
    let again = members(clique).map(|x| (least(x) - merged.window[x]).max(0)).max();
    (members(clique).map(least).sum::<i32>() - again.unwrap_or(0)) as u32
}

/// A counting argument of a certificate: the checker verifies that it excludes a period.
#[derive(Clone, Debug)]
pub(crate) enum Argument {
    /// The |d| in ascending order.
    Sequence,
    /// Neighbours along a line.
    Line(usize),
    /// Neighbours round a ring.
    Ring(usize),
    /// Sensors with gaps to each other: one set, sets that contain all sensors, or disjoint sets.
    Cliques(Vec<u64>),
}

impl Argument {
    /// An argument that excludes the period, if there is one.
    pub(crate) fn that_excludes(merged: &Merged, period: u32) -> Option<Self> {
        if in_sequence(merged) > period {
            return Some(Self::Sequence);
        }
        let even = Even::of(merged);
        let largest = even.as_ref().map(Even::largest_clique);
        if let Some(clique) =
            cliques(merged).into_iter().chain(largest).find(|&clique| one_by_one(merged, clique) > period)
        {
            return Some(Self::Cliques(vec![clique]));
        }
        let even = even?;
        let by = |is_by: &dyn Fn(&Bound) -> bool| {
            even.bounds(merged).iter().any(|bound| bound.period() > period && is_by(bound))
        };
        if by(&|bound| matches!(bound, Bound::Density { .. } | Bound::Places { .. })) {
            return Some(Self::Cliques(cover(merged).0));
        }
        let classes = Classes::of(&even).filter(|_| by(&|bound| matches!(bound, Bound::Classes { .. })))?;
        Some(match classes.kind {
            Kind::Line => Self::Line(classes.n as usize),
            Kind::Ring => Self::Ring(classes.n as usize),
            Kind::Cliques(_) => Self::Cliques(even.disjoint(classes.n as u32)),
        })
    }

    /// The lines of a certificate, with sensors in place of those of the merged problem.
    pub(crate) fn lines(&self, sensors: &[usize]) -> String {
        match self {
            Self::Sequence => "sequence\n".to_owned(),
            Self::Line(n) => format!("line {n}\n"),
            Self::Ring(n) => format!("ring {n}\n"),
            Self::Cliques(cliques) => lines_of(cliques, sensors),
        }
    }
}

/// The lines of a certificate for these cliques.
pub(crate) fn lines_of(cliques: &[u64], sensors: &[usize]) -> String {
    let row = |&clique: &u64| members(clique).map(|x| format!(" {}", sensors[x])).collect::<String>();
    cliques.iter().map(|clique| format!("clique{}\n", row(clique))).collect()
}

/// **Sequence.** In ascending order each `|d|` is at least the larger of two separations above the one before: the
/// least period over all sequences, by the number of sensors taken and the separation of the last. Among equal
/// separations the longest window comes first, since exchanging two changes no distance. Returns 1 if that takes too
/// long.
fn in_sequence(merged: &Merged) -> u32 {
    let mut separations = merged.separation.clone();
    separations.sort_unstable();
    separations.dedup();
    let windows = separations.iter().map(|own| {
        let alike = (0..merged.count()).filter(|&x| merged.separation[x] == *own);
        let mut windows: Vec<i32> = alike.map(|x| merged.window[x]).collect();
        windows.sort_unstable_by_key(|window| -window);
        windows
    });
    let (windows, kinds) = (windows.collect::<Vec<_>>(), separations.len());
    let states = windows.iter().fold(kinds, |states, alike| states.saturating_mul(alike.len() + 1));
    if states > 1 << 15 {
        return 1;
    }
    // The least period less the last |d|, by the numbers taken in mixed radix and the kind of the last.
    let mut rest = vec![0; states];
    for (taken, last) in (0..states / kinds).rev().flat_map(|taken| (0..kinds).map(move |last| (taken, last))) {
        let mut next = 1;
        let periods = windows.iter().zip(&separations).enumerate().filter_map(|(kind, (alike, &own))| {
            let radix = next;
            next *= alike.len() + 1;
            let window = alike.get(taken / radix % (alike.len() + 1))?;
            let first = if merged.stale_echo { (own + 1) / 2 } else { 0 };
            let apart = if taken == 0 { first } else { own.max(separations[last]) };
            Some(apart + rest[(taken + radix) * kinds + kind].max(*window))
        });
        rest[taken * kinds + last] = periods.min().unwrap_or(0);
    }
    rest.first().map_or(1, |&period| period as u32)
}

/// **Capacity.** The |d| of sensors with a window of at least R lie apart, so the largest of them is at least their
/// width, and its sensor fires twice within T - |d|.
pub(crate) fn capacity(merged: &Merged) -> u32 {
    let mut by_window: Vec<usize> = (0..merged.count()).collect();
    by_window.sort_unstable_by_key(|&x| -merged.window[x]);
    let (mut width, mut narrowest, mut best) = (0, i32::MAX, 1);
    for x in by_window {
        width += merged.separation[x];
        narrowest = narrowest.min(merged.separation[x]);
        let least = if merged.stale_echo { (narrowest + 1) / 2 } else { 0 };
        best = best.max(merged.window[x] + least + width - narrowest);
    }
    best as u32
}

/// A bound on the period of a ring of identical sensors, with its argument. Times are in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bound {
    /// The window plus all `|d|` with their separation; the smallest is at least `least`.
    Capacity { sensors: u32, separation: u32, window: u32, least: u32 },
    /// Sensors that all have gaps to each other fire one after the other, and then `own` passes.
    Clique { sensors: u32, interval: u32, own: u32 },
    /// At most this many sensors can keep their interval at the same time, with `own` after a sensor's second firing.
    Density { sensors: u32, at_once: u32, interval: u32, own: u32 },
    /// At most this many sensors can keep their interval at the same time, and too few `|d|` fit into the remaining
    /// time.
    Places { sensors: u32, at_once: u32, interval: u32, separation: u32, period: u32 },
    /// Sensors with gaps to each other fire one after the other, and too few `|d|` fit into the remaining time.
    Classes { clique: u32, sensors: u32, interval: u32, separation: u32, period: u32 },
}

impl Bound {
    /// The period below which there is no schedule.
    pub(crate) fn period(self) -> u32 {
        let times = |count: u32, time: u32| u64::from(count) * u64::from(time);
        let period = match self {
            Self::Capacity { sensors, separation, window, least } => {
                times(sensors.saturating_sub(1), separation) + times(1, window) + times(1, least)
            }
            Self::Clique { sensors, interval, own } => {
                times(sensors.saturating_sub(1), interval) + times(1, own.max(1))
            }
            Self::Density { sensors, at_once, interval, own } => {
                (times(sensors, interval) + times(sensors, own)).div_ceil(times(2, at_once.max(1)))
            }
            Self::Classes { period, .. } | Self::Places { period, .. } => u64::from(period),
        };
        u32::try_from(period.max(1)).unwrap_or(u32::MAX)
    }
}

/// The largest bound by counting for a ring of identical sensors.
pub(crate) fn strongest(merged: &Merged) -> Bound {
    let least = if merged.stale_echo { (merged.separation[0] + 1) / 2 } else { 0 };
    let (separation, window) = (merged.separation[0] as u32, merged.window[0] as u32);
    let capacity = Bound::Capacity { sensors: merged.count() as u32, separation, window, least: least as u32 };
    let larger = |best: Bound, bound: Bound| if bound.period() > best.period() { bound } else { best };
    Even::of(merged).iter().flat_map(|even| even.bounds(merged)).fold(capacity, larger)
}

/// The bound of the even ring that requires no more than the problem.
fn of_even(merged: &Merged) -> u32 {
    Even::of(merged).iter().flat_map(|even| even.bounds(merged)).map(Bound::period).max().unwrap_or(1)
}

impl Even {
    /// The bound of a problem; `None` without any gap.
    pub(crate) fn of(merged: &Merged) -> Option<Self> {
        let interval = merged.gap.iter().flatten().copied().filter(|&gap| gap > 0).min()?;
        let mut separations = merged.separation.clone();
        separations.sort_unstable();
        Some(Self {
            count: merged.count(),
            rows: merged.neighbours.iter().map(|row| row.iter().fold(0, |set, y| set | 1 << y)).collect(),
            // For two sensors the larger separation counts, so the smallest of all never does.
            separation: separations.get(1).or(separations.first()).copied()?,
            interval,
            window: merged.window.iter().copied().min()?,
            least: if merged.stale_echo { (separations.first().copied()? + 1) / 2 } else { 0 },
        })
    }

    /// Counts bounds that need gaps.
    fn bounds(&self, merged: &Merged) -> Vec<Bound> {
        let (sensors, interval) = (self.count as u32, self.interval as u32);
        let own = self.interval.min(self.window) as u32;
        let (cliques, times) = cover(merged);
        let at_once = (cliques.len() / times) as u32;
        let density = Bound::Density { sensors, at_once, interval, own };
        let clique = Bound::Clique { sensors: self.largest_clique().count_ones(), interval, own };
        let mut bounds = vec![clique, density];
        if self.window >= self.interval {
            bounds.push(Bound::Places {
                sensors,
                at_once,
                interval,
                separation: self.separation as u32,
                period: self.least_by_places(at_once, density.period()),
            });
        }
        bounds.extend(Classes::of(self).map(|classes| Bound::Classes {
            clique: classes.n as u32,
            sensors: classes.sensors(self) as u32,
            interval,
            separation: self.separation as u32,
            period: classes.period(self).max(1) as u32,
        }));
        bounds
    }

    /// The least period, from this one on, at which density is met and all `|d|` fit.
    fn least_by_places(&self, at_once: u32, from: u32) -> u32 {
        let pace = |period: u32| Pace::new(self.count, at_once as i32, self.interval, period as i32);
        let excludes = |period: &u32| pace(*period).excludes(self.separation, self.window, self.least);
        let enough = from.saturating_add(self.interval as u32);
        (from..enough).find(|period| !excludes(period)).unwrap_or(enough)
    }

    pub(crate) fn all(&self) -> u64 {
        u64::MAX >> (64 - self.count)
    }

    /// A large clique of `from` with sensor `first`, found greedily in ascending order.
    pub(crate) fn grow(&self, first: usize, from: u64) -> u64 {
        let mut clique = 1_u64 << first;
        let mut common = self.rows[first] & from;
        while let Some(x) = members(common).next() {
            clique |= 1 << x;
            common &= self.rows[x];
        }
        clique
    }

    /// A large clique.
    pub(crate) fn largest_clique(&self) -> u64 {
        let from = |x: usize| [self.grow(x, u64::MAX << x), self.grow(x, u64::MAX)];
        (0..self.count).flat_map(from).max_by_key(|clique| clique.count_ones()).unwrap_or(1)
    }

    /// Disjoint cliques of this size.
    pub(crate) fn disjoint(&self, size: u32) -> Vec<u64> {
        let (mut left, mut disjoint) = (self.all(), Vec::new());
        for x in 0..self.count {
            let clique = if left >> x & 1 == 1 { self.grow(x, left) } else { 0 };
            if clique.count_ones() == size {
                left &= !clique;
                disjoint.push(clique);
            }
        }
        disjoint
    }

    /// n, if the sensors form a closed ring in which each has a gap to the next n - 1 on both sides.
    pub(crate) fn ring(&self) -> Option<usize> {
        let n = (self.rows[0] >> 1).trailing_ones() as usize + 1;
        let turned = |x: usize| members(self.rows[x]).fold(0, |set, y| set | 1 << ((y + 1) % self.count));
        (n > 1 && (0..self.count).all(|x| self.rows[(x + 1) % self.count] == turned(x))).then_some(n)
    }
}

#[cfg(test)]
mod tests {
    use super::in_sequence;
    use crate::engine::descent::Random;
    use crate::engine::problem::Problem;

    /// The least period for the sensors with a bit in `left`, less the last |d|, whose separation is given; by trying
    /// all orders.
    fn tried(problem: &Problem, left: u64, last: Option<u32>) -> u32 {
        let after = |x: usize| {
            let own = problem.separation[x];
            let first = if problem.stale_echo { own.div_ceil(2) } else { 0 };
            let apart = last.map_or(first, |last| last.max(own));
            apart + problem.window[x].max(tried(problem, left & !(1 << x), Some(own)))
        };
        super::members(left).map(after).min().unwrap_or(0)
    }

    #[test]
    fn least_over_sequences_is_that_of_trying_all() {
        let mut random = Random::new(1);
        for case in 0..300 {
            let sensors = 1 + random.below(6) as usize;
            let separation: Vec<u32> = (0..sensors).map(|_| 1 + random.below(5)).collect();
            let window = (0..sensors).map(|_| 1 + random.below(20)).collect();
            let (stale_echo, together, gaps) = (random.below(2) == 1, Vec::new(), Vec::new());
            let problem = Problem { tick_us: (1, 1), separation, window, stale_echo, together, gaps };
            let all = tried(&problem, (1 << sensors) - 1, None);
            assert_eq!(in_sequence(&problem.merged()), all, "case {case}: {problem:?}");
        }
    }
}
