//! The certificate of a design, and what the checker says of it.

use eeruf_check::check;
use eeruf_check::prove::NoProof;
use eeruf_design::{RingDesign, RingSpec, certificate};

use crate::report::watch::Watch;

/// The text of the certificate that the design's period is the shortest, or that none is below the search's bound.
pub(crate) fn prove(spec: &RingSpec, design: &RingDesign, budget: usize, watch: &mut Watch) -> Result<String, String> {
    let proven =
        certificate::prove(spec, design, budget, |nodes| watch.go_on(|| format!("certificate: {nodes} nodes")));
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
