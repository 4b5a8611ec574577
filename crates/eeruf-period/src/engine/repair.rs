//! Schedules by repair: sensors that break a need move, one at a time, to the times at which they break least.
//!
//! *Min-conflicts* (Minton, Johnston, Philips and Laird 1992) with *breakout* weights (Morris 1993) of each pair's gaps
//! and separation: needs that a move without gain leaves broken weigh more. A move is to the best pair of times of one
//! sensor. The cost of a pair is the sum of the costs of both times and of `|d|`: for each `d` two rows are added.

use crate::engine::construct::Times;
use crate::engine::descent::Random;
use crate::engine::problem::Merged;
use crate::engine::search::FiringTimes;

/// Weight at which all weights are halved, to keep sums small.
const HEAVY: i16 = 256;
/// Number of pairs of times that cost as much as a node of a search.
pub(crate) const PAIRS: u64 = 1 << 15;

/// The least and the greatest `|d|` that x may have by itself.
fn sizes(merged: &Merged, period: i32, x: usize) -> (i32, i32) {
    let least = if merged.stale_echo { (merged.separation[x] + 1) / 2 } else { 0 }.min(period - 1);
    (least, (period - merged.window[x]).clamp(least, period - 1))
}

/// Firing times that violate some needs of a period, and their repair.
pub(crate) struct Repair {
    random: Random,
    pub(crate) period: i32,
    times: Times,
    /// Weights of the gaps, then of the separations, of each pair in both directions.
    weights: [Vec<i16>; 2],
    /// Number of needs that each sensor violates with others.
    broken: Vec<i16>,
    /// The sensor that moved last.
    last: usize,
    /// Buffers for the costs of a sensor's times in phases a and b, and of its `|d|`.
    costs: [Vec<i16>; 3],
}

impl Repair {
    /// A repair that begins with times for a longer period.
    pub(crate) fn new(merged: &Merged, period: u32, fire: &FiringTimes, seed: u64) -> Self {
        let (count, period) = (merged.count(), period as i32);
        let mut times: Times = merged.firsts().iter().map(|&x| fire.each_ref().map(|times| times[x] as i32)).collect();
        for (x, [a, b]) in times.iter_mut().enumerate() {
            let (least, most) = sizes(merged, period, x);
            let size = (*a - *b).abs().min(most).max(least);
            let first = (*a).min(*b).min(period - 1 - size);
            (*a, *b) = if a < b { (first, first + size) } else { (first + size, first) };
        }
        let weights = [vec![1; count * count], vec![1; count * count]];
        let (broken, costs) = (vec![0; count], [const { Vec::new() }; 3]);
        let mut repair = Self { random: Random::new(seed), period, times, weights, broken, last: count, costs };
        for x in 0..count {
            repair.broken[x] = (0..count).filter(|&y| y != x).flat_map(|y| repair.breaks(merged, x, y)).sum();
        }
        repair
    }

    /// The times, sensor by sensor.
    pub(crate) fn fire(&self, merged: &Merged) -> FiringTimes {
        [0, 1].map(|phase: usize| merged.of_sensor.iter().map(|&one| self.times[one][phase] as u32).collect())
    }

    /// The number of needs that x and y violate together, 0 or 1 each: gaps, separation.
    fn breaks(&self, merged: &Merged, x: usize, y: usize) -> [i16; 2] {
        let (to, back, [own, other]) = (merged.gap[x][y], merged.gap[y][x], [self.times[x], self.times[y]]);
        let gaps = to > 0
            && (0..2).any(|phase| {
                let later = other[phase] - own[phase];
                let next = self.period + other[1 - phase] - own[phase];
                let before = self.period + own[phase] - other[1 - phase];
                -back < later && later < to || next < to || before < back
            });
        let size = |[a, b]: [i32; 2]| (a - b).abs();
        [gaps, (size(own) - size(other)).abs() < merged.apart(x, y)].map(i16::from)
    }

    /// Moves a sensor. Returns true if the times then keep all needs.
    pub(crate) fn step(&mut self, merged: &Merged) -> bool {
        let count = merged.count();
        let broken = |x: &usize| self.broken[*x] > 0 && *x != self.last;
        // Two sensors break a need, so there is always another one.
        let drawn = self.random.below((0..count).filter(broken).count() as u32) as usize;
        let Some(x) = (0..count).filter(broken).nth(drawn) else { return true };
        self.weigh(merged, x);
        let (is_gain, to) = self.best(merged, x);
        let (before, mut is_heavy) = (self.times[x], false);
        self.last = x;
        for y in (0..count).filter(|&y| y != x) {
            self.times[x] = before;
            let old: i16 = self.breaks(merged, x, y).iter().sum();
            self.times[x] = to;
            let breaks = self.breaks(merged, x, y);
            let more = breaks[0] + breaks[1] - old;
            self.broken[x] += more;
            self.broken[y] += more;
            for (weights, breaks) in self.weights.iter_mut().zip(breaks).filter(|_| !is_gain) {
                weights[x * count + y] += breaks;
                weights[y * count + x] += breaks;
                is_heavy |= weights[x * count + y] >= HEAVY;
            }
        }
        if is_heavy {
            self.weights.iter_mut().flatten().for_each(|weight| *weight = (*weight + 1) / 2);
        }
        self.broken.iter().all(|needs| *needs == 0)
    }

    /// Computes the cost of each time of x and of each `|d|`: the sum of the weights of violated needs.
    fn weigh(&mut self, merged: &Merged, x: usize) {
        let Self { period, times, weights: [of_gaps, of_sizes], costs, .. } = self;
        let (period, count) = (*period, merged.count());
        for costs in costs.iter_mut() {
            costs.clear();
            costs.resize(period as usize, 0);
        }
        // Strictly between.
        let mut add = |of: usize, from: i32, to: i32, weight: i16| {
            let (from, to) = ((from + 1).clamp(0, period), to.clamp(0, period));
            for cost in costs[of].get_mut(from as usize..to as usize).into_iter().flatten() {
                *cost = cost.saturating_add(weight);
            }
        };
        for &y in &merged.neighbours[x] {
            let (to, back, weight) = (merged.gap[x][y], merged.gap[y][x], of_gaps[x * count + y]);
            for phase in 0..2 {
                let (beside, next) = (times[y][phase], times[y][1 - phase]);
                add(phase, beside - to, beside + back, weight);
                add(phase, period + next - to, period, weight);
                add(phase, -1, next + back - period, weight);
            }
        }
        for y in (0..count).filter(|&y| y != x) {
            let (size, apart) = ((times[y][0] - times[y][1]).abs(), merged.apart(x, y));
            add(2, size - apart, size + apart, of_sizes[x * count + y]);
        }
    }

    /// The times of x that violate least, at random among equal ones and different from the current ones if possible;
    /// true if they violate less than the current ones.
    fn best(&mut self, merged: &Merged, x: usize) -> (bool, [i32; 2]) {
        let Self { random, period, times, costs: [of_a, of_b, of_size], .. } = self;
        let (first, last) = sizes(merged, *period, x);
        let period = *period as usize;
        let (mut least, mut change, mut ties) = (i16::MAX, [0; 2], 0);
        for size in first as usize..=last as usize {
            if of_size[size] > least {
                continue;
            }
            for [a, b] in [[size, 0], [0, size]] {
                let pairs = of_a[a..period - b].iter().zip(&of_b[b..period - a]);
                let cost = pairs.map(|(a, b)| a.saturating_add(*b)).fold(i16::MAX, i16::min);
                let cost = cost.saturating_add(of_size[size]);
                ties = if cost < least { 1 } else { ties + u32::from(cost == least) };
                if cost < least || cost == least && random.below(ties) == 0 {
                    (least, change) = (cost, [a, b]);
                }
            }
        }
        let ([a, b], mut to, mut ties) = (change, times[x], 0);
        let rest = least.saturating_sub(of_size[a.max(b)]);
        for (at, (cost_a, cost_b)) in of_a[a..period - b].iter().zip(&of_b[b..period - a]).enumerate() {
            let pair = [(at + a) as i32, (at + b) as i32];
            let is_best = cost_a.saturating_add(*cost_b) == rest && pair != times[x];
            ties += u32::from(is_best);
            if is_best && random.below(ties) == 0 {
                to = pair;
            }
        }
        let [a, b] = times[x].map(|time| time as usize);
        (least < of_a[a].saturating_add(of_b[b]).saturating_add(of_size[a.abs_diff(b)]), to)
    }
}
