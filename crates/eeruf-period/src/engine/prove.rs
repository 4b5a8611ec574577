//! Writes certificates: a depth-first search for a tree of branchings that refutes every shorter period.
//!
//! Nothing here needs to be trusted: a checker that shares nothing with it reads what it writes.

use core::fmt;

use crate::engine::branching::{Branching, choose};
use crate::engine::orders::Orders;
use crate::engine::problem::Claim;
use crate::engine::search::nodes_between;
use crate::engine::state::{Mark, event};
use crate::engine::symmetry::Assumptions;

/// Why there is no certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoProof {
    /// The budget of this many nodes is spent.
    Budget(usize),
    /// The caller wanted no more.
    Stopped,
    /// In whole ticks a branch is neither refuted nor is there anything left to branch on. The earliest firing times
    /// there are a schedule with a period of `bound - 1`.
    Feasible([Vec<u32>; 2]),
    /// The same over the reals: schedules with these orders may or may not have a period below `bound`.
    Open(Orders),
    /// The claim is wrong in itself.
    Claim(String),
}

impl fmt::Display for NoProof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Budget(nodes) => write!(f, "the proof has more than {nodes} nodes"),
            Self::Stopped => f.write_str("the proof was stopped before its end"),
            Self::Feasible([a, b]) => {
                write!(f, "the claim is wrong: there is a schedule below the bound, firing at {a:?} and {b:?} ticks")
            }
            Self::Open(_) => f.write_str("the claim is not proven: the rules leave firing orders open below the bound"),
            Self::Claim(what) => write!(f, "no claim that can be proven: {what}"),
        }
    }
}

impl core::error::Error for NoProof {}

/// Writes a certificate of the claim; if budget or caller end the proof too early, one with the highest bound for which
/// a sixteenth of the budget suffices, or the rules alone after the caller wanted no more.
///
/// # Errors
///
/// See [`NoProof`]: only that the claim is wrong.
pub fn prove_what_can_be(
    claim: &Claim,
    budget: usize,
    mut go_on: impl FnMut(usize) -> bool,
) -> Result<String, NoProof> {
    let ended = match prove_while(claim, budget, &mut go_on) {
        Err(ended @ (NoProof::Budget(_) | NoProof::Stopped)) => ended,
        proven => return proven,
    };
    let budget = if ended == NoProof::Stopped { 1 } else { (budget / 16).max(1) };
    let (mut certified, mut open, mut best) = (0, claim.bound, Err(ended));
    while certified + 1 < open {
        let bound = certified + (open - certified) / 2;
        match prove_while(&Claim { bound, ..claim.clone() }, budget, &mut go_on) {
            Ok(text) => (certified, best) = (bound, Ok(text)),
            Err(NoProof::Budget(_) | NoProof::Stopped) => open = bound,
            wrong => return wrong,
        }
    }
    best
}

/// Writes a certificate of the claim, with a tree of at most `budget` nodes.
///
/// # Errors
///
/// See [`NoProof`].
pub fn prove(claim: &Claim, budget: usize) -> Result<String, NoProof> {
    prove_while(claim, budget, |_| true)
}

/// The same as [`prove`], as long as `go_on` says so: it is asked now and then, with the number of nodes so far.
///
/// # Errors
///
/// See [`NoProof`].
pub fn prove_while(claim: &Claim, budget: usize, go_on: impl FnMut(usize) -> bool) -> Result<String, NoProof> {
    prove_but(claim, budget, go_on, |_| false)
}

/// The same where over the reals it is no fault of the proof if orders stay open that `are_excluded`; the text is then
/// no certificate.
pub(crate) fn prove_but(
    claim: &Claim,
    budget: usize,
    mut go_on: impl FnMut(usize) -> bool,
    mut are_excluded: impl FnMut(&Orders) -> bool,
) -> Result<String, NoProof> {
    claim.check().map_err(NoProof::Claim)?;
    let merged = claim.problem.merged();
    let assumptions = Assumptions::of(&claim.problem);
    let mut text = claim.head() + &assumptions.lines();
    let Ok(mut state) = assumptions.root(&merged, claim.bound) else { return Ok(text + "end\n") };
    let firsts = merged.firsts();
    let sequence: Vec<usize> = (0..merged.count()).collect();
    let between = nodes_between(claim.problem.sensors());
    let mut nodes = 1;
    let mut open: Vec<(Mark, Branching)> = Vec::new();
    let mut holds = true;
    loop {
        let (branching, case) = match if holds { choose(&state, &merged, &sequence) } else { None } {
            Some(branching) => {
                text += &branching.line(&firsts);
                open.push((state.mark(), branching));
                (branching, 0)
            }
            None => {
                if holds && !merged.over_reals {
                    return Err(NoProof::Feasible([0, 1].map(|phase| {
                        let times = merged.of_sensor.iter().map(|&one| -state.bounds.at(event(one, phase), 0) / 2);
                        times.map(|time| time as u32).collect()
                    })));
                }
                let orders = if holds { Some(Orders::at(&state)) } else { None };
                if let Some(orders) = orders.filter(|orders| !are_excluded(orders)) {
                    return Err(NoProof::Open(orders));
                }
                // The second case of the deepest branching that has not come to it.
                let Some((mark, branching)) = open.pop() else { return Ok(text + "end\n") };
                state.drop_mark(mark);
                (branching, 1)
            }
        };
        nodes += 1;
        if nodes > budget {
            return Err(NoProof::Budget(budget));
        }
        if nodes.is_multiple_of(between) && !go_on(nodes) {
            return Err(NoProof::Stopped);
        }
        holds = branching.assume(case, &mut state, &merged).is_ok();
    }
}
