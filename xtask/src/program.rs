//! The program and the lab as they were built for the tests: with the features of all packages,
//! since another choice of packages would build what they stand on once more.

use std::env::consts::EXE_SUFFIX;
use std::path::PathBuf;
use std::process::Command;

use crate::steps::{Trouble, run};

/// `eeruf`, built.
pub(crate) fn program() -> Result<PathBuf, Trouble> {
    built("eeruf")
}

/// The program of `cargo lab`, built.
pub(crate) fn lab() -> Result<PathBuf, Trouble> {
    built("eeruf-lab")
}

fn built(name: &str) -> Result<PathBuf, Trouble> {
    build(&["--bin", name])?;
    std::path::absolute(format!("target/debug/{name}{EXE_SUFFIX}")).map_err(|error| Trouble::Failed(error.to_string()))
}

/// Builds binaries of the workspace as they were built for the tests. A test is among them, since only then
/// dependencies have the features that tests ask for.
pub(crate) fn build(what: &[&str]) -> Result<(), Trouble> {
    run(Command::new("cargo").args(["build", "--quiet", "--locked", "--workspace", "--test", "line"]).args(what))
}
