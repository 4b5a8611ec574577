//! `cargo xtask release --dry-run`: everything of a release but uploading.

use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use anyhow::{Context as _, Result, anyhow, ensure};
use cargo_metadata::MetadataCommand;
use fs_err as fs;

use crate::steps::{Steps, empty, need, output, run, run_line};

/// Steps left to a person.
const REMAINS: &str = "
What remains for a person, in this order (docs/project/releasing.md says how):
  1. read CHANGELOG.md once more as a user would, and the site (cargo xtask site)
  2. run the long checks that changed code asks for, and put their figures into the docs
  3. git tag v{VERSION} && git push origin v{VERSION}: the workflow publishes crates and wheels, and drafts the release
  4. push the files of target/arduino/Eeruf to the mirror that Arduino's library manager reads, with the same tag
  5. publish the draft, and try `pip install eeruf` and `cargo install eeruf` on another machine
";

/// Folder of the bills of materials.
const BILLS: &str = "target/materials";

pub(crate) fn release(steps: &mut Steps) {
    let version = steps.step("one version everywhere", one_version).unwrap_or_default();
    steps.step("nothing uncommitted", || {
        let changed = output(Command::new("git").args(["status", "--porcelain"]))?;
        ensure!(changed.is_empty(), "{changed}");
        Ok(())
    });
    steps.step("links of the documents", crate::links::check_documents);
    steps.step("workflow files", || {
        need("actionlint -version", "go install github.com/rhysd/actionlint/cmd/actionlint@latest")?;
        run_line("actionlint")?;
        need("zizmor --version", "pip install zizmor")?;
        run_line("zizmor --offline --min-severity medium .github")
    });
    steps.step("licences and sources of dependencies", || {
        need("cargo deny --version", "cargo install cargo-deny --locked")?;
        // Without `--workspace` it checks only the root package, not the wheel or the ROS 2 node.
        run_line("cargo deny --locked --workspace --log-level error check licenses bans sources")
    });
    steps.step("notices", notices);
    steps.step("public items", crate::api::api);
    steps.step("bills of materials", materials);
    crate::package::package(steps);
    steps.step("Arduino library", || crate::arduino::pack().map(drop));
    steps.step("wheel and source distribution", || crate::python::distributions(Path::new("target/release-files")));
    println!("{}", REMAINS.replace("{VERSION}", &version));
}

/// Writes the notices for the work of others in program and wheel, as found by cargo-about.
pub(crate) fn notices() -> Result<()> {
    need("cargo about --version", "cargo install cargo-about --locked --features cli")?;
    // The wheel contains the whole program.
    run_line(
        "cargo about generate --locked --fail --manifest-path crates/eeruf-py/Cargo.toml \
         --config packaging/notices/about.toml --output-file LICENSE-THIRD-PARTY.txt packaging/notices/notices.hbs",
    )?;
    // If the program was built without the notices, its build would not look for them again.
    Ok(fs::OpenOptions::new().append(true).open("build.rs")?.file().set_modified(SystemTime::now())?)
}

/// Writes the contents of each published crate as a bill in `CycloneDX`. Packages of the workspace are named from its
/// root, not from the disk's.
pub(crate) fn materials() -> Result<()> {
    need("cargo cyclonedx --version", "cargo install cargo-cyclonedx --locked")?;
    let metadata = MetadataCommand::new().no_deps().exec()?;
    // With a given time, the bill has no random number either.
    let time = output(Command::new("git").args(["log", "-1", "--format=%ct"]))?;
    let mut cargo = Command::new("cargo");
    cargo.args(["cyclonedx", "--format", "json", "--spec-version", "1.5", "--target", "x86_64-unknown-linux-gnu"]);
    run(cargo.env("SOURCE_DATE_EPOCH", time))?;
    empty(BILLS)?;
    for package in metadata.workspace_packages() {
        let written = package.manifest_path.with_file_name(format!("{}.cdx.json", package.name));
        let bill = fs::read_to_string(&written)?
            .replace(&format!("path+file://{}", metadata.workspace_root), "path+file:///eeruf");
        fs::remove_file(&written)?;
        if package.publish.is_none() {
            fs::write(format!("{BILLS}/{}-{}.cdx.json", package.name, package.version), bill)?;
        }
    }
    Ok(())
}

/// Returns the version, if all files that state it agree.
fn one_version() -> Result<String> {
    let metadata = MetadataCommand::new().no_deps().exec()?;
    let mut wrong = Vec::new();
    let program = metadata.workspace_packages().into_iter().find(|package| package.name == "eeruf");
    let version = program.context("no package eeruf")?.version.to_string();
    for package in metadata.workspace_packages() {
        if package.publish.is_none() && package.version.to_string() != version {
            wrong.push(format!("{} is {}, not {version}", package.name, package.version));
        }
    }
    for (file, wanted) in [
        ("CHANGELOG.md", format!("## {version}")),
        ("CITATION.cff", format!("version: {version}")),
        ("c/arduino/library.properties", format!("version={version}")),
        ("c/arduino/library.json", format!("  \"version\": \"{version}\"")),
        ("ros2/package.xml", format!("  <version>{version}</version>")),
        ("c/idf_component.yml", format!("version: \"{version}\"")),
        ("c/CMakeLists.txt", format!("  project(eeruf VERSION {version} ")),
    ] {
        let text = fs::read_to_string(file)?;
        if !text.lines().any(|line| line.starts_with(&wanted)) {
            wrong.push(format!("{file} has no line that begins with \"{wanted}\""));
        }
    }
    if wrong.is_empty() { Ok(version) } else { Err(anyhow!("{}", wrong.join("\n"))) }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    #[test]
    fn each_heading_of_the_change_log_is_a_version_and_stands_once() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../CHANGELOG.md");
        let text = std::fs::read_to_string(file).unwrap();
        let mut versions: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        let count = versions.len();
        assert!(count > 0);
        for version in &versions {
            let numbers = version.split([',', ' ']).next().unwrap();
            assert_eq!(numbers.split('.').filter(|number| number.parse::<u32>().is_ok()).count(), 3, "{version}");
        }
        versions.sort_unstable();
        versions.dedup();
        assert_eq!(versions.len(), count);
        // Users of a release have no clone. (A merge that keeps both sides can bring back removed names.)
        assert!(!text.contains("cargo xtask"));
    }
}
