//! `cargo xtask release --dry-run`: everything of a release but uploading.

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::SystemTime;

use cargo_metadata::MetadataCommand;

use crate::steps::{Steps, Trouble, output, run};

/// Steps that only a person may take.
const REMAINS: &str = "
What remains for a person, in this order (docs/project/releasing.md says how):
  1. read CHANGELOG.md once more as a user would, and the site (cargo xtask site)
  2. run the long checks that changed code asks for, and put their figures into the docs
  3. git tag v{VERSION} && git push origin v{VERSION}: the workflow publishes crates and wheels, and drafts the release
  4. publish the draft, and try `pip install eeruf` and `cargo install eeruf` on another machine
";

#[derive(clap::Args)]
pub(crate) struct Plan {
    /// Upload nothing. Only a tag does, through the workflow; this must be said so that nobody expects otherwise
    #[arg(long, required = true)]
    dry_run: bool,
}

pub(crate) fn release(_plan: &Plan) -> ExitCode {
    let mut steps = Steps::default();
    let mut version = String::new();
    steps.step("one version everywhere", || {
        version = one_version()?;
        Ok(())
    });
    steps.step("nothing uncommitted", || {
        let changed = output(Command::new("git").args(["status", "--porcelain"])).unwrap_or_default();
        if changed.trim().is_empty() { Ok(()) } else { Err(Trouble::Failed(changed)) }
    });
    steps.step("links of the documents", crate::links::check_documents);
    steps.step("workflow files", || {
        for (program, version, arguments, install) in [
            ("actionlint", "-version", &[][..], "go install github.com/rhysd/actionlint/cmd/actionlint@latest"),
            ("zizmor", "--version", &["--offline", "--min-severity", "medium", ".github"], "pip install zizmor"),
        ] {
            if output(Command::new(program).arg(version)).is_none() {
                return Err(Trouble::Skipped(format!("no {program}; try: {install}")));
            }
            run(Command::new(program).args(arguments))?;
        }
        Ok(())
    });
    steps.step("licences and sources of dependencies", || {
        match output(Command::new("cargo").args(["deny", "--version"])) {
            Some(_) => {
                // Else it looks at the package in the root alone: not at the wheel, not at the ROS 2 node.
                let check =
                    ["deny", "--locked", "--workspace", "--log-level", "error", "check", "licenses", "bans", "sources"];
                run(Command::new("cargo").args(check))
            }
            None => Err(Trouble::Skipped("no cargo-deny; try: cargo install cargo-deny --locked".to_owned())),
        }
    });
    steps.step("notices", notices);
    steps.step("public items", crate::api::api);
    steps.step("bills of materials", crate::materials::materials);
    crate::package::package(&mut steps);
    steps.step("wheel and source distribution", || crate::python::distributions(Path::new("target/release-files")));
    println!("{}", REMAINS.replace("{VERSION}", &version));
    steps.finish(false)
}

/// Writes the notices of what others wrote and is in program and wheel, as cargo-about finds it.
pub(crate) fn notices() -> Result<(), Trouble> {
    if output(Command::new("cargo").args(["about", "--version"])).is_none() {
        let install = "cargo install cargo-about --locked --features cli";
        return Err(Trouble::Skipped(format!("no cargo-about; try: {install}")));
    }
    // The wheel has the whole program within.
    let of = ["--manifest-path", "crates/eeruf-py/Cargo.toml", "--config", "packaging/notices/about.toml"];
    let to = ["--output-file", "LICENSE-THIRD-PARTY.txt", "packaging/notices/notices.hbs"];
    run(Command::new("cargo").args(["about", "generate", "--locked", "--fail"]).args(of).args(to))?;
    // Where the program was built without them, its build does not look for them.
    let touched =
        fs::File::options().append(true).open("build.rs").and_then(|file| file.set_modified(SystemTime::now()));
    touched.map_err(|error| Trouble::Failed(format!("build.rs: {error}")))
}

/// The version, where all files that state it agree.
fn one_version() -> Result<String, Trouble> {
    let metadata = MetadataCommand::new().no_deps().exec().map_err(|error| Trouble::Failed(error.to_string()))?;
    let mut wrong = Vec::new();
    let program = metadata.workspace_packages().into_iter().find(|package| package.name == "eeruf");
    let version = program.ok_or_else(|| Trouble::Failed("no package eeruf".to_owned()))?.version.to_string();
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
        let text = fs::read_to_string(file).map_err(|error| Trouble::Failed(format!("{file}: {error}")))?;
        if !text.lines().any(|line| line.starts_with(&wanted)) {
            wrong.push(format!("{file} has no line that begins with \"{wanted}\""));
        }
    }
    if wrong.is_empty() { Ok(version) } else { Err(Trouble::Failed(wrong.join("\n"))) }
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
        // Users of a release have no clone. (What was cut comes back where a merge keeps both sides, and names some.)
        assert!(!text.contains("cargo xtask"));
    }
}
