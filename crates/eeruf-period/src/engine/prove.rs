//! Writes certificates: a depth-first search for a tree of branchings that refutes every shorter period.
//!
//! Nothing here needs to be trusted: an independent checker reads its output.

use core::fmt;

use crate::engine::branching::{Branching, choose};
use crate::engine::counting::{Argument, lines_of};
use crate::engine::problem::Claim;
use crate::engine::search::nodes_between;
use crate::engine::sets::cover;
use crate::engine::state::{Mark, event};
use crate::engine::symmetry::Assumptions;

/// Reason why there is no certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoProof {
    /// The budget of this many nodes is spent.
    Budget(usize),
    /// The caller stopped the proof.
    Stopped,
    /// A branch is not refuted, and nothing is left to branch on. Its earliest firing times are a schedule with a
    /// period of `bound - 1`.
    Feasible([Vec<u32>; 2]),
    /// The claim itself is wrong.
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
            Self::Claim(what) => write!(f, "no claim that can be proven: {what}"),
        }
    }
}

impl core::error::Error for NoProof {}

/// Writes a certificate of the claim. If the budget ends too early, the certificate is for the highest bound that a
/// sixteenth of the budget proves; if the caller ends the proof, for the highest bound that the rules alone prove.
///
/// # Errors
///
/// [`NoProof`], but only because the claim is wrong.
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

/// Writes a certificate of the claim: by counting, or with a tree of at most `budget` nodes.
///
/// # Errors
///
/// See [`NoProof`].
pub fn prove(claim: &Claim, budget: usize) -> Result<String, NoProof> {
    prove_while(claim, budget, |_| true)
}

/// Proves like [`prove`] while `go_on`, called occasionally with the number of nodes so far, returns true.
///
/// # Errors
///
/// See [`NoProof`].
pub fn prove_while(claim: &Claim, budget: usize, mut go_on: impl FnMut(usize) -> bool) -> Result<String, NoProof> {
    if let Some(counted) = by_counting(claim)? {
        return Ok(counted);
    }
    let by_orders = tree(claim, false, budget, &mut go_on);
    if !matches!(by_orders, Err(NoProof::Budget(_))) {
        return by_orders;
    }
    tree(claim, true, budget, &mut |nodes| go_on(budget + nodes))
}

/// Writes a certificate with branchings on which sensor fires next.
///
/// # Errors
///
/// See [`NoProof`].
pub fn prove_in_time(claim: &Claim, budget: usize) -> Result<String, NoProof> {
    by_counting(claim)?.map_or_else(|| tree(claim, true, budget, &mut |_| true), Ok)
}

/// A certificate without a tree, if counting alone excludes all shorter periods.
fn by_counting(claim: &Claim) -> Result<Option<String>, NoProof> {
    claim.check().map_err(NoProof::Claim)?;
    let merged = claim.problem.merged();
    let argument = Argument::that_excludes(&merged, claim.bound - 1);
    Ok(argument.map(|argument| claim.head() + &argument.lines(&merged.firsts()) + "end\n"))
}

/// A certificate by branchings on orders, or on which sensor fires next.
fn tree(claim: &Claim, in_time: bool, budget: usize, go_on: &mut dyn FnMut(usize) -> bool) -> Result<String, NoProof> {
    let (merged, assumptions) = (&claim.problem.merged(), &Assumptions::of(&claim.problem));
    let firsts = merged.firsts();
    let mut text = claim.head();
    if in_time {
        text += &lines_of(&cover(merged).0, &firsts);
    }
    text += &assumptions.lines(in_time);
    let root = if in_time { Assumptions::root_in_time } else { Assumptions::root };
    let Ok(mut state) = root(assumptions, merged, claim.bound) else { return Ok(text + "end\n") };
    let sequence: Vec<usize> = (0..merged.count()).collect();
    let between = nodes_between(claim.problem.sensors());
    let mut nodes = 1;
    // What was known before a branching, and its next case.
    let mut open: Vec<(Mark, Branching, usize)> = Vec::new();
    let mut holds = true;
    loop {
        if holds {
            let Some(branching) = choose(&state, merged, &sequence) else {
                return Err(NoProof::Feasible([0, 1].map(|phase| {
                    let times = merged.of_sensor.iter().map(|&one| -state.bounds.at(event(one, phase), 0));
                    times.map(|time| time as u32).collect()
                })));
            };
            text += &branching.line(&firsts);
            open.push((state.mark(), branching, 0));
        }
        // The next case of the deepest branching that has one.
        let Some((mark, branching, next)) = open.last_mut() else { return Ok(text + "end\n") };
        if !holds {
            state.undo(*mark);
        }
        if *next == branching.cases(&state) {
            state.drop_mark(*mark);
            open.pop();
            holds = false;
            continue;
        }
        nodes += 1;
        if nodes > budget {
            return Err(NoProof::Budget(budget));
        }
        if nodes.is_multiple_of(between) && !go_on(nodes) {
            return Err(NoProof::Stopped);
        }
        *next += 1;
        holds = branching.assume(*next - 1, &mut state, merged).is_ok();
    }
}
