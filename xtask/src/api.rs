//! `cargo xtask api`: the public items of the crates that firmware stands on, against those that they had.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use crate::steps::{Trouble, run};
use crate::toolchain::cargo_of_version;

/// The crates whose interface is kept.
const CRATES: [&str; 2] = ["eeruf-core", "eeruf-hc-sr04"];
/// The version of Rust whose rustdoc writes the format that `public-api` reads.
const RUST: &str = "1.95";

/// Compares each crate's interface, with all features, with its `api.txt`; or writes that.
pub(crate) fn api(write: bool) -> Result<(), Trouble> {
    let mut differences = Vec::new();
    for name in CRATES {
        let file = PathBuf::from(format!("crates/{name}/api.txt"));
        let failed = |error: std::io::Error| Trouble::Failed(format!("{}: {error}", file.display()));
        let is = interface(name)?;
        println!("{name}: {} public items", is.lines().count());
        if write {
            fs::write(&file, is).map_err(failed)?;
            continue;
        }
        let was = fs::read_to_string(&file).map_err(failed)?;
        differences.extend(changes(&was, &is).into_iter().map(|change| format!("{name}: {change}")));
    }
    if differences.is_empty() {
        return Ok(());
    }
    let what = "if that is meant: cargo xtask api --write, and a line in CHANGELOG.md that says what users must do";
    Err(Trouble::Failed(format!("the interface changed\n{}\n{what}", differences.join("\n"))))
}

/// All public items of a crate, one a line; not what every type has by itself.
fn interface(name: &str) -> Result<String, Trouble> {
    let mut cargo = cargo_of_version(RUST)?;
    // JSON is not stable. In a folder of its own, since build scripts run anew where this variable comes and goes.
    cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_TARGET_DIR", "target/api");
    cargo.args(["rustdoc", "--quiet", "--locked", "--package", name, "--lib", "--all-features", "--"]);
    run(cargo.args(["-Zunstable-options", "--output-format", "json", "--cap-lints", "allow"]))?;
    let json = PathBuf::from(format!("target/api/doc/{}.json", name.replace('-', "_")));
    let api = public_api::Builder::from_rustdoc_json(json)
        .omit_auto_derived_impls(true)
        .omit_auto_trait_impls(true)
        .omit_blanket_impls(true)
        .build()
        .map_err(|error| Trouble::Failed(format!("{name}: {error}")))?;
    Ok(api.items().map(|item| format!("{item}\n")).collect())
}

/// What is gone (`-`) and what is new (`+`); order does not matter.
fn changes(was: &str, is: &str) -> Vec<String> {
    let (was, is): (BTreeSet<_>, BTreeSet<_>) = (was.lines().collect(), is.lines().collect());
    let gone = was.difference(&is).map(|line| format!("- {line}"));
    gone.chain(is.difference(&was).map(|line| format!("+ {line}"))).collect()
}

#[cfg(test)]
mod tests {
    use super::changes;

    #[test]
    fn what_is_gone_and_what_is_new_is_named_and_order_does_not_matter() {
        assert!(changes("pub fn a()\npub fn b()\n", "pub fn b()\npub fn a()\n").is_empty());
        let changed = changes("pub fn a()\npub fn b()\n", "pub fn a(u8)\npub fn b()\n");
        assert_eq!(changed, ["- pub fn a()", "+ pub fn a(u8)"]);
    }
}
