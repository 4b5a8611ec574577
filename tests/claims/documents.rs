//! The documents: the small tables are what the program prints, and their pictures exist.
//!
//! `<!-- printed by: eeruf ARGUMENTS -->` stands before what the program prints, `<!-- end -->` after it. What takes
//! long is marked `printed by (large):` and left to `cargo xtask reprint --check`, other commands than `eeruf` to
//! `cargo xtask test`.

use crate::common::eeruf;

const PRINTED_BY: &str = "<!-- printed by: eeruf ";
const END: &str = "<!-- end -->";

#[test]
fn the_small_tables_in_the_docs_are_what_the_commands_print() {
    let docs = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/docs")).unwrap();
    let mut documents: Vec<_> = docs.map(|entry| entry.unwrap().path()).collect();
    documents.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
    documents.push(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md").into());
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
fn every_picture_in_the_docs_exists_and_is_small() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/");
    let docs = std::fs::read_to_string(folder.to_owned() + "experiments.md").unwrap();
    let pictures: Vec<&str> = docs.split("](pictures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(pictures.len() >= 3, "{pictures:?}");
    for picture in pictures {
        let size = std::fs::metadata(format!("{folder}pictures/{picture}")).unwrap().len();
        assert!(size < 300_000, "{picture}: {size}");
    }
}
