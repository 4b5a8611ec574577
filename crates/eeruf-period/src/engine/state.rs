//! The knowledge at a node of the tree: bounds on differences of firing times, bounds on |d|, the order of |d|.

use crate::engine::bounds::{Bound, Bounds, Refuted};
use crate::engine::problem::Merged;
use crate::engine::turns::Turns;

/// The knowledge at a node.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) bounds: Bounds,
    /// Lower bounds on |d|.
    pub(crate) low: Vec<Bound>,
    /// The sensors with a smaller |d|, as a bitmask.
    pub(crate) below: Vec<u64>,
    /// Two sensors, the first of which fires before the second in at least one phase.
    pub(crate) reverse: Option<(usize, usize)>,
    /// True if the rules may conclude more than a certificate's rules.
    pub(crate) goes_further: bool,
    /// The sensors that fire first, if branchings follow the order of time.
    pub(crate) turns: Option<Turns>,
    /// Saved values of `low` and `below` for each mark.
    trail: Vec<(Bound, u64)>,
    /// State to which the rules were last applied without a conclusion.
    pub(crate) seen: Seen,
}

/// The premises from which a rule concluded nothing: while they are unchanged, it need not run again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen {
    /// State of the matrix for the rule of precedence.
    pub(crate) precedence: u64,
    /// State of the bounds on |d| and of their order, for the rules of ranks and spacing.
    sizes: Vec<(Bound, Bound, u64)>,
}

/// A point to which [`State::undo`] returns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    log: usize,
    trail: usize,
    placed: usize,
}

/// The event "x fires" in phase a (0) or b (1); event 0 is the start of both phases.
pub(crate) fn event(x: usize, phase: usize) -> usize {
    1 + 2 * x + phase
}

/// The firing of an event: sensor and phase. `None` for the start of the phases.
pub(crate) fn firing(event: usize) -> Option<(usize, usize)> {
    event.checked_sub(1).map(|event| (event / 2, event % 2))
}

impl State {
    /// State that holds for every schedule with a period below `period`.
    pub(crate) fn new(merged: &Merged, period: i32) -> Result<Self, Refuted> {
        let count = merged.count();
        // The period is at most `period - 1`, and firing times at most one less.
        let latest = period - 2;
        if latest < 0 {
            return Err(Refuted);
        }
        let mut bounds = Bounds::new(1 + 2 * count, latest);
        for x in 0..count {
            let (a, b) = (event(x, 0), event(x, 1));
            bounds.learn(a, 0, 0)?;
            bounds.learn(b, 0, 0)?;
            let furthest = period - 1 - merged.window[x];
            bounds.learn(a, b, furthest)?;
            bounds.learn(b, a, furthest)?;
            for y in 0..count {
                if merged.gap[x][y] > 0 {
                    // After x in a phase, y in the next.
                    let furthest = period - 1 - merged.gap[x][y];
                    bounds.learn(event(y, 1), a, furthest)?;
                    bounds.learn(event(y, 0), b, furthest)?;
                }
            }
        }
        let low = merged.separation.iter().map(|own| if merged.stale_echo { (own + 1) / 2 } else { 0 }).collect();
        Ok(Self::of(bounds, low))
    }

    /// A state with these bounds, and nothing else known.
    pub(crate) fn of(bounds: Bounds, low: Vec<Bound>) -> Self {
        let below = vec![0; low.len()];
        Self {
            bounds,
            low,
            below,
            reverse: None,
            goes_further: false,
            turns: None,
            trail: Vec::new(),
            seen: Seen::default(),
        }
    }

    /// Saves the state for [`undo`](Self::undo).
    pub(crate) fn mark(&mut self) -> Mark {
        let placed = self.turns.as_ref().map_or(0, |turns| turns.placed.len());
        let mark = Mark { log: self.bounds.mark(), trail: self.trail.len(), placed };
        self.trail.extend(self.low.iter().copied().zip(self.below.iter().copied()));
        mark
    }

    /// Restores the state at the mark, and keeps the mark. Later marks become invalid.
    pub(crate) fn undo(&mut self, mark: Mark) {
        self.bounds.undo(mark.log);
        if let Some(turns) = &mut self.turns {
            turns.placed.truncate(mark.placed);
        }
        let count = self.low.len();
        for (x, &(low, below)) in self.trail[mark.trail..mark.trail + count].iter().enumerate() {
            (self.low[x], self.below[x]) = (low, below);
        }
        self.trail.truncate(mark.trail + count);
    }

    /// Restores the state at the mark, and removes the mark.
    pub(crate) fn drop_mark(&mut self, mark: Mark) {
        self.undo(mark);
        self.trail.truncate(mark.trail);
    }

    /// Returns true if nothing followed from the current bounds on |d| and their order.
    pub(crate) fn has_seen_sizes(&self) -> bool {
        let seen = &self.seen.sizes;
        seen.len() == self.low.len()
            && seen.iter().enumerate().all(|(x, seen)| *seen == (self.high(x), self.low[x], self.below[x]))
    }

    /// Notes that nothing follows from the current bounds on |d| and their order.
    pub(crate) fn see_sizes(&mut self) {
        let mut sizes = core::mem::take(&mut self.seen.sizes);
        sizes.clear();
        sizes.extend((0..self.low.len()).map(|x| (self.high(x), self.low[x], self.below[x])));
        self.seen.sizes = sizes;
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
        self.bounds.learn(event(y, phase), event(x, phase), -merged.gap[x][y])
    }

    /// Returns true if it is known that in this phase x fires before y.
    pub(crate) fn is_ordered(&self, merged: &Merged, x: usize, y: usize, phase: usize) -> bool {
        self.bounds.at(event(y, phase), event(x, phase)) <= -merged.gap[x][y]
    }
}
