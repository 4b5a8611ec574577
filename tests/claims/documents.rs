//! The documents: the small tables are what the program prints, and their pictures exist.
//!
//! `<!-- printed by: eeruf ARGUMENTS -->` stands before what the program prints, `<!-- end -->` after it. What takes
//! long is marked `printed by (large):` and left to `cargo xtask reprint --check`, other commands than `eeruf` to
//! `cargo xtask test`.

use std::path::{Path, PathBuf};

use crate::common::eeruf;

const PRINTED_BY: &str = "<!-- printed by: eeruf ";
const END: &str = "<!-- end -->";

/// The Markdown files below a folder.
fn documents(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| match path.is_dir() {
            true => documents(&path),
            false => vec![path],
        })
        .filter(|path| path.extension().is_some_and(|ending| ending == "md"))
        .collect()
}

#[test]
fn the_small_tables_in_the_docs_are_what_the_commands_print() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut documents = documents(&root.join("docs"));
    documents.push(root.join("README.md"));
    let mut verbs = Vec::new();
    for document in documents {
        let text = std::fs::read_to_string(&document).unwrap();
        for block in text.split(PRINTED_BY).skip(1) {
            let (command, rest) = block.split_once(" -->\n").unwrap();
            let (expected, _) = rest.split_once(END).unwrap();
            let words: Vec<&str> = command.split_whitespace().collect();
            assert_eq!(eeruf(&words).out.trim(), expected.trim(), "{}: {command}", document.display());
            verbs.push(words[..2].join(" "));
        }
    }
    for verb in ["experiment set-one", "experiment set-two"] {
        assert!(verbs.iter().any(|checked| checked == verb), "{verbs:?}");
    }
}

#[test]
fn every_picture_in_the_docs_is_small() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pictures = 0;
    for document in documents(&root.join("docs")) {
        let text = std::fs::read_to_string(&document).unwrap();
        for picture in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if [".png", ".svg"].iter().any(|ending| picture.ends_with(ending)) {
                let size = std::fs::metadata(document.parent().unwrap().join(picture)).unwrap().len();
                assert!(size < 300_000, "{picture}: {size}");
                pictures += 1;
            }
        }
    }
    assert!(pictures >= 10, "{pictures}");
}

#[test]
fn user_path_has_at_most_20_000_words() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let mut path = documents(&docs.join("tutorial"));
    path.extend(documents(&docs.join("how-to")));
    path.push(docs.join("faq.md"));
    let words = path.iter().map(|document| std::fs::read_to_string(document).unwrap().split_whitespace().count());
    let words: usize = words.sum();
    assert!(words <= 20_000, "{words}; figures and diaries belong into docs/log");
}
