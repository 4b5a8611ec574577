//! The proof: lines for VeriPB, and the lemmas that they derive.
//!
//! A lemma is true of all schedules, whatever has been assumed where it is first needed. So it is derived once.

use core::fmt::Write as _;
use std::collections::{HashMap, HashSet};

use super::literals::{Literal, Truth, Variable, before, below, clause};
use super::model::{Id, Model};

/// More than any coefficient of a sum of a path's inequalities: dividing by it leaves a clause.
const DIVISOR: i64 = 1 << 40;

/// Why a bound on the difference of two firing times holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Why {
    /// An inequality of the model.
    Always(Id),
    /// In this phase the first fires before the second.
    Order(usize, usize, usize),
    /// `d_x` is at least so much.
    AtLeast(usize, i32),
    /// `d_x` is at most so much.
    AtMost(usize, i32),
}

/// The lines so far.
#[derive(Debug)]
pub(crate) struct Proof<'m> {
    pub(crate) model: &'m Model<'m>,
    pub(crate) text: String,
    last: Id,
    /// Those that are needed by their numbers again.
    steps: HashMap<(usize, i32, bool), Id>,
    at_most_one: HashMap<i32, Option<Id>>,
    size_chains: HashMap<(usize, i32, i32), Id>,
    /// Those that are not: they serve by unit propagation.
    derived: HashSet<String>,
}

impl<'m> Proof<'m> {
    pub(crate) fn new(model: &'m Model<'m>) -> Self {
        let last = model.lines.len();
        let (steps, at_most_one, size_chains) = (HashMap::new(), HashMap::new(), HashMap::new());
        let text = format!("pseudo-Boolean proof version 3.0\nf {last};\n");
        Self { model, text, last, steps, at_most_one, size_chains, derived: HashSet::new() }
    }

    /// Adds a line that derives an inequality: its number.
    pub(crate) fn derive(&mut self, line: &str) -> Id {
        self.last += 1;
        let _ = writeln!(self.text, "{line};");
        self.last
    }

    /// The same, unless it exists.
    fn derive_once(&mut self, line: String) {
        if !self.derived.contains(&line) {
            self.derive(&line);
            self.derived.insert(line);
        }
    }

    /// One of these holds, since unit propagation refutes that none does.
    pub(crate) fn propagated(&mut self, cases: &[Truth]) -> Option<Id> {
        clause(cases).map(|clause| self.derive(&format!("rup {clause}")))
    }

    /// The same, unless it exists.
    fn propagated_once(&mut self, cases: &[Truth]) {
        if let Some(clause) = clause(cases) {
            self.derive_once(format!("rup {clause}"));
        }
    }

    pub(crate) fn delete(&mut self, ids: &[Id]) {
        let ids: String = ids.iter().map(|id| format!(" {id}")).collect();
        let _ = writeln!(self.text, "del id{ids};");
    }

    /// Not all of what these bounds depend on can hold: they follow each other around a cycle, and add to less than 0.
    /// The firing times cancel, and what is left of the sum is a clause.
    pub(crate) fn cycle(&mut self, reasons: &[Why]) {
        let mut line = "pol".to_owned();
        for (i, &why) in reasons.iter().enumerate() {
            let id = match why {
                Why::Always(id) => id,
                Why::Order(phase, x, y) => self.model.order(phase, x, y),
                Why::AtLeast(x, v) => self.step(x, v, true),
                Why::AtMost(x, v) => self.step(x, v, false),
            };
            let _ = write!(line, " {id}{}", if i > 0 { " +" } else { "" });
        }
        self.derive_once(format!("{line} {DIVISOR} d"));
    }

    /// `a - b >= v` if `d_x >= v`, or `a - b <= v` if not `d_x >= v + 1`: `d` is the number of its variables that are
    /// true, less the reach, and those below a true one are true.
    fn step(&mut self, x: usize, v: i32, is_least: bool) -> Id {
        if let Some(&id) = self.steps.get(&(x, v, is_least)) {
            return id;
        }
        let model = self.model;
        let (reach, chain) = (model.reach[x], &model.chain[x]);
        // The number, from 1, of the variable that decides, and how many there are.
        let (this, all) = (if is_least { v + reach } else { v + 1 + reach }, 2 * reach);
        let variable = |number: i32| Variable::D(x, number - reach).is_true();
        let mut line = format!("pol {}", model.link[x][usize::from(!is_least)]);
        // Multiples of "variable `number` is not less than the next".
        let add = |line: &mut String, number: i32, times: i32| {
            let _ = write!(line, " {} {times} * +", chain[number as usize - 1]);
        };
        if is_least {
            (1..this).for_each(|number| add(&mut line, number, number));
            (this + 1..=all).for_each(|number| line += &format!(" {} +", variable(number)));
        } else {
            (1..this).for_each(|number| line += &format!(" {} +", !variable(number)));
            (this.max(1)..all).for_each(|number| add(&mut line, number, all - number));
        }
        let id = self.derive(&line);
        self.steps.insert((x, v, is_least), id);
        id
    }

    /// `|d_x| >= high` implies `|d_x| >= low`; both must be open.
    fn size_chain(&mut self, x: usize, low: i32, high: i32) -> Id {
        if let Some(&id) = self.size_chains.get(&(x, low, high)) {
            return id;
        }
        let cases = [self.model.size_from(x, low), !self.model.size_from(x, high)];
        let id = self.propagated(&cases).unwrap_or_default();
        self.size_chains.insert((x, low, high), id);
        id
    }

    /// The least separation of all, which Hall's condition is derived for.
    pub(crate) fn separation(&self) -> i32 {
        self.model.merged.separation.iter().copied().min().unwrap_or(1)
    }

    /// At most one `|d|` lies in `start ..= start + separation - 1`: from all pairs, by adding and dividing.
    fn at_most_one(&mut self, start: i32) -> Option<Id> {
        if let Some(&id) = self.at_most_one.get(&start) {
            return id;
        }
        let end = start + self.separation();
        let model = self.model;
        let members: Vec<usize> =
            (0..model.merged.count()).filter(|&x| model.size_from(x, start) != Truth::Never).collect();
        let cases = |x: usize| [!model.size_from(x, start), model.size_from(x, end)];
        let mut pairs = Vec::new();
        let mut line = String::new();
        for (i, &y) in members.iter().enumerate() {
            let of_y: Vec<Id> =
                members[..i].iter().filter_map(|&x| self.propagated(&[cases(x), cases(y)].concat())).collect();
            // Of i so far at most one; with one more i + 1 times that, divided by i.
            match i {
                0 => {}
                1 => line = format!("pol {}", of_y[0]),
                _ => {
                    line += &format!(" {} *", i - 1);
                    of_y.iter().for_each(|id| line += &format!(" {id} +"));
                    line += &format!(" {i} d");
                }
            }
            pairs.extend(of_y);
        }
        let id = match members[..] {
            [] => None,
            [x] => {
                // At least 0 is all there is to say.
                let mut terms = Vec::new();
                for case in cases(x) {
                    if let Truth::If(literal) = case {
                        terms.push(literal);
                    }
                }
                terms.first().map(|first| {
                    let more: String = terms[1..].iter().map(|literal| format!(" {literal} +")).collect();
                    self.derive(&format!("pol {first}{more}"))
                })
            }
            _ => {
                let id = self.derive(&line);
                self.delete(&pairs);
                Some(id)
            }
        };
        self.at_most_one.insert(start, id);
        id
    }

    /// Of these sensors, one more than `windows`, not all have `start <= |d| < start + windows * separation`.
    pub(crate) fn hall(&mut self, members: &[usize], start: i32, windows: i32) {
        let (step, model) = (self.separation(), self.model);
        let end = start + windows * step;
        let mut line = String::new();
        let mut add = |what: &str| {
            let plus = if line.is_empty() { "" } else { " +" };
            line += &format!(" {what}{plus}");
        };
        for window in 0..windows {
            if let Some(id) = self.at_most_one(start + window * step) {
                add(&id.to_string());
            }
        }
        // The sum speaks of all sensors. Of each that is no member: `|d| >= end` implies `|d| >= start`.
        for x in (0..model.merged.count()).filter(|x| !members.contains(x)) {
            match (model.size_from(x, start), model.size_from(x, end)) {
                (Truth::If(_), Truth::If(_)) => add(&self.size_chain(x, start, end).to_string()),
                (Truth::If(literal), _) => add(&literal.to_string()),
                (Truth::Always, Truth::If(literal)) => add(&(!literal).to_string()),
                _ => {}
            }
        }
        self.derive_once(format!("pol{line}"));
    }

    /// If all of `set` are below y and have `|d| >= start`, `|d_y|` is at least a separation above for each.
    pub(crate) fn room_below(&mut self, set: &[usize], y: usize, start: i32) {
        let end = start + set.len() as i32 * self.separation();
        self.hall(&with(set, y), start, set.len() as i32);
        let mut cases = vec![self.model.size_from(y, end)];
        for &x in set {
            cases.extend([!self.model.size_from(x, start), Truth::If(!below(x, y))]);
        }
        self.propagated_once(&cases);
    }

    /// If all of `set` are above y and have `|d|` within a separation for each of them from `start`, then `|d_y|` is
    /// below `start`.
    pub(crate) fn room_above(&mut self, set: &[usize], y: usize, start: i32) {
        let end = start + set.len() as i32 * self.separation();
        self.hall(&with(set, y), start, set.len() as i32);
        let mut cases = vec![!self.model.size_from(y, start)];
        for &x in set {
            cases.extend([self.model.size_from(x, end), Truth::If(!below(y, x))]);
        }
        self.propagated_once(&cases);
    }

    /// The order of |d| is transitive: a lemma of unit propagation, since each step adds a separation.
    pub(crate) fn transitive(&mut self, x: usize, y: usize, z: usize) {
        let cases = [!below(x, y), !below(y, z), below(x, z)].map(Truth::If);
        self.propagated_once(&cases);
    }

    /// Adds the clause, since the substitution takes each schedule without it to one with it.
    pub(crate) fn strengthen(&mut self, cases: &[Literal], image: impl Fn(Variable) -> Literal) {
        let cases: Vec<Truth> = cases.iter().copied().map(Truth::If).collect();
        let Some(clause) = clause(&cases) else { return };
        let moved = self.model.variables().into_iter().map(|variable| (variable, image(variable)));
        let moved = moved.filter(|(variable, image)| variable.is_true() != *image);
        let substitution: String = moved.map(|(variable, image)| format!(" {variable} -> {image}")).collect();
        self.derive(&format!("red {clause} :{substitution}"));
    }

    /// The last lines.
    pub(crate) fn end(mut self, contradiction: Id) -> String {
        let _ = write!(self.text, "output NONE;\nconclusion UNSAT : {contradiction};\nend pseudo-Boolean proof;\n");
        self.text
    }
}

/// The set with one more, in ascending order.
fn with(set: &[usize], y: usize) -> Vec<usize> {
    let mut with = [set, &[y]].concat();
    with.sort_unstable();
    with
}

/// Where a permutation of the sensors takes a variable.
pub(crate) fn permuted(variable: Variable, image: &[usize]) -> Literal {
    match variable {
        Variable::Bit(phase, x, bit) => Variable::Bit(phase, image[x], bit).is_true(),
        Variable::D(x, v) => Variable::D(image[x], v).is_true(),
        Variable::Size(x, v) => Variable::Size(image[x], v).is_true(),
        Variable::Order(phase, x, y) => before(phase, image[x], image[y]),
        Variable::Rank(x, y) => below(image[x], image[y]),
    }
}

/// The phases exchanged: all d change sign.
pub(crate) fn exchanged(variable: Variable) -> Literal {
    match variable {
        Variable::Bit(phase, x, bit) => Variable::Bit(1 - phase, x, bit).is_true(),
        Variable::D(x, v) => !Variable::D(x, 1 - v).is_true(),
        Variable::Order(phase, x, y) => before(1 - phase, x, y),
        other => other.is_true(),
    }
}

/// Time reversed and the phases exchanged: all d stay.
pub(crate) fn reversed(variable: Variable) -> Literal {
    match variable {
        Variable::Bit(phase, x, bit) => !Variable::Bit(1 - phase, x, bit).is_true(),
        Variable::Order(phase, x, y) => before(1 - phase, y, x),
        other => other.is_true(),
    }
}
