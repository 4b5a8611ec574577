//! `cargo xtask examples`: builds and links the programs in `examples/` for boards, as their READMEs say; runs none.

use std::path::{Path, absolute};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::steps::{Steps, empty, run};
use crate::toolchain::{cargo_for_target, is_debian};

/// The folders of the examples for boards, and the targets they are built for.
pub(crate) const BOARDS: [(&str, &str); 3] = [
    ("pico", "thumbv6m-none-eabi"),
    ("nucleo-f401", "thumbv7em-none-eabihf"),
    ("esp32-c3", "riscv32imc-unknown-none-elf"),
];

/// Builds all examples, or the named one.
pub(crate) fn examples(only: Option<&str>, steps: &mut Steps) {
    let is_asked_for = |board: &str| only.is_none_or(|only| only == board);
    for (board, target) in BOARDS.into_iter().filter(|(board, _)| is_asked_for(board)) {
        steps.step(&format!("example {board}"), || build(board, target));
    }
}

/// Builds an example from an empty folder, as `docs/how-to/firmware.md` does, and checks its program's length.
fn build(board: &str, target: &str) -> Result<()> {
    let example = Path::new("examples").join(board);
    run(Command::new("cargo").current_dir(&example).args(["fmt", "--check"]))?;
    let program = example.join(if board == "pico" { "src/bin/awaited.rs" } else { "src/main.rs" });
    let text = fs::read_to_string(&program)?;
    let holds = text.lines().count() <= 60 && !text.contains("unsafe");
    ensure!(holds, "{}: expected at most 60 lines without `unsafe`", program.display());
    let folder = Path::new("target/examples").join(board);
    empty(&folder)?;
    run(Command::new("cp").arg("-r").arg(example.join(".")).arg(&folder))?;
    let (manifest, checkout) = (folder.join("Cargo.toml"), absolute(".")?);
    let by_path = fs::read_to_string(&manifest)?.replace("../..", &checkout.to_string_lossy());
    fs::write(manifest, by_path)?;
    let mut cargo = cargo_for_target(target)?;
    // One folder for all examples, but not for two compilers.
    let shared = absolute(Path::new("target/examples").join(if is_debian(&cargo) { "debian" } else { "rustup" }))?;
    cargo.env("CARGO_TARGET_DIR", &shared).current_dir(&folder);
    run(cargo.args(["build", "--quiet", "--release", "--locked", "--target", target]))
}
