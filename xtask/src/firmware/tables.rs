//! The tables of `tests/data/boards.txt`, and their limits.

use anyhow::{Context as _, Result, bail};

use super::{BOARDS, Board, build, c_example, cargo, expect, on_target_tests, run_image, sections, stack};
use crate::measured::{self, Tables};
use crate::toolchain::{DEBIAN_RUSTC, is_debian, most_bytes, version_of};

/// Budgets of a ring of twelve on the Cortex-M0: name in the measured lines, most instructions.
const INSTRUCTIONS: [(&str, u32); 6] =
    [("idle_poll", 41), ("fire", 98), ("echo", 69), ("stamp", 60), ("reading", 467), ("reading_late", 2269)];
/// Budgets of a flow ring. `mean_reading` covers all readings of the measured world, six in ten of which are not
/// believed.
const FLOW_INSTRUCTIONS: [(&str, u32); 3] = [("fire", 309), ("reading_moving", 2166), ("mean_reading", 868)];
/// Programs of a flow ring of twelve: instructions and size.
const FLOW: [&str; 2] = ["flow-instructions", "size-flow-12"];
/// Share of a budget by which compilers may exceed it.
const LEEWAY: f64 = 0.05;
const FLASH: u64 = 5468;
const RAM: u64 = 12 * 32 + 92;
const STACK: u64 = 624;

/// Returns the tables of all boards or of one, and exceeded budgets.
pub(super) fn measure(only: Option<&str>) -> Result<(Tables, Vec<String>)> {
    let boards = || BOARDS.iter().filter(|board| only.is_none_or(|only| only == board.name));
    let mut tables = Tables::new();
    let mut over = Vec::new();
    let calls = "| board | call | fewest instructions | most |\n|---|---|---:|---:|\n";
    let [mut instructions, mut sizes, mut lateness, mut compilers, mut stacks] = [
        calls,
        "| board | sensors | flash (text) | data + bss |\n|---|---:|---:|---:|\n",
        "| board | ns per instruction | lateness under echo load |\n|---|---:|---|\n",
        "| board | compiler |\n|---|---|\n",
        "| board | function | worst stack, bytes |\n|---|---|---:|\n",
    ]
    .map(str::to_owned);
    let mut flow_calls = calls.to_owned();
    let mut flow_sizes =
        "| board | flash (text) | data + bss | stack of a poll | of a restart |\n|---|---:|---:|---:|---:|\n"
            .to_owned();
    for board in boards() {
        let rustc = if is_debian(&cargo(board)?) { DEBIAN_RUSTC } else { "rustc" };
        compilers += &format!("| {} | rustc {} |\n", board.name, version_of(rustc)?);
        build(board, &["--workspace", "--exclude", "eeruf-rtic", "--exclude", "eeruf-embassy"])?;
        expect(board, "eeruf-ring", 6, "accepted 1089")?;
        on_target_tests(board)?;
        let said = format!("{}{}", run_image(board, "instructions", 10)?, run_image(board, "instructions-alone", 10)?);
        instructions += &of_calls(board, &said)?;
        let bare = sections(board, "size-bare")?;
        for k in [8, 12, 24] {
            let with = sections(board, &format!("size-{k}"))?;
            let (flash, ram) = (with.0 - bare.0, with.1 - bare.1);
            sizes += &format!("| {} | {k} | {flash} | {ram} |\n", board.name);
            if is_budgeted(board) && k == 12 && (flash > most_bytes(FLASH) || ram > RAM) {
                over.push(format!("{flash} bytes of flash and {ram} of RAM; the budget is {FLASH} and {RAM}"));
            }
        }
        if is_budgeted(board) {
            over.extend(exceeded(&said, &INSTRUCTIONS)?);
        }
        let [of_calls_alone, size] = FLOW;
        let said = run_image(board, of_calls_alone, 10)?;
        flow_calls += &of_calls(board, &said)?;
        if is_budgeted(board) {
            over.extend(exceeded(&said, &FLOW_INSTRUCTIONS)?);
        }
        let with = sections(board, size)?;
        let (flash, ram) = (with.0 - bare.0, with.1 - bare.1);
        let [restart, poll] = if stack::is_read_on(board) {
            stack::stack(board, size, stack::FLOW_RING)?.map(|(_, bytes)| bytes.to_string())
        } else {
            ["-", "-"].map(str::to_owned)
        };
        flow_sizes += &format!("| {} | {flash} | {ram} | {poll} | {restart} |\n", board.name);
        if stack::is_read_on(board) {
            for (function, bytes) in stack::stack(board, "size-12", stack::RING)? {
                stacks += &format!("| {} | `{function}` | {bytes} |\n", board.name);
                if is_budgeted(board) && bytes > most_bytes(STACK) {
                    over.push(format!("{function}: {bytes} bytes of stack; the budget is {STACK}"));
                }
            }
        }
        for shift in [6, 9] {
            let said = run_image(board, "lateness", shift)?;
            lateness += &format!("| {} | {} | {} |\n", board.name, 1 << shift, said.trim());
        }
    }
    let [microbit, lm3s6965, ..] = &BOARDS;
    if boards().any(|board| board.name == lm3s6965.name) {
        build(lm3s6965, &["--package", "eeruf-rtic", "--package", "eeruf-embassy"])?;
        expect(lm3s6965, "eeruf-rtic", 6, "accepted 1188")?;
        expect(lm3s6965, "eeruf-embassy", 6, "accepted 1188")?;
        let search = run_image(lm3s6965, "search", 6)?;
        tables.insert("search", format!("| board | search |\n|---|---|\n| {} | {} |\n", lm3s6965.name, search.trim()));
    }
    if boards().any(|board| board.name == microbit.name) {
        build(microbit, &["--package", "eeruf-embassy"])?;
        expect(microbit, "eeruf-embassy", 6, "accepted 1188")?;
    }
    if only.is_none() {
        c_example(lm3s6965)?;
    }
    let all = [
        (measured::COMPILERS, compilers),
        ("instructions", instructions),
        ("size", sizes),
        ("stack", stacks),
        ("lateness", lateness),
        ("flow instructions", flow_calls),
        ("flow size", flow_sizes),
    ];
    tables.extend(all);
    Ok((tables, over))
}

/// Returns true for the smallest core, to which the budgets apply.
fn is_budgeted(board: &Board) -> bool {
    board.name == BOARDS[0].name
}

/// Makes rows from the lines `name fewest most`.
fn of_calls(board: &Board, said: &str) -> Result<String> {
    let mut text = String::new();
    for line in said.lines() {
        let [name, fewest, most] = line.split(' ').collect::<Vec<_>>()[..] else { continue };
        if most.parse::<u32>().is_err() {
            bail!("{}: {line}", board.name);
        }
        text += &format!("| {} | {name} | {fewest} | {most} |\n", board.name);
    }
    Ok(text)
}

/// Returns the calls that take more instructions than their budgets, from the lines `name fewest most`; each budgeted
/// call must occur.
fn exceeded(said: &str, budgets: &[(&str, u32)]) -> Result<Vec<String>> {
    let mut over = Vec::new();
    for (name, budget) in budgets {
        let line = said.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        let most = line.and_then(|line| line.split(' ').nth(1)?.parse::<u32>().ok());
        let most = most.with_context(|| format!("{name} has a budget and was not measured:\n{said}"))?;
        if f64::from(most) > f64::from(*budget) * (1.0 + LEEWAY) {
            over.push(format!("{name}: {most} instructions; the budget is {budget}"));
        }
    }
    Ok(over)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budgeted_call_that_is_too_long_or_is_not_measured_fails() {
        let of = |said: &str| exceeded(said, &[("fire", 100), ("echo", 60)]).map_err(|error| error.to_string());
        assert_eq!(of("fire 80 105\necho 3 60\nfire_late 1 999\n"), Ok(vec![]));
        assert_eq!(of("fire 80 106\necho 3 60\n"), Ok(vec!["fire: 106 instructions; the budget is 100".to_owned()]));
        assert!(of("fire 80 95\n").unwrap_err().starts_with("echo has a budget and was not measured"));
        assert!(of("fire 80 95\necho_late 1 2\n").is_err() && of("fire 80 95\necho 1\n").is_err());
    }
}
