//! The model: what schedules with one period are, as sums of 0-1 variables.
//!
//! docs/reference/certificate.md, "A second root of trust", lists its inequalities. They say what `schedule::check`
//! checks.

use core::fmt::Write as _;

use super::literals::{Literal, Truth, Variable, before, below, clause, inequality};
use crate::engine::problem::Merged;

/// The number of an inequality, in the order of the file.
pub(crate) type Id = usize;

/// The inequalities, and which is which.
#[derive(Clone, Debug)]
pub(crate) struct Model<'m> {
    pub(crate) merged: &'m Merged,
    /// The period that is to be refuted.
    pub(crate) period: i32,
    /// A firing time is the sum of some of these; all together are `period - 1`.
    pub(crate) weights: Vec<i32>,
    /// The largest `|d|` that the window allows.
    pub(crate) reach: Vec<i32>,
    /// All inequalities, one per line.
    pub(crate) lines: Vec<String>,
    /// Bounds on differences of events that hold always: `t_j - t_i <= v` as (i, j, v, number).
    pub(crate) always: Vec<(usize, usize, i32, Id)>,
    /// For each sensor `a - b >= sum - reach`, and `a - b <= sum - reach`, the sum being that of the [`Variable::D`].
    pub(crate) link: Vec<[Id; 2]>,
    /// For each sensor `d >= v + 1` implies `d >= v`, from `v = 1 - reach` on.
    pub(crate) chain: Vec<Vec<Id>>,
    /// For a pair (index x * count + y) and phase: x before y implies a gap.
    order: Vec<[Id; 2]>,
}

/// An event's summands, times a sign.
type Sum = Vec<(i32, Literal)>;

impl<'m> Model<'m> {
    pub(crate) fn new(merged: &'m Merged, period: i32) -> Self {
        let count = merged.count();
        // 1, 2, 4, .. and the rest: every time from 0 to period - 1 is a sum, and so is its distance from period - 1.
        let (mut weights, mut rest) = (Vec::new(), period - 1);
        while rest > 0 {
            let weight = rest.min(1 << weights.len());
            weights.push(weight);
            rest -= weight;
        }
        let reach = merged.window.iter().map(|window| (period - window).max(0)).collect();
        let (always, link, chain) = (Vec::new(), Vec::new(), Vec::new());
        let order = vec![[0; 2]; count * count];
        let mut model = Self { merged, period, weights, reach, lines: Vec::new(), always, link, chain, order };
        for x in 0..count {
            model.firing_times(x);
            model.sizes(x);
        }
        for &(x, y) in &merged.pairs {
            model.gaps(x, y);
        }
        for y in 0..count {
            for x in (0..count).filter(|&x| x != y) {
                model.separation(x, y);
            }
        }
        model
    }

    /// `d_x >= v`
    pub(crate) fn d_from(&self, x: usize, v: i32) -> Truth {
        let reach = self.reach[x];
        match v {
            v if v <= -reach => Truth::Always,
            v if v > reach => Truth::Never,
            v => Truth::If(Variable::D(x, v).is_true()),
        }
    }

    /// `|d_x| >= v`
    pub(crate) fn size_from(&self, x: usize, v: i32) -> Truth {
        match v {
            v if v <= 0 => Truth::Always,
            v if v > self.reach[x] => Truth::Never,
            v => Truth::If(Variable::Size(x, v).is_true()),
        }
    }

    /// The number of "x before y implies the gap after x".
    pub(crate) fn order(&self, phase: usize, x: usize, y: usize) -> Id {
        self.order[x * self.merged.count() + y][phase]
    }

    /// The distance of `|d_x|` and `|d_y|`.
    pub(crate) fn apart(&self, x: usize, y: usize) -> i32 {
        self.merged.apart(x, y) / 2
    }

    fn add(&mut self, inequality: String) -> Id {
        self.lines.push(inequality);
        self.lines.len()
    }

    fn add_clause(&mut self, cases: &[Truth]) -> Option<Id> {
        clause(cases).map(|clause| self.add(clause))
    }

    /// The firing time, times `sign`.
    fn time(&self, sign: i32, phase: usize, x: usize) -> Sum {
        let bit = |(bit, &weight): (usize, &i32)| (sign * weight, Variable::Bit(phase, x, bit).is_true());
        self.weights.iter().enumerate().map(bit).collect()
    }

    /// `t_j - t_i <= most`, and what else stands on the left of `t_i - t_j + .. >= -most`.
    fn difference(&self, i: (usize, usize), j: (usize, usize), other: &[(i32, Literal)], least: i32) -> String {
        let mut terms = self.time(1, i.0, i.1);
        terms.extend(self.time(-1, j.0, j.1));
        terms.extend(other);
        inequality(&terms, least)
    }

    /// Firing times lie in the period, the window is kept, and `d` counts its variables.
    fn firing_times(&mut self, x: usize) {
        let event = |phase| crate::engine::state::event(x, phase);
        for phase in 0..2 {
            let id = self.add(inequality(&self.time(1, phase, x), 0));
            self.always.push((event(phase), 0, 0, id));
            let id = self.add(inequality(&self.time(-1, phase, x), 1 - self.period));
            self.always.push((0, event(phase), self.period - 1, id));
        }
        let furthest = self.period - self.merged.window[x];
        for phase in 0..2 {
            // t_j - t_i <= furthest, i in this phase and j in the other.
            let id = self.add(self.difference((phase, x), (1 - phase, x), &[], -furthest));
            self.always.push((event(phase), event(1 - phase), furthest, id));
        }
        let reach = self.reach[x];
        let values = 1 - reach..=reach;
        let steps = |sign| values.clone().map(|v| (sign, Variable::D(x, v).is_true())).collect::<Sum>();
        let not_less = self.add(self.difference((0, x), (1, x), &steps(-1), -reach));
        let not_more = self.add(self.difference((1, x), (0, x), &steps(1), reach));
        self.link.push([not_less, not_more]);
        let mut chain = Vec::new();
        for v in 1 - reach..reach {
            chain.extend(self.add_clause(&[self.d_from(x, v), !self.d_from(x, v + 1)]));
        }
        self.chain.push(chain);
    }

    /// Sizes of `|d|`.
    fn sizes(&mut self, x: usize) {
        for v in 1..=self.reach[x] {
            let (size, above, not_below) = (self.size_from(x, v), self.d_from(x, v), self.d_from(x, 1 - v));
            self.add_clause(&[!above, size]);
            self.add_clause(&[not_below, size]);
            self.add_clause(&[!size, above, !not_below]);
            self.add_clause(&[self.size_from(x, v - 1), !size]);
        }
        if self.merged.stale_echo {
            let half = (self.merged.separation[x] + 1) / 2;
            self.add_clause(&[self.size_from(x, half)]);
        }
    }

    /// The gaps of a pair: within each phase by an order, and from each phase to the next.
    fn gaps(&mut self, x: usize, y: usize) {
        for phase in 0..2 {
            for (x, y) in [(x, y), (y, x)] {
                let gap = self.merged.gap[x][y];
                let (i, j) = ((phase, y), (phase, x));
                // With y before x the left side is least: 1 - period.
                let unless = (gap + self.period - 1, !before(phase, x, y));
                let id = self.add(self.difference(i, j, &[unless], gap));
                self.order[x * self.merged.count() + y][phase] = id;
                let id = self.add(self.difference((1 - phase, y), j, &[], gap - self.period));
                let (from, to) = (crate::engine::state::event(y, 1 - phase), crate::engine::state::event(x, phase));
                self.always.push((from, to, self.period - gap, id));
            }
        }
    }

    /// If `|d_x|` is below `|d_y|` and at least v, then `|d_y|` is at least `v + D`.
    fn separation(&mut self, x: usize, y: usize) {
        let apart = self.apart(x, y);
        for v in 0..=self.reach[x] {
            let is_above = Truth::If(!below(x, y));
            self.add_clause(&[is_above, !self.size_from(x, v), self.size_from(y, v + apart)]);
        }
    }

    /// All variables.
    pub(crate) fn variables(&self) -> Vec<Variable> {
        let count = self.merged.count();
        let mut all = Vec::new();
        for x in 0..count {
            for phase in 0..2 {
                all.extend((0..self.weights.len()).map(|bit| Variable::Bit(phase, x, bit)));
            }
            all.extend((1 - self.reach[x]..=self.reach[x]).map(|v| Variable::D(x, v)));
            all.extend((1..=self.reach[x]).map(|v| Variable::Size(x, v)));
            all.extend((x + 1..count).map(|y| Variable::Rank(x, y)));
        }
        all.extend(self.merged.pairs.iter().flat_map(|&(x, y)| (0..2).map(move |phase| Variable::Order(phase, x, y))));
        all
    }

    /// The file, in the format OPB.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("* #variable= {} #constraint= {}\n", self.variables().len(), self.lines.len());
        for line in &self.lines {
            let _ = writeln!(text, "{line} ;");
        }
        text
    }
}
