//! `eeruf-loop SCENE BOARD EMULATOR ..`: hardware in the loop, without a fault and with each of six.
//!
//! Prints a table in Markdown of what was the same. Leaves with 1 if anything was not as it must be.

mod emulator;
mod lines;
mod run;
mod twin;
mod unharmed;

use std::path::Path;
use std::process::ExitCode;

use eeruf_core::Kind;
use eeruf_sim::World;

use crate::run::{Fault, run};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, board, emulator @ ..] = &arguments[..] else {
        eprintln!("usage: eeruf-loop SCENE BOARD EMULATOR [ARGUMENT ..]");
        return ExitCode::from(2);
    };
    match every_fault(scene, board, emulator) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{board}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn every_fault(scene: &str, board: &str, emulator: &[String]) -> Result<(), String> {
    let world = World::from_toml(Path::new(scene)).map_err(|error| error.to_string())?;
    let whole = run(&world, Fault::None, emulator)?;
    let (same, most_us) = whole.as_simulated(&world)?;
    println!("{board}: {} readings, all as on the host; {same} of the kind that the simulator's own run has", whole.count());
    println!("  echo times within {most_us} us of it; edges noticed up to {} late", whole.latest);
    for kind in Kind::ALL {
        println!("  {kind}: {}", whole.read.iter().flatten().filter(|reading| reading.kind == kind).count());
    }
    for fault in Fault::ALL {
        let harmed = run(&world, fault, emulator)?;
        println!("{board} {fault:?}: {} readings, {}", harmed.count(), harmed.compare(&whole));
        println!("  named {:?} from period {:?}, max late {}", harmed.named, harmed.named_in, harmed.max_late);
    }
    Ok(())
}
