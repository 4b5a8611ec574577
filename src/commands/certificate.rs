//! The certificate of a design, proven by `eeruf-check`: of the search it uses only the schedule and the bound.

use eeruf_check::prove::{NoProof, prove_while};
use eeruf_check::{Claim, Uniform, check};
use eeruf_core::{Micros, Phase};

use crate::files::ring::RingSpec;
use crate::report::design::RingDesign;
use crate::report::watch::Watch;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound.
pub(crate) fn prove(spec: &RingSpec, design: &RingDesign, budget: usize, watch: &mut Watch) -> Result<String, String> {
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
    let proven = prove_while(&claim, budget, |nodes| watch.go_on(|| format!("certificate: {nodes} nodes")));
    proven.map_err(|error| match error {
        NoProof::Budget(nodes) => {
            format!("the proof has more than {nodes} nodes; give it more with --certificate-budget")
        }
        error => error.to_string(),
    })
}

/// What the checker says of the certificate.
pub(crate) fn claim(text: &str) -> String {
    check(text).map_or_else(|error| format!("refused: {error}"), |certified| certified.to_string())
}
