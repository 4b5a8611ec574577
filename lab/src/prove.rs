//! Completes a certificate: FILE ends with the line `no_period_below`, the whole goes to standard output. Fails when
//! the claim is false or the tree would need more than NODES nodes (a million by default).
//!
//!     cargo lab prove FILE [NODES]

use eeruf_check::read_claim;
use eeruf_design::engine::prove::prove;

#[path = "../../crates/eeruf-design/tests/common/mod.rs"]
mod common;

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let [file, nodes @ ..] = arguments else { return Err("expected FILE [NODES]".into()) };
    let nodes = nodes.first().map_or(Ok(1_000_000), |nodes| nodes.parse())?;
    let claim = read_claim(&std::fs::read_to_string(file)?)?;
    print!("{}", prove(&common::claim_of(&claim), nodes)?);
    Ok(())
}
