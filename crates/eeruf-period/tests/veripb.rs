//! Models and proofs for VeriPB, judged by a slow checker of our own; `cargo xtask veripb` has VeriPB judge them.

mod common;
#[path = "common/pseudo_boolean.rs"]
mod pseudo_boolean;

use common::{Random, feasible, random_problem, table};
use eeruf_period::engine::prove::NoProof;
use eeruf_period::engine::veripb::{VeriPb, model, prove};
use eeruf_period::engine::{Claim, Problem};
use pseudo_boolean::{check, read_model};
use std::collections::HashMap;

/// A tiny problem's shortest period, with a schedule, by trying all firing times.
fn claim(seed: u64) -> Option<Claim> {
    let problem = random_problem(&mut Random(seed + 1));
    let most = if problem.sensors() <= 3 { 13 } else { 9 };
    let (period, fire) = (2..=most).find_map(|period| feasible(&problem, period).map(|fire| (period, fire)))?;
    Some(Claim { problem, period, fire, bound: period })
}

/// The first inequality of each sensor says that a firing time is not negative: it has the summands' values.
fn weights(model: &str) -> Vec<u32> {
    let first = model.lines().nth(1).expect("a first inequality");
    let words: Vec<&str> = first.split(" >=").next().expect("a sum").split_whitespace().collect();
    words.chunks(2).map(|term| term[0].parse().expect("a weight")).collect()
}

/// Returns true if the model allows the schedule.
fn allows(model: &str, problem: &Problem, fire: &[Vec<u32>; 2]) -> bool {
    // Of sensors that fire together the model has one, numbered in the order of the first ones.
    let is_first = |x: &usize| !problem.together.iter().any(|group| group.contains(x) && group[0] != *x);
    let ones: Vec<usize> = (0..problem.sensors()).filter(is_first).collect();
    let mut bits = HashMap::new();
    for (one, &x) in ones.iter().enumerate() {
        for phase in 0..2 {
            let mut rest = fire[phase][x];
            for (bit, &weight) in weights(model).iter().enumerate().rev() {
                let is_in = weight <= rest;
                rest -= if is_in { weight } else { 0 };
                bits.insert(format!("{}{one}_{bit}", ["a", "b"][phase]), is_in);
            }
            assert_eq!(rest, 0, "each time in the period is a sum");
        }
    }
    let d = |one: usize| fire[0][ones[one]] as i32 - fire[1][ones[one]] as i32;
    let is_true = |variable: &str| {
        if let Some(&bit) = bits.get(variable) {
            return bit;
        }
        let (name, value) = variable.split_once('_').expect("a name with two parts");
        let kind = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let x: usize = name[kind.len()..].parse().expect("a sensor");
        let value: i32 = value.replace('m', "-").parse().expect("a value");
        let earlier = |phase: usize| fire[phase][ones[x]] < fire[phase][ones[value as usize]];
        match kind {
            "d" => d(x) >= value,
            "s" => d(x).abs() >= value,
            "r" => d(x).abs() < d(value as usize).abs(),
            "oa" => earlier(0),
            "ob" => earlier(1),
            _ => panic!("{variable}: no such variable"),
        }
    };
    read_model(model).iter().all(|inequality| inequality.holds(&is_true))
}

#[test]
fn no_schedule_beats_the_shortest_in_the_model() {
    let cases = std::env::var("EERUF_CASES").map_or(60, |cases| cases.parse().expect("a number"));
    let (mut solved, mut nodes) = (0, 0);
    for seed in 0..cases {
        let Some(claim) = claim(seed) else { continue };
        let proven = prove(&claim, 100_000, |_| true).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        check(&proven.model, &proven.proof).unwrap_or_else(|why| panic!("seed {seed}: {why}\n{claim:?}"));
        assert_eq!(proven.model, model(&claim.problem, claim.period - 1), "seed {seed}");
        // A schedule found by trying all solves the model of its period, which cannot be refuted.
        let next = model(&claim.problem, claim.period);
        assert!(allows(&next, &claim.problem, &claim.fire), "seed {seed}: {claim:?}");
        assert!(check(&next, &proven.proof).is_err(), "seed {seed}: the proof is of another period");
        let longer = Claim { period: claim.period + 1, bound: claim.period + 1, ..claim };
        assert!(matches!(prove(&longer, 100_000, |_| true), Err(NoProof::Feasible(_))), "seed {seed}");
        solved += 1;
        nodes += proven.nodes;
    }
    println!("{solved} of {cases} problems have a schedule, {nodes} nodes");
    assert!(solved * 3 > cases && nodes as u64 > 2 * solved, "{solved} of {cases} solved with {nodes} nodes");
}

/// A proof of a few dozen nodes, with all kinds of lines.
fn of_the_table() -> VeriPb {
    let rings = table(1);
    let (_, claim) = rings.iter().find(|(name, _)| name == "ring 8, window 45").expect("it is in the table");
    prove(claim, 1000, |_| true).expect("a proof")
}

#[test]
fn a_proof_with_one_line_broken_is_refused() {
    let VeriPb { model, proof, .. } = of_the_table();
    assert_eq!(check(&model, &proof), Ok(()));
    let lines: Vec<&str> = proof.lines().collect();
    let of = |word: &str| -> Vec<usize> { (0..lines.len()).filter(|&i| lines[i].starts_with(word)).collect() };
    let is_refused = |at: usize, line: &str| {
        let mut broken = lines.clone();
        broken[at] = line;
        assert!(check(&model, &(broken.join("\n") + "\n")).is_err(), "line {}: {line}", at + 1);
    };
    // A clause that claims too much, an assumption whose witness forgets a variable.
    let is_path = |line: &str| line.ends_with("1099511627776 d;");
    let path = of("pol").into_iter().find(|&i| is_path(lines[i])).expect("a path");
    let clause = of("rup").into_iter().find(|&i| i > path).expect("a clause");
    is_refused(clause, "rup >= 1;");
    let reds: Vec<usize> = of("red");
    assert!(reds.len() > 8, "a ring of eight has nine assumptions");
    let words: Vec<&str> = lines[reds[0]].split(' ').collect();
    is_refused(reds[0], &(words[..words.len() - 3].join(" ") + ";"));
    // One path may be spared, since others lead the same way; not all of them.
    let pathless: Vec<&str> = lines.iter().map(|line| if is_path(line) { "pol 1;" } else { line }).collect();
    assert!(check(&model, &(pathless.join("\n") + "\n")).is_err());
}

#[test]
fn the_proof_is_refused_for_a_ring_that_asks_for_less() {
    let rings = table(1);
    let (_, claim) = rings.iter().find(|(name, _)| name == "ring 8, window 45").expect("it is in the table");
    let proof = prove(claim, 1000, |_| true).expect("a proof").proof;
    let mut less = claim.problem.clone();
    less.window[3] = 10;
    assert!(check(&model(&less, claim.bound - 1), &proof).is_err());
}

#[test]
fn what_cannot_be_proven_is_said() {
    let Some(claim) = (0..).find_map(claim) else { unreachable!("there are such problems") };
    let error = |claim: &Claim, budget| prove(claim, budget, |_| true).expect_err("no proof").to_string();
    let nothing = error(&Claim { bound: 1, ..claim.clone() }, 10);
    assert_eq!(nothing, "no claim that can be proven: no period below 1; expected 2 or more");
    let mut reals = claim.clone();
    reals.problem.over_reals = true;
    reals.problem.stale_echo = false;
    assert_eq!(error(&reals, 10), "no claim that can be proven: over the reals; expected whole ticks");
    let rings = table(1);
    let (_, line) = rings.iter().find(|(name, _)| name == "line 8, window 15").expect("it is in the table");
    assert_eq!(error(line, 20), "the proof has more than 20 nodes");
    assert_eq!(prove(line, 1000, |_| false), Err(NoProof::Stopped));
}
