//! `cargo xtask test --quick`: what is worth knowing while one works, in under two minutes.

use std::process::{Command, ExitCode};

use cargo_metadata::{MetadataCommand, TargetKind};

use crate::changed;
use crate::listings;
use crate::steps::{Steps, Trouble, run, run_component};

pub(crate) fn run_quick() -> ExitCode {
    let mut steps = Steps::default();
    steps.step("formatting", || run_component("rustfmt", &["fmt", "--all", "--check"]));
    steps.step("rules of the house", crate::house::check);
    steps.step("listings of the documents", listings::check_all);
    steps.step("links of the documents", crate::links::check_documents);
    steps.step("clippy", || {
        let args = ["clippy", "--quiet", "--workspace", "--all-targets", "--locked", "--", "--deny", "warnings"];
        run_component("clippy", &args)
    });
    steps.step("unit tests of what changed", unit_tests_of_what_changed);
    steps.finish(false)
}

fn unit_tests_of_what_changed() -> Result<(), Trouble> {
    let metadata = MetadataCommand::new().no_deps().exec().map_err(|error| Trouble::Failed(error.to_string()))?;
    let files = changed::files()?;
    let packages = changed::packages(&metadata, &files);
    if packages.is_empty() {
        println!("no package among {} changed files", files.len());
        return Ok(());
    }
    let mut test = Command::new("cargo");
    test.args(["test", "--quiet", "--locked", "--bins"]);
    let has_library = |kind: &TargetKind| matches!(kind, TargetKind::Lib | TargetKind::RLib | TargetKind::CDyLib);
    if packages.iter().any(|package| package.targets.iter().any(|target| target.kind.iter().any(has_library))) {
        test.arg("--lib");
    }
    for package in packages {
        println!("{}", package.name);
        test.args(["--package", &package.name]);
    }
    run(&mut test)
}
