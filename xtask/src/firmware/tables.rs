//! The tables of `docs/log/firmware.md`, and what they may not exceed.

use std::process::Command;

use super::{
    BOARDS, Board, build, c_example, cargo, expect, in_the_loop, on_target_tests, rings, run_image, sections, stack,
};
use crate::measured::{self, Tables};
use crate::steps::{Trouble, output};

/// Budgets of a ring of twelve on the Cortex-M0: (name in the measured lines, most instructions).
const INSTRUCTIONS: [(&str, u32); 6] =
    [("idle_poll", 44), ("fire", 116), ("echo", 69), ("stamp", 60), ("reading", 553), ("reading_late", 3311)];
/// A ring of twelve that weighs readings by a tracker, and what it may cost there: it may not grow unnoticed.
struct Budget {
    name: &'static str,
    /// The programs that are measured: instructions and size.
    programs: [&'static str; 2],
    calls: &'static [(&'static str, u32)],
    flash: u64,
    ram: u64,
    /// Of a poll.
    stack: u64,
}

const HOPPING: Budget = Budget {
    name: "hopping",
    programs: ["hopping-instructions", "size-hopping-12"],
    calls: &[
        ("idle_poll", 49),
        ("fire", 146),
        ("echo", 74),
        ("reading", 1214),
        ("reading_moving", 1336),
        ("period_ended", 3003),
        ("new_lags", 24_354),
    ],
    flash: 8788,
    ram: 928,
    stack: 332,
};
const FLOW: Budget = Budget {
    name: "flow",
    programs: ["flow-instructions", "size-flow-12"],
    calls: &[
        ("idle_poll", 56),
        ("fire", 156),
        ("echo", 72),
        ("reading", 1240),
        ("reading_moving", 1416),
        ("period_ended", 4237),
    ],
    flash: 9052,
    ram: 916,
    stack: 372,
};
/// Compilers differ: only more than the budget and this part of it fails.
const LEEWAY: f64 = 0.05;
const FLASH: u64 = 5048;
const RAM: u64 = 12 * 32 + 92;
const STACK: u64 = 624;

/// The tables of all boards or of one, and which budgets are exceeded. Only of all boards there is the simulated world.
pub(super) fn measure(only: Option<&str>) -> Result<(Tables, Vec<String>), Trouble> {
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
    // Calls and sizes, of hopping and of flow.
    let tracking = "| board | flash (text) | data + bss | stack of a poll | of `new` |\n|---|---:|---:|---:|---:|\n";
    let mut tracking = [HOPPING, FLOW].map(|budget| (budget, calls.to_owned(), tracking.to_owned()));
    for board in boards() {
        compilers += &format!("| {} | {} |\n", board.name, compiler(board)?);
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
            if is_budgeted(board) && k == 12 && (flash > FLASH || ram > RAM) {
                over.push(format!("{flash} bytes of flash and {ram} of RAM; the budget is {FLASH} and {RAM}"));
            }
        }
        if is_budgeted(board) {
            over.extend(exceeded(&said, &INSTRUCTIONS)?);
        }
        for (budget, calls, sizes) in &mut tracking {
            let costs = Costs::of(board, budget)?;
            *calls += &of_calls(board, &costs.calls)?;
            *sizes += &costs.row(board);
            if is_budgeted(board) {
                over.extend(costs.over(budget)?);
            }
        }
        if stack::is_read_on(board) {
            for (function, bytes) in stack::stack(board, "size-12", stack::RING)? {
                stacks += &format!("| {} | `{function}` | {bytes} |\n", board.name);
                if is_budgeted(board) && bytes > STACK {
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
        rings::start(lm3s6965)?;
        tables.insert("in a simulated world", in_the_loop::run()?);
        tables.insert("hopping in a simulated world", in_the_loop::run_hopping()?);
    }
    let [(_, hopping_calls, hopping_sizes), (_, flow_calls, flow_sizes)] = tracking;
    let all = [
        (measured::COMPILERS, compilers),
        ("instructions", instructions),
        ("size", sizes),
        ("stack", stacks),
        ("lateness", lateness),
        ("hopping instructions", hopping_calls),
        ("hopping size", hopping_sizes),
        ("flow instructions", flow_calls),
        ("flow size", flow_sizes),
    ];
    tables.extend(all);
    Ok((tables, over))
}

/// The budgets are those of the smallest core.
fn is_budgeted(board: &Board) -> bool {
    board.name == BOARDS[0].name
}

/// Rows of the lines `name fewest most`.
fn of_calls(board: &Board, said: &str) -> Result<String, Trouble> {
    let mut text = String::new();
    for line in said.lines() {
        let [name, fewest, most] = line.split(' ').collect::<Vec<_>>()[..] else { continue };
        if most.parse::<u32>().is_err() {
            return Err(Trouble::Failed(format!("{}: {line}", board.name)));
        }
        text += &format!("| {} | {name} | {fewest} | {most} |\n", board.name);
    }
    Ok(text)
}

/// Calls that take more instructions than their budgets, by the lines `name fewest most`. Each must be among them.
fn exceeded(said: &str, budgets: &[(&str, u32)]) -> Result<Vec<String>, Trouble> {
    let mut over = Vec::new();
    for (name, budget) in budgets {
        let line = said.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        let most = line.and_then(|line| line.split(' ').nth(1)?.parse::<u32>().ok());
        let most = most.ok_or_else(|| Trouble::Failed(format!("{name} has a budget and was not measured:\n{said}")))?;
        if exceeds(most.into(), (*budget).into()) {
            over.push(format!("{name}: {most} instructions; the budget is {budget}"));
        }
    }
    Ok(over)
}

/// By more than compilers differ.
fn exceeds(value: u64, budget: u64) -> bool {
    value as f64 > budget as f64 * (1.0 + LEEWAY)
}

/// Costs on a board of a ring of twelve that weighs readings by a tracker.
struct Costs {
    /// Lines `name fewest most`, in instructions.
    calls: String,
    flash: u64,
    ram: u64,
    /// Of creating it and of a poll, where that can be read off.
    stack: Option<[u64; 2]>,
}

impl Costs {
    fn of(board: &Board, budget: &Budget) -> Result<Self, Trouble> {
        let [calls, size] = budget.programs;
        let (with, bare) = (sections(board, size)?, sections(board, "size-bare")?);
        let stack = || stack::stack(board, size, stack::TRACKING_RING);
        let stack = stack::is_read_on(board).then(stack).transpose()?.map(|of| of.map(|(_, bytes)| bytes));
        let calls = run_image(board, calls, 10)?;
        Ok(Self { calls, flash: with.0 - bare.0, ram: with.1 - bare.1, stack })
    }

    fn row(&self, board: &Board) -> String {
        let [new, poll] = self.stack.map_or(["-", "-"].map(str::to_owned), |of| of.map(|bytes| bytes.to_string()));
        format!("| {} | {} | {} | {poll} | {new} |\n", board.name, self.flash, self.ram)
    }

    /// Excess of the costs over a budget.
    fn over(&self, budget: &Budget) -> Result<Vec<String>, Trouble> {
        let name = budget.name;
        let calls = exceeded(&self.calls, budget.calls)?;
        let mut over: Vec<_> = calls.into_iter().map(|what| format!("{name}, {what}")).collect();
        if exceeds(self.flash, budget.flash) || exceeds(self.ram, budget.ram) {
            let (costs, budget) = ((self.flash, self.ram), (budget.flash, budget.ram));
            over.push(format!("{name}: (flash, RAM) is {costs:?} bytes; the budget is {budget:?}"));
        }
        if let Some([_, poll]) = self.stack.filter(|[_, poll]| exceeds(*poll, budget.stack)) {
            over.push(format!("{name}, a poll: {poll} bytes of stack; the budget is {}", budget.stack));
        }
        Ok(over)
    }
}

/// The compiler that a board's figures are of, as "rustc 1.95".
fn compiler(board: &Board) -> Result<String, Trouble> {
    let debian = cargo(board)?.get_program() == "/usr/bin/cargo";
    let rustc = if debian { "/usr/bin/rustc" } else { "rustc" };
    let said = output(Command::new(rustc).arg("--version")).unwrap_or_default();
    let version = said.strip_prefix("rustc ").and_then(|rest| rest.split('.').nth(1).map(|minor| (rest, minor)));
    let (rest, minor) = version.ok_or_else(|| Trouble::Failed(format!("{rustc} --version says {said}")))?;
    let major = rest.split('.').next().unwrap_or_default();
    Ok(format!("rustc {major}.{minor}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budgeted_call_that_is_too_long_or_is_not_measured_fails() {
        let of = |said: &str| {
            exceeded(said, &[("fire", 100), ("echo", 60)]).map_err(|trouble| match trouble {
                Trouble::Failed(why) | Trouble::Skipped(why) => why,
            })
        };
        assert_eq!(of("fire 80 105\necho 3 60\nfire_late 1 999\n"), Ok(vec![]));
        assert_eq!(of("fire 80 106\necho 3 60\n"), Ok(vec!["fire: 106 instructions; the budget is 100".to_owned()]));
        assert!(of("fire 80 95\n").unwrap_err().starts_with("echo has a budget and was not measured"));
        assert!(of("fire 80 95\necho_late 1 2\n").is_err() && of("fire 80 95\necho 1\n").is_err());
    }
}
