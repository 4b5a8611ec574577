//! A slow checker of the few rules of VeriPB's proofs that ours use, from the definition of each rule: an inequality is
//! a sum of coefficients times literals that is at least a number.
#![allow(dead_code)]

use std::collections::{BTreeMap, HashMap, HashSet};

/// `sum >= least`, all coefficients positive: for each variable its literal's sign and coefficient.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Inequality {
    terms: BTreeMap<String, (bool, i128)>,
    least: i128,
}

impl Inequality {
    fn zero() -> Self {
        Self { terms: BTreeMap::new(), least: 0 }
    }

    /// Adds `coefficient * literal` to the left side.
    fn add_term(&mut self, coefficient: i128, literal: &str) {
        let (is_true, variable) = literal.strip_prefix('~').map_or((true, literal), |variable| (false, variable));
        // c l = c - c (not l): the constant goes to the right side.
        let (is_true, coefficient) = if coefficient < 0 {
            self.least -= coefficient;
            (!is_true, -coefficient)
        } else {
            (is_true, coefficient)
        };
        let (old_true, old) = self.terms.remove(variable).unwrap_or((is_true, 0));
        let (sign, rest) = if old_true == is_true {
            (is_true, old + coefficient)
        } else {
            // Of both signs the smaller part adds to a constant.
            self.least -= old.min(coefficient);
            if old > coefficient { (old_true, old - coefficient) } else { (is_true, coefficient - old) }
        };
        if rest > 0 {
            self.terms.insert(variable.to_owned(), (sign, rest));
        }
    }

    /// `+2 x -3 ~y >= 1`
    pub(crate) fn parse(text: &str) -> Self {
        let (sum, least) = text.split_once(">=").expect("an inequality");
        let mut inequality = Self { least: least.trim().parse().expect("a number"), ..Self::zero() };
        let words: Vec<&str> = sum.split_whitespace().collect();
        for term in words.chunks(2) {
            inequality.add_term(term[0].parse().expect("a coefficient"), term[1]);
        }
        inequality
    }

    fn plus(mut self, other: &Self) -> Self {
        self.least += other.least;
        for (variable, (is_true, coefficient)) in &other.terms {
            self.add_term(*coefficient, &literal(variable, *is_true));
        }
        self
    }

    fn times(mut self, factor: i128) -> Self {
        self.least *= factor;
        self.terms.values_mut().for_each(|(_, coefficient)| *coefficient *= factor);
        self
    }

    /// Divides, and rounds up: the left side is then whole, and no smaller.
    fn divided(mut self, divisor: i128) -> Self {
        let up = |number: i128| number.div_euclid(divisor) + i128::from(number.rem_euclid(divisor) > 0);
        self.least = up(self.least);
        self.terms.values_mut().for_each(|(_, coefficient)| *coefficient = up(*coefficient));
        self
    }

    /// That it does not hold: all terms, negated, make up for what is missing.
    fn negated(&self) -> Self {
        let total: i128 = self.terms.values().map(|(_, coefficient)| coefficient).sum();
        let terms =
            self.terms.iter().map(|(variable, (is_true, coefficient))| (variable.clone(), (!is_true, *coefficient)));
        Self { terms: terms.collect(), least: total - self.least + 1 }
    }

    fn substituted(&self, witness: &HashMap<String, String>) -> Self {
        let mut image = Self { least: self.least, ..Self::zero() };
        for (variable, (is_true, coefficient)) in &self.terms {
            let to = witness.get(variable).map_or_else(|| variable.clone(), String::clone);
            image.add_term(*coefficient, &if *is_true { to } else { opposite(&to) });
        }
        image
    }

    /// Returns true if the assignment keeps it.
    pub(crate) fn holds(&self, is_true: &dyn Fn(&str) -> bool) -> bool {
        let kept = self.terms.iter().filter(|(variable, (sign, _))| is_true(variable) == *sign);
        kept.map(|(_, (_, coefficient))| coefficient).sum::<i128>() >= self.least
    }
}

fn literal(variable: &str, is_true: bool) -> String {
    if is_true { variable.to_owned() } else { format!("~{variable}") }
}

fn opposite(literal: &str) -> String {
    literal.strip_prefix('~').map_or_else(|| format!("~{literal}"), str::to_owned)
}

/// Returns true if unit propagation in these ends in a contradiction.
fn propagates_to_contradiction<'a>(all: &(impl Iterator<Item = &'a Inequality> + Clone)) -> bool {
    let mut assigned: HashMap<&str, bool> = HashMap::new();
    loop {
        let mut news = false;
        for inequality in all.clone() {
            let open = |variable: &str, sign: bool| assigned.get(variable).is_none_or(|value| *value == sign);
            let possible = inequality.terms.iter().filter(|(variable, (sign, _))| open(variable, *sign));
            let slack = possible.map(|(_, (_, coefficient))| coefficient).sum::<i128>() - inequality.least;
            if slack < 0 {
                return true;
            }
            for (variable, (sign, coefficient)) in &inequality.terms {
                // Without this one it could not hold any more.
                if *coefficient > slack && !assigned.contains_key(variable.as_str()) {
                    assigned.insert(variable, *sign);
                    news = true;
                }
            }
        }
        if !news {
            return false;
        }
    }
}

/// The model's inequalities.
pub(crate) fn read_model(text: &str) -> Vec<Inequality> {
    let lines = text.lines().filter(|line| !line.starts_with('*'));
    lines.map(|line| Inequality::parse(line.strip_suffix(" ;").expect("a line ends with ;"))).collect()
}

/// The error in the proof that the model has no solution, if any: the line and why.
pub(crate) fn check(model: &str, proof: &str) -> Result<(), String> {
    let mut known: Vec<Option<Inequality>> = read_model(model).into_iter().map(Some).collect();
    let mut lines = proof.lines().enumerate();
    if lines.next().map(|(_, line)| line) != Some("pseudo-Boolean proof version 3.0") {
        return Err("line 1: no header".to_owned());
    }
    let mut is_unsatisfiable = false;
    for (number, line) in lines {
        let wrong = |why: &str| Err(format!("line {}: {why}: {line}", number + 1));
        let Some(line) = line.strip_suffix(';') else { return wrong("no semicolon") };
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        let has = |id: &str| id.parse::<usize>().ok().and_then(|id| known.get(id.wrapping_sub(1))?.as_ref());
        match word {
            "f" if rest.parse() == Ok(known.len()) => {}
            "rup" => {
                let new = Inequality::parse(rest);
                let negated = new.negated();
                if !propagates_to_contradiction(&known.iter().flatten().chain([&negated])) {
                    return wrong("unit propagation does not derive it");
                }
                known.push(Some(new));
            }
            "pol" => {
                let Some(new) = calculated(rest, &has) else { return wrong("not a sum of what is known") };
                known.push(Some(new));
            }
            "red" => {
                let Some((new, witness)) = rest.split_once(" : ") else { return wrong("no witness") };
                let new = Inequality::parse(new);
                if let Some(why) = not_redundant(&known, &new, witness) {
                    return wrong(&why);
                }
                known.push(Some(new));
            }
            "del" => {
                for id in rest.trim_start_matches("id ").split(' ') {
                    match id.parse::<usize>().ok().and_then(|id| known.get_mut(id.wrapping_sub(1))) {
                        Some(known @ Some(_)) => *known = None,
                        _ => return wrong("nothing there to delete"),
                    }
                }
            }
            "output" if rest == "NONE" => {}
            "conclusion" => {
                let contradiction = rest.strip_prefix("UNSAT : ").and_then(has);
                is_unsatisfiable = contradiction.is_some_and(|it| it.terms.is_empty() && it.least > 0);
            }
            "end" => return if is_unsatisfiable { Ok(()) } else { wrong("no contradiction") },
            _ => return wrong("unknown, or wrong"),
        }
    }
    Err("the proof has no end".to_owned())
}

/// A sum in reverse Polish notation.
fn calculated<'a>(line: &str, has: &dyn Fn(&str) -> Option<&'a Inequality>) -> Option<Inequality> {
    let mut stack: Vec<Inequality> = Vec::new();
    let mut numbers: Vec<i128> = Vec::new();
    let words: Vec<&str> = line.split(' ').collect();
    for (i, word) in words.iter().enumerate() {
        match *word {
            "+" => {
                let (second, first) = (stack.pop()?, stack.pop()?);
                stack.push(first.plus(&second));
            }
            "*" => {
                let factor = numbers.pop()?;
                let first = stack.pop()?;
                stack.push(first.times(factor));
            }
            "d" => {
                let divisor = numbers.pop()?;
                let first = stack.pop()?;
                stack.push(first.divided(divisor));
            }
            number if number.as_bytes()[0].is_ascii_digit() => {
                // A number that an operator follows is no name of an inequality.
                if matches!(words.get(i + 1), Some(&"*" | &"d")) {
                    numbers.push(number.parse().ok().filter(|number| *number > 0)?);
                } else {
                    stack.push(has(number)?.clone());
                }
            }
            literal => {
                let mut axiom = Inequality::zero();
                axiom.add_term(1, literal);
                stack.push(axiom);
            }
        }
    }
    (stack.len() == 1 && numbers.is_empty()).then(|| stack.pop())?
}

/// Why the witness does not take each solution without the new inequality to one with it.
fn not_redundant(known: &[Option<Inequality>], new: &Inequality, witness: &str) -> Option<String> {
    let words: Vec<&str> = witness.split_whitespace().collect();
    let witness = words.chunks(3).map(|step| (step[0].to_owned(), step[2].to_owned())).collect();
    let present: HashSet<&Inequality> = known.iter().flatten().collect();
    let without = new.negated();
    for goal in known.iter().flatten().chain([new]) {
        let image = goal.substituted(&witness);
        let negated = image.negated();
        let follows = image == *goal && goal != new
            || present.contains(&image)
            || propagates_to_contradiction(&known.iter().flatten().chain([&without, &negated]));
        if !follows {
            return Some(format!("the witness does not keep {goal:?}"));
        }
    }
    None
}
