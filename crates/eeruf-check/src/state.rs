//! Knowledge at a node of the tree: bounds on differences of firing times, bounds on |d|, the order of |d|.

use crate::bounds::{Bound, Bounds, Refuted};
use crate::problem::Merged;

/// Knowledge at a node.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) bounds: Bounds,
    /// Lower bounds on |d|: `2 v` says "at least v", `2 v + 1` says "more than v".
    pub(crate) low: Vec<Bound>,
    /// The set of those with a smaller |d|, as bits.
    pub(crate) below: Vec<u64>,
    /// Two of which the first fires before the second in phase a or in phase b, or in both.
    pub(crate) reverse: Option<(usize, usize)>,
}

/// The event "x fires" in phase a (0) or b (1); event 0 is the start of both phases.
pub(crate) fn event(x: usize, phase: usize) -> usize {
    1 + 2 * x + phase
}

/// The smallest step by which a bound can be exceeded: a whole tick, or anything at all.
pub(crate) fn step(merged: &Merged) -> Bound {
    if merged.over_reals { 1 } else { 2 }
}

impl State {
    /// Bounds that every schedule with a period below `period` meets.
    pub(crate) fn new(merged: &Merged, period: i32) -> Result<Self, Refuted> {
        let (count, step) = (merged.count(), step(merged));
        // Whole ticks: the period is at most `period - 1`, and firing times at most one less.
        let latest = if merged.over_reals { 2 * period - 1 } else { 2 * period - 4 };
        if latest < 0 {
            return Err(Refuted);
        }
        let mut bounds = Bounds::new(1 + 2 * count, latest);
        for x in 0..count {
            let (a, b) = (event(x, 0), event(x, 1));
            bounds.learn(a, 0, 0)?;
            bounds.learn(b, 0, 0)?;
            let furthest = 2 * (period - merged.window[x]) - step;
            bounds.learn(a, b, furthest)?;
            bounds.learn(b, a, furthest)?;
            for y in 0..count {
                if merged.gap[x][y] > 0 {
                    // After x in a phase, y in the next.
                    let furthest = 2 * (period - merged.gap[x][y]) - step;
                    bounds.learn(event(y, 1), a, furthest)?;
                    bounds.learn(event(y, 0), b, furthest)?;
                }
            }
        }
        // Half a separation, in whole ticks rounded up: 2 * (D / 2) = D.
        let half = |x: usize| merged.separation[x] + if merged.over_reals { 0 } else { merged.separation[x] & 1 };
        let low = (0..count).map(|x| if merged.stale_echo { half(x) } else { 0 }).collect();
        Ok(Self { bounds, low, below: vec![0; count], reverse: None })
    }

    /// The upper bound on `d_x`, or on `-d_x` if `negative`.
    pub(crate) fn most(&self, x: usize, negative: bool) -> Bound {
        let (a, b) = (event(x, 0), event(x, 1));
        if negative { self.bounds.at(a, b) } else { self.bounds.at(b, a) }
    }

    /// Learns that `d_x`, or `-d_x` if `negative`, is at most `bound`.
    pub(crate) fn learn_most(&mut self, x: usize, negative: bool, bound: Bound) -> Result<bool, Refuted> {
        let (a, b) = (event(x, 0), event(x, 1));
        if negative { self.bounds.learn(a, b, bound) } else { self.bounds.learn(b, a, bound) }
    }

    /// The upper bound on `|d_x|`.
    pub(crate) fn high(&self, x: usize) -> Bound {
        self.most(x, false).max(self.most(x, true))
    }

    /// Learns that `|d_x|` is at most `bound`.
    pub(crate) fn learn_high(&mut self, x: usize, bound: Bound) -> Result<bool, Refuted> {
        Ok(self.learn_most(x, false, bound)? | self.learn_most(x, true, bound)?)
    }

    /// Learns that `|d_x|` is at least `bound`.
    pub(crate) fn learn_low(&mut self, x: usize, bound: Bound) -> Result<bool, Refuted> {
        let news = bound > self.low[x];
        self.low[x] = self.low[x].max(bound);
        if self.low[x] > self.high(x) { Err(Refuted) } else { Ok(news) }
    }

    /// Learns that `|d_x| < |d_y|`.
    pub(crate) fn learn_below(&mut self, x: usize, y: usize) -> bool {
        let news = !self.is_below(x, y);
        self.below[y] |= 1 << x;
        news
    }

    /// Returns true if `|d_x| < |d_y|` is known.
    pub(crate) fn is_below(&self, x: usize, y: usize) -> bool {
        self.below[y] >> x & 1 == 1
    }

    /// Learns that in this phase x fires before y.
    pub(crate) fn learn_order(&mut self, merged: &Merged, x: usize, y: usize, phase: usize) -> Result<bool, Refuted> {
        self.bounds.learn(event(y, phase), event(x, phase), -2 * merged.gap[x][y])
    }

    /// Returns true if it is known that in this phase x fires before y.
    pub(crate) fn is_ordered(&self, merged: &Merged, x: usize, y: usize, phase: usize) -> bool {
        self.bounds.at(event(y, phase), event(x, phase)) <= -2 * merged.gap[x][y]
    }
}
