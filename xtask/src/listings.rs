//! Listings in the documents are parts of compiled files: `<!-- listing: FILE [from TEXT] [to TEXT] -->` before a code
//! block says which.

use std::fs;

use crate::printed::documents;
use crate::steps::Trouble;

/// Compares each listing of every document with its file.
pub(crate) fn check_all() -> Result<(), Trouble> {
    documents()?.iter().try_for_each(|document| check(document))
}

/// The lines are those from the first that contains the text after `from` to the next that contains the text after
/// `to`.
fn check(document: &str) -> Result<(), Trouble> {
    let text = read(document)?;
    let mut rest = text.as_str();
    let mut listings = 0;
    while let Some((_, after)) = rest.split_once("<!-- listing: ") {
        let (what, after) =
            after.split_once(" -->\n").ok_or_else(|| failed(document, "a listing comment has no end"))?;
        let (_, after) = after.split_once('\n').ok_or_else(|| failed(document, what))?;
        let (block, after) = after.split_once("```").ok_or_else(|| failed(document, what))?;
        let (file, range) = what.split_once(" from ").unwrap_or((what, ""));
        let (from, to) = range.rsplit_once(" to ").unwrap_or((range, ""));
        let source = read(file)?;
        let lines: Vec<&str> = source.lines().collect();
        let first = lines.iter().position(|line| line.contains(from)).unwrap_or(0);
        let ends = |line: &&str| !to.is_empty() && line.contains(to);
        let last = lines.iter().skip(first).position(ends).map_or(lines.len(), |n| first + n + 1);
        if block.trim_end() != lines[first..last].join("\n").trim_end() {
            return Err(failed(document, &format!("the listing of {what} differs from the file")));
        }
        listings += 1;
        rest = after;
    }
    if listings > 0 {
        println!("{document}: {listings} listings are as in their files");
    }
    Ok(())
}

fn read(path: &str) -> Result<String, Trouble> {
    fs::read_to_string(path).map_err(|error| Trouble::Failed(format!("{path}: {error}")))
}

fn failed(document: &str, why: &str) -> Trouble {
    Trouble::Failed(format!("{document}: {why}"))
}
