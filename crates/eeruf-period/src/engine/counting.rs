//! Bounds on the period by counting (docs/explanation/theory.md, section 5).
//!
//! Where sensors differ, a ring whose sensors all have the smallest separation, gap and window asks for less, so a
//! bound on its period is one on theirs. Write I for that gap, D for the separation, R for the window, and
//! `own = min(I, R)` for the time that a firing keeps free of the sensor's own next one.
//!
//! - **Clique.** w sensors of which each has a gap to each other fire 2 w times in two periods. Between consecutive
//!   ones of these firings pass at least I, or R where both are of the same sensor, which happens only where one phase
//!   ends and the next begins, twice in two periods: `T >= (w - 1) I + own`.
//! - **Density.** At any time at most alpha of the intervals `[t, t + I)` that begin with a firing are open. Each
//!   sensor keeps at least `I + own` open in two periods: `2 alpha T >= K (I + own)`. Here alpha is the size of the
//!   largest set without gaps, or a number of cliques that cover all sensors, which is no smaller.
//! - **Classes.** How few |d| fit where clique and gap leave little to spare: [`Classes`].

use crate::engine::problem::Merged;

/// An even ring that asks for no more than a problem.
#[derive(Clone, Debug)]
struct Even {
    count: usize,
    /// Row x has bit y if there is a gap between x and y.
    rows: Vec<u64>,
    separation: i32,
    interval: i32,
    window: i32,
    /// The smallest |d| allowed.
    least: i32,
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
    capacity(merged).max(in_sequence(merged)).max(of_even(merged))
}

/// **Sequence.** In ascending order each `|d|` is at least the larger of two separations above the one before: the
/// least period over all sequences, by the sensors taken and the separation of the last. Of equal separations the
/// longest window comes first, as exchanging two changes no distance. 1 where that takes too long.
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

/// **Capacity.** The |d| of those with a window of R at least lie apart, so that the largest of them is at least their
/// width, and that sensor fires twice within T - |d|.
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

/// A bound on the period of a ring whose sensors are all alike, with the argument that gives it. Times are in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bound {
    /// The window, and behind it all `|d|` with their separation; the smallest is at least `least`.
    Capacity { sensors: u32, separation: u32, window: u32, least: u32 },
    /// Sensors that all have gaps to each other fire one after the other; `own` passes after the last of them.
    Clique { sensors: u32, interval: u32, own: u32 },
    /// At most this many sensors can keep their interval at the same time, and `own` after their second firing.
    Density { sensors: u32, at_once: u32, interval: u32, own: u32 },
    /// Sensors that all have gaps to each other fire one after the other, and too few `|d|` fit into the little time
    /// that leaves.
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
            Self::Classes { period, .. } => u64::from(period),
        };
        u32::try_from(period.max(1)).unwrap_or(u32::MAX)
    }
}

/// The largest bound of a ring whose sensors are all alike, by counting.
pub(crate) fn strongest(merged: &Merged) -> Bound {
    let least = if merged.stale_echo { (merged.separation[0] + 1) / 2 } else { 0 };
    let (separation, window) = (merged.separation[0] as u32, merged.window[0] as u32);
    let capacity = Bound::Capacity { sensors: merged.count() as u32, separation, window, least: least as u32 };
    let larger = |best: Bound, bound: Bound| if bound.period() > best.period() { bound } else { best };
    Even::of(merged).iter().flat_map(Even::bounds).fold(capacity, larger)
}

/// The bound of the even ring that asks for no more.
fn of_even(merged: &Merged) -> u32 {
    Even::of(merged).iter().flat_map(Even::bounds).map(Bound::period).max().unwrap_or(1)
}

impl Even {
    /// `None` without any gap.
    fn of(merged: &Merged) -> Option<Self> {
        let interval = merged.gap.iter().flatten().copied().filter(|&gap| gap > 0).min()?;
        let mut separations = merged.separation.clone();
        separations.sort_unstable();
        Some(Self {
            count: merged.count(),
            rows: merged.neighbours.iter().map(|row| row.iter().fold(0, |set, y| set | 1 << y)).collect(),
            // Of two sensors the larger counts, so the smallest of all never does.
            separation: separations.get(1).or(separations.first()).copied()?,
            interval,
            window: merged.window.iter().copied().min()?,
            least: if merged.stale_echo { (separations.first().copied()? + 1) / 2 } else { 0 },
        })
    }

    /// The bounds that need gaps.
    fn bounds(&self) -> impl Iterator<Item = Bound> {
        let (sensors, interval) = (self.count as u32, self.interval as u32);
        let own = self.interval.min(self.window) as u32;
        let (clique, cover) = self.cliques();
        let at_once = self.ring().map_or(cover, |n| self.count / n) as u32;
        let classes = Classes::of(self).map(|classes| Bound::Classes {
            clique: classes.n as u32,
            sensors: (classes.n * classes.cliques) as u32,
            interval,
            separation: self.separation as u32,
            period: classes.period(self).max(1) as u32,
        });
        let clique = Bound::Clique { sensors: clique as u32, interval, own };
        [clique, Bound::Density { sensors, at_once, interval, own }].into_iter().chain(classes)
    }

    fn all(&self) -> u64 {
        u64::MAX >> (64 - self.count)
    }

    /// A large clique among the sensors `from`, with sensor `first`: greedily, upwards.
    fn grow(&self, first: usize, from: u64) -> u64 {
        let mut clique = 1_u64 << first;
        let mut common = self.rows[first] & from;
        while let Some(x) = members(common).next() {
            clique |= 1 << x;
            common &= self.rows[x];
        }
        clique
    }

    /// The size of a large clique, and a number of cliques that cover all sensors.
    fn cliques(&self) -> (usize, usize) {
        let size = |x: usize, from: u64| self.grow(x, from).count_ones() as usize;
        let largest = (0..self.count).map(|x| size(x, u64::MAX << x).max(size(x, u64::MAX))).max();
        let (mut left, mut cover) = (self.all(), 0);
        while let Some(x) = members(left).next() {
            left &= !self.grow(x, left);
            cover += 1;
        }
        (largest.unwrap_or(1), cover)
    }

    /// A number of disjoint cliques of the largest size.
    fn disjoint(&self, size: usize) -> usize {
        let (mut left, mut disjoint) = (self.all(), 0);
        for x in 0..self.count {
            let clique = if left >> x & 1 == 1 { self.grow(x, left) } else { 0 };
            if clique.count_ones() as usize == size {
                left &= !clique;
                disjoint += 1;
            }
        }
        disjoint.max(1)
    }

    /// n, if the sensors stand on a closed ring where each has a gap to the next n - 1 on both sides.
    fn ring(&self) -> Option<usize> {
        let n = (self.rows[0] >> 1).trailing_ones() as usize + 1;
        let turned = |x: usize| members(self.rows[x]).fold(0, |set, y| set | 1 << ((y + 1) % self.count));
        (n > 1 && (0..self.count).all(|x| self.rows[(x + 1) % self.count] == turned(x))).then_some(n)
    }
}

/// The least slack of a period for sensors that all conflict, so that all their `|d|` find room.
///
/// Take n sensors that all conflict, in a period `T_p = n I + sigma`, with `R >= I`. Any two firings that follow each
/// other are I apart, also those of one sensor. If a sensor is the p-th of them in phase a and the q-th in phase b,
/// `n + p - q` such steps lie between its firing in b and the next in a, and `n - p + q` between a and the next b, so
/// with `c = p - q`
///
/// ```text
/// T_p + d >= (n + c) I,  T_p - d >= (n - c) I,  that is  c I - sigma <= d <= c I + sigma.
/// ```
///
/// Its **class** is `|c|`. As long as `sigma < I` each class has room for as many `|d|` as fit D apart into
/// `|c| I - sigma ..= |c| I + sigma`, cut off at `least` below and at the `T_p - R` that the window leaves above. The n
/// values c are how far the places of a permutation move. **Disjoint cliques** share the room of the classes.
///
/// **Line** (each n adjacent sensors conflict). Sensors i and i + n both conflict with the n - 1 between them, whose
/// firings leave `2 (n - 1)` gaps, in two periods end to end. A gap with u firings of sensor i and v of sensor i + n in
/// it is at least `(1 + max(u, v)) I` long; if `2 sigma < I`, together they are `2 T_p < (2 n + 1) I` long, so the sum
/// of `max(u, v)` is at most 2. As u and v sum to 2 each, `u = v` in each gap: sensor i + n takes the places of sensor
/// i. (Should i be last in both phases, i + n may instead be first in both: that moves all places of the sensors
/// between by one, in both phases alike.) So c of sensor x depends on `x mod n` alone: *one* permutation for all, and
/// each of its places needs room for `K / n` sensors or more.
///
/// **Ring** with K a multiple of n, `K >= 2 n`. The same goes all round. Let x and y conflict, x before y in phase b
/// and behind it in a: `a_x - a_y >= (p_x - p_y) I` and `b_y - b_x >= (q_y - q_x) I`, so `e = d - c I` is no smaller
/// for x than for y. If `c_x > 0`, somebody in each clique is overtaken so; there is one on either side of x, n sensors
/// apart and so of one class, and their e differ by D. Hence `e_x >= -sigma + D`, and likewise `e_x <= sigma - D` if
/// `c_x < 0`: in terms of `|d|` every class but 0 loses D at the lower end.
///
/// **Ring of `K = 2 n`.** Every sensor conflicts with all but the one opposite, and both fire in the same 2 n places of
/// two periods, of which each takes as long as its two firings are apart. The time from one firing to the next is
/// `T_p + d` or `T_p - d`; of two opposite sensors these times differ by D at least, so the two places that they share
/// take D together. (If they are next to each other, because the sensor that is last in one phase is first in the next,
/// then it is I from each firing to the next, and from the first of the four to the last `I + D`.) All n pairs of
/// places, with I behind each place: `2 T_p >= 2 n I + n D`.
struct Classes {
    n: i32,
    cliques: i32,
    line: bool,
    /// A ring of a multiple of n sensors.
    ring: bool,
}

/// The places tried before giving up on a permutation, which then says nothing.
const STEPS: u32 = 1 << 15;

impl Classes {
    fn of(even: &Even) -> Option<Self> {
        let (k, first) = (even.count, even.rows[0]);
        // Sensors 1 to n - 1 have a gap to sensor 0, and more only round the end of a ring.
        let n = (first >> 1).trailing_ones() as usize + 1;
        let row = |x: usize| (0..k).filter(|&y| x != y && x.abs_diff(y) < n).fold(0, |row, y| row | 1 << y);
        let line = (0..k).all(|x| even.rows[x] == row(x));
        let around = k >= 2 * n && k % n == 0 && first.count_ones() as usize == 2 * (n - 1);
        let ring = around && even.ring().is_some();
        let (n, cliques) = if line || ring {
            (n, k / n)
        } else {
            let (size, _) = even.cliques();
            (size, even.disjoint(size))
        };
        let counts = n >= 2 && even.window >= even.interval;
        counts.then_some(Self { n: n as i32, cliques: cliques as i32, line, ring })
    }

    /// A period below which there is no schedule; it may be smaller than other bounds.
    fn period(&self, even: &Even) -> i32 {
        let Some(mut yes) = even.interval.checked_mul(self.n + 1) else { return 0 };
        let mut no = yes - even.interval - 1;
        while no + 1 < yes {
            let middle = no + (yes - no) / 2;
            if self.excludes(even, middle) { no = middle } else { yes = middle }
        }
        yes
    }

    /// Returns true if too few |d| fit into the classes at this period, at least n I.
    fn excludes(&self, even: &Even, period: i32) -> bool {
        let (n, cliques, separation) = (self.n, self.cliques, even.separation);
        let spare = period - n * even.interval;
        let alike = cliques == 1 || (self.line || self.ring) && 2 * spare < even.interval;
        let (mut sum, mut rooms) = (0, Vec::new());
        for class in 0..n {
            let passed = if self.ring && alike && class > 0 { separation } else { 0 };
            let middle = class * even.interval;
            let (low, high) = ((middle - spare + passed).max(even.least), period - even.window);
            let high = high.min(middle + spare);
            let values = if low <= high { (high - low) / separation + 1 } else { 0 };
            sum += values.min(n * cliques);
            rooms.push(values / cliques);
        }
        let opposite = self.ring && alike && cliques == 2 && 2 * spare < n * separation;
        sum < n * cliques || opposite || alike && !permutes(&mut rooms)
    }
}

/// Returns true if some permutation of the places moves no more of them by each distance than there is room for, or if
/// that takes too long to find out.
fn permutes(room: &mut [i32]) -> bool {
    let n = room.len();
    let all = u64::MAX >> (64 - n);
    // Where each place goes, and where it may still be tried to go.
    let (mut to, mut open) = (vec![0; n], vec![all; n]);
    let (mut free, mut from) = (all, 0);
    for _ in 0..STEPS {
        if from == n {
            return true;
        }
        if let Some(p) = members(open[from] & free).find(|p| room[p.abs_diff(from)] > 0) {
            room[p.abs_diff(from)] -= 1;
            free &= !(1 << p);
            open[from] &= u64::MAX << p << 1;
            (to[from], from) = (p, from + 1);
            continue;
        }
        open[from] = all;
        if from == 0 {
            return false;
        }
        from -= 1;
        room[to[from].abs_diff(from)] += 1;
        free |= 1 << to[from];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::in_sequence;
    use crate::engine::descent::Random;
    use crate::engine::problem::Problem;

    /// The least period of those with a bit in `left`, less the last |d|, whose separation is given, by trying all.
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
            let (stale_echo, over_reals, together, gaps) = (random.below(2) == 1, false, Vec::new(), Vec::new());
            let problem = Problem { tick_us: (1, 1), separation, window, stale_echo, over_reals, together, gaps };
            let all = tried(&problem, (1 << sensors) - 1, None);
            assert_eq!(in_sequence(&problem.merged()), all, "case {case}: {problem:?}");
        }
    }
}
