//! `cargo xtask test`: every check that a change must pass; with `--quick` those that take two minutes.

use std::collections::BTreeMap;
use std::process::{Command, ExitCode};

use anyhow::Result;
use cargo_metadata::{Metadata, MetadataCommand, Package, TargetKind};

use crate::steps::{Beside, Steps, need, run, run_component, run_line};
use crate::toolchain::{cargo_of_version, program, version_of};
use crate::{changed, printed};

/// Commands that run beside the steps, in two lanes: emulators and C; and what waits for networks and clocks.
const BESIDE: [&[&[&str]]; 2] = [
    &[&["firmware"], &["arduino", "--short"], &["c"], &["micropython"]],
    &[&["python"], &["ros2"], &["page", "--test"]],
];

/// The first steps of both lanes.
fn sources(steps: &mut Steps) {
    steps.step("formatting", || run_component("rustfmt", "fmt --all --check"));
    steps.step("rules of the house", crate::house::check);
    steps.step("budget of lines", || {
        need("python3 --version", "apt install python3")?;
        run_line("python3 xtask/budget.py")
    });
    steps.step("listings of the documents", crate::blocks::check_listings);
    steps.step("links of the documents", crate::links::check_documents);
    steps.step("clippy", || {
        run_component("clippy", "clippy --quiet --workspace --all-targets --locked -- --deny warnings")
    });
}

pub(crate) fn run_quick() -> ExitCode {
    let mut steps = Steps::default();
    sources(&mut steps);
    steps.step("unit tests of what changed", unit_tests_of_what_changed);
    steps.finish(false)
}

pub(crate) fn run_all(nothing_skipped: bool) -> ExitCode {
    let (mut steps, beside) = (Steps::default(), BESIDE.map(Beside::begin));
    sources(&mut steps);
    let Some(metadata) = steps.step("cargo metadata", || Ok(MetadataCommand::new().no_deps().exec()?)) else {
        return steps.finish(nothing_skipped);
    };
    steps.step("each feature of the core alone", || each_feature_alone(&metadata));
    // Clippy has just built everything with the default compiler.
    let default = version_of("rustc").unwrap_or_default();
    for (version, packages) in packages_by_version(&metadata) {
        if default == version {
            continue;
        }
        steps.step(&format!("minimum Rust {version}"), || {
            let packages = packages.iter().flat_map(|package| ["--package", &package.name]);
            run(cargo_of_version(&version)?.args(["check", "--locked"]).args(packages))
        });
    }
    steps.step("public items", crate::api::api);
    steps.step("tests and doctests", || run_line("cargo test --workspace --locked --no-fail-fast"));
    // With the features of the whole workspace, as built for the tests.
    steps.step("benches, each once", || {
        run_line(
            "cargo test --workspace --features eeruf-benches/sim --locked \
             --bench design --bench paths --bench simulation --bench wait",
        )
    });
    steps.step("small tables in the documents", || printed::check(&printed::documents()?, printed::Which::Small));
    steps.step("tests of features: conversions, formats, awaiting", || {
        run_line(
            "cargo test --package eeruf-core --package eeruf-hc-sr04 --lib --test formats --test awaited --locked \
             --features defmt,embassy-time,fugit,serde,async -- interop serde format next_reads",
        )
    });
    steps.step("bags of ROS 1", || {
        let (python, packages) = ("/usr/bin/python3", "apt install python3-rosbag python3-sensor-msgs");
        need(&format!("{python} -c __import__('sensor_msgs'),__import__('rosbag')"), packages)?;
        run(Command::new(python).arg("crates/eeruf-logs/tests/ros1_bags.py").arg(program()?))
    });
    steps.step("documentation", || {
        run(Command::new("cargo")
            .args(["doc", "--workspace", "--no-deps", "--locked"])
            .env("RUSTDOCFLAGS", "--deny warnings"))
    });
    beside.into_iter().for_each(|lane| steps.join(lane));
    steps.finish(nothing_skipped)
}

fn unit_tests_of_what_changed() -> Result<()> {
    let metadata = MetadataCommand::new().no_deps().exec()?;
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

fn each_feature_alone(metadata: &Metadata) -> Result<()> {
    // Firmware links the core. `cargo xtask release --dry-run` builds each other crate alone, from its tarball.
    let check = "cargo check --package eeruf-core --locked --no-default-features";
    run_line(check)?;
    let core = metadata.workspace_packages().into_iter().find(|package| package.name == "eeruf-core");
    let features = core.into_iter().flat_map(|package| package.features.keys());
    features.filter(|feature| *feature != "default").try_for_each(|it| run_line(&format!("{check} --features {it}")))
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
