//! The claims of docs/project/dependencies.md: each dependency is named, and the number of crates that each of ours
//! brings along is right.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use cargo_metadata::MetadataCommand;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn document() -> String {
    std::fs::read_to_string(root().join("docs/project/dependencies.md")).unwrap()
}

/// Words between back quotes in a text.
fn quoted(text: &str) -> BTreeSet<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// The direct dependencies of all kinds that are not our own, in all workspaces, with the packages that have them.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let mut found = BTreeMap::<_, BTreeSet<_>>::new();
    let examples = ["esp32-c3", "nucleo-f401", "pico"].map(|name| format!("examples/{name}"));
    for folder in [".", "firmware", "fuzz"].map(str::to_owned).into_iter().chain(examples) {
        let manifest = root().join(folder).join("Cargo.toml");
        let metadata = MetadataCommand::new().manifest_path(manifest).no_deps().exec().unwrap();
        for package in metadata.workspace_packages() {
            for dependency in package.dependencies.iter().filter(|dependency| dependency.path.is_none()) {
                found.entry(dependency.name.clone()).or_default().insert(package.name.to_string());
            }
        }
    }
    found
}

// Every direct dependency is named with its reason, and no others are.
#[test]
fn direct_dependencies_are_named_with_reasons() {
    let (document, dependencies) = (document(), dependencies());
    let text = document.replace('\n', " ");
    let named = quoted(&text);
    let missing: Vec<_> = dependencies.iter().filter(|(name, _)| !named.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "docs/project/dependencies.md does not name {missing:?}");
    // The first column of the table has only dependencies.
    let rows = document.lines().filter_map(|line| line.strip_prefix("| `"));
    let first: Vec<_> = rows.map(|row| row.split('|').next().unwrap()).collect();
    assert!(first.len() > 15, "{first:?}");
    let gone: Vec<_> = first
        .iter()
        .flat_map(|cell| quoted(&format!("`{cell}")).into_iter().map(str::to_owned).collect::<Vec<_>>())
        .filter(|name| !dependencies.contains_key(name) && !name.starts_with("eeruf"))
        .collect();
    assert!(gone.is_empty(), "nothing depends on {gone:?}, which docs/project/dependencies.md names");
}

#[test]
fn crate_counts_are_those_of_the_document() {
    let document = document();
    let (mut wrong, mut rows) = (Vec::new(), 0);
    for row in document.lines().filter(|line| line.starts_with("| `eeruf")) {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        rows += 1;
        for package in quoted(cells[1]) {
            let mut cargo = Command::new("cargo");
            cargo.args(["tree", "--locked", "--offline", "--edges", "normal", "--prefix", "none"]);
            cargo.args(["--package", package, "--target", "x86_64-unknown-linux-gnu"]);
            let tree = String::from_utf8(cargo.current_dir(root()).output().unwrap().stdout).unwrap();
            let crates: BTreeSet<_> = tree.lines().filter_map(|line| line.split(" (").next()).collect();
            let others = crates.iter().filter(|name| !name.starts_with("eeruf")).count();
            if cells[2] != others.to_string() {
                wrong.push(format!("{package}: {others}, not {}", cells[2]));
            }
        }
    }
    assert!(rows >= 6, "{rows} rows of crates");
    assert!(wrong.is_empty(), "{wrong:?}");
}
