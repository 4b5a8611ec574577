//! The certificate of a design, proven by `eeruf-check`: of the search it uses only the schedule and the bound.

use eeruf_check::prove::{NoProof, prove_what_can_be};
use eeruf_check::{Answer, Uniform};
use eeruf_core::search::PeriodProblem;
use eeruf_core::{Micros, Phase};
use eeruf_sim::AnySchedule;

use crate::find::RingDesign;
use crate::ring::RingSpec;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound; or
/// a lower bound, where that proof has more than `budget` nodes or `go_on`, which is given the nodes so far, says no.
///
/// # Errors
/// The claim is wrong.
pub fn prove(
    spec: &RingSpec,
    design: &RingDesign,
    budget: usize,
    go_on: impl FnMut(usize) -> bool,
) -> Result<String, NoProof> {
    certify(&spec.problem(design.t_delta), &design.schedule, design.designed.found.bound, budget, go_on)
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
    let PeriodProblem { sensors, requirements, tick } = *problem;
    let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
    let uniform = Uniform {
        tick_us: tick.as_micros().max(1),
        sensors,
        t_delta_us: requirements.t_delta.as_micros(),
        window_us: requirements.window.as_micros(),
        interval_us: requirements.min_interval.as_micros(),
        stale_echo: requirements.stale_echo,
        pairs: pairs.filter(|&(x, y)| requirements.layout.neighbours(sensors, x, y)).collect(),
    };
    let fire_us = [Phase::A, Phase::B].map(|phase| {
        let times = (0..sensors).map(|sensor| schedule.t_fire(phase, sensor).unwrap_or_default());
        times.map(Micros::as_micros).collect()
    });
    let bound_us = bound.unwrap_or_default().as_micros();
    let answer = Answer { period_us: schedule.period().as_micros(), fire_us, bound_us };
    prove_what_can_be(&uniform.claim(&answer), budget, go_on)
}
