//! Instructions of five calls, counted by Valgrind: unlike times, they repeat to a thousandth on any machine.

use std::process::Command;

use eeruf_benches::CALLS;

/// Thousands of instructions of each call, in a test build. Without incremental compilation, as in CI, more of the last
/// call is inlined.
fn thousands() -> [u64; CALLS.len()] {
    let last = if option_env!("CARGO_INCREMENTAL") == Some("0") { 633 } else { 1_044 };
    [86_967, 73_500, 473_000, 421, last]
}

/// Counts the instructions of the program, with a call or without.
fn instructions(call: Option<usize>) -> u64 {
    let program = ["--tool=callgrind", "--callgrind-out-file=/dev/null", env!("CARGO_BIN_EXE_once")];
    let run = Command::new("valgrind").args(program).args(call.map(|call| call.to_string())).output();
    let run = run.expect("expected valgrind, as `apt install valgrind` gives it");
    let said = String::from_utf8_lossy(&run.stderr);
    let counted = said.lines().find_map(|line| line.split_once("Collected : ")?.1.trim().parse().ok());
    counted.unwrap_or_else(|| panic!("no count in what valgrind says: {said}"))
}

#[test]
fn five_calls_take_what_they_took() {
    let without = instructions(None);
    let counted: Vec<u64> = (0..CALLS.len()).map(|call| (instructions(Some(call)) - without) / 1000).collect();
    let expected = thousands();
    let is_near = |(counted, expected): (&u64, &u64)| counted.abs_diff(*expected) <= expected / 20;
    assert!(counted.iter().zip(&expected).all(is_near), "{counted:?}; expected {expected:?} within 5 %");
}
