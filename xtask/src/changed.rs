//! Files and packages that changed since the branch left the main one, as git knows it.

use std::path::Path;
use std::process::Command;

use cargo_metadata::{Metadata, Package};

use crate::steps::{Trouble, output};

/// The files that differ from where the branch left the main one, or on the main one itself from the last commit; with
/// what is not committed.
pub(crate) fn files() -> Result<Vec<String>, Trouble> {
    let git = |args: &[&str]| output(Command::new("git").args(args));
    let head = git(&["rev-parse", "HEAD"]).ok_or_else(|| Trouble::Failed("git rev-parse HEAD fails".to_owned()))?;
    let base = ["origin/HEAD", "origin/main", "main", "origin/master", "master"]
        .iter()
        .find_map(|branch| git(&["merge-base", "HEAD", branch]))
        .filter(|base| *base != head);
    let dirty = git(&["status", "--porcelain"]).is_some_and(|status| !status.is_empty());
    let last = if dirty { "HEAD" } else { "HEAD~1" };
    let base = base.unwrap_or_else(|| last.to_owned());
    let changed =
        git(&["diff", "--name-only", &base, "--"]).ok_or_else(|| Trouble::Failed(format!("git diff {base} fails")))?;
    let new = git(&["ls-files", "--others", "--exclude-standard"]).unwrap_or_default();
    Ok(changed.lines().chain(new.lines()).map(str::to_owned).collect())
}

/// The packages that hold these files. A file belongs to the innermost package around it; of the root package only what
/// Cargo builds counts, not documents.
pub(crate) fn packages<'a>(metadata: &'a Metadata, files: &[String]) -> Vec<&'a Package> {
    let root = metadata.workspace_root.as_std_path();
    let folder = |package: &Package| -> String {
        let folder = package.manifest_path.parent().map(cargo_metadata::camino::Utf8Path::as_std_path);
        let relative = folder.and_then(|folder| folder.strip_prefix(root).ok()).unwrap_or(Path::new(""));
        relative.display().to_string()
    };
    let mut packages: Vec<_> =
        metadata.workspace_packages().into_iter().map(|package| (folder(package), package)).collect();
    packages.sort_by_key(|(folder, _)| core::cmp::Reverse(folder.len()));
    let holds = |folder: &str, file: &str| {
        if folder.is_empty() {
            ["src/", "tests/", "benches/", "Cargo."].iter().any(|start| file.starts_with(start))
        } else {
            file.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'))
        }
    };
    let owners: Vec<_> =
        files.iter().filter_map(|file| packages.iter().position(|(folder, _)| holds(folder, file))).collect();
    packages.iter().enumerate().filter(|(index, _)| owners.contains(index)).map(|(_, (_, package))| *package).collect()
}
