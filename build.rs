//! Names the version and the commit that the program is built from, for `eeruf --version`, and takes in the notices of
//! what others wrote, for `eeruf licenses`.

use std::path::Path;
use std::process::Command;

/// Written by `cargo xtask notices` for a release; not part of the repository.
const NOTICES: &str = "LICENSE-THIRD-PARTY.txt";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let version = std::env::var("CARGO_PKG_VERSION").expect("cargo sets it");
    let version = commit().map_or_else(|| version.clone(), |commit| format!("{version} ({commit})"));
    println!("cargo::rustc-env=EERUF_VERSION={version}");
    let notices = std::fs::read_to_string(NOTICES);
    if notices.is_ok() {
        // As below: not where it is missing.
        println!("cargo::rerun-if-changed={NOTICES}");
    }
    let without = "This program was built without them; the programs and wheels of a release print them here.\n";
    let taken = Path::new(&std::env::var("OUT_DIR").expect("cargo sets it")).join("notices.txt");
    std::fs::write(taken, notices.as_deref().unwrap_or(without)).expect("a folder to write into");
}

/// Returns the commit: cargo's note of it in a tarball, else the clone's; `None` without either.
fn commit() -> Option<String> {
    if let Ok(noted) = std::fs::read_to_string(".cargo_vcs_info.json") {
        // Named only where it is: a file that is missing counts as changed, and all would be rebuilt each time.
        println!("cargo::rerun-if-changed=.cargo_vcs_info.json");
        let (_, rest) = noted.split_once("\"sha1\": \"")?;
        return rest.get(..7).map(str::to_owned);
    }
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        String::from_utf8(output.stdout).ok().map(|said| said.trim().to_owned())
    };
    // A clone of something else that this one lies in, as a vendored copy does, says nothing of us.
    let root = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&root).canonicalize().ok()? != std::env::current_dir().ok()?.canonicalize().ok()? {
        return None;
    }
    // Each commit and each change of branch adds a line there.
    println!("cargo::rerun-if-changed={}", git(&["rev-parse", "--git-path", "logs/HEAD"])?);
    git(&["rev-parse", "--short=7", "HEAD"])
}
