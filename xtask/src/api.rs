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
        return front_door();
    }
    let what = "if that is meant: cargo xtask api --write, and a line in CHANGELOG.md that says what users must do";
    Err(Trouble::Failed(format!("the interface changed\n{}\n{what}", differences.join("\n"))))
}

/// The most names that a reader of `eeruf-core`'s first page may have to choose from.
const NAMES_AT_ROOT: usize = 45;

/// Holds `eeruf-core`'s root against [`NAMES_AT_ROOT`]; no type may be there and in a module too.
fn front_door() -> Result<(), Trouble> {
    let file = "crates/eeruf-core/api.txt";
    let api = fs::read_to_string(file).map_err(|error| Trouble::Failed(format!("{file}: {error}")))?;
    let (names, twice) = (names_at_root(&api), types_at_two_places(&api));
    if names.len() > NAMES_AT_ROOT {
        let names = names.into_iter().collect::<Vec<_>>().join(", ");
        return Err(Trouble::Failed(format!("more than {NAMES_AT_ROOT} names at the root of eeruf-core: {names}")));
    }
    if !twice.is_empty() {
        return Err(Trouble::Failed(format!("types of eeruf-core under two paths: {}", twice.join(", "))));
    }
    Ok(())
}

/// The path that a line of an interface declares, without generic parameters; `None` for `impl` and the like.
fn declared(line: &str) -> Option<String> {
    let (_, item) = line.split_once("pub ")?;
    let mut depth = 0_u32;
    let mut plain = String::new();
    for (at, letter) in item.char_indices() {
        match letter {
            '<' => depth += 1,
            // Not the arrow before what is returned.
            '>' if depth > 0 && !item[..at].ends_with('-') => depth -= 1,
            _ if depth == 0 => plain.push(letter),
            _ => {}
        }
    }
    let path = plain.split_whitespace().find(|word| word.starts_with("eeruf_core"))?;
    let end = path.find(['(', '!']).unwrap_or(path.len());
    Some(path[..end].trim_end_matches(':').to_owned())
}

fn names_at_root(api: &str) -> BTreeSet<String> {
    let paths = api.lines().filter_map(declared);
    let names = paths.filter_map(|path| path.split_once("::").map(|(_, rest)| rest.to_owned()));
    names.filter(|rest| !rest.contains("::")).collect()
}

/// Types with the same name and members in two modules.
fn types_at_two_places(api: &str) -> Vec<String> {
    let lines: Vec<_> = api.lines().filter_map(|line| Some((line, declared(line)?))).collect();
    let is_type = |line: &str| ["struct", "enum", "trait"].iter().any(|kind| line.contains(&format!("pub {kind} ")));
    let mut seen = Vec::new();
    let mut twice = Vec::new();
    for (_, path) in lines.iter().filter(|(line, _)| is_type(line)) {
        let Some((module, name)) = path.rsplit_once("::") else { continue };
        let inside = format!("{path}::");
        let of_it = lines.iter().filter(|(_, other)| other.starts_with(&inside));
        let members: Vec<_> = of_it.map(|(line, _)| line.replace(&format!("{module}::"), "")).collect();
        let entry = (name, members);
        if seen.contains(&entry) {
            twice.push(path.clone());
        }
        seen.push(entry);
    }
    twice
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

/// Lines that are gone (`-`) and new (`+`); order does not matter.
fn changes(was: &str, is: &str) -> Vec<String> {
    let (was, is): (BTreeSet<_>, BTreeSet<_>) = (was.lines().collect(), is.lines().collect());
    let gone = was.difference(&is).map(|line| format!("- {line}"));
    gone.chain(is.difference(&was).map(|line| format!("+ {line}"))).collect()
}

#[cfg(test)]
mod tests {
    use super::{changes, names_at_root, types_at_two_places};

    #[test]
    fn changes_are_named_in_any_order() {
        assert!(changes("pub fn a()\npub fn b()\n", "pub fn b()\npub fn a()\n").is_empty());
        let changed = changes("pub fn a()\npub fn b()\n", "pub fn a(u8)\npub fn b()\n");
        assert_eq!(changed, ["- pub fn a()", "+ pub fn a(u8)"]);
    }

    // Names at the root are counted once and types under two paths are found.
    #[test]
    fn root_names_are_counted_once() {
        let api = "pub mod eeruf_core\npub mod eeruf_core::plan\npub struct eeruf_core::plan::Ring<P>\n\
                   impl<P> eeruf_core::plan::Ring<P>\npub const fn eeruf_core::plan::Ring<P>::new(u8) -> Self\n\
                   #[non_exhaustive] pub struct eeruf_core::Ring<P>\n\
                   pub const fn eeruf_core::Ring<P>::new(u8) -> Self\npub macro eeruf_core::schedule!\n";
        assert_eq!(names_at_root(api).into_iter().collect::<Vec<_>>(), ["Ring", "plan", "schedule"]);
        assert_eq!(types_at_two_places(api), ["eeruf_core::Ring"]);
        let other = api.replace("eeruf_core::Ring<P>::new(u8)", "eeruf_core::Ring<P>::new(u16)");
        assert!(types_at_two_places(&other).is_empty());
    }
}
