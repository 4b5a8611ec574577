//! The boards in the simulated world, in lock step with a ring on the host.

use std::env::consts::EXE_SUFFIX;
use std::process::{Command, Stdio};

use super::{BOARDS, emulator, image};
use crate::steps::Trouble;

/// The program on the host that puts the boards into a simulated world, and the boards' side of it.
const HARNESS: &str = "eeruf-hil";
const BOARD_PROGRAM: &str = "eeruf-hil-board";
/// The same with a ring that hops in time.
const HOPPING_PROGRAM: &str = "eeruf-hil-hopping";

/// Readings of every board's ring in that world without a fault: readings, as the host's ring, accepted, rejected, of
/// the kind that was simulated. Board and host run the same core, so that only numbers can tell that both are wrong.
const READ: [&str; 5] = ["8000", "all", "6213", "1779", "8000"];
/// Faults, how many readings of other sensors are then of another kind, and how the report begins that names the fault.
const FAULTS: [(&str, &str, &str); 6] = [
    ("sensor 3 missing", "0", "missing after 4 periods"),
    // A line that rose after its trigger counts as held for 250 ms.
    ("sensor 3 stuck high", "0", "stuck high after 23 periods"),
    ("sensor 3 chattering", "0", "chatters after 2 periods"),
    ("sensor 3 losing interrupts", "0", "loses edges after 6 periods"),
    ("main loop stalls for 50 ms", "2", "a firing 32"),
    ("clock wraps", "0", "nothing to name"),
];

/// The boards' rings in the simulated world, in lock step with the host's; the tables that come of it.
pub(super) fn run() -> Result<String, Trouble> {
    let tables = in_lock_step(BOARD_PROGRAM, &[])?;
    match unlike(&tables) {
        Some(row) => Err(Trouble::Failed(format!("hardware in the loop: not the numbers that core has: {row}"))),
        None => Ok(tables),
    }
}

/// The same with rings that hop in time.
pub(super) fn run_hopping() -> Result<String, Trouble> {
    in_lock_step(HOPPING_PROGRAM, &["--hopping"])
}

fn in_lock_step(program: &str, arguments: &[&str]) -> Result<String, Trouble> {
    crate::program::build(&["--bin", HARNESS])?;
    let mut harness = Command::new(format!("target/debug/{HARNESS}{EXE_SUFFIX}"));
    harness.arg("scenes/alcove-hc-sr04.toml").args(arguments);
    for board in &BOARDS {
        let qemu = emulator(board, &image(board, program)?, 6);
        harness.args(["--board", board.name]).arg(qemu.get_program()).args(qemu.get_args());
    }
    let what = |why: &dyn std::fmt::Display| Trouble::Failed(format!("hardware in the loop: {why}"));
    let said = harness.stderr(Stdio::inherit()).output().map_err(|error| what(&error))?;
    let tables = String::from_utf8_lossy(&said.stdout).into_owned();
    if said.status.success() { Ok(tables) } else { Err(what(&said.status)) }
}

/// A row, or what is missing, whose numbers are not those of [`READ`] and [`FAULTS`].
fn unlike(tables: &str) -> Option<String> {
    let rows: Vec<Vec<&str>> =
        tables.lines().map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect();
    let of = |board: &str, fault: Option<&str>| {
        rows.iter().find(|row| row.first() == Some(&board) && fault.is_none_or(|fault| row.get(1) == Some(&fault)))
    };
    for board in BOARDS.map(|board| board.name) {
        match of(board, None) {
            Some(row) if row.get(1..6) == Some(&READ) => {}
            row => return Some(row.map_or_else(|| format!("no row of {board}"), |row| row.join(" | "))),
        }
        for (fault, others, named) in FAULTS {
            match of(board, Some(fault)).map(Vec::as_slice) {
                Some(&[_, _, read, as_host, kinds, _, name])
                    if read == READ[0] && as_host == "all" && kinds == others && name.starts_with(named) => {}
                Some(row) => return Some(row.join(" | ")),
                None => return Some(format!("no row of {board}, {fault}")),
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(accepted: &str, kinds: &str) -> String {
        let row = |board: &str| format!("| {board} | 8000 | all | {accepted} | 1779 | 8000 | 1 us | 1 us | 1 us |\n");
        let fault = |board: &str, &(fault, _, named): &(&str, &str, &str)| {
            let kinds = if fault.starts_with("main") { kinds } else { "0" };
            format!("| {board} | {fault} | 8000 | all | {kinds} | 3 us | {named} |\n")
        };
        let boards = BOARDS.map(|board| board.name);
        let faults = boards.iter().flat_map(|board| FAULTS.iter().map(move |known| fault(board, known)));
        boards.iter().map(|board| row(board)).chain(faults).collect()
    }

    #[test]
    fn the_document_has_the_numbers_that_are_asked_for() {
        let document = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/log/firmware.md");
        let text = std::fs::read_to_string(document).expect("docs/log/firmware.md");
        let begin = text.find("<!-- measured: in a simulated world -->").expect("the table");
        let end = text[begin..].find("<!-- end -->").expect("its end");
        assert_eq!(unlike(&text[begin..begin + end]), None);
    }

    // Other numbers than core has are noticed though board and host agree.
    #[test]
    fn numbers_that_differ_from_cores_are_noticed() {
        assert_eq!(unlike(&table("6213", "2")), None);
        assert!(unlike(&table("6212", "2")).is_some_and(|row| row.contains("6212")));
        assert!(unlike(&table("6213", "27")).is_some_and(|row| row.contains("stalls")));
        let one_missing: String = table("6213", "2").lines().skip(1).map(|line| format!("{line}\n")).collect();
        assert!(unlike(&one_missing).is_some());
        assert_eq!(unlike(""), Some("no row of microbit".to_owned()));
    }
}
