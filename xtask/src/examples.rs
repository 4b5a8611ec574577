//! `cargo xtask examples`: the programs in `examples/` that one flashes onto a board. Each is built and linked as its
//! README says, that of the Uno with the table that `eeruf design` writes. That one is run among simulated modules by
//! `cargo xtask arduino`; nothing else is run.

use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::steps::{Steps, output, run};
use crate::toolchain::{cargo_for_target, is_debian};

/// The folders of the examples for boards, and the targets they are built for.
pub(crate) const BOARDS: [(&str, &str); 4] = [
    UNO,
    ("pico", "thumbv6m-none-eabi"),
    ("nucleo-f401", "thumbv7em-none-eabihf"),
    ("esp32-c3", "riscv32imc-unknown-none-elf"),
];

const UNO: (&str, &str) = ("uno", "avr-none");

/// All of them, or the one that is named.
pub(crate) fn examples(only: Option<&str>, steps: &mut Steps) {
    let is_asked_for = |board: &str| only.is_none_or(|only| only == board);
    for (board, target) in BOARDS.into_iter().filter(|(board, _)| is_asked_for(board)) {
        steps.step(&format!("example {board}"), || build(board, target).map(drop));
    }
}

/// The tables of the Uno and of the sample for Zephyr: building them takes minutes, and a better table must not be
/// forgotten in them until then.
pub(crate) fn tables() -> Result<()> {
    for (language, folder, table) in
        [("rust", "examples/uno", "src/ring.rs"), ("c", "c/zephyr/samples/ring", "src/ring.h")]
    {
        let [ring, table] = ["ring.toml", table].map(|file| Path::new(folder).join(file));
        let mut design = Command::new(crate::toolchain::program()?);
        let design = output(design.arg("design").arg(&ring).args(["--period-only", "--emit", language]))?;
        ensure!(fs::read_to_string(&table)?.trim() == design, "{}: not what eeruf design says", table.display());
    }
    Ok(())
}

/// Builds the program for the Uno.
pub(crate) fn uno() -> Result<PathBuf> {
    let (board, target) = UNO;
    build(board, target).map(|folder| folder.join("eeruf-example-uno.elf"))
}

/// Builds an example; returns the folder with the program.
fn build(board: &str, target: &str) -> Result<PathBuf> {
    let folder = Path::new("examples").join(board);
    run(Command::new("cargo").current_dir(&folder).args(["fmt", "--check"]))?;
    let mut cargo = cargo_for_target(target)?;
    // One folder for all, but not for two compilers.
    let shared = absolute(Path::new("target/examples").join(if is_debian(&cargo) { "debian" } else { "rustup" }))?;
    cargo.env("CARGO_TARGET_DIR", &shared).current_dir(&folder);
    run(cargo.args(["build", "--quiet", "--release", "--locked", "--target", target]))?;
    Ok(shared.join(target).join("release"))
}
