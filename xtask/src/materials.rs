//! `cargo xtask materials`: what is in each published crate and in the program, as bills in `CycloneDX`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::MetadataCommand;
use serde_json::Value;

use crate::steps::{Trouble, output, run};

/// Where the bills lie.
const BILLS: &str = "target/materials";

/// Writes a bill for each published crate. Packages of the workspace are named from its root, not from the disk's.
pub(crate) fn materials() -> Result<(), Trouble> {
    if output(Command::new("cargo").args(["cyclonedx", "--version"])).is_none() {
        return Err(Trouble::Skipped("no cargo-cyclonedx; try: cargo install cargo-cyclonedx --locked".to_owned()));
    }
    let failed = |what: &Path, why: &dyn std::fmt::Display| Trouble::Failed(format!("{}: {why}", what.display()));
    let metadata = MetadataCommand::new().no_deps().exec().map_err(|error| Trouble::Failed(error.to_string()))?;
    let time = output(Command::new("git").args(["log", "-1", "--format=%ct"])).unwrap_or_default();
    let mut cargo = Command::new("cargo");
    cargo.args(["cyclonedx", "--format", "json", "--spec-version", "1.5", "--target", "x86_64-unknown-linux-gnu"]);
    // With a time of its own the bill has no number drawn at random either.
    run(cargo.env("SOURCE_DATE_EPOCH", time))?;
    let bills = PathBuf::from(BILLS);
    fs::create_dir_all(&bills).map_err(|error| failed(&bills, &error))?;
    for package in metadata.workspace_packages() {
        let folder = package.manifest_path.parent().map_or(Path::new("."), |folder| folder.as_std_path());
        let written = folder.join(format!("{}.cdx.json", package.name));
        let text = fs::read_to_string(&written).map_err(|error| failed(&written, &error))?;
        fs::remove_file(&written).map_err(|error| failed(&written, &error))?;
        if package.publish.is_some() {
            continue;
        }
        let text = text.replace(&format!("path+file://{}", metadata.workspace_root), "path+file:///eeruf");
        let bill: Value = serde_json::from_str(&text).map_err(|error| failed(&written, &error))?;
        let components = bill["components"].as_array().map_or(0, Vec::len);
        let unlicensed = bill["components"].as_array().into_iter().flatten().filter(|part| part["licenses"].is_null());
        let unlicensed: Vec<_> = unlicensed.map(|part| part["name"].to_string()).collect();
        if !unlicensed.is_empty() {
            return Err(failed(&written, &format!("no licence of {}", unlicensed.join(", "))));
        }
        let to = bills.join(format!("{}-{}.cdx.json", package.name, package.version));
        fs::write(&to, text).map_err(|error| failed(&to, &error))?;
        println!("{}: {components} components", to.display());
    }
    Ok(())
}
