//! Files and packages that changed since the branch left the main one, from git.

use std::process::Command;

use anyhow::{Context as _, Result};
use cargo_metadata::{Metadata, Package};

use crate::steps::output;

/// The files that differ from the point where the branch left the main one, or on the main branch from the last commit,
/// including uncommitted changes.
pub(crate) fn files() -> Result<Vec<String>> {
    let git = |args: &[&str]| output(Command::new("git").args(args)).ok();
    let head = git(&["rev-parse", "HEAD"]).context("git rev-parse HEAD fails")?;
    let base = ["origin/HEAD", "origin/main", "main", "origin/master", "master"]
        .iter()
        .find_map(|branch| git(&["merge-base", "HEAD", branch]))
        .filter(|base| *base != head);
    let dirty = git(&["status", "--porcelain"]).is_some_and(|status| !status.is_empty());
    let last = if dirty { "HEAD" } else { "HEAD~1" };
    let base = base.unwrap_or_else(|| last.to_owned());
    let changed = git(&["diff", "--name-only", &base, "--"]).with_context(|| format!("git diff {base} fails"))?;
    let new = git(&["ls-files", "--others", "--exclude-standard"]).unwrap_or_default();
    Ok(changed.lines().chain(new.lines()).map(str::to_owned).collect())
}

/// The packages that hold these files. A file belongs to the innermost package around it; in the root package only
/// files that Cargo builds count, not documents.
pub(crate) fn packages<'a>(metadata: &'a Metadata, files: &[String]) -> Vec<&'a Package> {
    let folder = |package: &Package| package.manifest_path.with_file_name("");
    let mut packages = metadata.workspace_packages();
    packages.sort_by_key(|package| core::cmp::Reverse(folder(package).as_str().len()));
    let is_built = |file: &str| ["src/", "tests/", "benches/", "Cargo."].iter().any(|start| file.starts_with(start));
    let holds = |package: &Package, file: &str| {
        let folder = folder(package);
        metadata.workspace_root.join(file).starts_with(&folder) && (folder != metadata.workspace_root || is_built(file))
    };
    let owner = |file: &String| packages.iter().position(|package| holds(package, file));
    let owners: Vec<_> = files.iter().filter_map(owner).collect();
    packages.iter().enumerate().filter(|(index, _)| owners.contains(index)).map(|(_, package)| *package).collect()
}
