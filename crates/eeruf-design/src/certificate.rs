//! The certificate of a design: of the search it uses only the schedule and the bound.

use eeruf_core::Micros;
use eeruf_period::PeriodProblem;
use eeruf_period::engine::prove::{NoProof, prove_what_can_be};
use eeruf_period::engine::veripb::{self, VeriPb};
use eeruf_sim::AnySchedule;

use crate::find::RingDesign;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound; or
/// a lower bound, where that proof has more than `budget` nodes or `go_on`, which is given the nodes so far, says no.
///
/// # Errors
/// The claim is wrong.
pub fn prove(design: &RingDesign, budget: usize, go_on: impl FnMut(usize) -> bool) -> Result<String, NoProof> {
    certify(&design.bounding.problem(), &design.schedule, design.bound, budget, go_on)
}

/// The same for any schedule, and what is known to be the least period.
///
/// # Errors
/// As for [`prove`].
pub fn certify(
    problem: &PeriodProblem<'_>,
    schedule: &AnySchedule,
    bound: Option<Micros>,
    budget: usize,
    go_on: impl FnMut(usize) -> bool,
) -> Result<String, NoProof> {
    prove_what_can_be(&problem.claim(schedule, bound), budget, go_on)
}

/// The same as a model and a proof for VeriPB, of the period one tick below the bound.
///
/// # Errors
/// The proof has more than `budget` nodes, `go_on` says no, or the claim is wrong.
pub fn prove_to_veripb(
    design: &RingDesign,
    budget: usize,
    go_on: impl FnMut(usize) -> bool,
) -> Result<VeriPb, NoProof> {
    veripb::prove(&design.bounding.problem().claim(&design.schedule, design.bound), budget, go_on)
}
