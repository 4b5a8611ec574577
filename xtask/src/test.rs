//! `cargo xtask test`: everything that must hold before a change goes in.

use std::collections::BTreeMap;
use std::process::{Command, ExitCode};

use cargo_metadata::{Metadata, MetadataCommand, Package};

use crate::steps::{Beside, Steps, Trouble, output, run, run_component};
use crate::toolchain::cargo_of_version;

/// Steps that take one thread most of the time: on emulated processors, and of C.
const BESIDE: [&[&str]; 4] = [&["firmware"], &["arduino", "--short"], &["c"], &["micropython"]];

pub(crate) fn run_all(nothing_skipped: bool) -> ExitCode {
    let mut steps = Steps::default();
    steps.step("formatting", || run_component("rustfmt", &["fmt", "--all", "--check"]));
    steps.step("rules of the house", crate::house::check);
    steps.step("listings of the documents", crate::listings::check_all);
    steps.step("links of the documents", crate::links::check_documents);
    steps.step("clippy", || {
        let args = ["clippy", "--workspace", "--all-targets", "--locked", "--", "--deny", "warnings"];
        run_component("clippy", &args)
    });
    let metadata = match MetadataCommand::new().no_deps().exec() {
        Ok(metadata) => metadata,
        Err(error) => {
            steps.step("cargo metadata", || Err(Trouble::Failed(error.to_string())));
            return steps.finish(nothing_skipped);
        }
    };
    let beside = Beside::begin(&BESIDE);
    steps.step("each feature of the core alone", || each_feature_alone(&metadata));
    // What the default compiler can build, Clippy has just built with it.
    let default = version_of_default();
    for (version, packages) in packages_by_version(&metadata) {
        if default.as_deref() == Some(&*version) {
            continue;
        }
        steps.step(&format!("minimum Rust {version}"), || {
            let mut cargo = cargo_of_version(&version)?;
            cargo.args(["check", "--locked"]);
            for package in packages {
                cargo.args(["--package", &package.name]);
            }
            run(&mut cargo)
        });
    }
    steps.step("public items", crate::api::api);
    steps.step("tests and doctests", || run_cargo(&["test", "--workspace", "--locked"]));
    // With the features of the whole workspace, as built for the tests; those of instructions need a runner.
    steps.step("benches, each once", || {
        let benches = ["design", "paths", "simulation", "wait"].map(|name| ["--bench", name]).concat();
        run_cargo(&[&["test", "--workspace", "--locked"], &benches[..]].concat())
    });
    steps.step("small tables in the documents", || {
        crate::printed::check(&crate::printed::documents()?, crate::printed::Which::Small)
    });
    steps.step("tests of the core's conversions and formats", || {
        let features = "defmt,embassy-time,fugit,serde";
        let tests =
            ["--lib", "--test", "formats", "--locked", "--features", features, "--", "interop", "serde", "format"];
        run_cargo(&[&["test", "--package", "eeruf-core"], &tests[..]].concat())
    });
    steps.step("Python package", crate::python::python);
    steps.step("page in a browser", || crate::page::page(crate::page::Tests::Short));
    steps.step("ROS 2 node", crate::ros2::ros2);
    steps.step("ROS 2 package", crate::ros2::package);
    steps.step("documentation", || {
        run(Command::new("cargo")
            .args(["doc", "--workspace", "--no-deps", "--locked"])
            .env("RUSTDOCFLAGS", "--deny warnings"))
    });
    steps.join(beside);
    steps.finish(nothing_skipped)
}

fn run_cargo(args: &[&str]) -> Result<(), Trouble> {
    run(Command::new("cargo").args(args))
}

fn each_feature_alone(metadata: &Metadata) -> Result<(), Trouble> {
    // Firmware links the core. `cargo xtask release --dry-run` builds each other crate alone, out of its tarball.
    let is_core = |package: &&Package| package.name.as_str() == "eeruf-core";
    for package in metadata.workspace_packages().into_iter().filter(is_core) {
        run_cargo(&["check", "--package", &package.name, "--locked", "--no-default-features"])?;
        for feature in package.features.keys().filter(|feature| *feature != "default") {
            let features = ["--no-default-features", "--features", feature];
            run_cargo(&[&["check", "--package", &package.name, "--locked"], &features[..]].concat())?;
        }
    }
    Ok(())
}

/// The packages of the workspace by the minimum version of Rust that they declare, as "1.85".
fn packages_by_version(metadata: &Metadata) -> BTreeMap<String, Vec<&Package>> {
    let mut packages = BTreeMap::<_, Vec<_>>::new();
    for package in metadata.workspace_packages() {
        if let Some(version) = &package.rust_version {
            packages.entry(format!("{}.{}", version.major, version.minor)).or_default().push(package);
        }
    }
    packages
}

/// The version of the default compiler, as "1.95".
fn version_of_default() -> Option<String> {
    let said = output(Command::new("rustc").arg("--version"))?;
    let (version, _) = said.strip_prefix("rustc ")?.rsplit_once('.')?;
    Some(version.split('.').take(2).collect::<Vec<_>>().join("."))
}
