//! `veripb FILE STEM [NODES]` writes STEM.opb and STEM.pbp for the claim of a certificate: the model of the period one
//! tick below its bound, and the proof that no schedule has it.

#[path = "../../eeruf-design/tests/common/mod.rs"]
mod common;

use eeruf_check::read_claim;
use eeruf_design::engine::veripb;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let claim = arguments.first().and_then(|file| std::fs::read_to_string(file).ok()).map(|text| read_claim(&text));
    let (Some(Ok(claim)), Some(stem)) = (claim, arguments.get(1)) else {
        eprintln!("usage: veripb FILE STEM [NODES]");
        return ExitCode::from(2);
    };
    let budget = arguments.get(2).and_then(|nodes| nodes.parse().ok()).unwrap_or(1_000_000);
    match veripb::prove(&common::claim_of(&claim), budget, |_| true) {
        Ok(proven) => {
            println!("{} nodes, {} and {} bytes", proven.nodes, proven.model.len(), proven.proof.len());
            let files = [("opb", proven.model), ("pbp", proven.proof)];
            if files.iter().all(|(ending, text)| std::fs::write(format!("{stem}.{ending}"), text).is_ok()) {
                return ExitCode::SUCCESS;
            }
            eprintln!("{stem}: cannot be written");
        }
        Err(why) => println!("{why}"),
    }
    ExitCode::FAILURE
}
