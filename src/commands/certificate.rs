//! The certificate of a design, and what the checker says of it.

use eeruf_check::check;
use eeruf_design::{RingDesign, certificate};

use crate::report::watch::Watch;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound; or a
/// lower bound, if budget and time do not suffice for that.
pub(crate) fn prove(design: &RingDesign, budget: usize, watch: &mut Watch) -> Result<String, String> {
    let go_on = |nodes| watch.go_on(|| format!("certificate: {nodes} nodes"));
    certificate::prove(design, budget, go_on).map_err(|error| error.to_string())
}

/// What the checker says of the certificate.
pub(crate) fn claim_of(text: &str) -> String {
    check(text).map_or_else(|error| format!("refused: {error}"), |certified| certified.to_string())
}

/// What the checker says of the certificate, and whether the search knows more.
pub(crate) fn claim(text: &str, design: &RingDesign) -> String {
    let known = design.found.bound.unwrap_or_default();
    match check(text) {
        Ok(certified) if certified.claim.bound * certified.claim.problem.tick_us.0 < known.as_micros() => {
            format!("{certified}; a proof of {known} is longer, give it more with --certificate-budget or --time-limit")
        }
        _ => claim_of(text),
    }
}
