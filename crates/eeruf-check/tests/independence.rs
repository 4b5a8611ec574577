//! The checker checks and does nothing else, and nothing that searches is linked to its rules.

use cargo_metadata::{DependencyKind, Metadata, MetadataCommand};
use std::path::{Path, PathBuf};

/// The lines that this crate may have outside its tests.
const MOST_LINES: usize = 1_350;

fn metadata() -> Metadata {
    MetadataCommand::new()
        .no_deps()
        .other_options(["--offline".to_owned()])
        .exec()
        .expect("cargo describes the workspace")
}

/// The Rust files below a folder, with their text.
fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("a text");
            files.push((path, text));
        }
    }
    files
}

fn own_sources() -> Vec<(PathBuf, String)> {
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

/// The names that follow `eeruf_check::` in a text.
fn names_used(text: &str) -> Vec<&str> {
    let names = text.split("eeruf_check::").skip(1);
    names.map(|rest| rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default()).collect()
}

#[test]
fn checker_depends_on_nothing_and_is_short() {
    let metadata = metadata();
    let check = metadata.packages.iter().find(|package| package.name.as_str() == "eeruf-check").expect("this crate");
    let linked: Vec<_> = check.dependencies.iter().filter(|of| of.kind != DependencyKind::Development).collect();
    assert!(linked.is_empty(), "{linked:?}");
    let lines: usize = own_sources().iter().map(|(_, text)| text.lines().count()).sum();
    assert!(lines <= MOST_LINES, "{lines} lines");
}

#[test]
fn public_items_check_and_do_nothing_else() {
    let mut public = Vec::new();
    for (_, text) in own_sources() {
        let items = text.lines().map(str::trim_start).filter_map(|line| line.strip_prefix("pub "));
        let is_item =
            |line: &&str| ["fn ", "struct ", "enum ", "mod ", "const "].iter().any(|kind| line.starts_with(kind));
        public.extend(items.filter(is_item).map(|line| {
            let name = line.split(' ').nth(1).unwrap_or_default();
            name.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default().to_owned()
        }));
    }
    public.sort_unstable();
    let expected =
        ["Certified", "CheckError", "Claim", "MAX_NUMBER", "MAX_SENSORS", "Problem", "check", "read_claim", "sensors"];
    assert_eq!(public, expected);
}

#[test]
fn nothing_uses_the_checker_but_by_check() {
    let metadata = metadata();
    let mut users = Vec::new();
    for package in &metadata.packages {
        let links = package.dependencies.iter().any(|of| of.name == "eeruf-check" && of.kind == DependencyKind::Normal);
        let folder = package.manifest_path.parent().expect("a folder").join("src");
        if package.name.as_str() == "eeruf-check" || !folder.exists() {
            continue;
        }
        for (file, text) in sources(folder.as_std_path()) {
            for name in names_used(&text) {
                assert!(["check", "CheckError"].contains(&name), "{}: eeruf_check::{name}", file.display());
                assert!(links, "{}: a package that does not depend on the checker", file.display());
            }
        }
        if links {
            users.push(package.name.to_string());
        }
    }
    users.sort_unstable();
    // The designs' crate judges with it the rows of the atlas that it makes, and nothing that it searches.
    assert_eq!(users, ["eeruf", "eeruf-design", "eeruf-playground", "eeruf-py"]);
    let design = metadata.packages.iter().find(|package| package.name.as_str() == "eeruf-design").expect("it is there");
    let linked = design.dependencies.iter().find(|of| of.name == "eeruf-check" && of.kind == DependencyKind::Normal);
    assert!(linked.is_some_and(|of| of.optional));
    let with_it: Vec<_> =
        design.features.iter().filter(|(_, needs)| needs.iter().any(|need| need == "dep:eeruf-check")).collect();
    assert_eq!(with_it.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["make-atlas"]);
    let folder = design.manifest_path.parent().expect("a folder").join("src");
    for (file, text) in sources(folder.as_std_path()) {
        let may = file.ends_with("atlas_making.rs");
        assert!(may || names_used(&text).is_empty(), "{}: the checker", file.display());
    }
}
