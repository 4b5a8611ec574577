//! `cargo xtask api`: the public items of the crates that firmware uses, listed, counted and compared with limits.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::steps::run;
use crate::toolchain::cargo_of_version;

/// The crates whose interface is kept small.
const CRATES: [&str; 2] = ["eeruf-core", "eeruf-hc-sr04"];
/// The version of Rust whose rustdoc writes the format that `public-api` reads.
const RUST: &str = "1.95";
/// Lists of public items, one file per crate.
const LISTS: &str = "target/api";
/// Models that try a ring's methods.
const MODELS: &str = "fuzz/src/ring/model.rs fuzz/src/ring.rs fuzz/src/flow.rs \
                      crates/eeruf-core/tests/all/flow/world.rs crates/eeruf-core/tests/all/sound/world.rs";
/// The largest number of names on the first page of `eeruf-core`'s documentation.
const NAMES_AT_ROOT: usize = 45;
/// The number of public types of `eeruf-core`: a new one, or a second path to an old one, is named in a commit.
const TYPES: usize = 74;

/// Lists each crate's interface, with all features, and compares that of `eeruf-core` with [`NAMES_AT_ROOT`] and
/// [`TYPES`].
pub(crate) fn api() -> Result<()> {
    for name in CRATES {
        let file = Path::new(LISTS).join(format!("{name}.txt"));
        let items = interface(name)?;
        println!("{}: {} public items", file.display(), items.lines().count());
        fs::write(&file, &items)?;
        if name == CRATES[0] {
            front_door(&items)?;
            all_are_fuzzed(&items)?;
        }
    }
    Ok(())
}

fn front_door(api: &str) -> Result<()> {
    let (names, types) = (names_at_root(api), types(api).count());
    println!("eeruf-core: {} names at the root, {types} types", names.len());
    let few = names.len() <= NAMES_AT_ROOT;
    ensure!(few, "more than {NAMES_AT_ROOT} names at the root of eeruf-core: {names:?}");
    ensure!(types <= TYPES, "{types} public types of eeruf-core, by their paths; expected at most {TYPES}");
    Ok(())
}

/// Checks that each method of a ring is called by a model that checks its promises.
fn all_are_fuzzed(api: &str) -> Result<()> {
    let models = MODELS.split_whitespace().map(fs::read_to_string).collect::<Result<String, _>>()?;
    let methods = api.lines().filter(|line| line.contains(" fn ") && line.contains("self")).filter_map(declared);
    let methods = methods.filter_map(|path| path.strip_prefix("eeruf_core::Ring::").map(str::to_owned));
    let uncalled: BTreeSet<_> = methods.filter(|name| !models.contains(&format!(".{name}("))).collect();
    ensure!(uncalled.is_empty(), "methods of a ring that no model of {MODELS} calls: {uncalled:?}");
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
            // Not the arrow before a return type.
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

/// Returns the paths of structures, enumerations and traits.
fn types(api: &str) -> impl Iterator<Item = String> {
    let is_type = |line: &&str| ["struct", "enum", "trait"].iter().any(|kind| line.contains(&format!("pub {kind} ")));
    api.lines().filter(is_type).filter_map(declared)
}

/// Returns all public items of a crate, one per line, without those that every type has.
fn interface(name: &str) -> Result<String> {
    let mut cargo = cargo_of_version(RUST)?;
    // JSON is not stable. It has a folder of its own, since build scripts run again whenever this variable changes.
    cargo.env("RUSTC_BOOTSTRAP", "1").env("CARGO_TARGET_DIR", "target/api");
    cargo.args(["rustdoc", "--quiet", "--locked", "--package", name, "--lib", "--all-features", "--"]);
    run(cargo.args(["-Zunstable-options", "--output-format", "json", "--cap-lints", "allow"]))?;
    let json = PathBuf::from(format!("target/api/doc/{}.json", name.replace('-', "_")));
    let api = public_api::Builder::from_rustdoc_json(json)
        .omit_auto_derived_impls(true)
        .omit_auto_trait_impls(true)
        .omit_blanket_impls(true)
        .build()?;
    Ok(api.items().map(|item| format!("{item}\n")).collect())
}

#[cfg(test)]
mod tests {
    use super::{names_at_root, types};

    // Names at the root are counted once, and types by their paths.
    #[test]
    fn root_names_are_counted_once() {
        let api = "pub mod eeruf_core\npub mod eeruf_core::plan\npub struct eeruf_core::plan::Ring<P>\n\
                   impl<P> eeruf_core::plan::Ring<P>\npub const fn eeruf_core::plan::Ring<P>::new(u8) -> Self\n\
                   #[non_exhaustive] pub struct eeruf_core::Ring<P>\n\
                   pub const fn eeruf_core::Ring<P>::new(u8) -> Self\npub macro eeruf_core::schedule!\n";
        assert_eq!(names_at_root(api).into_iter().collect::<Vec<_>>(), ["Ring", "plan", "schedule"]);
        assert_eq!(types(api).collect::<Vec<_>>(), ["eeruf_core::plan::Ring", "eeruf_core::Ring"]);
    }
}
