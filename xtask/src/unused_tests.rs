//! Dependencies that a package names and none of its sources mentions.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use cargo_metadata::MetadataCommand;

use crate::steps::output;

// Sources are those of the package, and modules that they take from elsewhere.
#[test]
fn every_dependency_is_mentioned_in_a_source() {
    let metadata = MetadataCommand::new().no_deps().exec().unwrap();
    let root = metadata.workspace_root.as_std_path();
    let listing = ["ls-files", "--cached", "--others", "--exclude-standard", "*.rs"];
    let listed = output(Command::new("git").current_dir(root).args(listing)).unwrap();
    let files: Vec<PathBuf> = listed.lines().map(|file| root.join(file)).filter(|file| file.exists()).collect();
    let text = |file: &PathBuf| std::fs::read_to_string(file).unwrap();
    let sources: Vec<(&Path, String)> = files.iter().map(|file| (file.as_path(), text(file))).collect();
    let folder = |package: usize| metadata.packages[package].manifest_path.as_std_path().parent();
    let owner = |file: &Path| {
        let holds = |&package: &usize| folder(package).is_some_and(|folder| file.starts_with(folder));
        (0..metadata.packages.len()).filter(holds).max_by_key(|&package| folder(package).map(Path::as_os_str))
    };
    let mut unused = Vec::new();
    for (number, package) in metadata.packages.iter().enumerate() {
        let own: Vec<&(&Path, String)> = sources.iter().filter(|(file, _)| owner(file) == Some(number)).collect();
        let borrowed: Vec<PathBuf> = own.iter().flat_map(|(file, text)| borrowed(file, text)).collect();
        let is_borrowed = |file: &Path| borrowed.iter().any(|folder| file.starts_with(folder));
        let all = own.iter().copied().chain(sources.iter().filter(|(file, _)| is_borrowed(file)));
        let words: BTreeSet<&str> = all.flat_map(|(_, text)| words(text)).collect();
        for dependency in &package.dependencies {
            let name = dependency.rename.as_ref().unwrap_or(&dependency.name).replace('-', "_");
            if !words.contains(name.as_str()) {
                unused.push(format!("{}: {}: in no source; expected no such dependency", package.name, name));
            }
        }
    }
    assert!(unused.is_empty(), "{}", unused.join("\n"));
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
}

/// The folders of the modules that a source takes from elsewhere, by `#[path]`.
fn borrowed(file: &Path, text: &str) -> Vec<PathBuf> {
    let paths = text.lines().filter_map(|line| line.strip_prefix("#[path = \"")?.strip_suffix("\"]"));
    let folder = |path: &str| {
        let mut at = file.parent()?.to_owned();
        for part in Path::new(path).parent()?.components() {
            match part {
                Component::ParentDir => _ = at.pop(),
                part => at.push(part),
            }
        }
        Some(at)
    };
    paths.filter_map(folder).collect()
}
