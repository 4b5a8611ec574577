//! Branchings of a short descent: the largest |d|, firing orders, then the ranks of the other |d|, downwards.
//!
//! The order of cases affects only how soon a schedule is found: the first case is drawn from a fixed seed, copied from
//! a schedule for another period or from the neighbouring sensors, or is the one that leaves the others most room.

use crate::engine::bounds::Refuted;
use crate::engine::branching::Branching;
use crate::engine::construct::Times;
use crate::engine::counting::{capacity, members};
use crate::engine::problem::Merged;
use crate::engine::rules::propagate;
use crate::engine::state::{State, event};

/// A case of a branching.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Case {
    /// One of two cases.
    Of(Branching, usize),
    /// Sensor x has the largest |d| of these, and its d is negative or not.
    Largest { x: usize, negative: bool, of: u64 },
}

impl Case {
    /// Assumes the case and propagates.
    pub(crate) fn assume(self, state: &mut State, merged: &Merged) -> Result<(), Refuted> {
        match self {
            Self::Of(branching, case) => branching.assume(case, state, merged),
            Self::Largest { x, negative, of } => {
                members(of & !(1 << x)).for_each(|y| _ = state.learn_below(y, x));
                state.learn_most(x, !negative, if negative { -1 } else { 0 })?;
                propagate(state, merged)
            }
        }
    }
}

/// A generator of pseudo-random numbers, the same on every machine (xorshift64*).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number below `end`.
    pub(crate) fn below(&mut self, end: u32) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        ((self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) % u64::from(end.max(1))) as u32
    }
}

/// The rules for choosing the first alternative.
pub(crate) struct Choice {
    pub(crate) random: Option<Random>,
    /// The times of a schedule with another period.
    pub(crate) guide: Option<Times>,
    /// The sensors for which the guide is ignored (*large neighbourhood search*, Shaw 1998), as bits.
    free: u64,
    /// True if separations differ, and the |d| of this period leave no room.
    has_wide: bool,
    /// True to try a sensor with a large separation first for the largest |d|.
    prefers_wide: bool,
    /// Distance to the sensors from which orders are copied.
    shift: usize,
    /// The sensor with the largest |d|, then the sensors in the order in which their firing orders are decided.
    sequence: Option<(usize, Vec<usize>)>,
}

impl Choice {
    pub(crate) fn new(merged: &Merged, period: u32, guide: Option<Times>) -> Self {
        let clique = |x: usize| {
            let mut clique = vec![x];
            for &y in merged.neighbours[x].iter().filter(|&&y| y > x) {
                if clique.iter().all(|&z| merged.gap[z][y] > 0) {
                    clique.push(y);
                }
            }
            clique.len()
        };
        let has_wide = capacity(merged) == period && merged.separation.iter().any(|&own| own != merged.separation[0]);
        let shift = (0..merged.count()).map(clique).max().unwrap_or(1);
        Self { random: None, guide, free: 0, has_wide, prefers_wide: false, shift, sequence: None }
    }

    /// Begins another descent: at random, or along the guide except for some adjacent sensors.
    pub(crate) fn restart(&mut self, seed: u64, guide: Option<Times>, count: usize) {
        let mut random = Random::new(seed);
        self.free = 0;
        self.prefers_wide = self.has_wide && random.below(2) == 0;
        if guide.is_some() {
            let (first, length) = (random.below(count as u32) as usize, 2 + random.below(count as u32 / 2) as usize);
            self.free = (first..first + length).fold(0, |free, x| free | 1 << (x % count));
        }
        (self.random, self.guide) = (Some(random), guide);
    }

    /// The guide's times of sensor x.
    fn guide_of(&self, x: usize) -> Option<[i32; 2]> {
        self.guide.as_ref().filter(|_| self.free >> x & 1 == 0).map(|guide| guide[x])
    }

    /// The cases of the next branching; the one to try first comes last. `None` if nothing is left.
    pub(crate) fn cases(&mut self, state: &State, merged: &Merged) -> Option<Vec<Case>> {
        let all = u64::MAX >> (64 - merged.count());
        let above = |x: usize, set: u64| members(set).all(|y| y == x || state.is_below(y, x));
        let top = (0..merged.count()).find(|&x| above(x, all));
        let Some(top) = top else { return Some(self.largest(state, merged, all, true)) };
        if let Some(cases) = self.order(state, merged, top) {
            return Some(cases);
        }
        let mut unranked = all;
        while let Some(x) = members(unranked).find(|&x| above(x, unranked)) {
            let sign = Branching::Sign(x);
            if !sign.is_decided(state, merged) {
                let first = match self.guide_of(x) {
                    Some([a, b]) => usize::from(a < b),
                    None => usize::from(state.most(x, true) > state.most(x, false)),
                };
                return Some([1 - first, first].map(|case| Case::Of(sign, case)).into());
            }
            unranked &= !(1 << x);
        }
        if unranked != 0 {
            return Some(self.largest(state, merged, unranked, false));
        }
        let open = (0..merged.count()).filter(|&x| state.low[x] < state.high(x)).min_by_key(|&x| state.low[x])?;
        let least = Branching::Split(open, state.low[open] as u32);
        Some([1, 0].map(|case| Case::Of(least, case)).into())
    }

    /// The sensors that may have the largest |d| of these, with either sign.
    fn largest(&mut self, state: &State, merged: &Merged, of: u64, is_top: bool) -> Vec<Case> {
        let is_lower = |x: usize| members(of).any(|y| y != x && state.is_below(x, y));
        let mut cases = Vec::new();
        for x in members(of).filter(|&x| !is_lower(x)) {
            for negative in [false, true] {
                let most = state.most(x, negative);
                if most > 0 || (most == 0 && !negative) {
                    cases.push(Case::Largest { x, negative, of });
                }
            }
        }
        let parts = |case: &Case| match *case {
            Case::Largest { x, negative, .. } => (x, negative),
            _ => (0, false),
        };
        let preferred = |case: &Case| {
            let (x, negative) = parts(case);
            if let Some([a, b]) = self.guide_of(x) {
                let d = a - b;
                return (d.abs(), if (d < 0) == negative { 1 } else { 0 }, -(x as i32));
            }
            // At the top a large separation takes room on one side only.
            let room = match (is_top, self.prefers_wide) {
                (true, true) => merged.separation[x],
                (true, false) => 0,
                (false, _) => state.low[x],
            };
            (room, i32::from(!negative), -(x as i32))
        };
        cases.sort_by_key(preferred);
        if let Some(random) = &mut self.random
            && self.guide.is_none()
            && cases.len() > 1
            && (is_top && !self.prefers_wide || random.below(2) == 0)
        {
            let (last, drawn) = (cases.len() - 1, random.below(cases.len() as u32) as usize);
            cases.swap(drawn, last);
        }
        cases
    }

    /// The most constrained undecided order of the first sensor in the sequence that has one.
    fn order(&mut self, state: &State, merged: &Merged, top: usize) -> Option<Vec<Case>> {
        if self.sequence.as_ref().is_none_or(|(first, _)| *first != top) {
            self.sequence = Some((top, sequence(merged, top)));
        }
        let (_, sequence) = self.sequence.as_ref()?;
        let mut before = 0_u64;
        for &x in sequence {
            let mut best: Option<(i32, usize, usize)> = None;
            for &y in merged.neighbours[x].iter().filter(|&&y| before >> y & 1 == 1) {
                for phase in 0..2 {
                    let order = Branching::Order(phase, x, y);
                    let (u, v) = (event(x, phase), event(y, phase));
                    let room = state.bounds.at(u, v) + state.bounds.at(v, u);
                    if best.is_none_or(|(least, ..)| room < least) && !order.is_decided(state, merged) {
                        best = Some((room, y, phase));
                    }
                }
            }
            before |= 1 << x;
            let Some((_, y, phase)) = best else { continue };
            // The longest times from x to y, and from y to x.
            let after = state.bounds.at(event(x, phase), event(y, phase));
            let before = state.bounds.at(event(y, phase), event(x, phase));
            let first = self.pattern(state, merged, x, y, phase).unwrap_or_else(|| match &mut self.random {
                // In half ticks, for which the seeds were chosen.
                Some(random) => random.below((2 * (after + before)).max(1) as u32) < 2 * after.max(0) as u32,
                None => after >= before,
            });
            let first = usize::from(!first);
            return Some([1 - first, first].map(|case| Case::Of(Branching::Order(phase, x, y), case)).into());
        }
        None
    }

    /// True if x fires before y in the guide, or in the order copied from the sensors one clique further along; `None`
    /// if neither decides.
    fn pattern(&self, state: &State, merged: &Merged, x: usize, y: usize, phase: usize) -> Option<bool> {
        if let (Some(x), Some(y)) = (self.guide_of(x), self.guide_of(y)) {
            return Some(x[phase] < y[phase]);
        }
        if self.guide.is_some() {
            return None;
        }
        let count = merged.count();
        for shift in [self.shift, 2 * count - self.shift] {
            let (x, y) = ((x + shift) % count, (y + shift) % count);
            if merged.gap[x][y] > 0 {
                if state.is_ordered(merged, x, y, phase) {
                    return Some(true);
                }
                if state.is_ordered(merged, y, x, phase) {
                    return Some(false);
                }
            }
        }
        None
    }
}

/// Sensors from `first` on; each next one has the most gaps to those before it.
fn sequence(merged: &Merged, first: usize) -> Vec<usize> {
    let (mut sequence, mut taken) = (vec![first], 1_u64 << first);
    while sequence.len() < merged.count() {
        let known = |x: usize| merged.neighbours[x].iter().filter(|&&y| taken >> y & 1 == 1).count();
        let left = (0..merged.count()).filter(|&x| taken >> x & 1 == 0);
        // Of equals the lowest: `max_by_key` would take the last.
        let Some(next) = left.min_by_key(|&x| merged.count() - known(x)) else { break };
        taken |= 1 << next;
        sequence.push(next);
    }
    sequence
}
