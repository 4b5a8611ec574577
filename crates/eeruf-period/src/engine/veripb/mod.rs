//! A proof for VeriPB, a checker of pseudo-Boolean proofs that others wrote: a second root of trust.
//!
//! docs/reference/certificate.md, "A second root of trust", has the model and how its proof goes.

mod known;
mod literals;
mod model;
mod proof;
mod symmetry;

use crate::engine::bounds::Refuted;
use crate::engine::branching::choose;
use crate::engine::problem::{Claim, Problem};
use crate::engine::prove::NoProof;
use crate::engine::search::nodes_between;
use crate::engine::state::event;
use known::{Known, first_case};
use literals::Truth;
use model::Model;
use proof::Proof;

/// The two files that VeriPB reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VeriPb {
    /// The model of the schedules with a period of `bound - 1` ticks, in the format OPB.
    pub model: String,
    /// The proof that there are none, in VeriPB's format 3.0.
    pub proof: String,
    /// The nodes of the tree, leaves included.
    pub nodes: usize,
}

/// The model of the schedules with this period, in ticks: it has a solution if and only if there is one.
#[must_use]
pub fn model(problem: &Problem, period: u32) -> String {
    Model::new(&problem.merged(), period as i32).text()
}

/// A node's branching, on the way to where the tree has come.
struct Open {
    known: Known,
    /// Assumption of its second case.
    second: Truth,
    /// The clause that refutes its first case, once that is done.
    first_refuted: Option<usize>,
}

/// Writes the model of the period `bound - 1` and the proof that no schedule has it, with a tree of at most `budget`
/// nodes, as long as `go_on` says so: it is asked now and then, with the number of nodes so far.
///
/// # Errors
///
/// See [`NoProof`]. There is nothing to prove below the bound 2, and no proof over the reals.
pub fn prove(claim: &Claim, budget: usize, mut go_on: impl FnMut(usize) -> bool) -> Result<VeriPb, NoProof> {
    claim.check().map_err(NoProof::Claim)?;
    if claim.problem.over_reals {
        return Err(NoProof::Claim("over the reals; expected whole ticks".to_owned()));
    }
    if claim.bound < 2 {
        return Err(NoProof::Claim(format!("no period below {}; expected 2 or more", claim.bound)));
    }
    let merged = claim.problem.merged();
    let model = Model::new(&merged, claim.bound as i32 - 1);
    let sequence: Vec<usize> = (0..merged.count()).collect();
    let mut proof = Proof::new(&model);
    let mut reached = Known::new(&mut proof)
        .and_then(|mut known| symmetry::assume(&mut proof, &mut known, &claim.problem).map(|()| known));
    let between = nodes_between(claim.problem.sensors());
    let mut nodes = 1;
    let mut assumed: Vec<Truth> = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    loop {
        match reached {
            Ok(known) => {
                let Some(branching) = choose(&known.state, &merged, &sequence) else {
                    return Err(NoProof::Feasible([0, 1].map(|phase| {
                        let times =
                            merged.of_sensor.iter().map(|&one| -known.state.bounds.at(event(one, phase), 0) / 2);
                        times.map(|time| time as u32).collect()
                    })));
                };
                let first = first_case(&model, branching);
                open.push(Open { known: known.clone(), second: !first, first_refuted: None });
                assumed.push(first);
                reached = assume(&mut proof, known, first);
            }
            Err(Refuted) => {
                // Not all that is assumed here holds.
                let cases: Vec<Truth> = assumed.iter().map(|truth| !*truth).collect();
                let mut refuted = proof.propagated(&cases);
                // Where both cases are refuted, so is the node.
                while let Some(Open { first_refuted: Some(first), .. }) = open.last() {
                    let first = *first;
                    open.pop();
                    assumed.pop();
                    let cases: Vec<Truth> = assumed.iter().map(|truth| !*truth).collect();
                    let second = refuted;
                    refuted = proof.propagated(&cases);
                    proof.delete(&[Some(first), second].into_iter().flatten().collect::<Vec<_>>());
                }
                let Some(last) = open.last_mut() else {
                    let text = proof.end(refuted.unwrap_or_default());
                    return Ok(VeriPb { model: model.text(), proof: text, nodes });
                };
                last.first_refuted = Some(refuted.unwrap_or_default());
                assumed.pop();
                assumed.push(last.second);
                let (known, second) = (last.known.clone(), last.second);
                reached = assume(&mut proof, known, second);
            }
        }
        nodes += 1;
        if nodes > budget {
            return Err(NoProof::Budget(budget));
        }
        if nodes.is_multiple_of(between) && !go_on(nodes) {
            return Err(NoProof::Stopped);
        }
    }
}

/// Assumes a case and propagates.
fn assume(proof: &mut Proof<'_>, mut known: Known, case: Truth) -> Result<Known, Refuted> {
    match case {
        Truth::Always => {}
        Truth::Never => return Err(Refuted),
        Truth::If(literal) => {
            known.assume(proof, literal)?;
        }
    }
    known.propagate(proof).map(|()| known)
}
