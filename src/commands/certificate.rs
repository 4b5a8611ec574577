//! The certificate of a design, proven by `eeruf-check`: of the search it uses only the schedule and the bound.

use eeruf_check::prove::prove_what_can_be;
use eeruf_check::{Answer, Uniform, check};
use eeruf_core::Phase;

use crate::files::ring::RingSpec;
use crate::report::design::RingDesign;
use crate::report::watch::Watch;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound; or a
/// lower bound, if budget and time do not suffice for that.
pub(crate) fn prove(spec: &RingSpec, design: &RingDesign, budget: usize, watch: &mut Watch) -> Result<String, String> {
    let requirements = spec.problem(design.t_delta).requirements;
    let neighbours = |x, y| requirements.layout.neighbours(spec.sensors, x, y);
    let uniform = Uniform {
        tick_us: spec.tick.as_micros().max(1),
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
    let fire_us = [Phase::A, Phase::B].map(|phase| {
        let times = (0..spec.sensors).map(|sensor| design.schedule.t_fire(phase, sensor));
        times.map(|time| time.unwrap_or_default().as_micros()).collect()
    });
    let bound_us = design.designed.found.bound.unwrap_or_default().as_micros();
    let answer = Answer { period_us: design.schedule.period().as_micros(), fire_us, bound_us };
    let go_on = |nodes| watch.go_on(|| format!("certificate: {nodes} nodes"));
    prove_what_can_be(&uniform.claim(&answer), budget, go_on).map_err(|error| error.to_string())
}

/// What the checker says of the certificate, and whether the search knows more.
pub(crate) fn claim(text: &str, design: &RingDesign) -> String {
    let known = design.designed.found.bound.unwrap_or_default();
    match check(text) {
        Ok(certified) if certified.claim.bound * certified.claim.problem.tick_us.0 < known.as_micros() => {
            format!("{certified}; a proof of {known} is longer, give it more with --certificate-budget or --time-limit")
        }
        Ok(certified) => certified.to_string(),
        Err(error) => format!("refused: {error}"),
    }
}
