//! Knowledge at a node of the tree, and its consequences: rules 1 to 5 of docs/reference/certificate.md, each with a
//! lemma in the proof wherever unit propagation in the model alone would not see it.

use super::literals::{Literal, Truth, Variable, before, below};
use super::model::Model;
use super::proof::{Proof, Why};
use crate::engine::bounds::{Bounds, Refuted};
use crate::engine::state::{State, event};

/// An upper bound on the difference of two events, `t_to - t_from <= most`, and why it holds.
#[derive(Clone, Copy, Debug)]
struct Edge {
    from: usize,
    to: usize,
    most: i32,
    why: Why,
}

/// Knowledge at a node. All of it is what unit propagation knows there, given the proof's lemmas.
#[derive(Clone, Debug)]
pub(crate) struct Known {
    /// In the form in which the certificate's branchings are chosen: the closed bounds, and who is below whom.
    pub(crate) state: State,
    /// The bounds of which all others are sums.
    edges: Vec<Edge>,
    /// The bounds on each d and each |d| that the literals say.
    d: Vec<(i32, i32)>,
    size: Vec<(i32, i32)>,
}

impl Known {
    /// Bounds that hold in every schedule.
    pub(crate) fn new(proof: &mut Proof<'_>) -> Result<Self, Refuted> {
        let model = proof.model;
        let count = model.merged.count();
        let bounds = Bounds::new(1 + 2 * count, 2 * (model.period - 1));
        let state = State::of(bounds, vec![0; count]);
        let d = model.reach.iter().map(|reach| (-reach, *reach)).collect();
        let size = model.reach.iter().map(|reach| (0, *reach)).collect();
        let mut known = Self { state, edges: Vec::new(), d, size };
        for &(from, to, most, id) in &model.always {
            known.learn(proof, Edge { from, to, most, why: Why::Always(id) })?;
        }
        if model.merged.stale_echo {
            for x in 0..count {
                known.raise(proof, x, (model.merged.separation[x] + 1) / 2)?;
            }
        }
        Ok(known)
    }

    /// Learns a bound; closing a cycle that adds to less than 0 is a contradiction.
    fn learn(&mut self, proof: &mut Proof<'_>, edge: Edge) -> Result<bool, Refuted> {
        self.edges.push(edge);
        self.state.bounds.learn(edge.from, edge.to, 2 * edge.most).inspect_err(|_| {
            let mut cycle = self.path(edge.to, edge.from, -edge.most - 1);
            cycle.push(edge.why);
            proof.cycle(&cycle);
        })
    }

    /// The fewest bounds along a path that add to at most `most`; there must be some.
    fn path(&self, from: usize, to: usize, most: i32) -> Vec<Why> {
        let events = 1 + 2 * self.d.len();
        let far = i32::MAX / 2;
        let mut rounds: Vec<Vec<(i32, usize)>> = vec![vec![(far, usize::MAX); events]];
        rounds[0][from].0 = 0;
        while rounds[rounds.len() - 1][to].0 > most && rounds.len() <= events {
            let before = &rounds[rounds.len() - 1];
            let mut next: Vec<(i32, usize)> = before.iter().map(|(length, _)| (*length, usize::MAX)).collect();
            for (number, edge) in self.edges.iter().enumerate() {
                let length = before[edge.from].0.saturating_add(edge.most);
                if before[edge.from].0 < far && length < next[edge.to].0 {
                    next[edge.to] = (length, number);
                }
            }
            rounds.push(next);
        }
        let (mut path, mut at) = (Vec::new(), to);
        for round in rounds[1..].iter().rev() {
            if let Some(edge) = self.edges.get(round[at].1) {
                path.push(edge.why);
                at = edge.from;
            }
        }
        path.reverse();
        path
    }

    /// Assumes a literal.
    pub(crate) fn assume(&mut self, proof: &mut Proof<'_>, literal: Literal) -> Result<bool, Refuted> {
        let yes = literal.is_true;
        match literal.variable {
            Variable::Bit(..) => Ok(false),
            Variable::D(x, v) if yes => self.at_least(proof, x, v),
            Variable::D(x, v) => self.at_most(proof, x, v - 1),
            Variable::Size(x, v) if yes => self.raise(proof, x, v),
            Variable::Size(x, v) => self.lower(proof, x, v - 1),
            Variable::Rank(x, y) => {
                let (x, y) = if yes { (x, y) } else { (y, x) };
                Ok(self.state.learn_below(x, y))
            }
            Variable::Order(phase, x, y) => {
                let (x, y) = if yes { (x, y) } else { (y, x) };
                let most = -proof.model.merged.gap[x][y];
                let why = Why::Order(phase, x, y);
                self.learn(proof, Edge { from: event(y, phase), to: event(x, phase), most, why })
            }
        }
    }

    /// `d_x >= v`
    fn at_least(&mut self, proof: &mut Proof<'_>, x: usize, v: i32) -> Result<bool, Refuted> {
        if v <= self.d[x].0 {
            return Ok(false);
        }
        self.d[x].0 = v;
        let (from, to) = (event(x, 0), event(x, 1));
        if v > self.d[x].1 {
            return Err(Refuted);
        }
        self.learn(proof, Edge { from, to, most: -v, why: Why::AtLeast(x, v) })?;
        Ok(true)
    }

    /// `d_x <= v`
    fn at_most(&mut self, proof: &mut Proof<'_>, x: usize, v: i32) -> Result<bool, Refuted> {
        if v >= self.d[x].1 {
            return Ok(false);
        }
        self.d[x].1 = v;
        let (from, to) = (event(x, 1), event(x, 0));
        if v < self.d[x].0 {
            return Err(Refuted);
        }
        self.learn(proof, Edge { from, to, most: v, why: Why::AtMost(x, v) })?;
        Ok(true)
    }

    /// `|d_x| >= v`
    fn raise(&mut self, proof: &mut Proof<'_>, x: usize, v: i32) -> Result<bool, Refuted> {
        let (low, high) = self.size[x];
        let news = v > low;
        self.size[x].0 = low.max(v);
        self.state.low[x] = 2 * self.size[x].0;
        if self.size[x].0 > high {
            return Err(Refuted);
        }
        Ok(news | self.sides(proof, x)?)
    }

    /// `|d_x| <= v`
    fn lower(&mut self, proof: &mut Proof<'_>, x: usize, v: i32) -> Result<bool, Refuted> {
        let (low, high) = self.size[x];
        let news = v < high;
        self.size[x].1 = high.min(v);
        if self.size[x].1 < low {
            return Err(Refuted);
        }
        Ok(news | self.sides(proof, x)?)
    }

    /// Consequences for d of bounds on |d|.
    fn sides(&mut self, proof: &mut Proof<'_>, x: usize) -> Result<bool, Refuted> {
        let (low, high) = self.size[x];
        let mut news = self.at_most(proof, x, high)? | self.at_least(proof, x, -high)?;
        if self.d[x].1 < low {
            news |= self.at_most(proof, x, -low)?;
        }
        if -self.d[x].0 < low {
            news |= self.at_least(proof, x, low)?;
        }
        Ok(news)
    }

    /// Applies all rules until none tells anything new.
    pub(crate) fn propagate(&mut self, proof: &mut Proof<'_>) -> Result<(), Refuted> {
        loop {
            let news = self.orders(proof)? | self.values(proof)? | self.ranks(proof)?;
            self.spacing(proof)?;
            if !news {
                return Ok(());
            }
        }
    }

    /// Rule 2: if y cannot come a gap after x, then x comes after y.
    fn orders(&mut self, proof: &mut Proof<'_>) -> Result<bool, Refuted> {
        let merged = proof.model.merged;
        let mut news = false;
        for &(x, y) in &merged.pairs {
            for (phase, x, y) in [(0, x, y), (0, y, x), (1, x, y), (1, y, x)] {
                let (from, to, gap) = (event(x, phase), event(y, phase), merged.gap[x][y]);
                if self.state.bounds.at(from, to) < 2 * gap && !self.is_ordered(y, x, phase) {
                    let mut cycle = self.path(from, to, gap - 1);
                    cycle.push(Why::Order(phase, x, y));
                    proof.cycle(&cycle);
                    self.assume(proof, before(phase, y, x))?;
                    news = true;
                }
            }
        }
        if let Some((x, y)) = self.state.reverse {
            for phase in 0..2 {
                if self.is_ordered(y, x, phase) && !self.is_ordered(x, y, 1 - phase) {
                    self.assume(proof, before(1 - phase, x, y))?;
                    news = true;
                }
            }
        }
        Ok(news)
    }

    /// Returns true if it is known, as a literal, that in this phase x fires before y.
    fn is_ordered(&self, x: usize, y: usize, phase: usize) -> bool {
        self.edges.iter().any(|edge| edge.why == Why::Order(phase, x, y))
    }

    /// Rule 3: bounds on d, on |d| and on differences of firing times bound each other.
    fn values(&mut self, proof: &mut Proof<'_>) -> Result<bool, Refuted> {
        let mut news = false;
        for x in 0..self.d.len() {
            let most = self.state.most(x, false).div_euclid(2);
            if most < self.d[x].1 {
                let mut cycle = self.path(event(x, 1), event(x, 0), most);
                cycle.push(Why::AtLeast(x, most + 1));
                proof.cycle(&cycle);
                news |= self.at_most(proof, x, most)?;
            }
            let least = -self.state.most(x, true).div_euclid(2);
            if least > self.d[x].0 {
                let mut cycle = self.path(event(x, 0), event(x, 1), -least);
                cycle.push(Why::AtMost(x, least - 1));
                proof.cycle(&cycle);
                news |= self.at_least(proof, x, least)?;
            }
            let (least, most) = self.d[x];
            news |= self.raise(proof, x, least.max(-most))?;
            news |= self.lower(proof, x, most.max(-least))?;
        }
        Ok(news)
    }

    /// Rule 4: the order of |d|, and what it says of their bounds.
    fn ranks(&mut self, proof: &mut Proof<'_>) -> Result<bool, Refuted> {
        let model = proof.model;
        let count = self.d.len();
        let mut news = false;
        for y in 0..count {
            for x in (0..count).filter(|&x| x != y) {
                if self.size[x].1 < self.size[y].0 + model.apart(x, y) {
                    news |= self.state.learn_below(x, y);
                }
                if !self.state.is_below(x, y) {
                    continue;
                }
                if self.state.is_below(y, x) {
                    return Err(Refuted);
                }
                for z in (0..count).filter(|&z| z != y) {
                    if self.state.is_below(z, x) && !self.state.is_below(z, y) {
                        proof.transitive(z, x, y);
                        self.state.learn_below(z, y);
                        news = true;
                    }
                }
                news |= self.raise(proof, y, self.size[x].0 + model.apart(x, y))?;
                news |= self.lower(proof, x, self.size[y].1 - model.apart(x, y))?;
            }
        }
        for y in 0..count {
            news |= self.above(proof, y)? | self.under(proof, y)?;
        }
        Ok(news)
    }

    /// Those below y need room below it.
    fn above(&mut self, proof: &mut Proof<'_>, y: usize) -> Result<bool, Refuted> {
        let mut set: Vec<usize> = (0..self.d.len()).filter(|&x| self.state.is_below(x, y)).collect();
        set.sort_unstable_by_key(|&x| core::cmp::Reverse(self.size[x].0));
        let mut best = (self.size[y].0, 0);
        for (number, &x) in set.iter().enumerate() {
            let low = self.size[x].0 + (number as i32 + 1) * proof.separation();
            if low > best.0 {
                best = (low, number + 1);
            }
        }
        let (low, number) = best;
        if number == 0 {
            return Ok(false);
        }
        let start = self.size[set[number - 1]].0;
        set.truncate(number);
        proof.room_below(&set, y, start);
        self.raise(proof, y, low)
    }

    /// Those above y need room above it.
    fn under(&mut self, proof: &mut Proof<'_>, y: usize) -> Result<bool, Refuted> {
        let mut set: Vec<usize> = (0..self.d.len()).filter(|&x| self.state.is_below(y, x)).collect();
        set.sort_unstable_by_key(|&x| self.size[x].1);
        let mut best = (self.size[y].1, 0);
        for (number, &x) in set.iter().enumerate() {
            let high = self.size[x].1 - (number as i32 + 1) * proof.separation();
            if high < best.0 {
                best = (high, number + 1);
            }
        }
        let (high, number) = best;
        if number == 0 {
            return Ok(false);
        }
        set.truncate(number);
        proof.room_above(&set, y, (high + 1).max(0));
        self.lower(proof, y, high)
    }

    /// Rule 5, Hall's condition: those whose |d| lies within an interval must have room there.
    fn spacing(&self, proof: &mut Proof<'_>) -> Result<(), Refuted> {
        let mut by_high: Vec<usize> = (0..self.d.len()).collect();
        by_high.sort_unstable_by_key(|&x| (self.size[x].1, x));
        for &first in &by_high {
            let start = self.size[first].0;
            let mut members = Vec::new();
            for &x in by_high.iter().filter(|&&x| self.size[x].0 >= start) {
                members.push(x);
                let windows = members.len() as i32 - 1;
                if start + windows * proof.separation() > self.size[x].1 {
                    members.sort_unstable();
                    proof.hall(&members, start, windows);
                    return Err(Refuted);
                }
            }
        }
        Ok(())
    }

    /// Assumes that `|d|` of the first is below that of the second.
    pub(crate) fn assume_below(&mut self, x: usize, y: usize) {
        self.state.learn_below(x, y);
    }
}

/// The literals of a branching's first case; the second is its opposite.
pub(crate) fn first_case(model: &Model<'_>, branching: crate::engine::branching::Branching) -> Truth {
    use crate::engine::branching::Branching;
    match branching {
        Branching::Order(phase, x, y) => Truth::If(before(phase, x, y)),
        Branching::Sign(x) => model.d_from(x, 0),
        Branching::Rank(x, y) => Truth::If(below(x, y)),
        Branching::Split(x, at) => !model.size_from(x, at as i32 + 1),
    }
}
