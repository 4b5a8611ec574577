//! The next branching of the search, and the alternative it tries first.
//!
//! The alternative that comes first matters only for how soon a schedule is found: it is drawn from a fixed seed in
//! short descents, copied from a schedule for an easier problem, or the one that leaves the others most room.
//!
//! Indices: sensors are below `problem.sensors` and so below `MAX_SENSORS`, the length of what is indexed by sensor.

use super::super::problem::CheckedProblem;
use super::super::symmetry;
use super::decision::{Branch, Decision};
use super::state::State;
use crate::schedule::MAX_SENSORS;
use crate::search::common::Members;

impl State<'_, '_> {
    /// The next decision to make.
    pub(super) fn next_decision(&mut self) -> Decision {
        let k = self.problem.sensors;
        if self.ranks.highs().is_empty() {
            let mut decision = Decision::new(Branch::Top);
            decision.positive = symmetry::representatives(self.problem);
            return decision;
        }
        if let Some(decision) = self.branch_on_order() {
            return decision;
        }
        let unranked = self.problem.all() & !self.ranks.ranked;
        if unranked != 0 {
            return self.branch_on_rank(unranked);
        }
        let intervals = self.intervals();
        let mut decision = Decision::new(Branch::Value);
        // If all are fixed and still no schedule, there is no alternative left.
        decision.tried = 3;
        if let Some(x) = (0..k).filter(|&x| intervals.low[x] < intervals.high[x]).min_by_key(|&x| intervals.low[x]) {
            (decision.x, decision.tried) = (x as u8, 0);
            decision.positive = intervals.low[x] as u64;
            decision.negative = intervals.high[x] as u64;
        }
        decision
    }

    /// The most constrained undecided order of the first sensor in the sequence that has one.
    fn branch_on_order(&mut self) -> Option<Decision> {
        let interval = self.problem.interval;
        if interval == 0 {
            return None;
        }
        let mut before = 0u64;
        for &x in &self.sequence[..self.problem.sensors] {
            let x = usize::from(x);
            let mut best: Option<(i32, usize, usize)> = None;
            for y in Members(self.problem.conflicts[x] & before) {
                for phase in 0..2 {
                    let (u, v) = (self.node(x, phase), self.node(y, phase));
                    let (late, early) = (self.differences.at_most(u, v), self.differences.at_most(v, u));
                    if late > -interval && early > -interval && best.is_none_or(|(room, ..)| late + early < room) {
                        best = Some((late + early, u, v));
                    }
                }
            }
            before |= 1 << x;
            let Some((_, u, v)) = best else { continue };
            let (late, early) = (self.differences.at_most(u, v), self.differences.at_most(v, u));
            let pattern = self.pattern(u, v);
            let first = if let Some(random) = &mut self.random {
                // `early` and `late` are at least the interval here, or the order would be decided.
                let fair = random.below((late + early).max(1) as u32) < early.max(0) as u32;
                pattern.unwrap_or(fair)
            } else {
                pattern.unwrap_or(early >= late)
            };
            let mut decision = Decision::new(Branch::Order);
            (decision.x, decision.y) = if first { (u as u8, v as u8) } else { (v as u8, u as u8) };
            return Some(decision);
        }
        None
    }

    /// Returns true if `u` fires before `v` by the order of the sensors one clique further along, if that is decided.
    fn pattern(&self, u: usize, v: usize) -> Option<bool> {
        let (k, shift) = (self.problem.sensors, self.shift);
        let (x, y, phase) = ((u - 1) % k, (v - 1) % k, (u - 1) / k);
        if let Some(guide) = &self.guide {
            let times = if phase == 0 { &guide.a } else { &guide.b };
            return Some(times[x] < times[y]);
        }
        for shift in [shift, 2 * k - shift] {
            let (x, y) = ((x + shift) % k, (y + shift) % k);
            let (u, v) = (self.node(x, phase), self.node(y, phase));
            if self.problem.conflict(x, y) {
                if self.differences.at_most(u, v) <= -self.problem.interval {
                    return Some(true);
                }
                if self.differences.at_most(v, u) <= -self.problem.interval {
                    return Some(false);
                }
            }
        }
        None
    }

    /// The sensors that may have the largest `|d|` of those without a rank.
    fn branch_on_rank(&mut self, unranked: u64) -> Decision {
        let separation = self.problem.separation;
        let intervals = self.intervals();
        let mut decision = Decision::new(Branch::Rank);
        for x in Members(unranked) {
            let (low, high) = self.span(x);
            if Members(unranked & !(1 << x)).all(|y| intervals.low[y] + separation <= intervals.high[x]) {
                // d = 0 counts as positive.
                decision.positive |= u64::from(high >= 0) << x;
                decision.negative |= u64::from(low < 0) << x;
            }
        }
        decision
    }

    /// The remaining candidate for a rank that leaves the others most room, or any.
    pub(super) fn pick(&mut self, decision: &Decision) -> Option<(u8, bool)> {
        if let Some(random) = &mut self.random {
            let count = decision.positive.count_ones() + decision.negative.count_ones();
            if count > 1 && (decision.branch == Branch::Top || random.below(2) == 0) {
                let nth = random.below(count) as usize;
                let positive = Members(decision.positive).map(|x| (x as u8, false));
                let negative = Members(decision.negative).map(|x| (x as u8, true));
                return positive.chain(negative).nth(nth);
            }
        }
        if let Some(guide) = &self.guide {
            let d = |x: usize| i64::from(guide.a[x]) - i64::from(guide.b[x]);
            let key = |x: usize| -d(x).abs();
            let best = Members(decision.positive | decision.negative).min_by_key(|&x| key(x))?;
            let negative = decision.negative >> best & 1 == 1 && (d(best) < 0 || decision.positive >> best & 1 == 0);
            return Some((best as u8, negative));
        }
        if decision.branch == Branch::Top {
            return Members(decision.positive).next().map(|x| (x as u8, false));
        }
        let intervals = self.intervals();
        let key = |x: usize| -intervals.low[x];
        let best = Members(decision.positive | decision.negative).min_by_key(|&x| key(x))?;
        Some((best as u8, decision.positive >> best & 1 == 0))
    }
}

/// Sensors from `first` on, each the one with the most conflicts with those before it.
pub(super) fn sequence(problem: &CheckedProblem, first: usize) -> [u8; MAX_SENSORS] {
    let mut sequence = [0; MAX_SENSORS];
    let mut taken = 0u64;
    let mut next = first;
    for slot in sequence.iter_mut().take(problem.sensors) {
        *slot = next as u8;
        taken |= 1 << next;
        let left = problem.all() & !taken;
        // Of equals the lowest: `max_by_key` would take the last.
        next = Members(left).min_by_key(|&x| 64 - (problem.conflicts[x] & taken).count_ones()).unwrap_or(0);
    }
    sequence
}
