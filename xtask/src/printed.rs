//! Quotations of programs' output in documents: `<!-- printed by: COMMAND -->` stands before it, `<!-- end -->` after
//! it.
//!
//! The command is `eeruf ARGUMENTS` or `cargo ARGUMENTS`. Words in brackets qualify it, as in `<!-- printed by (large,
//! decimals are timings): COMMAND -->`: the command takes long, and numbers with a decimal point are timings, which are
//! not compared.

use std::process::Command;

use anyhow::{Result, anyhow, bail, ensure};
use fs_err as fs;

use crate::blocks::{Block, blocks, replaced};
use crate::steps::{output, run_line};

const PRINTED_BY: &str = "<!-- printed by";
const ROOMS: &str = "tests/data/rooms.txt";
const FENCE: &str = "```text\n";

/// Parts of a document to compare.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Which {
    All,
    /// The blocks that are not large.
    Small,
}

/// The mark of a printed part.
#[derive(Debug, PartialEq, Eq)]
struct Mark<'a> {
    large: bool,
    decimals_are_timings: bool,
    command: &'a str,
}

fn mark<'a>(block: &Block<'a>) -> Result<Mark<'a>> {
    let bad = || anyhow!("`printed by{}`; expected `printed by (WORDS): COMMAND`", block.label);
    let (words, command) = block.label.split_once(": ").ok_or_else(bad)?;
    let words = words.trim().trim_start_matches('(').trim_end_matches(')');
    let mut mark = Mark { large: false, decimals_are_timings: false, command };
    for word in words.split(", ").filter(|word| !word.is_empty()) {
        match word {
            "large" => mark.large = true,
            "decimals are timings" => mark.decimals_are_timings = true,
            _ => return Err(bad()),
        }
    }
    Ok(mark)
}

/// README.md, ARCHITECTURE.md, all documents in `docs`, and the tables of rooms that they quote.
pub(crate) fn documents() -> Result<Vec<String>> {
    let listed = output(Command::new("git").args(["ls-files", "README.md", "ARCHITECTURE.md", "docs/*.md", ROOMS]))?;
    Ok(listed.lines().map(str::to_owned).collect())
}

/// Compares documents with the current output of their commands.
pub(crate) fn check(documents: &[String], which: Which) -> Result<()> {
    let mut differ = Vec::new();
    let mut same = 0;
    for document in documents {
        for block in blocks(&fs::read_to_string(document)?, PRINTED_BY)? {
            let mark = mark(&block)?;
            if which == Which::Small && mark.large {
                continue;
            }
            let printed = output_of(&mark)?;
            let compared =
                |text: &str| if mark.decimals_are_timings { without_decimals(text) } else { text.to_owned() };
            if compared(unfenced(block.body)) == compared(printed.trim()) {
                same += 1;
            } else {
                println!("{document}: {} prints\n{printed}", mark.command);
                differ.push(format!("{document}: {}", mark.command));
            }
        }
    }
    println!("{same} parts of documents are as printed");
    ensure!(differ.is_empty(), "not as printed: {}", differ.join("; "));
    Ok(())
}

/// Replaces quoted output in a document by the current output.
pub(crate) fn reprint(document: &str) -> Result<()> {
    let fresh = replaced(&fs::read_to_string(document)?, PRINTED_BY, |block| {
        let printed = output_of(&mark(block)?)?;
        let fenced = block.body.trim().starts_with(FENCE);
        Ok(if fenced { format!("{FENCE}{}\n```", printed.trim_end()) } else { printed })
    })?;
    Ok(fs::write(document, fresh)?)
}

/// Returns the body of a part, without the fence around text that is not Markdown.
fn unfenced(body: &str) -> &str {
    let body = body.trim();
    body.strip_prefix(FENCE).map_or(body, |inner| inner.trim_end_matches("```").trim())
}

/// Standard output of a command. Unless it is large, the lab is built as for the tests, to save a build.
fn output_of(mark: &Mark<'_>) -> Result<String> {
    let command = mark.command;
    println!("{command}");
    let mut words = command.split_whitespace();
    let mut process = match words.next() {
        Some("eeruf") => {
            run_line("cargo build --quiet --release --locked --package eeruf --bin eeruf")?;
            Command::new("target/release/eeruf")
        }
        Some("cargo") if !mark.large && words.clone().next() == Some("lab") => {
            words.next();
            Command::new(crate::toolchain::lab()?)
        }
        Some("cargo") => Command::new("cargo"),
        _ => bail!("{command}: expected eeruf or cargo"),
    };
    output(process.args(words))
}

/// The text without numbers that have a decimal point, and without the spaces that align columns.
fn without_decimals(text: &str) -> String {
    let is_timing = |word: &str| word.contains('.') && word.replace(',', "").parse::<f64>().is_ok();
    let words = text.split(|letter: char| letter.is_whitespace() || "()".contains(letter));
    words.filter(|word| !word.is_empty() && !is_timing(word)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mark_says_what_is_large_and_what_are_timings() {
        let of = |label| mark(&Block { label, body: "" }).ok();
        let plain = Mark { large: false, decimals_are_timings: false, command: "eeruf design" };
        assert_eq!(of(": eeruf design"), Some(plain));
        let both = Mark { large: true, decimals_are_timings: true, command: "cargo run" };
        assert_eq!(of(" (large, decimals are timings): cargo run"), Some(both));
        assert_eq!(of(" (huge): cargo run"), None);
    }

    #[test]
    fn fence_around_a_part_is_ignored() {
        assert_eq!(unfenced("\n```text\na\n|-- b\n```\n"), "a\n|-- b");
        assert_eq!(unfenced("\n| a |\n"), "| a |");
    }

    #[test]
    fn timings_are_left_alone_and_nothing_else() {
        assert_eq!(without_decimals("| 62 (26 / 0.1) |"), without_decimals("| 62 (26 / 12.75)  |"));
        assert_ne!(without_decimals("| 62 (26 / 0.1) |"), without_decimals("| 62 (27 / 0.1) |"));
    }
}
