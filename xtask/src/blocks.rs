//! Parts of documents that are made elsewhere. A program's output has a comment before it with the command, and
//! `<!-- end -->` after it. A listing is a part of a compiled file: `<!-- listing: FILE [from TEXT] [to TEXT] -->`
//! before a code block says which.

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use crate::printed::documents;

const END: &str = "<!-- end -->";

/// A part that was printed.
pub(crate) struct Block<'a> {
    /// The comment after its first words.
    pub(crate) label: &'a str,
    pub(crate) body: &'a str,
}

/// The parts of a text whose comments begin with these words.
pub(crate) fn blocks<'a>(text: &'a str, begin: &str) -> Result<Vec<Block<'a>>> {
    text.split(begin).skip(1).map(|rest| Ok(split(rest)?.0)).collect()
}

/// Returns the text with the body of each part replaced by the result of `fresh`.
pub(crate) fn replaced(text: &str, begin: &str, mut fresh: impl FnMut(&Block<'_>) -> Result<String>) -> Result<String> {
    let mut pieces = text.split(begin);
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (block, after) = split(piece)?;
        out += &format!("{begin}{} -->\n\n{}\n\n{END}{after}", block.label, fresh(&block)?.trim());
    }
    Ok(out)
}

fn split(rest: &str) -> Result<(Block<'_>, &str)> {
    let (label, rest) = rest.split_once(" -->\n").context("a comment has no end")?;
    let (body, after) = rest.split_once(END).with_context(|| format!("no {END} after {label}"))?;
    Ok((Block { label, body }, after))
}

/// Compares each listing of every document with its file.
pub(crate) fn check_listings() -> Result<()> {
    documents()?.iter().try_for_each(|document| check_listings_of(document))
}

/// Compares the listings of a document: each holds the lines from the first that contains the text after `from` to the
/// next that contains the text after `to`.
fn check_listings_of(document: &str) -> Result<()> {
    let (text, mut listings) = (fs::read_to_string(document)?, 0);
    for after in text.split("<!-- listing: ").skip(1) {
        let cut = || format!("{document}: the listing of {} has no end", after.lines().next().unwrap_or_default());
        let (what, after) = after.split_once(" -->\n").with_context(cut)?;
        let (_, after) = after.split_once('\n').with_context(cut)?;
        let (block, _) = after.split_once("```").with_context(cut)?;
        let (file, range) = what.split_once(" from ").unwrap_or((what, ""));
        let (from, to) = range.rsplit_once(" to ").unwrap_or((range, ""));
        let source = fs::read_to_string(file)?;
        let lines: Vec<&str> = source.lines().collect();
        let first = lines.iter().position(|line| line.contains(from)).unwrap_or(0);
        let ends = |line: &&str| !to.is_empty() && line.contains(to);
        let last = lines.iter().skip(first).position(ends).map_or(lines.len(), |n| first + n + 1);
        let same = block.trim_end() == lines[first..last].join("\n").trim_end();
        ensure!(same, "{document}: the listing of {what} differs from the file");
        listings += 1;
    }
    if listings > 0 {
        println!("{document}: {listings} listings are as in their files");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a\n<!-- made by x y -->\n\n1\n\n<!-- end -->\nb\n<!-- made by z -->\n\n2\n\n<!-- end -->\n";

    #[test]
    fn every_block_is_found_with_its_label_and_body() {
        let Ok(found) = blocks(TEXT, "<!-- made by ") else { panic!("two blocks") };
        let found: Vec<_> = found.iter().map(|block| (block.label, block.body.trim())).collect();
        assert_eq!(found, [("x y", "1"), ("z", "2")]);
    }

    #[test]
    fn replacing_a_body_by_itself_changes_nothing() {
        assert_eq!(replaced(TEXT, "<!-- made by ", |block| Ok(block.body.to_owned())).ok(), Some(TEXT.to_owned()));
    }

    #[test]
    fn a_block_without_an_end_is_an_error() {
        assert!(blocks("<!-- made by x -->\n1\n", "<!-- made by ").is_err());
    }
}
