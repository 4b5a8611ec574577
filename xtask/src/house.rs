//! Rules for sources that no linter has: for Rust, lengths of lines and files and vague phrases; for all languages,
//! openings of doc comments. CONTRIBUTING.md has the reasons.

use std::fmt::Write as _;
use std::process::Command;

use anyhow::{Context as _, Result, ensure};

use crate::steps::output;

/// Largest number of characters in a line; the formatter does not wrap comments and texts.
const LINE: usize = 120;
/// Largest number of lines in a file, tests included.
const FILE: usize = 700;

/// Openings that name nothing, or something on the line above: a doc comment begins with a noun, or with what the
/// function does.
const OPENINGS: [&str; 21] = [
    "What ",
    "Whether ",
    "How ",
    "Who ",
    "Whom ",
    "Whose ",
    "By how ",
    "The same ",
    "As [",
    "Of ",
    "It ",
    "Those ",
    "These ",
    "They ",
    "Their ",
    "Its ",
    "Why ",
    "For how ",
    "When it ",
    "Where it ",
    "To be ",
];
/// Vague phrases and their plainer words; each phrase is in two parts, so that this file does not contain it.
const PHRASES: [(&str, &str, &str); 2] =
    [("so ma", "ny", "the number, or `this many`"), ("is not the", "re", "`out of range`, or `missing`")];

/// Sources that the program writes, in lines as long as their numbers.
const EMITTED: &str = "tests/claims/emitted/";

/// Checks every source in Rust, Python and C of the repository.
pub(crate) fn check() -> Result<()> {
    // Includes files that are about to be added.
    let listing = ["ls-files", "--cached", "--others", "--exclude-standard"];
    let sources = ["*.rs", "*.py", "*.pyi", "*.c", "*.h", "*.cpp"];
    let listed = output(Command::new("git").args(listing).args(sources));
    let listed = listed.context("git ls-files: no answer")?;
    let mut broken = String::new();
    for file in listed.lines() {
        let text = std::fs::read_to_string(file)?;
        let is_by_hand = file.ends_with(".rs") && !file.starts_with(EMITTED);
        let broken_rules = if is_by_hand { broken_rules(&text) } else { wrong_openings(&text) };
        for (line, what) in broken_rules {
            _ = write!(broken, "\n{file}:{line}: {what}");
        }
    }
    ensure!(broken.is_empty(), "{broken}");
    Ok(())
}

/// Returns the lines at which a doc comment begins with one of [`OPENINGS`], counted from 1.
fn wrong_openings(text: &str) -> Vec<(usize, String)> {
    let mut was_doc = false;
    let wrong = |(line, words): (usize, &str)| {
        let words = words.trim_start();
        let doc = words.strip_prefix("///").or_else(|| words.strip_prefix("//!"));
        let begins =
            doc.filter(|_| !was_doc).or_else(|| ["\"\"\"", "/*"].iter().find_map(|mark| words.strip_prefix(mark)));
        was_doc = doc.is_some();
        let begins = begins?.trim_start();
        let opening = OPENINGS.iter().find(|word| begins.starts_with(**word))?;
        Some((line, format!("a doc comment that begins with `{}`; expected a noun or a verb", opening.trim())))
    };
    (1..).zip(text.lines()).filter_map(wrong).collect()
}

/// Returns the lines of a Rust file that break a rule, counted from 1, with the rule.
fn broken_rules(text: &str) -> Vec<(usize, String)> {
    let mut broken = wrong_openings(text);
    for (line, words) in (1..).zip(text.lines()) {
        for (start, end, plain) in PHRASES {
            let phrase = [start, end].concat();
            if words.to_lowercase().contains(&phrase) {
                broken.push((line, format!("`{phrase}`; expected {plain}")));
            }
        }
        let length = words.chars().count();
        if length > LINE {
            broken.push((line, format!("{length} characters; expected at most {LINE}")));
        }
    }
    let lines = text.lines().count();
    if lines > FILE {
        broken.push((lines, format!("{lines} lines; expected at most {FILE}: two stories, two files")));
    }
    broken
}

#[cfg(test)]
mod tests {
    use super::{FILE, LINE, broken_rules};

    fn lines_of(text: &str) -> Vec<usize> {
        broken_rules(text).into_iter().map(|(line, _)| line).collect()
    }

    #[test]
    fn long_lines_and_long_files_are_found() {
        assert_eq!(lines_of(&format!("a\n{}\n{}", "ä".repeat(LINE), "ä".repeat(LINE + 1))), [3]);
        assert!(lines_of(&"a\n".repeat(FILE)).is_empty());
        assert_eq!(lines_of(&"a\n".repeat(FILE + 1)), [FILE + 1]);
    }

    #[test]
    fn doc_comment_begins_with_a_noun_or_a_verb() {
        assert_eq!(lines_of("/// Whether it fires.\nfn a() {}\n/// The time.\n/// How it is found.\nfn b() {}\n"), [1]);
        assert_eq!(lines_of("//! What it is.\n"), [1]);
        assert_eq!(lines_of("\"\"\"Whether it fires.\"\"\"\n    /* How it fires. */\n/* The time. */\n"), [1, 2]);
        assert_eq!(lines_of(&["// for so ma", "ny sensors"].concat()), [1]);
    }
}
