//! `cargo xtask notices`: what others wrote in program and wheel, and under which licences, as
//! `LICENSE-THIRD-PARTY.txt`. cargo-about finds the texts; those of what is no crate are in `xtask/notices/others.txt`.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::steps::{Trouble, output};

/// The file, which program and wheel carry.
pub(crate) const FILE: &str = "LICENSE-THIRD-PARTY.txt";
/// Linked parts that are no crates.
const OTHERS: &str = "xtask/notices/others.txt";
const HEAD: &str = "\
What others wrote and is within the program eeruf and the Python package eeruf, and under which licence it is used \
there.
Made by `cargo xtask notices --write`, from the texts that came with each part; SPDX's where none did.

";
/// Ends Apache's terms; what follows is how to apply them, and sometimes whose work it is.
const END_OF_TERMS: &str = "END OF TERMS AND CONDITIONS";

/// Compares the file with what cargo-about finds, or writes it.
pub(crate) fn notices(write: bool) -> Result<(), Trouble> {
    let failed = |what: &str, why: &dyn std::fmt::Display| Trouble::Failed(format!("{what}: {why}"));
    if output(Command::new("cargo").args(["about", "--version"])).is_none() {
        let install = "cargo install cargo-about --locked --features cli";
        return Err(Trouble::Skipped(format!("no cargo-about; try: {install}")));
    }
    let mut about = Command::new("cargo");
    about.args(["about", "generate", "--locked", "--fail", "--format", "json", "--config", "xtask/notices/about.toml"]);
    // The wheel has the whole program within.
    about.args(["--manifest-path", "crates/eeruf-py/Cargo.toml"]);
    let found = output(&mut about).ok_or_else(|| failed("cargo about", &"no answer"))?;
    let found: Value = serde_json::from_str(&found).map_err(|error| failed("cargo about", &error))?;
    let others = fs::read_to_string(OTHERS).map_err(|error| failed(OTHERS, &error))?;
    let text = text(&found, &others).ok_or_else(|| failed("cargo about", &"not what this version of it writes"))?;
    if write {
        return fs::write(FILE, text).map_err(|error| failed(FILE, &error));
    }
    let kept = fs::read_to_string(FILE).map_err(|error| failed(FILE, &error))?;
    if kept == text { Ok(()) } else { Err(failed(FILE, &"out of date; try: cargo xtask notices --write")) }
}

/// One licence text and who uses it.
#[derive(Default)]
struct Used {
    id: String,
    text: String,
    by: BTreeSet<String>,
    /// Authors, where the text itself leaves that open.
    whose: BTreeSet<String>,
}

/// The file: the crates with their licences, then each text once.
fn text(found: &Value, others: &str) -> Option<String> {
    let (mut crates, mut texts) = (BTreeMap::<_, BTreeSet<_>>::new(), BTreeMap::<_, Used>::new());
    for license in found["licenses"].as_array()? {
        let (id, text) = (license["id"].as_str()?, license["text"].as_str()?.replace("\r\n", "\n"));
        let (terms, rest) = match text.find(END_OF_TERMS) {
            Some(at) if id == "Apache-2.0" => text.split_at(at + END_OF_TERMS.len()),
            _ => (&*text, ""),
        };
        // The same words, however they are set.
        let words: Vec<_> = terms.split_whitespace().collect();
        let used = texts.entry((id.to_owned(), words.join(" "))).or_default();
        if used.text.is_empty() {
            (used.id, used.text) = (id.to_owned(), tidy(terms));
        }
        let whose = rest.lines().map(str::trim).filter(|line| line.starts_with("Copyright"));
        let whose: Vec<_> = whose.filter(|line| !line.contains(['[', '{'])).collect();
        for one in license["used_by"].as_array()? {
            let (name, version) = (one["crate"]["name"].as_str()?, one["crate"]["version"].as_str()?);
            if name.starts_with("eeruf") {
                continue;
            }
            crates.entry(format!("{name} {version}")).or_default().insert(id.to_owned());
            used.by.insert(format!("{name} {version}"));
            used.whose.extend(whose.iter().map(|line| format!("{name}: {line}")));
        }
    }
    let mut out = HEAD.to_owned();
    for (name, licenses) in &crates {
        let licenses: Vec<_> = licenses.iter().map(String::as_str).collect();
        _ = writeln!(out, "{name}: {}", licenses.join(" AND "));
    }
    _ = write!(out, "\n{}\n", others.trim_end());
    for used in texts.values().filter(|used| !used.by.is_empty()) {
        let by: Vec<_> = used.by.iter().map(String::as_str).collect();
        _ = write!(out, "\n{}\n{}, of {}\n", "-".repeat(80), used.id, by.join(", "));
        for whose in &used.whose {
            _ = writeln!(out, "{whose}");
        }
        _ = write!(out, "\n{}\n", used.text);
    }
    for notice in found["notices"].as_array().into_iter().flatten() {
        let (name, text) = (notice["crate"]["name"].as_str()?, notice["text"].as_str()?);
        _ = write!(out, "\n{}\nNotice of {name}\n\n{}\n", "-".repeat(80), tidy(text));
    }
    Some(out)
}

/// A text without spaces at the ends of lines, and without empty lines around it.
fn tidy(text: &str) -> String {
    let lines: Vec<_> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};
    use std::process::Command;

    use serde_json::json;

    use super::{FILE, OTHERS, text};
    use crate::steps::output;

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
    }

    fn file() -> String {
        std::fs::read_to_string(root().join(FILE)).unwrap()
    }

    /// The crates that the file names, as `name version`.
    fn named(file: &str) -> BTreeSet<String> {
        let lines = file.lines().skip_while(|line| !line.is_empty()).skip(1).take_while(|line| !line.is_empty());
        lines.filter_map(|line| line.split_once(':')).map(|(name, _)| name.to_owned()).collect()
    }

    #[test]
    fn every_crate_of_the_wheel_has_its_licence_in_the_notices() {
        let file = file();
        let named = named(&file);
        let mut linked = BTreeSet::new();
        for target in ["x86_64-unknown-linux-gnu", "x86_64-unknown-linux-musl", "aarch64-unknown-linux-gnu"] {
            let mut cargo = Command::new("cargo");
            cargo.args(["tree", "--locked", "--offline", "--edges", "normal", "--prefix", "none"]);
            cargo.args(["--package", "eeruf-py", "--target", target]);
            let tree = output(cargo.current_dir(root())).unwrap();
            let crates = tree.lines().filter_map(|line| line.split(" (").next()).map(|line| line.replace(" v", " "));
            linked.extend(crates.filter(|name| !name.starts_with("eeruf")));
        }
        assert!(linked.len() > 100, "{linked:?}");
        let missing: Vec<_> = linked.difference(&named).collect();
        assert!(missing.is_empty(), "{FILE} lacks {missing:?}; try: cargo xtask notices --write");
        // What is there for other systems is of the versions that are built.
        let lock = std::fs::read_to_string(root().join("Cargo.lock")).unwrap();
        let locked = |name: &String| {
            let (name, version) = name.split_once(' ').unwrap();
            lock.contains(&format!("name = \"{name}\"\nversion = \"{version}\"\n"))
        };
        let gone: Vec<_> = named.iter().filter(|name| !locked(name)).collect();
        assert!(gone.is_empty(), "{FILE} names {gone:?}; try: cargo xtask notices --write");
    }

    #[test]
    fn what_is_no_crate_is_in_the_notices_as_it_was_written_down() {
        let others = std::fs::read_to_string(root().join(OTHERS)).unwrap();
        assert!(file().contains(others.trim_end()));
        for part in ["Rust's standard library", "musl", "libunwind", "SQLite", "Zstandard"] {
            assert!(others.contains(part), "{part}");
        }
    }

    // A text that many use stands once and names them and their authors.
    #[test]
    fn shared_licence_text_stands_once() {
        let crates = |names: &[&str]| {
            let one = |name: &&str| json!({ "crate": { "name": name, "version": "1.0.0" } });
            names.iter().map(one).collect::<Vec<_>>()
        };
        let unnamed = "Terms\n\nEND OF TERMS AND CONDITIONS\n  Copyright [yyyy]";
        let named = " Terms \nEND OF TERMS AND CONDITIONS\n  Copyright 2020 C";
        let found = json!({ "licenses": [
            { "id": "Apache-2.0", "text": unnamed, "used_by": crates(&["a", "b"]) },
            { "id": "Apache-2.0", "text": named, "used_by": crates(&["c"]) },
            { "id": "MIT", "text": "Copyright D", "used_by": crates(&["c"]) },
        ], "notices": [{ "crate": { "name": "b" }, "text": "heed" }] });
        let text = text(&found, "others\n").unwrap();
        let (_, listed) = text.split_once("\n\n").unwrap();
        assert!(
            listed.starts_with("a 1.0.0: Apache-2.0\nb 1.0.0: Apache-2.0\nc 1.0.0: Apache-2.0 AND MIT\n\nothers\n\n-")
        );
        assert_eq!(text.matches("Terms\n").count(), 1, "{text}");
        assert!(text.contains("Apache-2.0, of a 1.0.0, b 1.0.0, c 1.0.0\nc: Copyright 2020 C\n\nTerms"), "{text}");
        assert!(text.contains("MIT, of c 1.0.0\n\nCopyright D\n") && text.contains("Notice of b\n\nheed\n"), "{text}");
    }
}
