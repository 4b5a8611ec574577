//! `prove FILE [NODES]` completes a certificate: FILE ends with the line `no_period_below`, the whole goes to standard
//! output. Exit 1 when the claim is false or the tree would need more than NODES nodes (a million by default).

#[path = "../../eeruf-period/tests/common/mod.rs"]
mod common;

use eeruf_check::read_claim;
use eeruf_period::engine::prove::prove;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(text) = arguments.first().and_then(|file| std::fs::read_to_string(file).ok()) else {
        eprintln!("usage: prove FILE [NODES]");
        return ExitCode::from(2);
    };
    let nodes = arguments.get(1).and_then(|nodes| nodes.parse().ok()).unwrap_or(1_000_000);
    let proof = read_claim(&text).map_err(|error| error.to_string());
    match proof.and_then(|claim| prove(&common::claim_of(&claim), nodes).map_err(|error| error.to_string())) {
        Ok(certificate) => {
            print!("{certificate}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
