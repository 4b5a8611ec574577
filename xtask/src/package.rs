//! `cargo xtask package`: packs every crate that is published, and builds and tests each from its tarball alone.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Result, ensure};
use cargo_metadata::MetadataCommand;
use fs_err as fs;

use crate::steps::{Steps, empty, run};

/// Returns the folder for unpacked tarballs: no folder above it has a manifest.
fn folder() -> PathBuf {
    std::env::temp_dir().join("eeruf-package")
}

/// The largest tarball, in bytes.
const LARGEST: u64 = 300_000;

pub(crate) fn package(steps: &mut Steps) {
    let crates = steps.step("tarballs", pack).unwrap_or_default();
    for name in &crates {
        steps.step(&format!("{name} from its tarball"), || {
            let manifest = folder().join(name).join("Cargo.toml");
            for verb in ["build", "test"] {
                let mut cargo = Command::new("cargo");
                cargo.args([verb, "--all-features", "--manifest-path"]).arg(&manifest);
                // Debug information is useless here, and takes gigabytes.
                cargo.env("CARGO_PROFILE_DEV_DEBUG", "0").env("CARGO_TARGET_DIR", folder().join("target"));
                run(cargo.current_dir(folder()))?;
            }
            Ok(())
        });
    }
}

/// Packs all crates and unpacks them, each into a folder of its name; they find each other there.
fn pack() -> Result<Vec<String>> {
    let metadata = MetadataCommand::new().no_deps().exec()?;
    let published = metadata.workspace_packages().into_iter().filter(|package| package.publish.is_none());
    let crates: Vec<_> = published.map(|package| (package.name.to_string(), package.version.to_string())).collect();
    let mut cargo = Command::new("cargo");
    cargo.args(["package", "--no-verify", "--locked", "--allow-dirty"]);
    for (name, _) in &crates {
        cargo.args(["--package", name]);
    }
    run(&mut cargo)?;
    let folder = folder();
    empty(&folder)?;
    fs::create_dir_all(folder.join(".cargo"))?;
    let mut patch = "[patch.crates-io]\n".to_owned();
    for (name, version) in &crates {
        let tarball = metadata.target_directory.join(format!("package/{name}-{version}.crate"));
        let size = fs::metadata(&tarball)?.len();
        println!("{name}-{version}.crate: {size} bytes");
        ensure!(size <= LARGEST, "{tarball}: {size} bytes; expected at most {LARGEST}");
        run(Command::new("tar").args(["-xzf", tarball.as_str(), "-C"]).arg(&folder))?;
        fs::rename(folder.join(format!("{name}-{version}")), folder.join(name))?;
        // The tarball's own lock file names unpublished crates; ours has the same versions of all others.
        fs::copy("Cargo.lock", folder.join(name).join("Cargo.lock"))?;
        patch += &format!("{name} = {{ path = {:?} }}\n", folder.join(name));
    }
    fs::write(folder.join(".cargo/config.toml"), patch)?;
    Ok(crates.into_iter().map(|(name, _)| name).collect())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use cargo_metadata::MetadataCommand;

    // Each crate says what a stranger asks or why it is not published.
    #[test]
    fn each_crate_says_what_a_stranger_asks() {
        let metadata = MetadataCommand::new().no_deps().exec().unwrap();
        let mut missing = Vec::new();
        for package in metadata.workspace_packages() {
            let name = &package.name;
            let manifest = fs::read_to_string(&package.manifest_path).unwrap();
            let mut needs = |what: &str, there: bool| {
                if !there {
                    missing.push(format!("{name}: {what}"));
                }
            };
            if package.publish.is_some() {
                let lines: Vec<_> = manifest.lines().collect();
                let at = lines.iter().position(|line| *line == "publish = false").unwrap();
                needs("the reason above `publish = false`", lines[at - 1].starts_with("# "));
                continue;
            }
            let folder = package.manifest_path.parent().unwrap();
            for file in ["README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
                needs(file, fs::metadata(folder.join(file)).is_ok_and(|file| file.len() > 500));
            }
            needs("documentation", package.documentation.is_some());
            needs("description", package.description.is_some());
            needs("repository", package.repository.is_some());
            needs("licence", package.license.is_some());
            needs("keywords", !package.keywords.is_empty());
            needs("categories", !package.categories.is_empty());
            needs("docs.rs with all features", package.metadata["docs"]["rs"]["all-features"] == true);
        }
        assert!(missing.is_empty(), "{missing:#?}");
    }
}
