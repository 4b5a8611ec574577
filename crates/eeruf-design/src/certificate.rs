//! The certificate of a design, proven by `eeruf-check`: of the search it uses only the schedule and the bound.

use eeruf_check::prove::{NoProof, prove_while};
use eeruf_check::{Claim, Uniform};
use eeruf_core::{Micros, Phase};

use crate::find::RingDesign;
use crate::ring::RingSpec;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound.
/// `keep_going` is told the nodes so far.
///
/// # Errors
/// The proof has more than `budget` nodes, `keep_going` answered `false`, or the rules cannot prove it.
pub fn prove(
    spec: &RingSpec,
    design: &RingDesign,
    budget: usize,
    keep_going: impl FnMut(usize) -> bool,
) -> Result<String, NoProof> {
    let tick = spec.tick.as_micros().max(1);
    let requirements = spec.problem(design.t_delta).requirements;
    let neighbours = |x, y| requirements.layout.neighbours(spec.sensors, x, y);
    let uniform = Uniform {
        tick_us: tick,
        sensors: spec.sensors,
        t_delta_us: requirements.t_delta.as_micros(),
        window_us: requirements.window.as_micros(),
        interval_us: requirements.min_interval.as_micros(),
        stale_echo: requirements.stale_echo,
        pairs: (0..spec.sensors)
            .flat_map(|x| (x + 1..spec.sensors).map(move |y| (x, y)))
            .filter(|&(x, y)| neighbours(x, y))
            .collect(),
    };
    let ticks = |time: Micros| time.as_micros() / tick;
    let fire = [Phase::A, Phase::B].map(|phase| {
        let times = (0..spec.sensors).map(|sensor| design.schedule.t_fire(phase, sensor));
        times.map(|time| ticks(time.unwrap_or_default())).collect()
    });
    let period = ticks(design.schedule.period());
    let bound = design.designed.found.bound.map_or(1, ticks).max(1);
    let claim = Claim { problem: uniform.problem(), period, fire, bound };
    prove_while(&claim, budget, keep_going)
}
