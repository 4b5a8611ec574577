//! Tables of measurements in tests/data/boards.txt: `<!-- measured: NAME -->` stands before each, `<!-- end -->`
//! after it.
//!
//! Counts repeat on the same compiler and must be the same; those of another one, which may be a third more or less,
//! are not compared. Timings differ a little from run to run.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result, ensure};
use fs_err as fs;

use crate::blocks::{blocks, replaced};

pub(crate) const DOCUMENT: &str = "tests/data/boards.txt";
const MEASURED: &str = "<!-- measured: ";
/// The table that names the compiler of each board's figures.
pub(crate) const COMPILERS: &str = "compilers";

/// Tolerance of a timing, as a share of the larger one and in addition: the emulator does not take every interrupt at
/// the same instruction.
const TIMING_SHARE: f64 = 0.1;
const TIMING_BESIDES: f64 = 40.0;

/// Measured tables by their names.
pub(crate) type Tables = BTreeMap<&'static str, String>;

/// Puts the tables into the document.
pub(crate) fn write(tables: &Tables) -> Result<()> {
    let fresh = replaced(&fs::read_to_string(DOCUMENT)?, MEASURED, |block| {
        tables.get(block.label).cloned().with_context(|| format!("nothing is measured for {}", block.label))
    })?;
    Ok(fs::write(DOCUMENT, fresh)?)
}

/// Compares the tables with those of the document, or with the rows of one board in them.
pub(crate) fn check(tables: &Tables, only: Option<&str>) -> Result<()> {
    let text = fs::read_to_string(DOCUMENT)?;
    let documented: BTreeMap<&str, &str> =
        blocks(&text, MEASURED)?.iter().map(|block| (block.label, block.body)).collect();
    let mut differ = Vec::new();
    for (name, measured) in tables {
        let expected = documented.get(name).with_context(|| format!("{DOCUMENT} has no `{MEASURED}{name} -->`"))?;
        if *name != COMPILERS {
            let now = rows(tables.get(COMPILERS).map_or("", String::as_str));
            let then = rows(documented.get(COMPILERS).unwrap_or(&""));
            let expected = only.map_or((*expected).to_owned(), |only| rows_of(expected, only));
            differ.extend(differences(name, &expected, measured, |board| {
                now.iter().any(|row| row.first() == Some(&board) && then.contains(row))
            }));
        }
    }
    let differ = differ.join("\n");
    ensure!(differ.is_empty(), "{DOCUMENT}: not as measured (`cargo xtask firmware --write` writes it):\n{differ}");
    println!("{DOCUMENT}: {} tables are as measured", tables.len());
    Ok(())
}

/// Returns a table without the rows of other boards.
fn rows_of(table: &str, board: &str) -> String {
    let kept = ["board", "---", board];
    let is_kept = |line: &&str| rows(line).iter().flatten().next().is_some_and(|first| kept.contains(first));
    table.lines().filter(is_kept).map(|line| format!("{line}\n")).collect()
}

/// The cells of a line.
pub(crate) fn cells(line: &str) -> Vec<&str> {
    line.trim().trim_matches('|').split('|').map(str::trim).collect()
}

/// The cells of each line.
fn rows(table: &str) -> Vec<Vec<&str>> {
    table.lines().filter(|line| !line.trim().is_empty()).map(cells).collect()
}

fn differences(
    name: &str,
    expected: &str,
    measured: &str,
    is_of_the_same_compiler: impl Fn(&str) -> bool,
) -> Vec<String> {
    let (expected, measured) = (rows(expected), rows(measured));
    let mut differ = Vec::new();
    if expected.len() != measured.len() {
        differ.push(format!("{name}: {} lines; measured {}", expected.len(), measured.len()));
    }
    for (expected, measured) in expected.iter().zip(&measured) {
        if !is_of_the_same_compiler(measured.first().unwrap_or(&"")) {
            continue;
        }
        let same = |(expected, measured): (&&str, &&str)| is_same(expected, measured);
        if expected.len() != measured.len() || !expected.iter().zip(measured).all(same) {
            differ.push(format!("{name}: | {} |, measured | {} |", expected.join(" | "), measured.join(" | ")));
        }
    }
    differ
}

/// Returns true if a cell matches the measured one. A number is a timing if it stands before `us` or `ms`, or after a
/// word that ends in `_us`.
fn is_same(expected: &str, measured: &str) -> bool {
    let words = |cell: &str| cell.split_whitespace().map(|word| word.trim_end_matches(',').to_owned()).collect();
    let (expected, measured): (Vec<String>, Vec<String>) = (words(expected), words(measured));
    let is_timing = |index: usize| {
        matches!(measured.get(index + 1).map(String::as_str), Some("us" | "ms"))
            || index.checked_sub(1).and_then(|before| measured.get(before)).is_some_and(|word| word.ends_with("_us"))
    };
    let same = |(index, (expected, measured)): (usize, (&String, &String))| match (
        expected.parse::<f64>(),
        measured.parse::<f64>(),
    ) {
        (Ok(expected), Ok(measured)) => {
            let (share, besides) = if is_timing(index) { (TIMING_SHARE, TIMING_BESIDES) } else { (0.0, 0.0) };
            (expected - measured).abs() <= share * expected.max(measured) + besides
        }
        _ => expected == measured,
    };
    expected.len() == measured.len() && expected.iter().zip(&measured).enumerate().all(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    // Counts must be the same on the same compiler and are left alone on another.
    #[test]
    fn counts_must_match_on_the_same_compiler() {
        let table = |most: u32| format!("| board | most |\n|---|---:|\n| microbit | {most} |\n");
        assert!(differences("size", &table(3564), &table(3564), |_| true).is_empty());
        assert_eq!(
            differences("size", &table(3564), &table(3560), |_| true),
            ["size: | microbit | 3564 |, measured | microbit | 3560 |"]
        );
        assert!(differences("size", &table(3564), &table(3560), |board| board != "microbit").is_empty());
    }

    #[test]
    fn one_board_is_compared_with_its_own_rows() {
        let table = "| board | most |\n|---|---:|\n| microbit | 1 |\n| rv_virt | 2 |\n";
        assert_eq!(rows_of(table, "rv_virt"), "| board | most |\n|---|---:|\n| rv_virt | 2 |\n");
    }

    // Timings may differ a little and words and counts beside them may not.
    #[test]
    fn timings_may_differ_a_little() {
        assert!(is_same("a firing 32.1 ms late", "a firing 32.073 ms late"));
        assert!(!is_same("a firing 32.1 ms late", "nothing to name"));
        assert!(is_same("latest_us 58 accepted 2386", "latest_us 61 accepted 2386"));
        assert!(!is_same("latest_us 58 accepted 2386", "latest_us 58 accepted 2385"));
        assert!(!is_same("latest_us 58", "latest_us 158"));
    }
}
