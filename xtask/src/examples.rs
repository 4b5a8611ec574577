//! `cargo xtask examples`: the programs in `examples/` that one flashes onto a board. Each is built and linked as its
//! README says; none is run.

use std::path::{Path, absolute};
use std::process::Command;

use anyhow::Result;

use crate::steps::{Steps, run};
use crate::toolchain::{cargo_for_target, is_debian};

/// The folders of the examples for boards, and the targets they are built for.
pub(crate) const BOARDS: [(&str, &str); 3] = [
    ("pico", "thumbv6m-none-eabi"),
    ("nucleo-f401", "thumbv7em-none-eabihf"),
    ("esp32-c3", "riscv32imc-unknown-none-elf"),
];

/// All of them, or the one that is named.
pub(crate) fn examples(only: Option<&str>, steps: &mut Steps) {
    let is_asked_for = |board: &str| only.is_none_or(|only| only == board);
    for (board, target) in BOARDS.into_iter().filter(|(board, _)| is_asked_for(board)) {
        steps.step(&format!("example {board}"), || build(board, target));
    }
}

/// Builds an example.
fn build(board: &str, target: &str) -> Result<()> {
    let folder = Path::new("examples").join(board);
    run(Command::new("cargo").current_dir(&folder).args(["fmt", "--check"]))?;
    let mut cargo = cargo_for_target(target)?;
    // One folder for all, but not for two compilers.
    let shared = absolute(Path::new("target/examples").join(if is_debian(&cargo) { "debian" } else { "rustup" }))?;
    cargo.env("CARGO_TARGET_DIR", &shared).current_dir(&folder);
    run(cargo.args(["build", "--quiet", "--release", "--locked", "--target", target]))
}
